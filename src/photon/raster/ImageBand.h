#pragma once
// A few rows of the image that one task draws: the recorded rays, a register at a time, and what they have gathered.

#include "photon/raster/Registers.h"
#include "photon/view/CameraRecord.h"

#include "tungsten/film/Film.h"

#include <array>

namespace tungsten::photon {

/// One segment of the band's rays. Rays without it end at 0.
struct BandSegment {
    size_t number; ///< in the record
    std::vector<float> start, end;
    float leastStart = 0.0f, mostStart = 0.0f;   ///< of the rays that have this segment
    bool mixed = false;                          ///< rays differ in medium or interactions
    int medium = -1, interactions = 0;           ///< of the first ray that has this segment, if any
    std::vector<float> media, interactionCounts; ///< of every ray, if mixed
    std::array<std::vector<float>, 3> sums;      ///< by channel, frame by frame, without the rays' throughput
    /// By frame: sums, in double, of all records but those drawn last (at most MostInFloats); empty while there are
    /// none.
    std::vector<std::vector<Vec3d>> settled;

    /// Adds weight times power at pixels `first`...
    void add(size_t first, const Batch& weight, int channel, float power) {
        float* sum = sums[size_t(channel)].data() + first;
        xsimd::fma(weight, Batch(power), Batch::load_unaligned(sum)).store_unaligned(sum);
    }
    /// Which of `inside` lie in the medium and have from `least` to `most` interactions.
    [[nodiscard]] Batch::batch_bool_type select(Batch::batch_bool_type inside, size_t first, int inMedium, int least,
                                                int most) const {
        const Batch count = Batch::load_unaligned(interactionCounts.data() + first);
        return inside && Batch::load_unaligned(media.data() + first) == float(inMedium) && count >= float(least) &&
               count <= float(most);
    }
};

/// Arrays over rows x stride pixels. Behind the last column is room for a register of rays that meet nothing.
class ImageBand {
  public:
    static constexpr int Rows = 4; ///< at most a register of them (ImageFootprint::columns)
    static_assert(Rows <= Lanes);
    static size_t count(int imageHeight) { return size_t((imageHeight + Rows - 1) / Rows); }

    /// `frames`: how many have sums at a time.
    ImageBand(const CameraRecord& record, size_t number, int frames = 1);

    [[nodiscard]] size_t at(int column, int row) const { return size_t(row - firstRow) * stride + size_t(column); }
    /// Where the sums of a frame begin.
    [[nodiscard]] size_t sumsOf(int frame) const { return placeOf(frame) * x.size(); }
    [[nodiscard]] const CameraRecord& record() const { return record_; }
    /// After each photon, beam or slice, which add at most once to every pixel: floats sum a few of them.
    void countDrawn(int frame = 0) {
        if (++drawn_[placeOf(frame)] == MostInFloats) settle(frame);
    }
    /// Adds the sums, times throughput, to the frame's pass image and begins new ones.
    void addToFilm(int frame, Film& film);

    int firstRow, lastRow; ///< inclusive
    size_t stride;
    std::vector<float> x, y, z; ///< unit directions
    std::vector<BandSegment> segments;

  private:
    template <typename T>
    std::vector<float> rowsOf(const std::vector<T>& image, float beyond = 0.0f) const;
    void addSegment(size_t number);
    [[nodiscard]] size_t placeOf(int frame) const { return frames_ > 1 ? size_t(frame) : 0; }
    /// A frame's sums of floats into those of doubles.
    void settle(int frame);

    /// Equal numbers, the worst case: sums of 128 floats are off by 2e-6. 2e5 at a time were by 3e-3.
    static constexpr int MostInFloats = 128;

    const CameraRecord& record_;
    int frames_;
    std::vector<int> drawn_; ///< by frame, since it settled
};

/// A band's photons or beams lie scattered in memory: asks for the one that is drawn DrawnAhead later.
template <typename T>
void prefetch(const T& drawnLater) {
    const auto* bytes = reinterpret_cast<const char*>(&drawnLater);
    for (size_t line = 0; line < sizeof(T); line += 64) __builtin_prefetch(bytes + line);
}
inline constexpr size_t DrawnAhead = 4;

} // namespace tungsten::photon
