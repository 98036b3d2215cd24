#pragma once
// A session's result where the ranks of a team share its films.

#include "tungsten/render/RenderSession.h"
#include "tungsten/render/TeamFilm.h"

#include <chrono>

namespace tungsten {

/// What the progress bar says.
struct ShownErrors {
    double relative, bound;
    RelativeBias bias;
};

/// Film, bias and statistics of all ranks; without a team, those of the one process, at no cost.
class SharedResult {
  public:
    /// The result must outlive this.
    SharedResult(Team* team, SessionResult& result);

    [[nodiscard]] size_t rank() const { return team_ ? size_t(team_->rank()) : 0; }
    /// Whether this process tells and writes.
    [[nodiscard]] bool speaks() const { return rank() == 0; }
    [[nodiscard]] std::vector<double> largest(std::vector<double> values);
    /// What rank 0 has resumed becomes that of all.
    void shareResumed();
    /// TeamFilm::collect() and fold() of film and bias.
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

    Team* team_;
    SessionResult& result_;
    TeamFilm film_, bias_;
    bool whole_ = true; ///< rank 0's films are
    ShownErrors shown_;
    Clock::time_point gathered_ = Clock::now();
    Clock::duration gathering_{}; ///< that the last gather() took
};

} // namespace tungsten
