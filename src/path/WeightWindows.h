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
    [[nodiscard]] bool any() const { return !factors_.empty(); }
    /// n, for splitting and for roulette, of throughput 1.
    struct Factors {
        float split = 1.0f, survival = 1.0f;
    };
    [[nodiscard]] const Factors& factors(const Vec3f& position, double time, bool inMedium) const {
        return factors_[stateOf(position, time, inMedium)];
    }

    /// A path of a pilot: its vertices, and how many contributions the pilot had found when the path went on from each.
    struct Record {
        struct Vertex {
            Vec3f position;
            double time;
            bool inMedium;
            float throughput;
            size_t found;
        };
        transport::SharePilot pilot{};
        std::vector<Vertex> vertices{};

        void add(const transport::PathState& path, const transport::WalkVertex& vertex) {
            vertices.push_back({vertex.position, path.time, vertex.medium != nullptr, meanComponent(path.throughput),
                                pilot.contributions()});
        }
    };
    /// Learns from two paths of a pixel.
    void learn(const std::array<Record, 2>& pair);
    /// Ends the learning. There are no windows if too little has been found for any.
    void finish();

  private:
    static constexpr int Times = 32, Cells = 8; ///< along each axis
    static constexpr auto CellsOfTime = size_t(Cells * Cells * Cells);

    /// Cells of one width along an axis, of which the first and the last have what lies beyond.
    struct Axis {
        double start = 0.0, perUnit = 0.0;

        /// Between these values but for a hundredth of them at either end; one cell where these are equal.
        static Axis of(std::vector<double> values, int cells);
        [[nodiscard]] int cell(double value, int cells) const {
            return int(std::min(std::max(0.0, (value - start) * perUnit), double(cells - 1))); // NaN: 0
        }
    };
    /// What a path of throughput 1 found from a vertex on, in so many vertices.
    struct Learned {
        Vec3f position;
        double time;
        bool inMedium;
        double found;
        float vertices;
    };
    struct Sums {
        double found = 0.0, squares = 0.0, vertices = 0.0, states = 0.0;

        void add(const Sums& other, double part = 1.0);
        /// How many contributions of their mean would have the same spread.
        [[nodiscard]] double effective() const { return squares > 0.0 ? found * found / squares : 0.0; }
    };

    [[nodiscard]] size_t stateOf(const Vec3f& position, double time, bool inMedium) const;
    /// Chooses the cells, and sums what was learned in each.
    std::vector<Sums> byState(const std::vector<Learned>& learned);
    /// Notes a path's vertices, and returns what it has found in all.
    double learn(const Record& path);

    std::vector<Learned> learned_;
    Sums starts_;
    double variance_ = 0.0; ///< of a pixel's paths, summed over pairs

    Axis times_;
    std::array<Axis, 3> places_;
    std::vector<Factors> factors_; ///< by state: all cells of one time after those of another
};

/// Plain steps in as many copies as weight windows say, if there are any.
template <transport::PlainOptions Options>
class WindowedSteps : public transport::PlainSteps<Options> {
  public:
    WindowedSteps(const transport::WalkContext& context, const WeightWindows* windows)
        : transport::PlainSteps<Options>(context), windows_(windows) {}

    int copies(transport::PathState& path, const transport::WalkVertex& vertex) {
        if (!windows_) return 1;
        const auto [split, survival] = windows_->factors(vertex.position, path.time, vertex.medium != nullptr);
        const float throughput = meanComponent(path.throughput);
        return splitting_.copies(path, throughput * split, throughput * survival, Draw::Roulette, MostCopies);
    }

  private:
    static constexpr int MostCopies = 4; ///< a bound on what one vertex may cost

    const WeightWindows* windows_;
    transport::Splitting splitting_;
};

} // namespace tungsten::path
