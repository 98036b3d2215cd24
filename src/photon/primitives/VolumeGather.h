#pragma once
// One pass's records of a volume primitive, splatted where sensor rays are straight, gathered where they fold.

#include "photon/primitives/VolumePrimitive.h"
#include "photon/primitives/beams/BeamGather.h"
#include "photon/primitives/points/PointGather.h"
#include "photon/primitives/sliced/SliceGather.h"
#include "photon/view/SensorRecord.h"

#include "tungsten/film/Film.h"

#include <functional>
#include <optional>

namespace tungsten::photon {

/// Which sensor rays there are.
struct SensorRays {
    bool splatted = false; ///< straight ones have their records brought to them
    bool folded = true;    ///< there are others
    size_t parts = 0;      ///< highlight paths of a pixel, each of which gathers its own part on folded rays
    float uFolded = 0.0f;  ///< in [0, 1): chooses what folded rays gather beside splats
};

template <typename Primitive>
class VolumeGather {
  public:
    using Record = typename Primitive::Record;
    static constexpr const char* GatheredCounter = Primitive::Gathered;
    /// Ends the kernels of records that surfaces are near to; `splatted`: straight rays of the image alone see them.
    using EndKernels = std::function<void(Selection<Record>&, bool splatted)>;

    /// `sensor` has the pass's gate: a delta gate's temporal kernel is a narrow box. `endKernels` is asked for what
    /// rays are going to see, no more. `narrows`: narrow() will be called, which needs records whose kernels go on.
    VolumeGather(const Scene& scene, const transport::Sensor& sensor, const ArrivalCulling& culling,
                 Store<Record> store, Radii radii, EndKernels endKernels, const SensorRays& rays, bool narrows = false)
        : scene_(scene), sensor_(sensor), culling_(culling), endKernels_(std::move(endKernels)),
          scale_(store.scale()), all_{std::move(store.records), std::move(radii)} {
        if (rays.splatted && rays.folded) selectFolded(rays);
        if (narrows) before_ = {all_, folded_};
        build(rays);
    }

    VolumeGather(const VolumeGather&) = delete;
    VolumeGather& operator=(const VolumeGather&) = delete;

    /// Looks at the same records with radii times `factor` and another gate from now on.
    void narrow(float factor, const transport::Sensor& sensor, const SensorRays& rays) {
        sensor_ = sensor;
        all_ = before_->all;
        folded_ = before_->folded;
        all_.radii.scale(factor);
        folded_.radii.scale(factor);
        straight_.reset();
        build(rays);
    }

    /// On the records' power: 1 / number of paths.
    [[nodiscard]] float scale() const { return scale_; }
    /// Adds what straight rays of several samples see to the pass image; returns the records that it met.
    uint64_t splat(const SensorRecords& samples, double scale, Film& film, const ProgressToken& watch) {
        const bool any = std::any_of(samples.begin(), samples.end(), [](const auto* s) { return !s->pieces.empty(); });
        return any ? Primitive::splat(scene_, sensor_, samples, straight(), scale, film, watch) : 0;
    }
    /// Adds what a segment meets to the sums; returns how many records that were.
    uint64_t gather(const CameraSegment& segment, bool folded, FrameSums& sums) const {
        const auto& structure = straightGather_ && !folded ? straightGather_ : gather_;
        return structure ? structure->gather(segment, sums) : 0;
    }
    /// The same for a highlight path's part.
    uint64_t gatherPart(const CameraSegment& segment, size_t part, FrameSums& sums) const {
        return parts_.empty() ? 0 : parts_[part]->gather(segment, sums);
    }

  private:
    using Gather = typename Primitive::Gather;

    /// Whether straight rays see less than all.
    [[nodiscard]] bool selectsStraight() const { return !culling_.directView() && culling_.straightTimesKnown(); }
    /// What straight rays can see, chosen when there are any.
    const Selection<Record>& straight() {
        if (!selectsStraight()) return all_;
        if (!straight_) {
            straight_ = Primitive::straight(scene_, culling_, all_.records, all_.radii);
            if (straight_ && !allEnd_) endKernels_(*straight_, splatted_);
        }
        return straight_ ? *straight_ : all_;
    }
    [[nodiscard]] std::unique_ptr<Gather> gatherOf(const Selection<Record>& selection, bool fewRays) const {
        return std::make_unique<Gather>(scene_, sensor_, selection.records, selection.radii, fewRays);
    }
    void selectFolded(const SensorRays& rays) {
        const double share = Primitive::foldedShare(all_.records, all_.radii);
        folded_ = {chosenEvenly(all_.records, share, rays.uFolded), all_.radii.chosen(share, rays.uFolded)};
    }
    void deal(size_t parts) {
        auto hands = dealt(folded_.records, parts);
        const auto radii = folded_.radii.dealt(parts);
        dealt_.resize(parts);
        for (size_t k = 0; k < parts; ++k) dealt_[k] = {std::move(hands[k]), radii[k]};
    }
    /// Ends kernels and makes structures.
    void build(const SensorRays& rays) {
        if (rays.splatted && rays.folded) {
            endKernels_(folded_, false);
            deal(rays.parts);
        }
        splatted_ = rays.splatted;
        allEnd_ = !rays.splatted || !selectsStraight();
        if (allEnd_) endKernels_(all_, splatted_);
        buildGathers(rays);
    }
    void buildGathers(const SensorRays& rays) {
        if (!rays.splatted) {
            gather_ = gatherOf(all_, false);
            if (const auto& seen = straight(); &seen != &all_) straightGather_ = gatherOf(seen, false);
        } else if (rays.folded) {
            gather_ = gatherOf(folded_, true);
            parts_.clear();
            for (const auto& hand : dealt_) parts_.push_back(gatherOf(hand, true));
        }
    }

    const Scene& scene_;
    transport::Sensor sensor_;
    const ArrivalCulling& culling_;
    EndKernels endKernels_;
    float scale_;
    Selection<Record> all_;
    bool splatted_ = false;                     ///< straight rays have records brought to them
    bool allEnd_ = false;                       ///< kernels of all have been ended
    std::optional<Selection<Record>> straight_; ///< none: all, or not chosen yet
    Selection<Record> folded_;
    struct Selections {
        Selection<Record> all, folded;
    };
    std::optional<Selections> before_; ///< with kernels that have not ended
    std::vector<Selection<Record>> dealt_;
    std::unique_ptr<Gather> gather_, straightGather_;
    std::vector<std::unique_ptr<Gather>> parts_;
};

namespace detail {

template <typename... Primitives>
std::variant<std::monostate, VolumeGather<Primitives>...> gathersOf(const std::variant<Primitives...>&);

} // namespace detail

/// Of the primitive in use; empty where no medium scatters or nothing was stored.
using VolumeGathers = decltype(detail::gathersOf(VolumePrimitive{}));

} // namespace tungsten::photon
