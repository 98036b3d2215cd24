#pragma once
// `tungsten merge`: partial states in, images out.

#include <functional>

namespace CLI {
class App;
}

namespace tungsten {

/// The arguments start with "merge". Returns the exit code; throws UsageError and InputError.
int mergeCommand(int argc, const char* const* argv);
/// Calls use() with its parser, for what tells of its options.
void withMergeOptions(const std::function<void(const CLI::App&)>& use);

} // namespace tungsten
