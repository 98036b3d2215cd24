#include "photon/primitives/beams/BeamSplat.h"

#include "photon/raster/ImageBand.h"
#include "photon/raster/ImageFootprint.h"
#include "transport/BounceLimits.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

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
        const auto inDouble = [](const Vec3f& v) { return Vec3d(double(v.x), double(v.y), double(v.z)); };
        const Vec3d base = inDouble(beam.base) - inDouble(origin_), along = inDouble(beam.direction);
        const double toFoot = -base.dot(along) / along.length2();
        const Vec3d foot = base + along * toFoot;
        const Medium& medium = scene_.media[size_t(beam.medium)];
        Ribbon r{};
        r.direction = beam.direction;
        r.foot = Vec3f(float(foot.x), float(foot.y), float(foot.z));
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

uint64_t splatBeams(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecords& records,
                    const std::vector<PhotonBeam>& beams, const Radii& radii, double scale, Film& film,
                    const ProgressToken& watch) {
    const BeamSplatter splatter(scene, sensor, scale, film);
    const size_t bands = ImageBand::count(scene.camera.resolution.y);
    std::vector<std::optional<Ribbon>> ribbons(beams.size());
    tbb::parallel_for(size_t(0), ribbons.size(), [&](size_t i) {
        watch.advanceWithin(1024, i);
        ribbons[i] = splatter.ribbon(beams[i], radii[i], radii.edges(i));
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
