#include "photon/primitives/sliced/SliceSplat.h"

#include "photon/primitives/beams/BeamSplat.h"
#include "photon/primitives/sliced/SliceEstimate.h"
#include "photon/primitives/sliced/SliceFootprints.h"
#include "photon/primitives/sliced/SliceGather.h"
#include "photon/raster/ImageBand.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

/// What a band's rays have besides the band.
struct BandRays {
    std::vector<float> x, y, z;  ///< origins; empty: all the record's
    std::vector<float> rotation; ///< of random numbers
    /// With occluders: what is drawn is looked at in doses, each of them tested once.
    std::vector<float> dose, filled;
    bool dosed = false;
};

/// Where flights of a register of rays end.
struct LaneFlights {
    std::array<Batch, 3> lengths;
    Batch alongRay;
};

constexpr size_t PilotStep = 8;
constexpr float DosesPerRay = 64.0f;

class Splatter {
  public:
    Splatter(const Scene& scene, const transport::Sensor& sensor, const SensorRecord& record, double scale, Film& film)
        : scene_(scene), sensor_(sensor), record_(record), estimate_(scene, sensor), scale_(scale), film_(film),
          warped_(!scene.transport.cameraUnwarped), occluders_(!scene.primitives.empty()) {}

    uint64_t draw(const ImageSlice& slice, ImageBand& band, BandRays& rays) const {
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
    /// Of a piece that all rays share.
    [[nodiscard]] bool shownIn(const ImageSlice& slice, const BandPiece& piece) const {
        const int sum = piece.interactions + slice.record.flights->bounce + slice.record.flights->flights();
        return piece.medium == slice.record.flights->medium && sum >= scene_.transport.minBounces &&
               sum < scene_.transport.maxBounces;
    }

    uint64_t drawLanes(const ImageSlice& slice, ImageBand& band, BandRays& origins, int x, int y) const {
        const size_t i = band.at(x, y);
        const auto load = [i](const std::vector<float>& v) { return Batch::load_unaligned(v.data() + i); };
        const Vec3f &o = record_.origin, &b = slice.record.flights->base;
        const Lanes3 toOrigin = origins.x.empty()
                                    ? Lanes3(o - b)
                                    : Lanes3(load(origins.x) - b.x, load(origins.y) - b.y, load(origins.z) - b.z);
        const LaneRays rays{toOrigin, {load(band.x), load(band.y), load(band.z)}, Batch(slice.residual)};
        if (!slice.ball) {
            LaneSlice met = slice.record.volume.meet(rays, warped_);
            if (occluders_) met.met = met.met && met.t1 < slice.record.flights->reach;
            if (!xsimd::any(met.met)) return 0;
            const Batch weight = volumeWeight(slice.record, rays, met, warped_);
            return collect(slice, band, origins, met.met, {{met.t1, met.t2, met.t3}, met.alongRay}, weight, x, y);
        }
        if (slice.width > 0.0f) {
            const Batch sum = load(origins.rotation) + float(slice.record.flights->randomNumber(0));
            const BallGateLanes met(rays, slice.width, sum - xsimd::floor(sum), warped_);
            if (!xsimd::any(met.met)) return 0;
            return collect(slice, band, origins, met.met, {{met.length, met.length, met.length}, met.alongRay},
                           ballGateWeight(slice.record, rays, met, slice.width), x, y);
        }
        const BallLanes met(rays, warped_);
        if (!xsimd::any(met.met)) return 0;
        uint64_t gathered = 0;
        const auto reach = [&](const Batch& alongRay) {
            gathered += collect(slice, band, origins, met.met, {{met.length, met.length, met.length}, alongRay},
                                ballWeight(slice.record, rays, met, alongRay, warped_), x, y);
        };
        reach(met.nearRay);
        if (!warped_) reach(met.farRay);
        return gathered;
    }

    /// Into the band's sums.
    uint64_t collect(const ImageSlice& slice, ImageBand& band, BandRays& rays, const LaneMask& met,
                     const LaneFlights& flights, const Batch& weight, int x, int y) const {
        const size_t i = band.at(x, y);
        const int before = slice.record.flights->bounce + slice.record.flights->flights();
        uint64_t gathered = 0;
        for (BandPiece& piece : band.pieces) {
            const Batch start = Batch::load_unaligned(piece.start.data() + i);
            LaneMask inside =
                met && flights.alongRay >= start && flights.alongRay < Batch::load_unaligned(piece.end.data() + i);
            if (piece.mixed)
                inside = piece.select(inside, i, slice.record.flights->medium, scene_.transport.minBounces - before,
                                      scene_.transport.maxBounces - 1 - before);
            else if (!shownIn(slice, piece))
                continue;
            if (!xsimd::any(inside)) continue;
            // The throughput holds the way to the piece.
            Batch here = xsimd::select(inside, weight * xsimd::exp(slice.record.sigmaT * start), Batch(0.0f));
            if (occluders_) here = tested(slice, band, rays, flights, here, x, y);
            for (int k = 0; k < 3; ++k) piece.add(i, here, k, slice.power[k]);
            gathered += uint64_t(darts::lanes::sum(xsimd::select(inside, Batch(1.0f), Batch(0.0f))));
        }
        return gathered;
    }

    /// Whole doses in place of weights: shadow rays cost a hundred times what weights do. Whenever what a ray has been
    /// given fills another dose, by the record at hand, that one is tested and stands for the dose; evenly from a
    /// random start, so that every record brings what it weighs on average.
    Batch tested(const ImageSlice& slice, const ImageBand& band, BandRays& rays, const LaneFlights& flights,
                 const Batch& weight, int x, int y) const {
        const size_t i = band.at(x, y);
        const float power = meanComponent(slice.power);
        const Batch dose = Batch::load_unaligned(rays.dose.data() + i);
        const Batch filled = Batch::load_unaligned(rays.filled.data() + i);
        if (!rays.dosed) { // the pilot that finds the doses
            (filled + weight * power).store_unaligned(rays.filled.data() + i);
            return Batch(0.0f);
        }
        const Batch sum = filled + weight * power / dose, whole = xsimd::floor(sum);
        (sum - whole).store_unaligned(rays.filled.data() + i);
        if (!xsimd::any(whole > 0.0f)) return Batch(0.0f);
        alignas(64) std::array<float, Lanes> doses, along;
        alignas(64) std::array<std::array<float, Lanes>, 3> lengths;
        (whole * dose / power).store_aligned(doses.data());
        flights.alongRay.store_aligned(along.data());
        for (size_t k = 0; k < 3; ++k) flights.lengths[k].store_aligned(lengths[k].data());
        for (size_t lane = 0; lane < size_t(Lanes); ++lane) {
            if (!(doses[lane] > 0.0f)) continue;
            const std::array<double, 3> t{double(lengths[0][lane]), double(lengths[1][lane]), double(lengths[2][lane])};
            const size_t at = i + lane;
            const Vec3f origin = rays.x.empty() ? record_.origin : Vec3f(rays.x[at], rays.y[at], rays.z[at]);
            const Vec3f end = origin + Vec3f(band.x[at], band.y[at], band.z[at]) * along[lane];
            const bool open = slice.ball ? estimate_.unoccluded(*slice.record.flights, end)
                                         : estimate_.unoccluded(*slice.record.flights, t.data(), 3);
            if (!open) doses[lane] = 0.0f;
        }
        return Batch::load_aligned(doses.data());
    }

    uint64_t drawRays(const ImageSlice& slice, int x, int y, int last) const {
        uint64_t gathered = 0;
        FrameSums sums(size_t(sensor_.gate.frames));
        for (; x <= last; ++x) {
            const size_t pixel = size_t(y) * size_t(record_.width) + size_t(x);
            for (const StraightPiece& piece : record_.pieces) {
                if (!(piece.end[pixel] > piece.start[pixel]) || piece.medium[pixel] != slice.record.flights->medium)
                    continue;
                std::fill(sums.begin(), sums.end(), Vec3d(0.0));
                if (!estimate_.add(*slice.record.flights, segmentOf(piece, pixel), sums)) continue;
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
        const double inverseSpeed = 1.0 / double(scene_.media[size_t(piece.medium[pixel])].speedOfLight);
        return {origin + direction * start,   direction,    piece.end[pixel] - start,
                double(start) * inverseSpeed, inverseSpeed, piece.interactions[pixel],
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
    /// By a pilot over a part of what is to be drawn: any dose above 0 will do, this one makes about DosesPerRay.
    void findDoses(const std::vector<std::optional<ImageSlice>>& slices, const std::vector<uint32_t>& drawn,
                   ImageBand& band, BandRays& rays) const {
        if (!occluders_ || drawn.empty()) return;
        rays.dose.assign(band.x.size(), 1.0f);
        rays.filled.assign(band.x.size(), 0.0f);
        for (size_t k = 0; k < drawn.size(); k += PilotStep)
            if (slices[drawn[k]]->inLanes) draw(*slices[drawn[k]], band, rays);
        const CollapsedFlights& first = *slices[drawn.front()]->record.flights;
        Sampler sampler(first.random[0], RandomStream::Folded, first.random[1], drawn.size());
        for (size_t i = 0; i < rays.dose.size(); ++i) {
            rays.dose[i] = std::max(rays.filled[i] * (float(PilotStep) / DosesPerRay), 1e-30f);
            rays.filled[i] = sampler.next1D();
        }
        rays.dosed = true;
    }
    [[nodiscard]] BandRays originsOf(const ImageBand& band) const {
        BandRays rays;
        rays.rotation.resize(band.x.size());
        for (size_t i = 0; i < rays.rotation.size(); ++i)
            rays.rotation[i] = float(rayRotation(Vec3f(band.x[i], band.y[i], band.z[i]), 0));
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
    transport::Sensor sensor_;
    const SensorRecord& record_;
    SliceEstimate estimate_;
    double scale_;
    Film& film_;
    bool warped_, occluders_;
};

/// Of the media that scatter and the camera's region: what splatBeams needs.
bool oneSpeed(const Scene& scene) {
    return std::all_of(scene.media.begin(), scene.media.end(), [&](const Medium& medium) {
        return !medium.scatters() || medium.speedOfLight == scene.cameraRegion.speed;
    });
}

} // namespace

uint64_t splatSlices(const Scene& scene, const transport::Sensor& sensor, const SensorRecord& record,
                     const std::vector<CollapsedFlights>& records, const Radii& radius, double scale, Film& film) {
    const Splatter splatter(scene, sensor, record, scale, film);
    const SliceFootprints footprints(scene, sensor.gate, scale);
    const size_t bands = ImageBand::count(record.height);
    std::vector<std::optional<ImageSlice>> slices(records.size());
    tbb::parallel_for(size_t(0), slices.size(), [&](size_t i) {
        if (records[i].shape != FlightShape::Beam) slices[i] = footprints.prepare(records[i]);
    });
    // Records by band, in their own order: the sums do not depend on the threads.
    std::vector<std::vector<uint32_t>> byBand(bands);
    for (size_t i = 0; i < slices.size(); ++i)
        if (slices[i])
            for (int band = slices[i]->area.top / ImageBand::Rows; band <= slices[i]->area.bottom / ImageBand::Rows;
                 ++band)
                byBand[size_t(band)].push_back(uint32_t(i));
    const auto beams = beamsAmong(scene, records);
    const bool drawBeams = record.origins.empty() && oneSpeed(scene);
    std::optional<BeamGather> beamGather;
    if (!beams.empty() && !drawBeams) beamGather.emplace(scene, sensor, beams, radius);
    std::vector<uint64_t> gathered(bands, 0);
    tbb::parallel_for(size_t(0), bands, [&](size_t number) {
        const auto& drawn = byBand[number];
        ImageBand band(record, number);
        BandRays rays = splatter.originsOf(band);
        splatter.findDoses(slices, drawn, band, rays);
        for (const uint32_t i : drawn) gathered[number] += splatter.draw(*slices[i], band, rays);
        band.addToFilm(0, film);
        if (beamGather) gathered[number] += splatter.gatherBeams(*beamGather, band);
    });
    uint64_t total = drawBeams ? splatBeams(scene, sensor, record, beams, radius[0], scale, film) : 0;
    for (const uint64_t count : gathered) total += count;
    return total;
}

} // namespace tungsten::photon
