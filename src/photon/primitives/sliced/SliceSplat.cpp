#include "photon/primitives/sliced/SliceSplat.h"

#include "photon/Tuning.h"
#include "photon/primitives/beams/Beams.h"
#include "photon/primitives/sliced/CameraRay.h"
#include "photon/primitives/sliced/RecordBudget.h"
#include "photon/primitives/sliced/SliceEstimate.h"
#include "photon/primitives/sliced/SliceGather.h"
#include "photon/primitives/sliced/SliceLanes.h"
#include "photon/raster/ImageBand.h"

#include <tbb/parallel_for.h>

#include <limits>

namespace tungsten::photon {

SliceFootprints::SliceFootprints(const Scene& scene, const transport::TimeSensor& sensor, double scale)
    : scene_(scene), gate_(sensor.gate), scale_(scale), warped_(!scene.transport.cameraUnwarped),
      delta_(scene.transport.gate.delta), weighed_(sensor.response != nullptr) {
    if (scene.camera.hasSinglePosition()) footprint_.emplace(scene.camera);
}

std::optional<ImageSlice> SliceFootprints::prepare(const SliceRecord& flights, std::span<const float> shares) const {
    const Medium& medium = scene_.media[size_t(flights.medium)];
    const auto speed = double(medium.speedOfLight);
    const bool far = farAway(flights, speed);
    const float common =
        far && warped_ && !gate_.steadyState ? (scene_.camera.position() - flights.base).length() : 0.0f;
    LaneTimes times = timesOf(flights, speed, double(common));
    times.shares = shares;
    const float length = std::min(times.start(times.frames) + common, visibleReach(medium));
    if (!(length > 0.0f)) return std::nullopt;
    const auto area = areaOf(flights, length);
    if (!area) return std::nullopt;
    const bool ball = flights.shape == FlightShape::Ball, occluders = !scene_.primitives.empty();
    const auto& w = flights.directions;
    const LightAtBall light = lightAt(flights);
    LaneRecord record{&flights,
                      times,
                      medium.sigmaT(),
                      medium.isGrey(),
                      warped_,
                      far,
                      common,
                      medium.phase.g(),
                      occluders ? flights.reach : Infinity,
                      occluders || flights.shared,
                      ball ? 0.0f : medium.phase.pdf(w[1], w[2]),
                      1.0f,
                      light.leaving,
                      light.leastCosine};
    if (ball) record.pdfs = pdfFlight(medium, flights.lengths[0]) * pdfFlight(medium, flights.lengths[1]);
    ImageSlice s{record, kernelOf(flights), *area, flights.power, false};
    s.inLanes = !weighed_ && medium.phase.isHenyeyGreenstein() && light.known;
    const double perLength = atLengths(flights) ? speed * gate_.frameWidth : 1.0;
    for (int k = 0; k < 3; ++k)
        s.power[k] *= float(scale_ * perLength * collisions(double(medium.sigmaS()[k]), flights.flights()));
    s.power = s.power * light.intensity;
    return s;
}

auto SliceFootprints::lightAt(const SliceRecord& ball) const -> LightAtBall {
    if (ball.emitter < 0) return {};
    const Emitter& emitter = scene_.emitters[size_t(ball.emitter)];
    if (const AreaEmitter* area = emitter.surface()) {
        const SurfaceSample point = ball.surfacePoint();
        return {area->emittedIntensity(point, point.normal), LaneRecord::Leaving::Cosine, area->cosCone()};
    }
    if (const auto even = isotropicIntensity(emitter)) return {*even, LaneRecord::Leaving::Evenly};
    return {.known = false};
}

bool SliceFootprints::farAway(const SliceRecord& flights, double speed) const {
    // Floats lose 1e-7 of the distance: a hundred-thousandth of what is left, a thousandth of a frame.
    constexpr double MostOfLeft = 32.0, MostOfFrame = 1e4;
    const auto distance = double((scene_.camera.position() - flights.base).length());
    if (gate_.steadyState) return distance > MostOfLeft * double(visibleReach(scene_.media[size_t(flights.medium)]));
    const double left = (gate_.end() - flights.time) * speed - (warped_ ? distance : 0.0);
    return distance > std::min(MostOfLeft * left, MostOfFrame * gate_.frameWidth * speed);
}

bool SliceFootprints::atLengths(const SliceRecord& flights) const {
    if (flights.shape == FlightShape::Hypervolume) return true;
    return delta_ && !flights.blurredInTime();
}

LaneTimes SliceFootprints::timesOf(const SliceRecord& flights, double speed, double common) const {
    if (gate_.steadyState) return {0.0f, std::numeric_limits<float>::max(), 1};
    if (delta_ && !flights.blurredInTime())
        return {float((scene_.transport.gate.start - flights.time) * speed - common), 0.0f, 1};
    return {float((gate_.start - flights.time) * speed - common), float(gate_.frameWidth * speed), gate_.frames};
}

SliceKernel SliceFootprints::kernelOf(const SliceRecord& flights) const {
    if (flights.shape == FlightShape::Plane) return PlaneLanes(flights);
    if (flights.shape == FlightShape::Hypervolume) return HypervolumeLanes(flights);
    if (flights.shape == FlightShape::Volume)
        return atLengths(flights) ? SliceKernel(VolumeSliceLanes(flights)) : SliceKernel(VolumeChordLanes(flights));
    return atLengths(flights) ? SliceKernel(BallSliceLanes()) : SliceKernel(BallGateLanes());
}

std::optional<PixelArea> SliceFootprints::areaOf(const SliceRecord& flights, float length) const {
    const Vec2i resolution = scene_.camera.resolution;
    const PixelArea all{0, resolution.x - 1, 0, resolution.y - 1};
    if (!footprint_) return all;
    if (flights.shape == FlightShape::Ball) {
        const auto area = footprint_->around(flights.base, 1.0001f * length);
        return area;
    }
    std::array<Vec3f, 5> points;
    points[0] = flights.base;
    const auto count = size_t(flights.flights());
    for (size_t i = 0; i < count; ++i) points[i + 1] = flights.base + flights.directions[i] * length;
    // An unwarped slice is the triangle alone.
    const bool triangle = delta_ && !warped_ && flights.shape == FlightShape::Volume;
    return footprint_->aroundHull(std::span(points).subspan(triangle ? 1 : 0, count + (triangle ? 0 : 1)));
}

namespace {

// ---- Shadow rays of slices that are drawn a register of rays at a time

/// Whole doses in place of weights: shadow rays cost a hundred times what weights do. Whenever what a ray has been
/// given fills another dose, by the record at hand, that one is tested and stands for the dose; evenly from a random
/// start, so that every record brings what it weighs on average, whatever the doses are.
class SystematicShadowRays {
  public:
    /// For so many rays. Until begin() all is counted and nothing let through: a pilot over a part of the records.
    void reserve(size_t rays) {
        dose_.assign(rays, 1.0f);
        filled_.assign(rays, 0.0f);
        begun_ = false;
    }
    /// The pilot has shown `part` of what comes: about `number` doses for each ray.
    void begin(float part, float number, Sampler& sampler);

