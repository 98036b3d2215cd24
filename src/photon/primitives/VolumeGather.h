#pragma once
// One pass's records of a volume primitive, splatted where camera rays are straight, gathered where they are
// redirected.

#include "photon/primitives/VolumePrimitive.h"
#include "photon/primitives/beams/BeamGather.h"
#include "photon/primitives/points/PointGather.h"
#include "photon/primitives/sliced/SliceGather.h"
#include "photon/view/CameraRecord.h"

#include "tungsten/film/Film.h"

#include <functional>
#include <optional>

namespace tungsten::photon {

/// Which camera rays there are.
struct GatherRays {
    bool splatted = false;    ///< straight ones have their records brought to them
    bool redirected = true;   ///< there are others
    size_t parts = 0;         ///< highlight paths of a pixel, each of which gathers its own part on redirected rays
    float uRedirected = 0.0f; ///< in [0, 1): chooses what redirected rays gather beside splats
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
    VolumeGather(const Scene& scene, const transport::TimeSensor& sensor, const ArrivalCulling& culling,
                 Store<Record> store, Radii radii, EndKernels endKernels, const GatherRays& rays, bool narrows = false)
        : scene_(scene), sensor_(sensor), culling_(culling), endKernels_(std::move(endKernels)),
          scale_(store.scale()), all_{std::move(store.records), std::move(radii)} {
        if (rays.splatted && rays.redirected) selectRedirected(rays);
        if (narrows) before_ = {all_, redirected_};
        build(rays);
    }

    VolumeGather(const VolumeGather&) = delete;
    VolumeGather& operator=(const VolumeGather&) = delete;

    /// Looks at the same records with radii times `factor` and another gate from now on.
    void narrow(float factor, const transport::TimeSensor& sensor, const GatherRays& rays) {
        sensor_ = sensor;
        all_ = before_->all;
        redirected_ = before_->redirected;
        all_.radii.scale(factor);
        redirected_.radii.scale(factor);
        straight_.reset();
        build(rays);
    }

    /// On the records' power: 1 / number of paths.
    [[nodiscard]] float scale() const { return scale_; }
    /// Adds what straight rays of several samples see to the pass image; returns the records that it met.
    uint64_t splat(const CameraRecords& samples, double scale, Film& film, const ProgressToken& watch) {
        const bool any =
            std::any_of(samples.begin(), samples.end(), [](const auto* s) { return !s->mediumSegments.empty(); });
        return any ? Primitive::splat(scene_, sensor_, samples, straight(), scale, film, watch) : 0;
    }
    /// Adds what a segment meets to the sums; returns how many records that were.
    uint64_t gather(const CameraSegment& segment, bool redirected, FrameSums& sums) const {
        const auto& structure = straightGather_ && !redirected ? straightGather_ : gather_;
        return structure ? structure->gather(segment, sums) : 0;
    }
    /// Gathers from the records of a highlight path's part.
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
    void selectRedirected(const GatherRays& rays) {
        const double share = Primitive::redirectedShare(all_.records, all_.radii);
        redirected_ = {systematicSubset(all_.records, share, rays.uRedirected),
                       all_.radii.chosen(share, rays.uRedirected)};
    }
    void partition(size_t parts) {
        auto sets = partitioned(redirected_.records, parts);
        const auto radii = redirected_.radii.partitioned(parts);
        partSelections_.resize(parts);
        for (size_t k = 0; k < parts; ++k) partSelections_[k] = {std::move(sets[k]), radii[k]};
    }
    /// Ends kernels and makes structures.
    void build(const GatherRays& rays) {
        if (rays.splatted && rays.redirected) {
            endKernels_(redirected_, false);
            partition(rays.parts);
        }
        splatted_ = rays.splatted;
        allEnd_ = !rays.splatted || !selectsStraight();
        if (allEnd_) endKernels_(all_, splatted_);
        buildGathers(rays);
    }
    void buildGathers(const GatherRays& rays) {
        if (!rays.splatted) {
            gather_ = gatherOf(all_, false);
            if (const auto& seen = straight(); &seen != &all_) straightGather_ = gatherOf(seen, false);
        } else if (rays.redirected) {
            gather_ = gatherOf(redirected_, true);
            parts_.clear();
            for (const auto& part : partSelections_) parts_.push_back(gatherOf(part, true));
        }
    }

    const Scene& scene_;
    transport::TimeSensor sensor_;
    const ArrivalCulling& culling_;
    EndKernels endKernels_;
    float scale_;
    Selection<Record> all_;
    bool splatted_ = false;                     ///< straight rays have records brought to them
    bool allEnd_ = false;                       ///< kernels of all have been ended
    std::optional<Selection<Record>> straight_; ///< none: all, or not chosen yet
    Selection<Record> redirected_;
    struct Selections {
        Selection<Record> all, redirected;
    };
    std::optional<Selections> before_; ///< with kernels that have not ended
    std::vector<Selection<Record>> partSelections_;
    std::unique_ptr<Gather> gather_, straightGather_;
    std::vector<std::unique_ptr<Gather>> parts_;
};

namespace detail {

template <typename... Primitives>
std::variant<std::monostate, VolumeGather<Primitives>...> gathersOf(const std::variant<Primitives...>&);

} // namespace detail

/// The gather of the primitive in use; empty where no medium scatters or nothing was stored.
using VolumeGathers = decltype(detail::gathersOf(VolumePrimitive{}));

} // namespace tungsten::photon
