#pragma once
// Splitting and roulette of plain camera paths by what paths of a pilot found from places and times like theirs on
// (docs/method.md, section 11).

#include "transport/PlainSteps.h"
#include "transport/SharePilot.h"

#include <array>
#include <vector>

namespace tungsten::path {

/// Weight windows of the least variance x cost (Rath et al. 2022). A path at state s with throughput T goes on in about
///   n = T sqrt(V(s) / C(s)) / sqrt(V / C)
/// copies: V(s) is the variance of what a path of throughput 1 finds from there on (of its square where n < 1, as
/// roulette adds that), C(s) the number of vertices that takes, V and C those of a path from the camera. States are
/// cells of place and time, in a medium or on a surface. Whatever the pilot has missed, images are the same.
class WeightWindows {
  public:
    WeightWindows() = default;
    /// `end`: of the times at which light counts; infinite where all does.
    WeightWindows(const Scene& scene, double end);

    [[nodiscard]] bool any() const { return !factors_.empty(); }
    /// n, for splitting and for roulette, of throughput 1.
    struct Factors {
        float split = 1.0f, survival = 1.0f;
    };
    [[nodiscard]] const Factors& factors(const transport::PathState& path, const transport::WalkVertex& vertex) const {
        return factors_[stateOf(path, vertex)];
    }

    /// A path of a pilot: its vertices, before each of which the pilot had found so many contributions.
    struct Record {
        struct Vertex {
            size_t state, found;
            float throughput;
        };
        const WeightWindows& windows;
        transport::SharePilot pilot{};
        std::vector<Vertex> vertices{};

        void add(const transport::PathState& path, const transport::WalkVertex& vertex) {
            vertices.push_back({windows.stateOf(path, vertex), pilot.contributions(), meanComponent(path.throughput)});
        }
    };
    /// Learns from two paths of a pixel.
    void learn(const std::array<Record, 2>& pair);
    /// Ends the learning. There are no windows if too little has been found for any.
    void finish();

  private:
    static constexpr int Times = 32, Cells = 8; ///< along each axis

    struct Sums {
        double found = 0.0, squares = 0.0, vertices = 0.0, states = 0.0;

        void add(const Sums& other, double part = 1.0);
        /// How many contributions of their mean would have the same spread.
        [[nodiscard]] double effective() const { return squares > 0.0 ? found * found / squares : 0.0; }
    };

    [[nodiscard]] size_t stateOf(const transport::PathState& path, const transport::WalkVertex& vertex) const;
    /// Adds a path to the states of its vertices, and returns what it has found in all.
    double learn(const Record& path);

    double timeScale_ = 0.0;
    Vec3f corner_{0.0f}, cellScale_{0.0f};
    std::vector<Sums> sums_; ///< by state: all cells of one time after those of another
    Sums starts_;
    double variance_ = 0.0; ///< of a pixel's paths, summed over pairs
    std::vector<Factors> factors_;
};

/// Plain steps in as many copies as weight windows say, if there are any; notes their vertices for a record.
template <transport::PlainOptions Options>
class WindowedSteps : public transport::PlainSteps<Options> {
  public:
    WindowedSteps(const transport::WalkContext& context, const WeightWindows* windows, WeightWindows::Record* record)
        : transport::PlainSteps<Options>(context), windows_(windows), record_(record) {}
    void stopRecording() { record_ = nullptr; }

    int copies(transport::PathState& path, const transport::WalkVertex& vertex) {
        if (record_) record_->add(path, vertex);
        if (!windows_) return 1;
        const WeightWindows::Factors& factors = windows_->factors(path, vertex);
        const float throughput = meanComponent(path.throughput);
        if (throughput * factors.split > 2.0f && splits_ < MostSplits) {
            ++splits_;
            return std::min(int(throughput * factors.split), MostCopies);
        }
        const float survival = throughput * factors.survival;
        if (!(survival < 0.5f)) return 1;
        path.random.at(path.interactions, Draw::Roulette);
        if (!(path.random.next1D() < survival)) return 0;
        path.throughput = path.throughput / survival;
        return 1;
    }

  private:
    /// Copies run within each other: a bound on the stack; and on what one vertex may cost.
    static constexpr int MostSplits = 1000, MostCopies = 4;

    const WeightWindows* windows_;
    WeightWindows::Record* record_;
    int splits_ = 0; ///< of the path and those that it is a copy of
};

} // namespace tungsten::path
