#pragma once
// Signals that ask for an end.

#include "tungsten/session/ProcessGroup.h"

#include <atomic>

namespace tungsten {

/// Set by the first signal: break the pass off and write what those before it gave. A second leaves at once.
extern std::atomic<bool> interrupted;

/// While it lives, a first signal leaves at once, too: a scene is loaded, and there is nothing to write.
class Loading {
  public:
    Loading();
    ~Loading();
    Loading(const Loading&) = delete;
    Loading& operator=(const Loading&) = delete;
};

/// From now on writing fails where a file would exceed the limit of sizes (ulimit -f), as on a full disk.
void letTooLargeFilesFail();

/// Signals that ask for an end are handled, but those that whoever started the command has set aside (nohup). A reader
/// of our messages that goes away is no reason to lose a render. SIGUSR1 is what mpirun hands on without killing.
void handleSignals(const ProcessGroup* group);

} // namespace tungsten
