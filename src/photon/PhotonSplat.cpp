#include "photon/PhotonSplat.h"

#include "photon/ImageFootprint.h"
#include "photon/PointGather.h"

#include <tbb/parallel_for.h>
#include <xsimd/xsimd.hpp>

namespace tungsten::photon {

namespace {

using Batch = xsimd::batch<float>;
constexpr int Lanes = int(Batch::size);
constexpr int BandRows = 4; ///< rows of the image that one task draws

class Splatter {
  public:
    Splatter(const Scene& scene, const Sensor& sensor, const SensorRecord& record, const PhotonStore& store,
             const std::vector<float>& radii, double scale, Film& film)
        : scene_(scene), sensor_(sensor), record_(record), photons_(store.photons), radii_(radii), scale_(float(scale)),
          film_(film) {}

    uint64_t draw(const Photon& photon, float radius, const PixelArea& area, int firstRow, int lastRow) const {
        const TransportSettings& transport = scene_.transport;
        const Vec3f offset = photon.position - record_.origin;
        int frame = 0;
        float weight = scale_;
        if (!sensor_.gate.steadyState) {
            const Vec3d way(double(photon.position.x) - double(record_.origin.x),
                            double(photon.position.y) - double(record_.origin.y),
                            double(photon.position.z) - double(record_.origin.z));
            const double cameraTime = transport.cameraUnwarped ? 0.0 : way.length() / double(scene_.cameraRegion.speed);
            const double arrival = photon.time + cameraTime;
            frame = sensor_.gate.frameOf(arrival);
            if (frame < 0) return 0;
            weight *= sensor_.weight(arrival);
        }
        const Medium& medium = scene_.media[size_t(photon.medium)];
        const float g = medium.phase.g();
        const bool rayleigh = std::holds_alternative<Rayleigh>(medium.phase.model);
        const Rgb power = photon.power * (weight * 3.0f * InvPi / (radius * radius));
        const Spot spot{
            photon,           medium, offset, power, 1.0f / (radius * radius), frame, g, medium.isGrey() && !rayleigh,
            medium.sigmaT().x};
        uint64_t gathered = 0;
        for (const StraightPiece& piece : record_.pieces)
            for (int y = std::max(area.top, firstRow); y <= std::min(area.bottom, lastRow); ++y)
                gathered += drawRow(spot, piece, y, area.left, area.right);
        return gathered;
    }

  private:
    struct Spot {
        const Photon& photon;
        const Medium& medium;
        Vec3f offset;
        Rgb power; ///< with the kernel's constant
        float inverseSquaredRadius;
        int frame;
        float g;
        bool simple; ///< grey, isotropic or Henyey-Greenstein: a register at a time
        float sigmaT;
    };

