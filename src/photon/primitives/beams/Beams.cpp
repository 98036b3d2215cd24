#include "photon/primitives/beams/Beams.h"

#include "photon/PhotonSettings.h"
#include "photon/Tuning.h"
#include "photon/primitives/NearSurfaces.h"
#include "photon/primitives/Primitive.h"
#include "photon/primitives/beams/BeamGather.h"
#include "photon/raster/ImageBand.h"
#include "photon/raster/ImageFootprint.h"
#include "photon/view/CameraRecord.h"

#include "transport/BounceLimits.h"

#include "tungsten/film/Film.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

/// Beyond an optical depth of 60 in every channel that scatters, nothing shows in a float.
float visibleReach(const Medium& medium) {
    constexpr float OpticalDepth = 60.0f;
    float reach = 0.0f;
    for (int channel = 0; channel < 3; ++channel)
        if (medium.sigmaS()[channel] > 0.0f) reach = std::max(reach, OpticalDepth / medium.sigmaT()[channel]);
    return reach;
}

std::optional<PhotonBeam> clippedBeam(const ArrivalCulling& culling, const Medium& medium, PhotonBeam flight) {
    flight.tEnd = std::min(flight.tEnd, visibleReach(medium));
    const FlightPart part =
        culling.countingPart(flight.base, flight.direction, flight.time, double(medium.speedOfLight));
    flight.tStart = std::max(flight.tStart, float(part.start));
    flight.tEnd = std::min(flight.tEnd, float(part.end));
    if (!(flight.tStart < flight.tEnd)) return std::nullopt;
    return flight;
}

std::optional<PhotonBeam> straightPart(const Scene& scene, const ArrivalCulling& culling, PhotonBeam beam) {
    const double speed = double(scene.media[size_t(beam.medium)].speedOfLight);
    const FlightPart part = culling.straightPart(beam.base, beam.direction, beam.time, speed);
    beam.tStart = std::max(beam.tStart, float(part.start));
    beam.tEnd = std::min(beam.tEnd, float(part.end));
    if (!(beam.tStart < beam.tEnd)) return std::nullopt;
    return beam;
}

float Beams::reach(const KernelSettings& settings) {
    return settings.volumeRadius;
}

void Beams::read(const ObjectReader& block, const Scene& scene, PhotonSettings& settings) {
    settings.requireRadius(block, scene);
}

double Beams::kernelWidth(const KernelSettings& settings, bool deltaGate, uint32_t step) {
    return flightRadiusFactor(settings, deltaGate, step);
}

Radii Beams::radii(const KernelSettings& settings, bool deltaGate, const std::vector<PhotonBeam>&, uint32_t step,
                   const ProgressToken&) {
    return settings.volumeRadius * float(flightRadiusFactor(settings, deltaGate, step));
}

NearSurfaces Beams::nearSurfaces(const KernelSettings& settings, const Scene& scene) {
    return {scene, reach(settings), 1.0f + 0.5f * tuning::NearPartInRadii};
}

Selection<PhotonBeam> Beams::straight(const Scene& scene, const ArrivalCulling& culling,
                                      const std::vector<PhotonBeam>& beams, const Radii& radii) {
    Selection<PhotonBeam> seen;
    if (radii.single()) seen.radii = radii[0];
    for (size_t i = 0; i < beams.size(); ++i) {
        const auto part = straightPart(scene, culling, beams[i]);
        if (!part) continue;
        seen.records.push_back(*part);
        seen.radii.append(radii, i);
    }
    return seen;
}

double Beams::redirectedShare(const std::vector<PhotonBeam>& beams, const Radii& radii) {
    constexpr double MeanSine = 0.25 * double(Pi);
    ExpectedHits meeting;
    for (size_t i = 0; i < beams.size(); ++i) {
        const PhotonBeam& beam = beams[i];
        const float radius = radii[i];
        meeting.include(beam.base + beam.direction * beam.tStart, radius);
        meeting.include(beam.base + beam.direction * beam.tEnd, radius);
        meeting.addArea(MeanSine * 2.0 * double(radius) * double(beam.tEnd - beam.tStart));
    }
    return meeting.share();
}

// ---- Ribbons at surfaces

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

