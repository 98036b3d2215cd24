#pragma once
// The manual page and the shell's completion, from the options themselves.

#include <string>

namespace CLI {
class App;
}

namespace tungsten {

/// As man(1) reads it. `merge` is the command of that name.
std::string manualPage(const CLI::App& app, const CLI::App& merge, const std::string& version);
/// For bash: options of both, and scenes, states and images by their endings.
std::string bashCompletion(const CLI::App& app, const CLI::App& merge);

} // namespace tungsten
