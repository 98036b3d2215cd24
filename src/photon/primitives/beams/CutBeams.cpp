#include "photon/primitives/beams/CutBeams.h"

#include "photon/Tuning.h"
#include "photon/primitives/NearSurfaces.h"
#include "photon/primitives/beams/RibbonRange.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

struct BeamPart {
    float start, end;
    float radius;
    KernelEdges edges; ///< their reach from the beam's base
    float weight;      ///< one over the part of the ribbon between its edges that lies before all surfaces
};

/// Cuts one beam.
class BeamCutter {
  public:
    BeamCutter(const NearSurfaces& surfaces, const PhotonBeam& beam, float radius, const Sampler& random)
        : surfaces_(surfaces), beam_(beam), radius_(radius), frame_(beam.direction), random_(random) {}

    [[nodiscard]] std::vector<BeamPart> parts() {
        cut(beam_.tStart, beam_.tEnd);
        return std::move(parts_);
    }

  private:
    void cut(float start, float end) {
        const float half = 0.5f * (end - start), middle = start + half;
        const Vec3f position = at(middle);
        const KernelEdge nearest = surfaces_.nearest(position, half + radius_);
        if (!nearest.exists()) return addClear(start, end);
        if (half <= 0.5f * tuning::PieceInRadii * radius_) return addNear(start, end, middle, nearest);
        // A ball without surfaces holds the part of the beam about its middle.
        const float clear = std::max(nearest.reach - radius_, 0.0f), low = middle - clear, high = middle + clear;
        if (!(low > start && high < end)) return addClear(start, end); // rounding
        cut(start, low);
        if (low < high) addClear(low, high);
        cut(high, end);
    }
    void addClear(float start, float end) {
        if (!parts_.empty() && !parts_.back().edges.nearest.exists())
            parts_.back().end = end;
        else
            parts_.push_back({start, end, radius_, {}, 1.0f});
    }
    void addNear(float start, float end, float middle, const KernelEdge& nearest) {
        const Vec3f position = at(middle);
        const KernelEdge opposite = surfaces_.opposite(position, nearest, radius_ + 0.5f * (end - start));
        const float between = std::max(nearest.reach, opposite.reach);
        BeamPart part{start, end, std::min(tuning::WidthAtSurfaces * radius_, between), {nearest, opposite}, 1.0f};
        for (KernelEdge* edge : {&part.edges.nearest, &part.edges.opposite})
            if (edge->exists()) edge->reach += edge->normal.dot(position - beam_.base);
        part.weight = float(triesUntilSeen([&] { return seesRandomPoint(part); }));
        parts_.push_back(part);
    }
    /// Of the part's ribbon, seen from anywhere.
    [[nodiscard]] bool seesRandomPoint(const BeamPart& part) {
        const float along = part.start + random_.next1D() * (part.end - part.start);
        const float angle = 2.0f * Pi * random_.next1D();
        const Vec3f across = frame_.s * std::cos(angle) + frame_.t * std::sin(angle);
        const RibbonRange range = RibbonRange::of(part.edges, along, beam_.direction, across, part.radius);
        return surfaces_.sees(at(along), across * (range.low + random_.next1D() * range.width()), part.radius);
    }
    [[nodiscard]] Vec3f at(float along) const { return beam_.base + beam_.direction * along; }

    const NearSurfaces& surfaces_;
    const PhotonBeam& beam_;
    float radius_;
    Frame frame_;
    Sampler random_;
    std::vector<BeamPart> parts_;
};

} // namespace

void cutAtSurfaces(const Scene& scene, const Sampler& random, std::vector<PhotonBeam>& beams, Radii& radius,
                   const ProgressToken& watch) {
    const NearSurfaces surfaces(scene);
    std::vector<std::vector<BeamPart>> parts(beams.size());
    watch.stage("kernels at surfaces", beams.size());
    tbb::parallel_for(tbb::blocked_range<size_t>(0, beams.size(), 64), [&](const auto& range) {
        for (size_t i = range.begin(); i < range.end(); ++i) {
            watch.advanceEvery(64, i);
            parts[i] = BeamCutter(surfaces, beams[i], radius[0], random.branch(RandomStream::Record, i)).parts();
        }
    });
    const auto isWhole = [](const auto& of) { return of.size() == 1 && !of.front().edges.nearest.exists(); };
    if (std::all_of(parts.begin(), parts.end(), isWhole)) return;
    std::vector<PhotonBeam> cut;
    std::vector<float> radii;
    std::vector<KernelEdges> edges;
    for (size_t i = 0; i < beams.size(); ++i)
        for (const BeamPart& part : parts[i]) {
            cut.push_back(beams[i]);
            cut.back().tStart = part.start;
            cut.back().tEnd = part.end;
            cut.back().power = beams[i].power * part.weight;
            radii.push_back(part.radius);
            edges.push_back(part.edges);
        }
    beams = std::move(cut);
    radius = {std::move(radii), std::move(edges)};
}

} // namespace tungsten::photon
