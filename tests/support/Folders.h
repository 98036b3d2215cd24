#pragma once
// Where the build put the command and its plugins, and where scenes are. Defined once, so that the tests' objects do
// not depend on paths.

#include <filesystem>

namespace tungsten::test {

std::filesystem::path binaryFolder(); ///< the command, its plugins and the host's library
std::filesystem::path dataFolder();   ///< `data/` of the project
std::filesystem::path corpusFolder(); ///< inputs of the fuzzed formats, a folder each
std::filesystem::path sharedFolder(); ///< scenes by others beside the project; need not exist

} // namespace tungsten::test
