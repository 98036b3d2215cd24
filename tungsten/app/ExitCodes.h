#pragma once
// What the command leaves with; 0: all was done.

namespace tungsten {

inline constexpr int ExitBadInput = 1, ExitBadUsage = 2, ExitInterrupted = 130;

} // namespace tungsten
