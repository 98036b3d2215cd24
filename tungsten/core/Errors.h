#pragma once
// Errors a user can cause, as values that say where, what was found and what is accepted.

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tungsten {

/// One mistake in an input file: `file: path: message`.
struct Problem {
    std::string file;
    std::string path; ///< JSON path such as `primitives[3].transform`; empty for other files
    std::string message;

    /// To be printed.
    [[nodiscard]] std::string text() const;
};

/// On one line of a terminal, which acts on control characters: those as \x1b, and cut where it is very long.
std::string printable(std::string_view text);

/// Bad input: exit code 1. Carries every problem found, not only the first, and what would have been warned about.
class InputError : public std::runtime_error {
  public:
    explicit InputError(std::vector<Problem> problems, std::vector<Problem> warnings = {});
    InputError(std::string file, std::string message);
    [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }
    [[nodiscard]] const std::vector<Problem>& warnings() const { return warnings_; }

  private:
    std::vector<Problem> problems_, warnings_;
};

/// Bad command line: exit code 2.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The candidate closest to `name` by edit distance, whatever the case, or an empty string when none differs in less
/// than a quarter of the letters.
std::string nearestName(std::string_view name, const std::vector<std::string>& candidates);

/// "a, b or c", for messages that list what is accepted.
std::string listOf(const std::vector<std::string>& names);

} // namespace tungsten
