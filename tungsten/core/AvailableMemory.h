#pragma once
// What memory there is.

#include <string>

namespace tungsten {

/// Bytes that this process can still take: of the machine's memory, of its control group's limit and of its own
/// (limitMemory, ulimit -d).
double availableMemoryBytes();

/// "1.5 GiB".
std::string memoryText(double bytes);

} // namespace tungsten
