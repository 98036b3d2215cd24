#include "photon/primitives/sliced/SliceSplat.h"

#include "photon/primitives/sliced/SliceEstimate.h"
#include "photon/primitives/sliced/SliceGather.h"
#include "photon/primitives/sliced/SliceLanes.h"
#include "photon/raster/ImageBand.h"
#include "photon/raster/ImageFootprint.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

/// A record as the image sees it.
struct Slice {
    const CollapsedFlights* flights;
    PixelArea area;
    VolumeLanes volume; ///< of its directions
    float residual;     ///< path length left at the base, at the delta gate
    Rgb power;          ///< with the collapsed collisions
    float pdfs;         ///< of a ball's two flights
    float g, sigmaT;
    bool ball, inLanes; ///< inLanes: evaluated a register at a time; otherwise ray by ray
};

/// Rays of one band that are not in the band itself.
struct BandRays {
    std::vector<float> x, y, z; ///< origins; empty: all the record's
};

class Splatter {
  public:
    Splatter(const Scene& scene, const Sensor& sensor, const SensorRecord& record, double scale, Film& film)
        : scene_(scene), sensor_(sensor), record_(record), estimate_(scene, sensor), scale_(scale), film_(film),
          warped_(!scene.transport.cameraUnwarped), delta_(scene.transport.gate.delta),
          occluders_(!scene.primitives.empty()), speed_(double(scene.cameraRegion.speed)) {
        if (record.origins.empty()) footprint_.emplace(scene.camera);
    }

    [[nodiscard]] std::optional<Slice> prepare(const CollapsedFlights& flights) const {
        const Medium& medium = scene_.media[size_t(flights.medium)];
        const TimeGate& gate = sensor_.gate;
        const double until = delta_ ? scene_.transport.gate.start : gate.end();
        const double left =
            gate.steadyState ? std::numeric_limits<double>::infinity() : (until - flights.time) * speed_;
        const float length = float(std::min(left, double(visibleReach(medium))));
        if (!(length > 0.0f)) return std::nullopt;
        const auto area = areaOf(flights, length);
        if (!area) return std::nullopt;
        const bool ball = flights.shape == FlightShape::Ball;
        Slice s{&flights,
                *area,
                VolumeLanes({flights.directions[0], flights.directions[1], flights.directions[2]}),
                float(left),
                flights.power,
                1.0f,
                medium.phase.g(),
                medium.sigmaT().x,
                ball,
                false};
        s.inLanes = delta_ && (ball || flights.shape == FlightShape::Volume) && flights.emitter < 0 &&
                    medium.isGrey() && !std::holds_alternative<Rayleigh>(medium.phase.model);
        const double sigmaS = double(medium.sigmaS.x);
        s.power = flights.power * float(scale_ * speed_ * gate.frameWidth * (ball ? sigmaS : sigmaS * sigmaS * sigmaS));
        if (ball) s.pdfs = pdfFlight(medium, flights.lengths[0]) * pdfFlight(medium, flights.lengths[1]);
        return s;
    }

    uint64_t draw(const Slice& slice, ImageBand& band, const BandRays& rays) const {
        uint64_t gathered = 0;
        const auto shows = [&](const BandPiece& piece) { return piece.mixed || shownIn(slice, piece); };
        if (std::none_of(band.pieces.begin(), band.pieces.end(), shows)) return 0;
        for (int y = std::max(slice.area.top, band.firstRow); y <= std::min(slice.area.bottom, band.lastRow); ++y)
            for (int x = slice.area.left; x <= slice.area.right; x += Lanes)
                gathered += slice.inLanes ? drawLanes(slice, band, rays, x, y)
                                          : drawRays(slice, x, y, std::min(x + Lanes - 1, slice.area.right));
        return gathered;
    }

