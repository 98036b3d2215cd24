#pragma once
// The published direction sampling of He et al. 2024: the elliptical diffusion approximation, tabulated.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace darts {

/// Bins of nearly equal ratio whose number is read off a float's bits, without a logarithm.
/// [2^lowest, 2^(lowest + octaves)), every octave cut into 2^log2PerOctave equal bins (at most 2^8).
class OctaveBins {
  public:
    OctaveBins(int lowest, int octaves, int log2PerOctave)
        : shift_(23 - log2PerOctave), base_((lowest + 127) << log2PerOctave), count_(octaves << log2PerOctave) {}

    [[nodiscard]] int count() const { return count_; }
    /// The bin that holds x; the nearest one for x outside the range.
    [[nodiscard]] int index(float x) const {
        return std::clamp((std::bit_cast<std::int32_t>(x) >> shift_) - base_, 0, count_ - 1);
    }
    /// Lower edge of bin i; edge(count()) is the end of the range.
    [[nodiscard]] float edge(int i) const { return std::bit_cast<float>((base_ + i) << shift_); }
    [[nodiscard]] float centre(int i) const { return 0.5f * (edge(i) + edge(i + 1)); }

  private:
    int shift_, base_, count_;
};

/// How much light a direction can still bring to the target, if what follows its first flight is taken from the
/// diffusion approximation.
///
/// log f of a direction, f(cos | C, S) = int_0^{t(S)} e^{-tau} Phi(rho(tau), S - tau) dtau, up to a term common to all
/// directions of the same C and S. Phi is DiffusionGreensFunction, t and rho are those of Ellipse. Lengths are in mean
/// free paths (sigmaT = 1): C is the distance to the target, delta = S - C > 0, h = 1 - cos(theta) in [0, 2].
/// Within 2e-4 for S from 1e-6 to 1e4, C / S up to 1 - 1e-7 and every albedo and g.
[[nodiscard]] double edaLogDensity(double albedo, double g, double C, double delta, double h);

/// How finely a table is cut. delta / S = 1 - C / S has bins that shrink toward the needle, C / S -> 1; so has sigmaT
/// S.
struct EdaResolution {
    int excessOctaves = 20;      // delta / S from 2^-20 to 1
    int log2ExcessPerOctave = 2; // 4 bins an octave
    int lowestDepthLog2 = -7;    // sigmaT S from 2^-7
    int depthOctaves = 17;       // to 2^10
    int log2DepthPerOctave = 1;
    float floor = 0.02f; // share of the directions drawn regardless of f, half evenly in h, half evenly over the bins

    [[nodiscard]] OctaveBins excess() const { return {-excessOctaves, excessOctaves, log2ExcessPerOctave}; }
    [[nodiscard]] OctaveBins depth() const { return {lowestDepthLog2, depthOctaves, log2DepthPerOctave}; }
    bool operator==(const EdaResolution&) const = default;
};

/// Directions distributed as f(h | C, S) (edaLogDensity), h = 1 - cos(theta) about the target's direction, phi uniform.
/// One table serves every vertex in media of one albedo and g. A vertex uses the row of the nearest C / S and sigmaT S;
/// sample and pdf use the same row, so they match whatever its accuracy, and no direction has density zero.
class EdaTable {
  public:
    class Row;

    /// Deterministic, the same for any number of threads (0: all cores). Throws as requireValid.
    [[nodiscard]] static EdaTable build(float albedo, float g, const EdaResolution& resolution = {},
                                        unsigned threads = 0);

    /// The table of the default resolution: the one that somebody in the process still holds, or built now. May be
    /// called from several threads. Throws as requireValid.
    [[nodiscard]] static std::shared_ptr<const EdaTable> shared(float albedo, float g);

    /// Throws std::invalid_argument unless albedo is in [0, 1], g in [-1, 1] and the resolution within its bounds.
    static void requireValid(float albedo, float g, const EdaResolution& resolution);

    /// The distribution at a vertex at distance C of the target, for connections of length S = C + delta; one unit.
    [[nodiscard]] Row row(float C, float delta, float sigmaT) const;
    /// u in [0, 1) -> h in [0, 2], increasing in u.
    [[nodiscard]] float sample(float C, float delta, float sigmaT, float u) const;
    /// Density per solid angle.
    [[nodiscard]] float pdf(float C, float delta, float sigmaT, float h) const;