    /// Factors on weights of this brightness at rays `first`...: 0 for what is not tested, or not seen. The rays'
    /// origins are relative to the base.
    [[nodiscard]] Batch tested(const SliceEstimate& estimate, const LaneRecord& record, const LaneRays& rays,
                               const LaneHit& hit, const Batch& brightness, size_t first);

  private:
    std::vector<float> dose_, filled_;
    bool begun_ = false;
};

using LaneArray = std::array<float, size_t(Lanes)>;

LaneArray stored(const Batch& batch) {
    alignas(64) LaneArray values;
    batch.store_unaligned(values.data());
    return values;
}

void SystematicShadowRays::begin(float part, float number, Sampler& sampler) {
    for (size_t i = 0; i < dose_.size(); ++i) {
        dose_[i] = std::max(filled_[i] / (part * number), 1e-30f);
        filled_[i] = sampler.next1D();
    }
    begun_ = true;
}

Batch SystematicShadowRays::tested(const SliceEstimate& estimate, const LaneRecord& record, const LaneRays& rays,
                                   const LaneHit& hit, const Batch& brightness, size_t first) {
    const Batch filled = Batch::load_unaligned(filled_.data() + first);
    if (!begun_) {
        (filled + brightness).store_unaligned(filled_.data() + first);
        return Batch(0.0f);
    }
    const Batch dose = Batch::load_unaligned(dose_.data() + first);
    const Batch sum = filled + brightness / dose, whole = xsimd::floor(sum);
    (sum - whole).store_unaligned(filled_.data() + first);
    if (!xsimd::any(whole > 0.0f)) return Batch(0.0f);
    const Batch lit = xsimd::max(brightness, Batch(std::numeric_limits<float>::min()));
    LaneArray factors = stored(xsimd::select(whole > 0.0f, whole * dose / lit, Batch(0.0f)));
    const Lanes3 at = rays.toOrigin + rays.direction * hit.alongRay;
    const LaneArray x = stored(at.x), y = stored(at.y), z = stored(at.z);
    std::array<LaneArray, 4> lengths;
    for (size_t k = 0; k < 4; ++k) lengths[k] = stored(hit.lengths[k]);
    const SliceRecord& flights = *record.flights;
    for (size_t lane = 0; lane < size_t(Lanes); ++lane) {
        if (!(factors[lane] > 0.0f)) continue;
        std::array<double, 4> t;
        for (size_t k = 0; k < 4; ++k) t[k] = double(lengths[k][lane]);
        const bool open = flights.shape == FlightShape::Ball
                              ? estimate.unoccluded(flights, flights.base + Vec3f(x[lane], y[lane], z[lane]))
                              : estimate.unoccluded(flights, t.data(), flights.flights());
        if (!open) factors[lane] = 0.0f;
    }
    return Batch::load_unaligned(factors.data());
}

// ---- Drawing

/// What a band's rays have besides the band.
struct BandRays {
    std::vector<float> x, y, z;           ///< origins; empty: all the record's
    std::vector<float> rotation;          ///< of random numbers
    SystematicShadowRays doses;           ///< with occluders
    std::vector<const ImageSlice*> drawn; ///< the last one that was drawn into each frame
};

constexpr size_t PilotStep = 8;

/// Draws on the straight rays of one sample, registers of them where a slice has such a form, else ray by ray.
/// Functions return how many records rays met, and may run in many threads, one a band.
class SliceSplatter {
  public:
    SliceSplatter(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecord& record, double scale,
                  Film& film)
        : scene_(scene), sensor_(sensor), record_(record), estimate_(scene, sensor), scale_(scale), film_(film),
          occluders_(!scene.primitives.empty()) {}

