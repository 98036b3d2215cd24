#pragma once
// `tungsten merge`: partial states in, images out.

namespace tungsten {

/// The arguments start with "merge". Returns the exit code; throws UsageError and InputError.
int mergeCommand(int argc, const char* const* argv);

} // namespace tungsten
