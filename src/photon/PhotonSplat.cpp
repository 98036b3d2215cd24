#include "photon/PhotonSplat.h"

#include "photon/ImageBand.h"
#include "photon/ImageFootprint.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

namespace tungsten::photon {

namespace {

/// What photons of a medium share.
struct MediumTerms {
    Rgb sigmaT;
    bool grey, rayleigh;
    float g;

    explicit MediumTerms(const Medium& medium)
        : sigmaT(medium.sigmaT()), grey(medium.isGrey()),
          rayleigh(std::holds_alternative<Rayleigh>(medium.phase.model)), g(medium.phase.g()) {}
};

/// A photon as the camera sees it.
struct Spot {
    uint32_t photon;
    int frame; ///< -1: not to be seen
    Vec3f offset;
    Rgb power; ///< with the kernel's constant and the sensor's weight
    float inverseSquaredRadius;
    ImageDisc disc;
};

class Splatter {
  public:
    Splatter(const Scene& scene, const Sensor& sensor, const SensorRecord& record, const PhotonStore& store,
             double scale)
        : scene_(scene), sensor_(sensor), record_(record), photons_(store.photons), scale_(float(scale)),
          footprint_(scene.camera), media_(scene.media.begin(), scene.media.end()) {}

    [[nodiscard]] Spot spot(uint32_t index, float radius) const {
        Spot spot{};
        spot.frame = -1;
        const Photon& photon = photons_[index];
        float weight = scale_;
        int frame = 0;
        if (!sensor_.gate.steadyState) {
            const double arrival = photon.time + cameraTime(photon.position);
            frame = sensor_.gate.frameOf(arrival);
            if (frame < 0) return spot;
            weight *= sensor_.weight(arrival);
        }
        const auto disc = footprint_.disc(photon.position, radius);
        if (!disc) return spot;
        const float inverse = 1.0f / (radius * radius);
        return {index,   frame, photon.position - record_.origin, photon.power * (weight * 3.0f * InvPi * inverse),
                inverse, *disc};
    }

    /// Returns how many rays gather the photon.
    uint64_t draw(const Spot& spot, ImageBand& band) const {
        const Photon& photon = photons_[spot.photon];
        const int top = std::max(spot.disc.area.top, band.firstRow),
                  bottom = std::min(spot.disc.area.bottom, band.lastRow);
        int left[ImageBand::Rows], right[ImageBand::Rows];
        footprint_.columns(spot.disc, top, bottom - top + 1, left, right);
        const int least = scene_.transport.minBounces - photon.bounce,
                  most = scene_.transport.maxBounces - photon.bounce - 1;
        Batch gathered(0.0f);
        for (BandPiece& piece : band.pieces) {
            if (!piece.mixed &&
                (piece.medium != photon.medium || piece.interactions < least || piece.interactions > most))
                continue;
            for (int row = top; row <= bottom; ++row)
                gathered += drawRow(spot, piece, band, row, left[row - top], right[row - top], least, most);
        }
        return uint64_t(xsimd::hadd(gathered));
    }

  private:
    [[nodiscard]] double cameraTime(const Vec3f& position) const {
        if (scene_.transport.cameraUnwarped) return 0.0;
        const Vec3f& o = record_.origin;
        const Vec3d way(double(position.x) - double(o.x), double(position.y) - double(o.y),
                        double(position.z) - double(o.z));
        return way.length() / double(scene_.cameraRegion.speed);
    }