    uint64_t draw(const ImageSlice& slice, ImageBand& band, BandRays& rays) const {
        const auto shows = [&](const BandSegment& segment) { return segment.mixed || shownIn(slice, segment); };
        if (std::none_of(band.segments.begin(), band.segments.end(), shows)) return 0;
        if (!slice.inLanes) return drawRays(slice, band);
        uint64_t gathered = 0;
        const auto drawBy = [&](const auto& kernel) {
            for (BandSegment& segment : band.segments)
                if (shows(segment)) gathered += drawLanes(kernel, slice, band, segment, rays);
        };
        std::visit(drawBy, slice.kernel);
        return gathered;
    }

    uint64_t gatherBeams(const BeamGather& beams, const ImageBand& band) const {
        uint64_t gathered = 0;
        FrameSums sums(size_t(sensor_.gate.frames));
        for (int y = band.firstRow; y <= band.lastRow; ++y)
            for (int x = 0; x < record_.width; ++x) {
                const size_t pixel = size_t(y) * size_t(record_.width) + size_t(x);
                for (const MediumSegment& segment : record_.mediumSegments) {
                    if (!(segment.end[pixel] > segment.start[pixel])) continue;
                    std::fill(sums.begin(), sums.end(), Vec3d(0.0));
                    gathered += beams.gather(segmentOf(segment, pixel), sums);
                    addToFilm(sums, segment.throughput[pixel], x, y);
                }
            }
        return gathered;
    }
    /// Finds the doses by a pilot over a part of what is to be drawn.
    void findDoses(const std::vector<std::optional<ImageSlice>>& slices, const std::vector<uint32_t>& drawn,
                   ImageBand& band, BandRays& rays) const {
        if (!occluders_ || drawn.empty()) return;
        rays.doses.reserve(band.x.size());
        for (size_t k = 0; k < drawn.size(); k += PilotStep)
            if (slices[drawn[k]]->inLanes) draw(*slices[drawn[k]], band, rays);
        const SliceRecord& first = *slices[drawn.front()]->record.flights;
        Sampler sampler(first.random[0], RandomStream::Folded, first.random[1], drawn.size());
        rays.doses.begin(1.0f / float(PilotStep), tuning::ShadowRaysPerRay, sampler);
    }
    [[nodiscard]] BandRays originsOf(const ImageBand& band) const {
        BandRays rays;
        rays.drawn.resize(size_t(sensor_.gate.frames), nullptr);
        rays.rotation.resize(band.x.size());
        for (size_t i = 0; i < rays.rotation.size(); ++i)
            rays.rotation[i] = float(rayRotation(Vec3f(band.x[i], band.y[i], band.z[i])));
        if (record_.origins.empty()) return rays;
        for (auto* v : {&rays.x, &rays.y, &rays.z}) v->resize(band.x.size());
        for (int row = band.firstRow; row <= band.lastRow; ++row)
            for (int column = 0; column < record_.width; ++column) {
                const Vec3f& o = record_.origins[size_t(row) * size_t(record_.width) + size_t(column)];
                const size_t i = band.at(column, row);
                rays.x[i] = o.x;
                rays.y[i] = o.y;
                rays.z[i] = o.z;
            }
        return rays;
    }