    [[nodiscard]] float albedo() const { return albedo_; }
    [[nodiscard]] float g() const { return g_; }
    [[nodiscard]] const EdaResolution& resolution() const { return resolution_; }

    /// What a cache file keeps: the number of octaves of every row's h bins, and the rows' cumulative distributions.
    [[nodiscard]] std::span<const std::uint8_t> octaves() const { return octaves_; }
    [[nodiscard]] std::span<const float> cumulative() const { return cumulative_; }
    /// The table with these contents; none if they cannot be a table's. Throws as requireValid.
    [[nodiscard]] static std::optional<EdaTable> restore(float albedo, float g, const EdaResolution& resolution,
                                                         std::vector<std::uint8_t> octaves,
                                                         std::vector<float> cumulative);

    friend bool operator==(const EdaTable&, const EdaTable&) = default;

  private:
    EdaTable(float albedo, float g, const EdaResolution& resolution)
        : albedo_(albedo), g_(g), resolution_(resolution) {}
    /// Where each row begins, from the octaves; false if the cumulative distributions do not fill them.
    bool index();

    float albedo_, g_;
    EdaResolution resolution_;
    std::vector<std::uint8_t> octaves_; // [excess][depth]
    std::vector<std::uint32_t> first_;
    std::vector<float> cumulative_;
};

/// One distribution of h: piecewise constant over bins of x = 1 + h (2^octaves - 1) / 2 in [1, 2^octaves], four an
/// octave. Valid as long as its table.
class EdaTable::Row {
  public:
    static constexpr int Log2PerOctave = 2, MinOctaves = 3, MaxOctaves = 40, Padding = 8;
    [[nodiscard]] static constexpr int binsOf(int octaves) { return octaves << Log2PerOctave; }
    /// Floats in the table: the cumulative distribution at the bins' edges, padded to whole registers.
    [[nodiscard]] static constexpr int strideOf(int octaves) { return (binsOf(octaves) / Padding + 1) * Padding; }

    Row(const float* cumulative, int octaves)
        : cumulative_(cumulative), bins_(0, octaves, Log2PerOctave), scale_(scaleOf(octaves)) {}

    /// u in [0, 1) -> h in [0, 2], increasing in u.
    [[nodiscard]] float sample(float u) const {
        // Counting in full registers is faster than a search of this few numbers. The last edge and the padding are 1.
        int bin = -1;
        const int stride = strideOf(bins_.count() >> Log2PerOctave);
        for (int i = 0; i < stride; ++i) bin += cumulative_[i] <= u;
        bin = std::clamp(bin, 0, bins_.count() - 1);
        const float x = bins_.edge(bin), within = (u - cumulative_[bin]) / mass(bin);
        return std::min(((x - 1.0f) + within * (bins_.edge(bin + 1) - x)) / scale_, 2.0f);
    }
    /// Density per solid angle.
    [[nodiscard]] float pdf(float h) const {
        const int bin = bins_.index(1.0f + scale_ * h);
        return mass(bin) * scale_ / ((bins_.edge(bin + 1) - bins_.edge(bin)) * 6.283185307f);
    }

    [[nodiscard]] int bins() const { return bins_.count(); }
    /// Lower edge of a bin in h; edge(bins()) = 2.
    [[nodiscard]] float edge(int bin) const { return (bins_.edge(bin) - 1.0f) / scale_; }
    /// Probability of a bin.
    [[nodiscard]] float mass(int bin) const { return cumulative_[bin + 1] - cumulative_[bin]; }
    [[nodiscard]] static float scaleOf(int octaves) { return 0.5f * float((std::uint64_t(1) << octaves) - 1); }

  private:
    const float* cumulative_;
    OctaveBins bins_;
    float scale_;
};

inline EdaTable::Row EdaTable::row(float C, float delta, float sigmaT) const {
    const float S = C + delta;
    const OctaveBins depth = resolution_.depth();
    const auto i = size_t(resolution_.excess().index(delta / S) * depth.count() + depth.index(sigmaT * S));
    return {cumulative_.data() + first_[i], octaves_[i]};
}
inline float EdaTable::sample(float C, float delta, float sigmaT, float u) const {
    return row(C, delta, sigmaT).sample(u);
}
inline float EdaTable::pdf(float C, float delta, float sigmaT, float h) const {
    return row(C, delta, sigmaT).pdf(h);
}

} // namespace darts
