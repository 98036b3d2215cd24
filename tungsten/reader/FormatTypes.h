#pragma once
// What the format has and this renderer has not: every such type with what comes nearest to it.

#include <map>
#include <string>
#include <vector>

namespace tungsten {

/// By type, what to use instead.
using Instead = std::map<std::string, std::string>;

const Instead& unsupportedMedia();
const Instead& unsupportedTransmittances();
const Instead& unsupportedBsdfs();
const Instead& unsupportedMetals();
const Instead& unsupportedTextures();
const Instead& unsupportedPrimitives();
const Instead& unsupportedCameras();
const Instead& unsupportedIntegrators();

/// Against a type that is none of `supported`: that it is not supported and what is nearest in meaning, where `instead`
/// knows it; else what is expected, with the nearest name. `found` is how the problem shows it.
std::string refusal(const std::string& type, const std::string& found, const std::vector<std::string>& supported,
                    const Instead& instead);

} // namespace tungsten
