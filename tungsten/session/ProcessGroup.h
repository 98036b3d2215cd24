#pragma once
// Processes that render one film together, whatever carries their messages (tungsten/mpi).

#include "tungsten/integrator/Plugin.h"

#include <exception>
#include <memory>
#include <string>
#include <vector>

namespace tungsten {

using Bytes = std::vector<char>;

/// Every rank calls these functions alike and in the same order, from one thread.
class ProcessGroup {
  public:
    ProcessGroup() = default;
    virtual ~ProcessGroup() = default;
    ProcessGroup(const ProcessGroup&) = delete;
    ProcessGroup& operator=(const ProcessGroup&) = delete;

    /// From 0; rank 0 is the one that speaks and writes.
    [[nodiscard]] virtual int rank() const = 0;
    [[nodiscard]] virtual int size() const = 0;
    /// Ranks on this rank's machine.
    [[nodiscard]] virtual int onThisMachine() const = 0;
    /// Of this machine, for messages.
    [[nodiscard]] virtual std::string machine() const = 0;
    /// By place, the largest of what the ranks give. No NaN.
    [[nodiscard]] virtual std::vector<double> allReduceMax(std::vector<double> values) = 0;
    /// parts[r] goes to rank r; returns what each rank has for this one.
    [[nodiscard]] virtual std::vector<Bytes> allToAll(const std::vector<Bytes>& parts) = 0;
    /// Ends all ranks at once, wherever they are; any rank may call it.
    [[noreturn]] virtual void abort(int exitCode) = 0;
};

/// A failure that all ranks know of.
class GroupFailure : public std::exception {
  public:
    // NOLINTNEXTLINE(bugprone-throw-keyword-missing): a member is set, nothing is to be thrown
    explicit GroupFailure(std::exception_ptr toTell) : toTell_(std::move(toTell)) {}
    /// What this rank is to report; none where another one reports.
    [[nodiscard]] const std::exception_ptr& toTell() const { return toTell_; }
    [[nodiscard]] const char* what() const noexcept override { return "another process has failed"; }

  private:
    std::exception_ptr toTell_;
};

/// Runs action() in every rank. Where it throws in any, all ranks throw a GroupFailure; if rank 0
/// failed, it alone reports; otherwise each failed rank reports its own failure. Without a group action() just runs.
template <typename Action>
void runOnAll(ProcessGroup* group, const Action& action) {
    if (!group) return action();
    std::exception_ptr failure;
    try {
        action();
    } catch (...) {
        failure = std::current_exception();
    }
    const double failed = failure ? 1.0 : 0.0;
    const std::vector<double> all = group->allReduceMax({failed, group->rank() == 0 ? failed : 0.0});
    if (all[0] == 0.0) return;
    const bool othersTell = group->rank() > 0 && all[1] > 0.0;
    throw GroupFailure(othersTell ? nullptr : failure);
}

/// The group that this process was started in, by mpirun for example; none where it was started alone. Throws
/// UsageError where the part of this program that a group needs is not there.
std::unique_ptr<ProcessGroup> joinProcessGroup();

struct ProcessGroupModule {
    const char* abi;
    std::unique_ptr<ProcessGroup> (*join)();
};

} // namespace tungsten