  private:
    /// Whether a slice shows in a segment that all rays share.
    [[nodiscard]] bool shownIn(const ImageSlice& slice, const BandSegment& segment) const {
        const int sum = segment.interactions + slice.record.flights->bounce + slice.record.flights->flights();
        return segment.medium == slice.record.flights->medium && sum >= scene_.transport.minBounces &&
               sum < scene_.transport.maxBounces;
    }

    // A register of rays after the other.
    template <typename Kernel>
    uint64_t drawLanes(const Kernel& kernel, const ImageSlice& slice, ImageBand& band, BandSegment& segment,
                       BandRays& rays) const {
        uint64_t gathered = 0;
        for (int y = std::max(slice.area.top, band.firstRow); y <= std::min(slice.area.bottom, band.lastRow); ++y)
            for (int x = slice.area.left; x <= slice.area.right; x += Lanes) {
                const size_t i = band.at(x, y);
                const LaneRays lanes = raysOf(slice, band, segment, rays, i);
                kernel.intersect(slice.record, lanes, [&](int frame, const LaneHit& hit) {
                    if (std::exchange(rays.drawn[size_t(frame)], &slice) != &slice) band.countDrawn(frame);
                    gathered += collect(slice, lanes, hit, segment, frame, band.sumsOf(frame), rays, i);
                });
            }
        return gathered;
    }
    [[nodiscard]] LaneRays raysOf(const ImageSlice& slice, const ImageBand& band, const BandSegment& segment,
                                  const BandRays& rays, size_t i) const {
        constexpr float Far = 1e18f; // products with it are finite
        const auto load = [i](const std::vector<float>& v) { return Batch::load_unaligned(v.data() + i); };
        const SliceRecord& flights = *slice.record.flights;
        const Vec3f &o = record_.origin, &b = flights.base;
        const Lanes3 toOrigin =
            rays.x.empty() ? Lanes3(o - b) : Lanes3(load(rays.x) - b.x, load(rays.y) - b.y, load(rays.z) - b.z);
        const Batch start = load(segment.start), end = xsimd::min(load(segment.end), Batch(Far));
        LaneMask seen = start < end;
        const int before = flights.bounce + flights.flights();
        if (segment.mixed)
            seen = segment.select(seen, i, flights.medium, scene_.transport.minBounces - before,
                                  scene_.transport.maxBounces - 1 - before);
        const LaneRays asCast{toOrigin,           {load(band.x), load(band.y), load(band.z)}, start, end, seen,
                              load(rays.rotation)};
        return slice.record.placed(asCast);
    }