void Beams::endAtSurfaces(const KernelEnds& ends, std::vector<PhotonBeam>& beams, Radii& radius) {
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

// ---- Splats

namespace {

constexpr float LeastSine = 1e-4f;

/// A surface's plane as a ribbon meets it (RibbonRange).
struct RibbonEdge {
    float height = Infinity; ///< of the foot before the plane
    float slope = 0.0f;      ///< of the beam towards it
    Vec3f tilt{0.0f};        ///< normal x direction: its product with a ray is as that of the normal and beam x ray
};

/// A beam as the camera sees it. Its line comes closest to the camera at `foot`, relative to the camera; distances
/// along the beam count from there, which leaves no difference of large numbers (closestApproach).
struct Ribbon {
    Vec3f direction, foot;
    Vec3f normal; ///< foot x direction: of the plane through camera and beam, as long as foot
    float low, high, fromBase, radius;
    float shortest, longest; ///< from the foot over the beam to the camera, inside the gate
    double time;             ///< at the foot, where a flight from the base would pass or would have passed
    Rgb power;               ///< with the kernel's constant and the flight's transmittance up to the foot
    ImageHalfPlane sides[2];
    bool surrounds; ///< the camera lies inside the beam's cylinder: there are no sides
    std::array<RibbonEdge, 2> edges;
    bool ends; ///< whether there are any
    float g, sigmaT;
    bool simple; ///< grey, isotropic or Henyey-Greenstein: a register at a time
    int medium, bounce;
    PixelArea area;
};

class BeamSplatter {
  public:
    BeamSplatter(const Scene& scene, const transport::TimeSensor& sensor, double scale, Film& film)
        : scene_(scene), sensor_(sensor), origin_(scene.camera.position()), footprint_(scene.camera),
          scale_(float(scale)), film_(film), speed_(double(scene.cameraRegion.speed)),
          timeless_(sensor.gate.steadyState), oneFrame_(timeless_ || (sensor.gate.frames == 1 && !sensor.response)) {}

    [[nodiscard]] std::optional<Ribbon> ribbon(const PhotonBeam& beam, float radius, const KernelEdges& edges) const {
        const auto area =
            footprint_.around(beam.base + beam.direction * beam.tStart, beam.base + beam.direction * beam.tEnd, radius);
        if (!area) return std::nullopt;
        const Vec3d base = Vec3d(beam.base) - Vec3d(origin_), along = Vec3d(beam.direction);
        const double toFoot = -base.dot(along) / along.length2();
        const Vec3d foot = base + along * toFoot;
        const Medium& medium = scene_.media[size_t(beam.medium)];
        Ribbon r{};
        r.direction = beam.direction;
        r.foot = Vec3f(foot);
        r.normal = r.foot.cross(r.direction);
        r.low = float(double(beam.tStart) - toFoot);
        r.high = float(double(beam.tEnd) - toFoot);
        r.fromBase = float(toFoot);
        r.radius = radius;
        r.time = beam.time + toFoot / speed_;
        r.shortest = float((sensor_.gate.start - r.time) * speed_);
        r.longest = float((sensor_.gate.end() - r.time) * speed_);
        r.power = beam.power * medium.sigmaS() * (scale_ / (2.0f * radius));
        r.g = medium.phase.g();
        r.sigmaT = medium.sigmaT().x;
        r.simple = medium.isGrey() && medium.phase.isHenyeyGreenstein();
        r.medium = beam.medium;
        r.bounce = beam.bounce;
        r.area = *area;
        r.ends = edges.nearest.exists();
        r.edges = {edgeOf(edges.nearest, r), edgeOf(edges.opposite, r)};
        const double distance = foot.length();
        r.surrounds = distance <= 1.0001 * double(radius);
        if (!r.surrounds) {
            // The planes through the camera that touch the cylinder; both hold the beam's direction.
            const float sine = radius / float(distance), cosine = std::sqrt(1.0f - sine * sine);
            const Vec3f towards = r.foot * (sine / float(distance)), aside = r.normal * (cosine / float(distance));
            r.sides[0] = footprint_.halfPlane(towards + aside);
            r.sides[1] = footprint_.halfPlane(towards - aside);
        }
        return r;
    }

    uint64_t draw(const Ribbon& ribbon, ImageBand& band) const {
        uint64_t gathered = 0;
        for (int y = std::max(ribbon.area.top, band.firstRow); y <= std::min(ribbon.area.bottom, band.lastRow); ++y) {
            int left = ribbon.area.left, right = ribbon.area.right;
            if (!ribbon.surrounds)
                for (const ImageHalfPlane& side : ribbon.sides) footprint_.narrow(side, y, left, right);
            for (BandSegment& segment : band.segments)
                if (segment.mixed ||
                    (segment.medium == ribbon.medium && rendered(segment.interactions + ribbon.bounce + 1)))
                    gathered += drawRow(ribbon, segment, band, y, left, right);
        }
        return gathered;
    }

  private:
    static RibbonEdge edgeOf(const KernelEdge& edge, const Ribbon& r) {
        if (!edge.exists()) return {};
        const float slope = edge.normal.dot(r.direction);
        return {edge.reach - r.fromBase * slope, slope, edge.normal.cross(r.direction)};
    }
    /// Where a ray comes closest to the beam, and what it gathers there.
    struct Approaches {
        alignas(64) float alongBeam[Lanes], alongRay[Lanes], toCamera[Lanes];
        alignas(64) float weight[Lanes]; ///< 0 for rays that miss
    };

    /// Into the band's sums, or pixel by pixel into the film.
    uint64_t drawRow(const Ribbon& ribbon, BandSegment& segment, const ImageBand& band, int y, int left,
                     int right) const {
        uint64_t gathered = 0;
        Approaches found;
        for (int x = left; x <= right; x += Lanes) {
            const size_t i = band.at(x, y);
            if (!approach(ribbon, band, segment, i, found)) continue;
            if (ribbon.simple && oneFrame_) {
                gathered += collect(ribbon, found, segment, i);
                continue;
            }
            for (int lane = 0; lane < Lanes; ++lane)
                if (found.weight[lane] > 0.0f)
                    gathered += add(ribbon, band.record(), segment.number, y, x + lane, found, lane);
        }
        return gathered;
    }
    /// From pixel `first` of the band on. Beams of cornell-fog take 22 % more CPU time lane by lane.
    uint64_t collect(const Ribbon& ribbon, const Approaches& found, BandSegment& segment, size_t first) const {
        auto weight = Batch::load_aligned(found.weight);
        auto inside = weight > 0.0f;
        if (segment.mixed) {
            const auto [least, most] = transport::BounceLimits(scene_.transport).remaining(ribbon.bounce + 1);
            inside = segment.select(inside, first, ribbon.medium, least, most);
        }
        if (!timeless_) {
            Batch length = Batch::load_aligned(found.alongBeam);
            if (!scene_.transport.cameraUnwarped) length += Batch::load_aligned(found.toCamera);
            inside = inside && length >= ribbon.shortest && length < ribbon.longest;
        }
        weight = xsimd::select(inside, weight, Batch(0.0f));
        for (int k = 0; k < 3; ++k) segment.add(first, weight, k, ribbon.power[k]);
        return uint64_t(darts::lanes::sum(xsimd::select(inside, Batch(1.0f), Batch(0.0f))));
    }

    /// False if no ray meets the ribbon.
    bool approach(const Ribbon& r, const ImageBand& band, const BandSegment& segment, size_t first,
                  Approaches& found) const {
        const auto load = [first](const std::vector<float>& v) { return Batch::load_unaligned(v.data() + first); };
        const Batch dx = load(band.x), dy = load(band.y), dz = load(band.z), start = load(segment.start);
        const Vec3f &w = r.direction, &a = r.foot, &n = r.normal;
        const Batch cosine = dx * w.x + dy * w.y + dz * w.z;
        const Batch px = dx - cosine * w.x, py = dy - cosine * w.y, pz = dz - cosine * w.z;
        const Batch squaredSine = px * px + py * py + pz * pz;
        const Batch inverse = 1.0f / xsimd::max(squaredSine, Batch(LeastSine * LeastSine));
        const Batch t = (dx * a.x + dy * a.y + dz * a.z) * inverse, s = cosine * t;
        const Batch across = dx * n.x + dy * n.y + dz * n.z, squaredDistance = across * across * inverse;
        auto inside = squaredSine > LeastSine * LeastSine && squaredDistance < r.radius * r.radius && s >= r.low &&
                      s < r.high && t > start && t <= load(segment.end);
        if (!xsimd::any(inside)) return false;
        Batch weight = xsimd::sqrt(inverse);
        if (r.ends) inside = inside && withinEdges(r, dx, dy, dz, s, across, weight);
        if (r.simple) {
            const Batch exponent = xsimd::select(inside, (start - t - s - r.fromBase) * r.sigmaT, Batch(0.0f));
            weight = weight * xsimd::exp(exponent) * henyeyGreenstein(r.g, w, dx, dy, dz);
        }
        xsimd::select(inside, weight, Batch(0.0f)).store_aligned(found.weight);
        s.store_aligned(found.alongBeam);
        t.store_aligned(found.alongRay);
        if (!timeless_) xsimd::sqrt(t * t + squaredDistance).store_aligned(found.toCamera);
        return true;
    }

    /// Whether rays meet the ribbon before its edges; weighs them by how much narrower these make it. `weight` comes as
    /// the inverse of the sine.
    Batch::batch_bool_type withinEdges(const Ribbon& r, const Batch& dx, const Batch& dy, const Batch& dz,
                                       const Batch& s, const Batch& across, Batch& weight) const {
        Batch low(-r.radius), high(r.radius);
        const Batch offset = -across * weight;
        for (const RibbonEdge& edge : r.edges) {
            if (!(edge.height < Infinity)) continue;
            const Batch slope = (dx * edge.tilt.x + dy * edge.tilt.y + dz * edge.tilt.z) * weight;
            const Batch end =
                xsimd::max(edge.height - s * edge.slope, Batch(0.0f)) / xsimd::max(xsimd::abs(slope), Batch(1e-6f));
            high = xsimd::select(slope > 0.0f, xsimd::min(high, end), high);
            low = xsimd::select(slope > 0.0f, low, xsimd::max(low, -end));
        }
        weight *= 2.0f * r.radius / xsimd::max(high - low, Batch(1e-6f * r.radius));
        return offset >= low && offset < high;
    }

    [[nodiscard]] bool rendered(int interactions) const {
        return transport::BounceLimits(scene_.transport).renders(interactions);
    }
    uint64_t add(const Ribbon& ribbon, const CameraRecord& record, size_t number, int y, int x, const Approaches& found,
                 int lane) const {
        const MediumSegment& segment = record.mediumSegments[number];
        const size_t pixel = size_t(y) * size_t(record.width) + size_t(x);
        if (segment.medium[pixel] != ribbon.medium) return 0;
        if (!rendered(int(segment.interactions[pixel]) + ribbon.bounce + 1)) return 0;
        float weight = found.weight[lane];
        int frame = 0;
        if (!timeless_) {
            const double toCamera = scene_.transport.cameraUnwarped ? 0.0 : double(found.toCamera[lane]);
            const double arrival = ribbon.time + (double(found.alongBeam[lane]) + toCamera) / speed_;
            frame = sensor_.gate.frameOf(arrival);
            if (frame < 0) return 0;
            weight *= sensor_.weight(arrival);
        }
        Rgb radiance = ribbon.power * segment.throughput[pixel] * weight;
        if (!ribbon.simple) {
            const Medium& medium = scene_.media[size_t(ribbon.medium)];
            const Vec3f back(-record.x[pixel], -record.y[pixel], -record.z[pixel]);
            radiance = radiance *
                       medium.transmittance(ribbon.fromBase + found.alongBeam[lane] + found.alongRay[lane] -
                                            segment.start[pixel]) *
                       medium.phase.eval(ribbon.direction, back);
        }
        film_.add(frame, x, y, radiance);
        return 1;
    }

    const Scene& scene_;
    transport::TimeSensor sensor_;
    Vec3f origin_;
    ImageFootprint footprint_;
    float scale_;
    Film& film_;
    double speed_;
    bool timeless_, oneFrame_; ///< without a gate; no frame to choose and no response to weigh by
};

} // namespace

uint64_t Beams::splat(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecords& records,
                      const Selection<PhotonBeam>& beams, double scale, Film& film, const ProgressToken& watch) {
    const BeamSplatter splatter(scene, sensor, scale, film);
    const size_t bands = ImageBand::count(scene.camera.resolution.y);
    std::vector<std::optional<Ribbon>> ribbons(beams.records.size());
    tbb::parallel_for(size_t(0), ribbons.size(), [&](size_t i) {
        watch.advanceWithin(1024, i);
        ribbons[i] = splatter.ribbon(beams.records[i], beams.radii[i], beams.radii.edges(i));
    });
    // Beams by band, in their own order: the sums do not depend on the threads.
    std::vector<std::vector<uint32_t>> byBand(bands);
    for (size_t i = 0; i < ribbons.size(); ++i)
        if (ribbons[i])
            for (int band = ribbons[i]->area.top / ImageBand::Rows; band <= ribbons[i]->area.bottom / ImageBand::Rows;
                 ++band)
                byBand[size_t(band)].push_back(uint32_t(i));
    std::vector<uint64_t> gathered(bands, 0);
    watch.stage("splat", bands);
    tbb::parallel_for(size_t(0), bands, [&](size_t number) {
        const auto& drawn = byBand[number];
        if (drawn.empty()) return;
        for (const CameraRecord* record : records) {
            ImageBand band(*record, number);
            for (size_t i = 0; i < drawn.size(); ++i) {
                watch.advanceWithin(64, i);
                prefetch(*ribbons[drawn[std::min(i + DrawnAhead, drawn.size() - 1)]]);
                gathered[number] += splatter.draw(*ribbons[drawn[i]], band);
                band.countDrawn();
            }
            // With several frames nothing has been collected.
            band.addToFilm(0, film);
        }
        watch.advance();
    });
    uint64_t total = 0;
    for (const uint64_t count : gathered) total += count;
    return total;
}

} // namespace tungsten::photon
