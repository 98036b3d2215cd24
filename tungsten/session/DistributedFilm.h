#pragma once
// A film that the ranks of a group fold together, each some image rows of every pass.

#include "tungsten/film/Film.h"
#include "tungsten/session/ProcessGroup.h"
#include "tungsten/session/SessionResult.h"

#include <chrono>

namespace tungsten {

/// In every round each rank renders one pass; its rows go to the ranks that own them (ProcessGroup::allToAll), which
/// fold the passes in their order: the film's bits are those of one process. So each rank sends and receives about one
/// film per round, however many ranks there are, and rank 0 has the whole film only where somebody wants to see it.
/// Without a group the one process owns all rows, and nothing is moved.
class DistributedFilm {
  public:
    /// The film must outlive this.
    DistributedFilm(ProcessGroup* group, Film& film);

    /// After a round: takes the pass images of the first `passes` ranks apart. Once, before they are folded.
    void collect(size_t passes);
    /// Folds the pass of this rank in; call it in the order of ranks.
    void fold(size_t rank, double weight);
    /// Rank 0's film becomes whole, with its figures.
    void gather();
    /// Every rank's film becomes that of rank 0 as far as it owns it.
    void scatter();
    /// By this rank, of passes' rows, to others.
    [[nodiscard]] uint64_t bytesSent() const { return bytesSent_; }

  private:
    [[nodiscard]] int firstRowOf(int rank) const;
    [[nodiscard]] std::vector<Bytes> rowsFor() const;
    /// Deviations of the passes since the last time, to rank 0.
    void settle();

    ProcessGroup* group_;
    Film& film_;
    std::vector<Bytes> received_;         ///< rows of the round's passes, by rank
    std::vector<AccumulatedPass> folded_; ///< since settle()
    uint64_t bytesSent_ = 0;
    uint64_t told_ = 0; ///< non-finite samples that rank 0 knows of
};

/// What the progress bar says.
struct ShownErrors {
    double relative, bound;
    RelativeBias bias;
};

/// Film, bias and statistics of all ranks; without a group, those of the one process, at no cost.
class DistributedResult {
  public:
    /// The result must outlive this.
    DistributedResult(ProcessGroup* group, SessionResult& result);

    [[nodiscard]] size_t rank() const { return group_ ? size_t(group_->rank()) : 0; }
    /// Whether this process tells and writes.
    [[nodiscard]] bool isRoot() const { return rank() == 0; }
    [[nodiscard]] std::vector<double> allReduceMax(std::vector<double> values);
    /// What rank 0 has resumed becomes that of all.
    void shareResumed();
    /// DistributedFilm::collect() and fold() of film and bias.
    void collect(size_t passes);
    void fold(size_t rank, double weight);
    /// Rank 0's films become whole.
    void gather();
    [[nodiscard]] bool isWhole() const { return whole_; }
    /// Whether SessionResult::errorBound() is at most this.
    [[nodiscard]] bool errorIsBelow(double target);
    /// Whether it is time to gather for the progress bar: that takes at most a twentieth of the time.
    [[nodiscard]] bool mayShow() const;
    /// As of the last gather(). Costs a sweep over the film.
    [[nodiscard]] ShownErrors errors();
    /// Counters and CPU seconds of all ranks go to rank 0. At the end.
    void gatherStatistics();

  private:
    using Clock = std::chrono::steady_clock;

    ProcessGroup* group_;
    SessionResult& result_;
    DistributedFilm film_, bias_;
    bool whole_ = true; ///< rank 0's films are
    ShownErrors shown_;
    Clock::time_point gathered_ = Clock::now();
    Clock::duration gathering_{}; ///< that the last gather() took
};

} // namespace tungsten