    /// Returns how many rays gather the photon, lane by lane.
    Batch drawRow(const Spot& spot, BandPiece& piece, const ImageBand& band, int row, int left, int right, int least,
                  int most) const {
        const Photon& photon = photons_[spot.photon];
        const MediumTerms& medium = media_[size_t(photon.medium)];
        const Vec3f& o = spot.offset;
        Batch gathered(0.0f);
        for (size_t i = band.at(left, row), end = band.at(right, row) + 1; i < end; i += size_t(Lanes)) {
            const auto load = [i](const std::vector<float>& v) { return Batch::load_unaligned(v.data() + i); };
            const Batch dx = load(band.x), dy = load(band.y), dz = load(band.z), start = load(piece.start);
            const Batch t = dx * o.x + dy * o.y + dz * o.z;
            // Distance by the part of the offset across the ray: no difference of squares.
            const Batch px = o.x - dx * t, py = o.y - dy * t, pz = o.z - dz * t;
            const Batch part = 1.0f - (px * px + py * py + pz * pz) * spot.inverseSquaredRadius;
            auto inside = part > 0.0f && t > start && t <= load(piece.end);
            if (piece.mixed) inside = piece.select(inside, i, photon.medium, least, most);
            if (!xsimd::any(inside)) continue;
            gathered += select(inside, Batch(1.0f), Batch(0.0f));
            const Batch value = part * part * phase(medium, photon.direction, dx, dy, dz), length = start - t;
            Batch weight = select(inside, value * exp(length * medium.sigmaT.x), Batch(0.0f));
            piece.add(i, weight, 0, spot.power.x);
            if (!medium.grey) weight = select(inside, value * exp(length * medium.sigmaT.y), Batch(0.0f));
            piece.add(i, weight, 1, spot.power.y);
            if (!medium.grey) weight = select(inside, value * exp(length * medium.sigmaT.z), Batch(0.0f));
            piece.add(i, weight, 2, spot.power.z);
        }
        return gathered;
    }

    /// Between the photon's direction and the way back along the rays.
    static Batch phase(const MediumTerms& medium, const Vec3f& w, const Batch& dx, const Batch& dy, const Batch& dz) {
        const float g = medium.g;
        if (g == 0.0f && !medium.rayleigh) return Batch(0.25f * InvPi);
        const Batch cosine = -(dx * w.x + dy * w.y + dz * w.z);
        if (medium.rayleigh) return 3.0f / 16.0f * InvPi * (1.0f + cosine * cosine);
        const Batch d =
            xsimd::max(1.0f + g * g - 2.0f * g * cosine, Batch((1.0f - std::abs(g)) * (1.0f - std::abs(g))));
        return (1.0f - g * g) * 0.25f * InvPi / (d * xsimd::sqrt(d));
    }

    const Scene& scene_;
    Sensor sensor_;
    const SensorRecord& record_;
    const std::vector<Photon>& photons_;
    float scale_;
    ImageFootprint footprint_;
    std::vector<MediumTerms> media_;
};

/// Spots by band, frame by frame, in their own order: the sums do not depend on the threads.
std::vector<std::vector<const Spot*>> spotsByBand(const std::vector<Spot>& spots, size_t bands) {
    std::vector<std::vector<const Spot*>> byBand(bands);
    for (const Spot& spot : spots) {
        if (spot.frame < 0) continue;
        const PixelArea& area = spot.disc.area;
        for (int band = area.top / ImageBand::Rows; band <= area.bottom / ImageBand::Rows; ++band)
            byBand[size_t(band)].push_back(&spot);
    }
    return byBand;
}

} // namespace

uint64_t splatPhotons(const Scene& scene, const Sensor& sensor, const SensorRecord& record, const PhotonStore& store,
                      const std::vector<float>& radii, double scale, Film& film) {
    const Splatter splatter(scene, sensor, record, store, scale);
    std::vector<Spot> spots(store.photons.size());
    tbb::parallel_for(size_t(0), spots.size(),
                      [&](size_t i) { spots[i] = splatter.spot(uint32_t(i), radii[radii.size() == 1 ? 0 : i]); });
    auto byBand = spotsByBand(spots, ImageBand::count(record.height));
    std::atomic<uint64_t> total = 0;
    tbb::parallel_for(size_t(0), byBand.size(), [&](size_t number) {
        auto& drawn = byBand[number];
        if (drawn.empty()) return;
        // One frame's sums at a time.
        std::stable_sort(drawn.begin(), drawn.end(), [](const Spot* a, const Spot* b) { return a->frame < b->frame; });
        ImageBand band(record, number);
        uint64_t gathered = 0;
        for (size_t i = 0; i < drawn.size(); ++i) {
            gathered += splatter.draw(*drawn[i], band);
            if (i + 1 == drawn.size() || drawn[i + 1]->frame != drawn[i]->frame) band.addToFilm(drawn[i]->frame, film);
        }
        total += gathered;
    });
    return total;
}

} // namespace tungsten::photon
