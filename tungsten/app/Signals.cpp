#include "tungsten/app/Signals.h"

#include "tungsten/app/ExitCodes.h"

#include <csignal>

#include <unistd.h>

namespace tungsten {

std::atomic<bool> interrupted{false};

namespace {

std::atomic<bool> atLoading{false};

void onInterrupt(int) {
    constexpr char Message[] = "interrupted while loading: nothing was written\n";
    if (atLoading && write(STDERR_FILENO, Message, sizeof Message - 1) >= 0) _exit(ExitInterrupted);
    if (interrupted.exchange(true)) _exit(ExitInterrupted);
}

} // namespace

Loading::Loading() {
    atLoading = true;
}
Loading::~Loading() {
    atLoading = false;
}

void letTooLargeFilesFail() {
    std::signal(SIGXFSZ, SIG_IGN);
}

void handleSignals(const ProcessGroup* group) {
    if (group) std::signal(SIGUSR1, onInterrupt);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        if (std::signal(signal, onInterrupt) == SIG_IGN) std::signal(signal, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
}

} // namespace tungsten