    /// Into the band's sums. The throughput holds the way to the segment.
    uint64_t collect(const ImageSlice& slice, const LaneRays& lanes, const LaneHit& hit, BandSegment& segment,
                     int frame, size_t sums, BandRays& rays, size_t i) const {
        const LaneRecord& record = slice.record;
        const Rgb power = slice.power * record.times.factor(frame);
        const auto channel = [&](int k) {
            return xsimd::select(hit.met, hit.weight(record.sigmaT[k], lanes.start), Batch(0.0f));
        };
        std::array<Batch, 3> weights;
        weights.fill(channel(0));
        if (!record.grey)
            for (int k = 1; k < 3; ++k) weights[size_t(k)] = channel(k);
        if (occluders_) {
            Batch brightness(0.0f);
            for (int k = 0; k < 3; ++k) brightness += weights[size_t(k)] * (power[k] / 3.0f);
            const Batch factor = rays.doses.tested(estimate_, record, lanes, hit, brightness, i);
            if (!xsimd::any(factor > 0.0f)) return 0;
            for (Batch& weight : weights) weight *= factor;
        }
        for (int k = 0; k < 3; ++k) segment.add(sums + i, weights[size_t(k)], k, power[k]);
        return uint64_t(darts::lanes::sum(xsimd::select(hit.met, Batch(1.0f), Batch(0.0f))));
    }

    // Ray by ray.
    uint64_t drawRays(const ImageSlice& slice, const ImageBand& band) const {
        uint64_t gathered = 0;
        for (int y = std::max(slice.area.top, band.firstRow); y <= std::min(slice.area.bottom, band.lastRow); ++y)
            gathered += drawRays(slice, slice.area.left, y, slice.area.right);
        return gathered;
    }
    uint64_t drawRays(const ImageSlice& slice, int x, int y, int last) const {
        uint64_t gathered = 0;
        FrameSums sums(size_t(sensor_.gate.frames));
        for (; x <= last; ++x) {
            const size_t pixel = size_t(y) * size_t(record_.width) + size_t(x);
            for (const MediumSegment& segment : record_.mediumSegments) {
                if (!(segment.end[pixel] > segment.start[pixel]) ||
                    segment.medium[pixel] != slice.record.flights->medium)
                    continue;
                std::fill(sums.begin(), sums.end(), Vec3d(0.0));
                if (!estimate_.add(*slice.record.flights, segmentOf(segment, pixel), sums)) continue;
                ++gathered;
                addToFilm(sums, segment.throughput[pixel], x, y);
            }
        }
        return gathered;
    }

    void addToFilm(const FrameSums& sums, const Rgb& throughput, int x, int y) const {
        for (size_t frame = 0; frame < sums.size(); ++frame) {
            const Vec3d value = sums[frame] * scale_;
            film_.add(int(frame), x, y, Rgb(value) * throughput);
        }
    }

    [[nodiscard]] CameraSegment segmentOf(const MediumSegment& segment, size_t pixel) const {
        const Vec3f direction(record_.x[pixel], record_.y[pixel], record_.z[pixel]);
        const Vec3f origin = record_.origins.empty() ? record_.origin : record_.origins[pixel];
        const float start = segment.start[pixel];
        const double inverseSpeed = 1.0 / double(scene_.media[size_t(segment.medium[pixel])].speedOfLight);
        return {origin + direction * start,   direction,    segment.end[pixel] - start,
                double(start) * inverseSpeed, inverseSpeed, segment.interactions[pixel],
                segment.medium[pixel]};
    }

