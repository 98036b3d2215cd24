#pragma once
// The answer to `--describe`.

#include "tungsten/scene/SceneLoader.h"

#include <iosfwd>

namespace tungsten {

/// One field after the other, for the terminal.
void printDescriptions(const std::vector<DescribedKind>& kinds, std::ostream& out);

/// A page of tables; fields that several types of a kind share stand in one table. docs/scene-fields.md is this page.
void printMarkdown(const std::vector<DescribedKind>& kinds, std::ostream& out);

} // namespace tungsten
