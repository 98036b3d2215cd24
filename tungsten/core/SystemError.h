#pragma once
// What the system says of a failed call.

#include <string>
#include <system_error>

namespace tungsten {

/// The text of an `errno`, such as "No space left on device"; from any thread.
inline std::string systemError(int number) {
    return std::generic_category().message(number);
}

} // namespace tungsten