    const Scene& scene_;
    transport::TimeSensor sensor_;
    const CameraRecord& record_;
    SliceEstimate estimate_;
    double scale_;
    Film& film_;
    bool occluders_;
};

/// Whether the media that scatter and the camera's region have one speed: what Beams::splat needs.
bool oneSpeed(const Scene& scene) {
    return std::all_of(scene.media.begin(), scene.media.end(), [&](const Medium& medium) {
        return !medium.scatters() || medium.speedOfLight == scene.cameraRegion.speed;
    });
}

using SliceList = std::vector<std::optional<ImageSlice>>;

/// Slices as the image shows them; none where it does not show one, and none of beams.
SliceList prepared(const SliceFootprints& footprints, const std::vector<SliceRecord>& records,
                   const FrameRoulette& shares, const ProgressToken& watch) {
    SliceList slices(records.size());
    tbb::parallel_for(size_t(0), slices.size(), [&](size_t i) {
        watch.advanceWithin(256, i);
        if (records[i].shape != FlightShape::Beam) slices[i] = footprints.prepare(records[i], shares.of(i));
    });
    return slices;
}

/// Indices of those that each band shows, in their own order: the sums do not depend on the threads.
std::vector<std::vector<uint32_t>> byBand(const SliceList& slices, size_t bands) {
    std::vector<std::vector<uint32_t>> indices(bands);
    for (size_t i = 0; i < slices.size(); ++i) {
        if (!slices[i]) continue;
        const int first = slices[i]->area.top / ImageBand::Rows, last = slices[i]->area.bottom / ImageBand::Rows;
        for (int band = first; band <= last; ++band) indices[size_t(band)].push_back(uint32_t(i));
    }
    return indices;
}

} // namespace

uint64_t splatSlices(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecord& record,
                     const std::vector<SliceRecord>& records, const Radii& radius, double scale, Film& film,
                     const ProgressToken& watch) {
    const SliceSplatter splatter(scene, sensor, record, scale, film);
    const FrameRoulette shares(scene, sensor.gate, records, watch);
    const SliceList slices = prepared(SliceFootprints(scene, sensor, scale), records, shares, watch);
    const size_t bands = ImageBand::count(record.height);
    const std::vector<std::vector<uint32_t>> drawnIn = byBand(slices, bands);
    const Selection<PhotonBeam> beams{beamsAmong(scene, records), radius[0]};
    const bool drawBeams = record.origins.empty() && oneSpeed(scene);
    std::optional<BeamGather> beamGather;
    if (!beams.records.empty() && !drawBeams) beamGather.emplace(scene, sensor, beams.records, radius);
    std::vector<uint64_t> gathered(bands, 0);
    watch.stage("splat", bands);
    tbb::parallel_for(size_t(0), bands, [&](size_t number) {
        const auto& drawn = drawnIn[number];
        ImageBand band(record, number, sensor.gate.frames);
        BandRays rays = splatter.originsOf(band);
        splatter.findDoses(slices, drawn, band, rays);
        for (size_t i = 0; i < drawn.size(); ++i) {
            watch.advanceWithin(16, i);
            gathered[number] += splatter.draw(*slices[drawn[i]], band, rays);
        }
        for (int frame = 0; frame < sensor.gate.frames; ++frame) band.addToFilm(frame, film);
        if (beamGather) gathered[number] += splatter.gatherBeams(*beamGather, band);
        watch.advance();
    });
    uint64_t total = drawBeams ? Beams::splat(scene, sensor, {&record}, beams, scale, film, watch) : 0;
    for (const uint64_t count : gathered) total += count;
    return total;
}

} // namespace tungsten::photon