  private:
    [[nodiscard]] std::optional<PixelArea> areaOf(const CollapsedFlights& flights, float length) const {
        const PixelArea all{0, record_.width - 1, 0, record_.height - 1};
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
    /// Of a piece that all rays share.
    [[nodiscard]] bool shownIn(const Slice& slice, const BandPiece& piece) const {
        const int sum = piece.interactions + slice.flights->bounce + slice.flights->flights();
        return piece.medium == slice.flights->medium && sum >= scene_.transport.minBounces &&
               sum < scene_.transport.maxBounces;
    }

    uint64_t drawLanes(const Slice& slice, ImageBand& band, const BandRays& origins, int x, int y) const {
        const size_t i = band.at(x, y);
        const auto load = [i](const std::vector<float>& v) { return Batch::load_unaligned(v.data() + i); };
        const Vec3f &o = record_.origin, &b = slice.flights->base;
        const Lanes3 toOrigin = origins.x.empty()
                                    ? Lanes3(o - b)
                                    : Lanes3(load(origins.x) - b.x, load(origins.y) - b.y, load(origins.z) - b.z);
        const LaneRays rays{toOrigin, {load(band.x), load(band.y), load(band.z)}, Batch(slice.residual)};
        if (!slice.ball) {
            const LaneSlice met = slice.volume.meet(rays, warped_);
            if (!xsimd::any(met.met)) return 0;
            const Batch weight = volumeWeight(slice, rays, met);
            return collect(slice, band, met.met, met.alongRay, weight, x, y);
        }
        const BallLanes met(rays, warped_);
        if (!xsimd::any(met.met)) return 0;
        uint64_t gathered = collect(slice, band, met.met, met.nearRay, ballWeight(slice, rays, met, met.nearRay), x, y);
        if (!warped_)
            gathered += collect(slice, band, met.met, met.farRay, ballWeight(slice, rays, met, met.farRay), x, y);
        return gathered;
    }

    /// Without the transmittance, whose exponent is added in collect: (7), (16).
    [[nodiscard]] Batch volumeWeight(const Slice& slice, const LaneRays& rays, const LaneSlice& met) const {
        const auto& w = slice.flights->directions;
        const Batch flights = met.t1 + met.t2 + met.t3;
        Batch weight = henyeyGreenstein(slice.g, Lanes3(w[2]), -rays.direction) / met.jacobian *
                       xsimd::exp(-slice.sigmaT * (flights + met.alongRay));
        if (slice.flights->shared) {
            const float phasePdf = scene_.media[size_t(slice.flights->medium)].phase.pdf(w[1], w[2]);
            const Batch pdfs = slice.sigmaT * slice.sigmaT * xsimd::exp(-slice.sigmaT * (met.t1 + met.t2));
            const Lanes3 last(w[2]);
            weight = weight *
                     volumeShareOf(phasePdf * met.jacobian, pdfs * met.t3 * met.t3 * perLength(last, rays.direction));
        }
        return weight;
    }
    /// Change of path length along the ray.
    [[nodiscard]] Batch perLength(const Lanes3& last, const Lanes3& ray) const {
        const Lanes3 sum = last + ray;
        return warped_ ? 0.5f * sum.dot(sum) : xsimd::abs(last.dot(ray));
    }
    /// a / (a + b)
    static Batch volumeShareOf(const Batch& a, const Batch& b) { return a / xsimd::max(a + b, Batch(1e-37f)); }

    /// (11), (16)
    [[nodiscard]] Batch ballWeight(const Slice& slice, const LaneRays& rays, const BallLanes& met,
                                   const Batch& alongRay) const {
        const auto& w = slice.flights->directions;
        const Lanes3 last = (rays.toOrigin + rays.direction * alongRay) * (1.0f / met.length);
        const Batch first = henyeyGreenstein(slice.g, Lanes3(w[1]), last);
        Batch weight = first * henyeyGreenstein(slice.g, last, -rays.direction) / met.jacobian *
                       xsimd::exp(-slice.sigmaT * (met.length + alongRay));
        if (slice.flights->shared) {
            const Lanes3 a(w[0]), b(w[1]);
            const Lanes3& c = rays.direction;
            const Batch volume =
                xsimd::abs(warped_ ? (a + c).dot((b + c).cross(last + c)) : (a - last).dot((b - last).cross(c)));
            const Batch ball = slice.pdfs * met.jacobian;
            weight = weight * (ball / xsimd::max(first * volume + ball, Batch(1e-37f)));
        }
        return weight;
    }

    /// Into the band's sums; what may be occluded, ray by ray into the film.
    uint64_t collect(const Slice& slice, ImageBand& band, const LaneMask& met, const Batch& alongRay,
                     const Batch& weight, int x, int y) const {
        const size_t i = band.at(x, y);
        uint64_t gathered = 0;
        for (BandPiece& piece : band.pieces) {
            const Batch start = Batch::load_unaligned(piece.start.data() + i);
            LaneMask inside = met && alongRay >= start && alongRay < Batch::load_unaligned(piece.end.data() + i);
            if (piece.mixed)
                inside =
                    piece.select(inside, i, slice.flights->medium,
                                 scene_.transport.minBounces - slice.flights->bounce - slice.flights->flights(),
                                 scene_.transport.maxBounces - 1 - slice.flights->bounce - slice.flights->flights());
            else if (!shownIn(slice, piece))
                continue;
            if (!xsimd::any(inside)) continue;
            if (occluders_) {
                gathered += drawSelected(slice, piece, inside, x, y);
                continue;
            }
            // The throughput holds the way to the piece.
            const Batch here = xsimd::select(inside, weight * xsimd::exp(slice.sigmaT * start), Batch(0.0f));
            for (int k = 0; k < 3; ++k) piece.add(i, here, k, slice.power[k]);
            gathered += uint64_t(darts::lanes::sum(xsimd::select(inside, Batch(1.0f), Batch(0.0f))));
        }
        return gathered;
    }

    /// What may be occluded: ray by ray, those that are selected.
    uint64_t drawSelected(const Slice& slice, const BandPiece& piece, const LaneMask& selected, int x, int y) const {
        alignas(64) float chosen[Lanes];
        xsimd::select(selected, Batch(1.0f), Batch(0.0f)).store_aligned(chosen);
        uint64_t gathered = 0;
        FrameSums sums(1);
        for (int lane = 0; lane < Lanes; ++lane) {
            if (!(chosen[lane] > 0.0f)) continue;
            const size_t pixel = size_t(y) * size_t(record_.width) + size_t(x + lane);
            const StraightPiece& recorded = record_.pieces[piece.number];
            sums[0] = Vec3d(0.0);
            if (!estimate_.add(*slice.flights, segmentOf(recorded, pixel), sums)) continue;
            ++gathered;
            addToFilm(sums, recorded.throughput[pixel], x + lane, y);
        }
        return gathered;
    }
    uint64_t drawRays(const Slice& slice, int x, int y, int last) const {
        uint64_t gathered = 0;
        FrameSums sums(size_t(sensor_.gate.frames));
        for (; x <= last; ++x) {
            const size_t pixel = size_t(y) * size_t(record_.width) + size_t(x);
            for (const StraightPiece& piece : record_.pieces) {
                if (!(piece.end[pixel] > piece.start[pixel]) || piece.medium[pixel] != slice.flights->medium) continue;
                std::fill(sums.begin(), sums.end(), Vec3d(0.0));
                if (!estimate_.add(*slice.flights, segmentOf(piece, pixel), sums)) continue;
                ++gathered;
                addToFilm(sums, piece.throughput[pixel], x, y);
            }
        }
        return gathered;
    }

    void addToFilm(const FrameSums& sums, const Rgb& throughput, int x, int y) const {
        for (size_t frame = 0; frame < sums.size(); ++frame) {
            const Vec3d value = sums[frame] * scale_;
            film_.passPixel(int(frame), x, y) += Rgb(float(value.x), float(value.y), float(value.z)) * throughput;
        }
    }

    [[nodiscard]] CameraSegment segmentOf(const StraightPiece& piece, size_t pixel) const {
        const Vec3f direction(record_.x[pixel], record_.y[pixel], record_.z[pixel]);
        const Vec3f origin = record_.origins.empty() ? record_.origin : record_.origins[pixel];
        const float start = piece.start[pixel];
        return {origin + direction * start, direction,    piece.end[pixel] - start,
                double(start) / speed_,     1.0 / speed_, piece.interactions[pixel],
                piece.medium[pixel]};
    }

  public:
    uint64_t gatherBeams(const BeamGather& beams, const ImageBand& band) const {
        uint64_t gathered = 0;
        FrameSums sums(size_t(sensor_.gate.frames));
        for (int y = band.firstRow; y <= band.lastRow; ++y)
            for (int x = 0; x < record_.width; ++x) {
                const size_t pixel = size_t(y) * size_t(record_.width) + size_t(x);
                for (const StraightPiece& piece : record_.pieces) {
                    if (!(piece.end[pixel] > piece.start[pixel])) continue;
                    std::fill(sums.begin(), sums.end(), Vec3d(0.0));
                    gathered += beams.gather(segmentOf(piece, pixel), sums);
                    addToFilm(sums, piece.throughput[pixel], x, y);
                }
            }
        return gathered;
    }
    [[nodiscard]] BandRays originsOf(const ImageBand& band) const {
        BandRays rays;
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
    const Scene& scene_;
    Sensor sensor_;
    const SensorRecord& record_;
    SliceEstimate estimate_;
    std::optional<ImageFootprint> footprint_;
    double scale_;
    Film& film_;
    bool warped_, delta_, occluders_;
    double speed_;
};

} // namespace

uint64_t splatSlices(const Scene& scene, const Sensor& sensor, const SensorRecord& record,
                     const std::vector<CollapsedFlights>& records, const Radii& radius, double scale, Film& film) {
    const Splatter splatter(scene, sensor, record, scale, film);
    const size_t bands = ImageBand::count(record.height);
    std::vector<std::optional<Slice>> slices(records.size());
    tbb::parallel_for(size_t(0), slices.size(), [&](size_t i) {
        if (records[i].shape != FlightShape::Beam) slices[i] = splatter.prepare(records[i]);
    });
    // Records by band, in their own order: the sums do not depend on the threads.
    std::vector<std::vector<uint32_t>> byBand(bands);
    for (size_t i = 0; i < slices.size(); ++i)
        if (slices[i])
            for (int band = slices[i]->area.top / ImageBand::Rows; band <= slices[i]->area.bottom / ImageBand::Rows;
                 ++band)
                byBand[size_t(band)].push_back(uint32_t(i));
    const auto beams = beamsAmong(scene, records);
    std::optional<BeamGather> beamGather;
    if (!beams.empty()) beamGather.emplace(scene, sensor, beams, radius);
    std::vector<uint64_t> gathered(bands, 0);
    tbb::parallel_for(size_t(0), bands, [&](size_t number) {
        const auto& drawn = byBand[number];
        ImageBand band(record, number);
        const BandRays rays = splatter.originsOf(band);
        for (const uint32_t i : drawn) gathered[number] += splatter.draw(*slices[i], band, rays);
        band.addToFilm(0, film);
        if (beamGather) gathered[number] += splatter.gatherBeams(*beamGather, band);
    });
    uint64_t total = 0;
    for (const uint64_t count : gathered) total += count;
    return total;
}

} // namespace tungsten::photon
