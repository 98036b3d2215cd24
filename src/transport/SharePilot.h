#pragma once
// How much time plain and guided paths get: a few paths of both, before the first pass, tell what either costs and how
// much the image would vary at any share (docs/method.md, section 11).

#include "transport/Balance.h"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace tungsten::transport {

/// Key of a pilot's random numbers: not the render's, so that all its parts choose alike.
inline constexpr uint64_t PilotKey = 0x5EED0F511A5E5ull;

/// What a plain path costs alone, what its densities cost, and what a guided path costs; in one unit. `shared`: what
/// either costs besides, of what a pass costs whoever its paths are.
struct PathCosts {
    double plain = 1.0, densities = 0.0, guided = 1.0, shared = 0.0;

    /// Plain's share of the paths if it has this share of the time.
    [[nodiscard]] StrategyBalance ofTime(double plainTime) const;
    [[nodiscard]] double sum() const { return plain + densities + guided; }
    /// Mean cost of a path at this balance.
    [[nodiscard]] double mean(const StrategyBalance& balance) const;
};

class SharePilot {
  public:
    /// `plainInPairs`: what plain paths alone find together on one way is known from plain paths only, as guided ones
    /// leave records with directions of their own there.
    explicit SharePilot(bool plainInPairs = false) : plainInPairs_(plainInPairs) {}

    /// Shares of the time that plain paths may get; 1: all paths are plain, and nothing is weighed.
    static constexpr std::array<double, 5> Times{1.0, 0.75, 0.5, 0.25, 0.1};

    /// Another path, of the pixel at hand; they come in groups of PathsOfPixel: plain, guided, plain, guided.
    static constexpr int PathsOfPixel = 4;
    void begin(Strategy strategy) { paths_.push_back({strategy, found_.size()}); }
    /// Notes what a path has found, by the strategy's own estimate.
    void tell(float value, int frame, LogRatio logRatio, Found found) {
        found_.push_back({value, logRatio, frame, found});
    }
    /// What has been found so far: how many contributions, and one of them.
    [[nodiscard]] size_t contributions() const { return found_.size(); }
    [[nodiscard]] float value(size_t contribution) const { return found_[contribution].value; }
    /// Of what the last path has found by its own estimate: the square of the sum in each frame, less those of single
    /// contributions.
    [[nodiscard]] double pairsOfLast() const;
    /// pairsOfLast() of a path of the pixel at hand that is plain as all are without guided ones: its vertices choose
    /// points of lights by themselves, while those beside guided ones connect to one. Where it is not told, these
    /// count.
    void tellPairsOfAlone(double pairs);

    /// How many contributions of their mean would have the same spread, of all that one strategy, or both together,
    /// found.
    [[nodiscard]] double effective(Strategy strategy) const;
    /// E[squares of what a path finds in a frame] at this balance.
    [[nodiscard]] double secondMoment(const StrategyBalance& balance) const { return moments(balance).second; }
    /// Variance of the image (squared error), per path and up to a factor.
    [[nodiscard]] double variance(const StrategyBalance& balance) const;

    /// E[squares of what a path of the strategy finds in a frame], by its own estimate and its own paths.
    [[nodiscard]] double ownSecondMoment(Strategy strategy) const;

    /// The share of time with the least variance x cost; one half, unless enough has been found to tell. What plain
    /// paths have not found counts by what they would bring in the place of guided ones.
    [[nodiscard]] double choose(const PathCosts& costs) const {
        return choose([&](double plainTime) {
            const StrategyBalance balance = costs.ofTime(plainTime);
            return variance(balance) * costs.mean(balance);
        });
    }
    /// Plain paths alone are better or worse than with the least share of the time by two standard errors of variance x
    /// cost, pixel by pixel.
    [[nodiscard]] bool isSure(const PathCosts& costs) const;
    /// Chooses by another score of plain's share of the time; the least is best.
    [[nodiscard]] double choose(const std::function<double(double)>& score) const;

  private:
    struct Path {
        Strategy strategy;
        size_t first; ///< of what it found
    };
    struct Contribution {
        float value;
        LogRatio logRatio;
        int frame;
        Found found;
    };
    /// Both strategies have half of the pilot's paths.
    static constexpr StrategyBalance Halves{0.5f, 0.5f};

    [[nodiscard]] size_t end(size_t path) const {
        return path + 1 < paths_.size() ? paths_[path + 1].first : found_.size();
    }
    struct Moments {
        double second = 0.0, squaredMean = 0.0;
    };
    [[nodiscard]] Moments moments(const StrategyBalance& balance) const;
    /// Sums over the paths of each group.
    [[nodiscard]] std::vector<Moments> momentsByPixel(const StrategyBalance& balance) const;
    /// At the balance; of plain paths alone, what they would bring in the contribution's place.
    [[nodiscard]] double weighed(const Contribution& contribution, Strategy strategy,
                                 const StrategyBalance& balance) const;

    struct Pairs {
        double sum = 0.0;
        int paths = 0;
    };

    bool plainInPairs_;
    std::vector<Path> paths_;
    std::vector<Contribution> found_;
    std::vector<Pairs> alone_; ///< by pixel
};

} // namespace tungsten::transport