    uint64_t drawRow(const Spot& spot, const StraightPiece& piece, int y, int left, int right) const {
        const size_t row = size_t(y) * size_t(record_.width);
        uint64_t gathered = 0;
        alignas(64) float along[Lanes], weight[Lanes];
        for (int x = left; x <= right; x += Lanes) {
            const size_t first = row + size_t(x);
            const int count = std::min(Lanes, right - x + 1);
            if (first + Lanes > record_.x.size()) return gathered + drawSingly(spot, piece, y, x, right);
            const auto load = [first](const std::vector<float>& v) { return Batch::load_unaligned(v.data() + first); };
            const Batch dx = load(record_.x), dy = load(record_.y), dz = load(record_.z), start = load(piece.start);
            const Vec3f& o = spot.offset;
            const Batch t = dx * o.x + dy * o.y + dz * o.z;
            // Distance by the part of the offset across the ray: no difference of squares.
            const Batch px = o.x - dx * t, py = o.y - dy * t, pz = o.z - dz * t;
            const Batch part = 1.0f - (px * px + py * py + pz * pz) * spot.inverseSquaredRadius;
            const auto inside = part > 0.0f && t > start && t <= load(piece.end);
            if (!xsimd::any(inside)) continue;
            Batch value = part * part;
            if (spot.simple) {
                value = value * xsimd::exp((start - t) * spot.sigmaT) * phase(spot, dx, dy, dz);
            }
            xsimd::select(inside, value, Batch(0.0f)).store_aligned(weight);
            t.store_aligned(along);
            for (int lane = 0; lane < count; ++lane)
                if (weight[lane] > 0.0f) gathered += add(spot, piece, y, x + lane, along[lane], weight[lane]);
        }
        return gathered;
    }
    /// Henyey-Greenstein between the photon's direction and the way back along the rays.
    static Batch phase(const Spot& spot, const Batch& dx, const Batch& dy, const Batch& dz) {
        const float g = spot.g;
        if (g == 0.0f) return Batch(0.25f * InvPi);
        const Vec3f& w = spot.photon.direction;
        const Batch cosine = -(dx * w.x + dy * w.y + dz * w.z);
        const Batch d =
            xsimd::max(1.0f + g * g - 2.0f * g * cosine, Batch((1.0f - std::abs(g)) * (1.0f - std::abs(g))));
        return (1.0f - g * g) * 0.25f * InvPi / (d * xsimd::sqrt(d));
    }
    uint64_t drawSingly(const Spot& spot, const StraightPiece& piece, int y, int left, int right) const {
        uint64_t gathered = 0;
        for (int x = left; x <= right; ++x) {
            const size_t pixel = size_t(y) * size_t(record_.width) + size_t(x);
            const Vec3f direction(record_.x[pixel], record_.y[pixel], record_.z[pixel]);
            const float t = spot.offset.dot(direction);
            const float part = 1.0f - (spot.offset - direction * t).length2() * spot.inverseSquaredRadius;
            if (!(part > 0.0f) || !(t > piece.start[pixel]) || t > piece.end[pixel]) continue;
            float value = part * part;
            if (spot.simple)
                value *= std::exp((piece.start[pixel] - t) * spot.sigmaT) *
                         spot.medium.phase.eval(spot.photon.direction, -direction);
            gathered += add(spot, piece, y, x, t, value);
        }
        return gathered;
    }
    uint64_t add(const Spot& spot, const StraightPiece& piece, int y, int x, float along, float value) const {
        const size_t pixel = size_t(y) * size_t(record_.width) + size_t(x);
        if (piece.medium[pixel] != spot.photon.medium) return 0;
        const int interactions = int(piece.interactions[pixel]) + int(spot.photon.bounce);
        if (interactions < scene_.transport.minBounces || interactions >= scene_.transport.maxBounces) return 0;
        Rgb radiance = spot.power * piece.throughput[pixel] * value;
        if (!spot.simple) {
            const Vec3f back(-record_.x[pixel], -record_.y[pixel], -record_.z[pixel]);
            radiance = radiance * spot.medium.transmittance(along - piece.start[pixel]) *
                       spot.medium.phase.eval(spot.photon.direction, back);
        }
        film_.passPixel(spot.frame, x, y) += radiance;
        return 1;
    }

    const Scene& scene_;
    Sensor sensor_;
    const SensorRecord& record_;
    const std::vector<Photon>& photons_;
    const std::vector<float>& radii_;
    float scale_;
    Film& film_;
};

} // namespace

uint64_t splatPhotons(const Scene& scene, const Sensor& sensor, const SensorRecord& record, const PhotonStore& store,
                      const std::vector<float>& radii, double scale, Film& film) {
    const Splatter splatter(scene, sensor, record, store, radii, scale, film);
    const size_t bands = size_t((record.height + BandRows - 1) / BandRows);
    const ImageFootprint footprint(scene.camera);
    std::vector<std::optional<PixelArea>> footprints(store.photons.size());
    tbb::parallel_for(size_t(0), footprints.size(), [&](size_t i) {
        footprints[i] = footprint.around(store.photons[i].position, radii[radii.size() == 1 ? 0 : i]);
    });
    // Photons by band, in their own order: the sums do not depend on the threads.
    std::vector<std::vector<uint32_t>> byBand(bands);
    for (size_t i = 0; i < footprints.size(); ++i)
        if (footprints[i])
            for (int band = footprints[i]->top / BandRows; band <= footprints[i]->bottom / BandRows; ++band)
                byBand[size_t(std::clamp(band, 0, int(bands) - 1))].push_back(uint32_t(i));
    std::vector<uint64_t> gathered(bands, 0);
    tbb::parallel_for(size_t(0), bands, [&](size_t band) {
        const int first = int(band) * BandRows, last = std::min(first + BandRows, record.height) - 1;
        for (const uint32_t i : byBand[band])
            gathered[band] +=
                splatter.draw(store.photons[i], radii[radii.size() == 1 ? 0 : i], *footprints[i], first, last);
    });
    uint64_t total = 0;
    for (const uint64_t count : gathered) total += count;
    return total;
}

} // namespace tungsten::photon
