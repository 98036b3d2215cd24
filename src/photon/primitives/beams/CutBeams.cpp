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
    BeamCutter(const KernelEnds& ends, const PhotonBeam& beam, float radius, const Sampler& random)
        : surfaces_(ends.surfaces), view_(ends.view ? &*ends.view : nullptr), beam_(beam), radius_(radius),
          frame_(beam.direction), random_(random) {}

    /// Appends the parts of the beam.
    void cut(std::vector<BeamPart>& parts) {
        parts_ = &parts;
        first_ = parts.size();
        float start = beam_.tStart;
        while (start < beam_.tEnd) {
            const float half = 0.5f * std::min(tuning::NearPartInRadii * radius_, beam_.tEnd - start);
            const float middle = start + half, clear = surfaces_.clearance(at(middle)) - radius_;
            // A ball without surfaces holds the part of the beam about its middle.
            const float end =
                clear >= half ? std::min(middle + clear, beam_.tEnd) : std::min(middle + half, beam_.tEnd);
            if (!(end > start)) return addClear(start, beam_.tEnd); // rounding
            if (clear >= half)
                addClear(start, end);
            else
                addNear(start, end, middle);
            start = end;
        }
    }

  private:
    void addClear(float start, float end) {
        if (parts_->size() > first_ && !parts_->back().edges.nearest.exists())
            parts_->back().end = end;
        else
            parts_->push_back({start, end, radius_, {}, 1.0f});
    }
    void addNear(float start, float end, float middle) {
        const Vec3f position = at(middle);
        const float half = 0.5f * (end - start);
        if (view_ && !view_->around(at(start), at(end), radius_)) return;
        const auto [nearest, alone, faced] = surfaces_.nearest(position, half + radius_);
        if (!nearest.exists()) return addClear(start, end);
        if (alone) return addBesidePlane(start, end, middle, nearest);
        addPart(start, end, middle, nearest,
                faced ? surfaces_.opposite(position, nearest, radius_ + half) : KernelEdge{});
        BeamPart& part = parts_->back();
        part.weight = float(triesUntilSeen([&] { return seesRandomPoint(part); }));
    }
    /// Without any other surface about, what is farther from the plane than the radius is clear.
    void addBesidePlane(float start, float end, float middle, const KernelEdge& plane) {
        const float slope = plane.normal.dot(beam_.direction), beyond = plane.reach - radius_;
        const float crossing = middle + beyond / slope;
        if (!(std::abs(crossing - middle) < 0.5f * (end - start))) {
            if (beyond < 0.0f) return addPart(start, end, middle, plane, {});
            return addClear(start, end);
        }
        if (slope > 0.0f) {
            addClear(start, crossing);
            addPart(crossing, end, middle, plane, {});
        } else {
            addPart(start, crossing, middle, plane, {});
            addClear(crossing, end);
        }
    }
    /// Edges as they are from the beam's middle.
    void addPart(float start, float end, float middle, const KernelEdge& nearest, const KernelEdge& opposite) {
        const float between = std::max(nearest.reach, opposite.reach);
        BeamPart part{start, end, std::min(tuning::WidthAtSurfaces * radius_, between), {nearest, opposite}, 1.0f};
        for (KernelEdge* edge : {&part.edges.nearest, &part.edges.opposite})
            if (edge->exists()) edge->reach += edge->normal.dot(at(middle) - beam_.base);
        parts_->push_back(part);
    }
    /// Whether no surface hides a random point of the part's ribbon, turned at random about the beam.
    [[nodiscard]] bool seesRandomPoint(const BeamPart& part) {
        const float along = part.start + random_.next1D() * (part.end - part.start);
        const float angle = 2.0f * Pi * random_.next1D();
        const Vec3f across = frame_.s * std::cos(angle) + frame_.t * std::sin(angle);
        const RibbonRange range = RibbonRange::of(part.edges, along, beam_.direction, across, part.radius);
        return surfaces_.sees(at(along), across * (range.low + random_.next1D() * range.width()), part.radius);
    }
    [[nodiscard]] Vec3f at(float along) const { return beam_.base + beam_.direction * along; }

    const NearSurfaces& surfaces_;
    const ImageFootprint* view_;
    const PhotonBeam& beam_;
    float radius_;
    Frame frame_;
    Sampler random_;
    std::vector<BeamPart>* parts_ = nullptr;
    size_t first_ = 0; ///< of the beam's own
};

/// Parts of consecutive beams.
struct CutBlock {
    std::vector<BeamPart> parts;
    std::vector<uint32_t> ends; ///< of the parts of each beam
};

} // namespace

void cutAtSurfaces(const KernelEnds& ends, std::vector<PhotonBeam>& beams, Radii& radius) {
    constexpr size_t BlockSize = 256;
    std::vector<CutBlock> blocks((beams.size() + BlockSize - 1) / BlockSize);
    ends.watch.stage("kernels at surfaces", beams.size());
    tbb::parallel_for(size_t(0), blocks.size(), [&](size_t number) {
        CutBlock& block = blocks[number];
        for (size_t i = number * BlockSize; i < std::min((number + 1) * BlockSize, beams.size()); ++i) {
            ends.watch.advanceEvery(BlockSize, i);
            const PhotonBeam& beam = beams[i];
            const auto pointAt = [&](float along) { return beam.base + beam.direction * along; };
            if (!ends.view || ends.view->around(pointAt(beam.tStart), pointAt(beam.tEnd), radius[0]))
                BeamCutter(ends, beam, radius[0], ends.random.branch(RandomStream::Record, i)).cut(block.parts);
            block.ends.push_back(uint32_t(block.parts.size()));
        }
    });
    std::vector<PhotonBeam> cut;
    std::vector<float> radii;
    std::vector<KernelEdges> edges;
    size_t count = 0;
    bool near = false;
    for (const CutBlock& block : blocks) {
        count += block.parts.size();
        near = near || std::any_of(block.parts.begin(), block.parts.end(),
                                   [](const BeamPart& part) { return part.edges.nearest.exists(); });
    }
    if (!near) return;
    cut.reserve(count);
    radii.reserve(count);
    edges.reserve(count);
    for (size_t number = 0; number < blocks.size(); ++number) {
        const CutBlock& block = blocks[number];
        size_t at = 0;
        for (size_t k = 0; k < block.ends.size(); ++k)
            for (; at < block.ends[k]; ++at) {
                const BeamPart& part = block.parts[at];
                cut.push_back(beams[number * BlockSize + k]);
                cut.back().tStart = part.start;
                cut.back().tEnd = part.end;
                cut.back().power = cut.back().power * part.weight;
                radii.push_back(part.radius);
                edges.push_back(part.edges);
            }
    }
    beams = std::move(cut);
    radius = {std::move(radii), std::move(edges)};
}

} // namespace tungsten::photon
