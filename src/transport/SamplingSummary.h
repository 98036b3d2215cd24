#pragma once
// What an integrator samples how, in words: the three lines of --explain.

#include "transport/Policy.h"

#include "tungsten/integrator/SceneFacts.h"

namespace tungsten::transport {

/// Which strategies run. `walks`: "camera paths" or "light paths".
std::string describeStrategies(const std::string& walks, const Decision& guidance, const Decision& sideBySide,
                               const std::optional<float>& plainShare);
/// How plain walks draw distances and directions.
inline constexpr const char* PlainVertices = "plain ones: distances by transmittance, directions by phase functions";
/// How guided walks draw them in media that scatter in time. `aims`: at a target, not at a moment alone.
std::string describeVertices(const Scene& scene, const Policy& policy, darts::Mode mode, const SceneFacts& facts,
                             bool aims);
/// The reasons of those that are on, in order.
std::string describeEnds(const std::vector<Decision>& ends);

} // namespace tungsten::transport
