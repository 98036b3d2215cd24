#include "photon/primitives/points/Points.h"

#include "photon/PhotonSettings.h"
#include "photon/primitives/NearSurfaces.h"
#include "photon/primitives/Primitive.h"
#include "photon/primitives/points/PointGather.h"
#include "photon/raster/ImageBand.h"
#include "photon/raster/ImageFootprint.h"
#include "photon/view/CameraRecord.h"

#include "transport/BounceLimits.h"
#include "transport/Walk.h"

#include "tungsten/core/Overloaded.h"
#include "tungsten/core/Warp.h"
#include "tungsten/film/Film.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <atomic>

namespace tungsten::photon {

float Points::reach(const KernelSettings& settings) {
    return settings.fixedVolumeRadius ? settings.volumeRadius : Infinity;
}

void Points::read(const ObjectReader& block, const Scene& scene, PhotonSettings& settings) {
    if (settings.fixedVolumeRadius) settings.requireRadius(block, scene);
}

double Points::kernelWidth(const KernelSettings& settings, bool, uint32_t step) {
    const auto factor = double(pointRadiusFactor(step, settings.volumeAlpha));
    return settings.fixedVolumeRadius ? factor : std::sqrt(factor);
}

Radii Points::radii(const KernelSettings& settings, bool, const std::vector<Photon>& photons, uint32_t step,
                    const ProgressToken& watch) {
    const float factor = pointRadiusFactor(step, settings.volumeAlpha);
    if (settings.fixedVolumeRadius) return settings.volumeRadius * factor;
    std::vector<float> radii = adaptiveRadii(photons, watch);
    // The schedule's cube root acts on the squared radius here (docs/scene-format.md, section 10.5).
    for (float& radius : radii) radius *= std::sqrt(factor);
    return radii;
}

NearSurfaces Points::nearSurfaces(const KernelSettings& settings, const Scene& scene) {
    return {scene, reach(settings), 1.0f};
}

Selection<Photon> Points::straight(const Scene&, const ArrivalCulling& culling, const std::vector<Photon>& photons,
                                   const Radii& radii) {
    Selection<Photon> seen;
    if (radii.single()) seen.radii = radii[0];
    for (size_t i = 0; i < photons.size(); ++i) {
        if (!culling.seenStraight(photons[i].position, photons[i].time)) continue;
        seen.records.push_back(photons[i]);
        seen.radii.append(radii, i);
    }
    return seen;
}

double Points::redirectedShare(const std::vector<Photon>& photons, const Radii& radii) {
    ExpectedHits meeting;
    for (size_t i = 0; i < photons.size(); ++i) {
        meeting.include(photons[i].position, radii[i]);
        meeting.addArea(double(Pi * radii[i] * radii[i]));
    }
    return meeting.share();
}

// ---- Kernels at surfaces

namespace {

/// What surfaces make of a photon's kernel.
struct Fold {
    KernelEdge edge; ///< none: nothing
    float radius = 0.0f;
    float weight = 1.0f; ///< one over the part of kernel and image that lies before all surfaces
};

/// A point of the kernel, in discs of any direction: the radius holds 1 - (1 - d^2/r^2)^3 of it within d.
Vec3f pointOfKernel(float radius, Sampler& random) {
    const float distance = radius * std::sqrt(1.0f - std::cbrt(1.0f - random.next1D()));
    return warp::squareToSphere(random.next2D()) * distance;
}

Fold foldOf(const NearSurfaces& surfaces, const Vec3f& position, float radius, Sampler random) {
    const NearSurfaces::Nearest nearest = surfaces.nearest(position, radius);
    Fold fold{nearest.edge, radius};
    const KernelEdge& edge = fold.edge;
    if (!edge.exists() || nearest.alone) return fold;
    const KernelEdge opposite = nearest.faced ? surfaces.opposite(position, edge, radius) : KernelEdge{};
    if (opposite.exists()) fold.radius = std::max(std::min(opposite.reach, radius), edge.reach);
    fold.weight = float(triesUntilSeen([&] {
        Vec3f offset = pointOfKernel(fold.radius, random);
        const float beyond = edge.normal.dot(offset) - edge.reach;
        if (beyond > 0.0f) offset -= edge.normal * (2.0f * beyond);
        return surfaces.sees(position, offset, fold.radius);
    }));
    return fold;
}

/// Behind the plane; the camera sees it when it sees the photon itself.
Photon imageOf(const Scene& scene, const Photon& photon, const KernelEdge& edge) {
    Photon image = photon;
    image.position = photon.position + edge.normal * (2.0f * edge.reach);
    if (scene.transport.cameraUnwarped || scene.camera.hasParallelRays()) return image;
    const Vec3d camera(scene.camera.position());
    const double farther = (Vec3d(image.position) - camera).length() - (Vec3d(photon.position) - camera).length();
    image.time -= farther / double(scene.media[size_t(photon.medium)].speedOfLight);
    return image;
}

} // namespace

void Points::endAtSurfaces(const KernelEnds& ends, std::vector<Photon>& photons, Radii& radii) {
    std::vector<Fold> folds(photons.size());
    ends.watch.stage("kernels at surfaces", photons.size());
    tbb::parallel_for(tbb::blocked_range<size_t>(0, photons.size(), 256), [&](const auto& range) {
        for (size_t i = range.begin(); i < range.end(); ++i) {
            ends.watch.advanceEvery(256, i);
            // What an image adds before the plane lies within the radius of the record itself.
            const Vec3f& position = photons[i].position;
            folds[i] = ends.view && !ends.view->around(position, radii[i])
                           ? Fold{{}, radii[i]}
                           : foldOf(ends.surfaces, position, radii[i], ends.random.branch(RandomStream::Record, i));
        }
    });
    if (std::none_of(folds.begin(), folds.end(), [](const Fold& fold) { return fold.edge.exists(); })) return;
    std::vector<float> own;
    std::vector<KernelEdges> edges;
    own.reserve(folds.size());
    edges.reserve(folds.size());
    for (size_t i = 0; i < folds.size(); ++i) {
        own.push_back(folds[i].radius);
        edges.push_back({folds[i].edge, {}});
        photons[i].power = photons[i].power * folds[i].weight;
    }
    for (size_t i = 0; i < folds.size(); ++i) {
        const KernelEdge& edge = folds[i].edge;
        if (!(edge.reach < folds[i].radius)) continue;
        photons.push_back(imageOf(ends.scene, photons[i], edge));
        own.push_back(folds[i].radius);
        edges.push_back({{edge.normal, -edge.reach}, {}});
    }
    radii = {std::move(own), std::move(edges)};
}

// ---- Splats

namespace {

/// What photons of a medium share.
struct MediumTerms {
    Rgb sigmaT;
    bool grey, isotropic;
    PhaseFunction phase;

    explicit MediumTerms(const Medium& medium)
        : sigmaT(medium.sigmaT()), grey(medium.isGrey()),
          isotropic(medium.phase.g() == 0.0f && medium.phase.isHenyeyGreenstein()), phase(medium.phase) {}
};

/// A photon as the camera sees it: all that drawing needs.
struct alignas(64) Disc {
    int frame; ///< -1: not to be seen
    int medium, bounce;
    Vec3f offset{0.0f}, direction{0.0f};
    Rgb power{0.0f}; ///< with the kernel's constant and the sensor's weight
    float inverseSquaredRadius;
    KernelEdge edge;
    ImageDisc image;
};

/// A register of rays near a disc.
struct DiscHit {
    Batch dx, dy, dz, start;
    Batch t;    ///< along the rays
    Batch part; ///< 1 - squared distance over squared radius
    Batch::batch_bool_type inside;

    DiscHit(const Disc& disc, const BandSegment& segment, const ImageBand& band, size_t i)
        : dx(Batch::load_unaligned(band.x.data() + i)), dy(Batch::load_unaligned(band.y.data() + i)),
          dz(Batch::load_unaligned(band.z.data() + i)), start(Batch::load_unaligned(segment.start.data() + i)) {
        const Vec3f& o = disc.offset;
        t = dx * o.x + dy * o.y + dz * o.z;
        // Distance by the part of the offset across the ray: no difference of squares.
        const Batch px = o.x - dx * t, py = o.y - dy * t, pz = o.z - dz * t;
        part = 1.0f - (px * px + py * py + pz * pz) * disc.inverseSquaredRadius;
        inside = part > 0.0f && t > start && t <= Batch::load_unaligned(segment.end.data() + i);
        if (!disc.edge.exists()) return;
        const Vec3f& n = disc.edge.normal;
        inside = inside && px * n.x + py * n.y + pz * n.z > -disc.edge.reach;
    }
};

class PointSplatter {
  public:
    PointSplatter(const Scene& scene, const transport::TimeSensor& sensor, double scale)
        : scene_(scene), sensor_(sensor), origin_(scene.camera.position()), scale_(float(scale)),
          footprint_(scene.camera), media_(scene.media.begin(), scene.media.end()) {}

    [[nodiscard]] Disc disc(const Photon& photon, float radius, const KernelEdge& edge) const {
        Disc unseen{};
        unseen.frame = -1;
        float weight = scale_;
        int frame = 0;
        if (!sensor_.gate.steadyState) {
            const double arrival = photon.time + cameraTime(photon.position);
            frame = sensor_.gate.frameOf(arrival);
            if (frame < 0) return unseen;
            weight *= sensor_.weight(arrival);
        }
        const auto image = footprint_.disc(photon.position, radius);
        if (!image) return unseen;
        const float inverse = 1.0f / (radius * radius);
        return {frame,
                photon.medium,
                photon.bounce,
                photon.position - origin_,
                photon.direction,
                photon.power * (weight * 3.0f * InvPi * inverse),
                inverse,
                edge,
                *image};
    }

    /// Returns how many rays gather the photon.
    uint64_t draw(const Disc& disc, ImageBand& band) const {
        const int top = std::max(disc.image.area.top, band.firstRow),
                  bottom = std::min(disc.image.area.bottom, band.lastRow);
        const auto [left, right] = footprint_.columns(disc.image, top);
        const auto [least, most] = transport::BounceLimits(scene_.transport).remaining(disc.bounce);
        Batch gathered(0.0f);
        for (BandSegment& segment : band.segments) {
            if (!segment.mixed &&
                (segment.medium != disc.medium || segment.interactions < least || segment.interactions > most))
                continue;
            const auto even = segment.mixed ? std::nullopt : evenTerms(disc, segment);
            for (int row = top; row <= bottom; ++row) {
                const size_t first = band.at(left[row - top], row), end = band.at(right[row - top], row) + 1;
                gathered += even ? drawEvenly(disc, *even, segment, band, first, end)
                                 : drawRow(disc, segment, band, first, end, least, most);
            }
        }
        return uint64_t(darts::lanes::sum(gathered));
    }

  private:
    [[nodiscard]] double cameraTime(const Vec3f& position) const {
        if (scene_.transport.cameraUnwarped) return 0.0;
        return transport::distanceBetween(origin_, position) / double(scene_.cameraRegion.speed);
    }

    /// For exponents (start - t) sigmaT that differ little from their middle.
    struct EvenTerms {
        float sigmaT, middle;
        Rgb power; ///< the disc's, times phase function and e^middle
    };
    /// If the medium is grey and isotropic and the rays that meet the disc have so even exponents that a cubic about
    /// their middle is exact to rounding. Discs of some 8 pixels take 7 % longer without, small ones as long.
    [[nodiscard]] std::optional<EvenTerms> evenTerms(const Disc& disc, const BandSegment& segment) const {
        constexpr float MostDifference = 0.03f;
        const MediumTerms& medium = media_[size_t(segment.medium)];
        if (!medium.grey || !medium.isotropic) return std::nullopt;
        const float squared = disc.offset.length2(), farthest = std::sqrt(squared),
                    nearest = std::sqrt(std::max(squared - 1.0f / disc.inverseSquaredRadius, 0.0f));
        const float low = (segment.leastStart - farthest) * medium.sigmaT.x,
                    high = (segment.mostStart - nearest) * medium.sigmaT.x;
        if (!(high - low < 2.0f * MostDifference)) return std::nullopt;
        const float middle = 0.5f * (low + high);
        return EvenTerms{medium.sigmaT.x, middle, disc.power * (0.25f * InvPi * std::exp(middle))};
    }

    /// Draws a disc at the rays [first, end); returns how many gather the photon, lane by lane.
    static Batch drawEvenly(const Disc& disc, const EvenTerms& terms, BandSegment& segment, const ImageBand& band,
                            size_t first, size_t end) {
        Batch gathered(0.0f);
        for (size_t i = first; i < end; i += size_t(Lanes)) {
            const DiscHit met(disc, segment, band, i);
            if (!xsimd::any(met.inside)) continue;
            gathered += select(met.inside, Batch(1.0f), Batch(0.0f));
            const Batch e = (met.start - met.t) * terms.sigmaT - terms.middle;
            const Batch transmittance = 1.0f + e * (1.0f + e * (0.5f + e * (1.0f / 6.0f)));
            const Batch weight = select(met.inside, met.part * met.part * transmittance, Batch(0.0f));
            for (int k = 0; k < 3; ++k) segment.add(i, weight, k, terms.power[k]);
        }
        return gathered;
    }

    /// Draws a row of the disc in any medium.
    Batch drawRow(const Disc& disc, BandSegment& segment, const ImageBand& band, size_t first, size_t end, int least,
                  int most) const {
        const MediumTerms& medium = media_[size_t(disc.medium)];
        Batch gathered(0.0f);
        for (size_t i = first; i < end; i += size_t(Lanes)) {
            const DiscHit met(disc, segment, band, i);
            const auto inside = segment.mixed ? segment.select(met.inside, i, disc.medium, least, most) : met.inside;
            if (!xsimd::any(inside)) continue;
            gathered += select(inside, Batch(1.0f), Batch(0.0f));
            const Batch value = met.part * met.part * phase(medium, disc.direction, met), length = met.start - met.t;
            Batch weight = select(inside, value * exp(length * medium.sigmaT.x), Batch(0.0f));
            for (int k = 0; k < 3; ++k) {
                if (k > 0 && !medium.grey) weight = select(inside, value * exp(length * medium.sigmaT[k]), Batch(0.0f));
                segment.add(i, weight, k, disc.power[k]);
            }
        }
        return gathered;
    }

    /// Between the photon's direction and the way back along the rays.
    static Batch phase(const MediumTerms& medium, const Vec3f& w, const DiscHit& met) {
        if (medium.isotropic) return Batch(0.25f * InvPi);
        return std::visit(
            Overloaded{[](const Isotropic&) { return Batch(0.25f * InvPi); },
                       [&](const HenyeyGreenstein& hg) { return henyeyGreenstein(hg.g, w, met.dx, met.dy, met.dz); },
                       [&](const Rayleigh&) {
                           const Batch cosine = met.dx * w.x + met.dy * w.y + met.dz * w.z;
                           return Batch(3.0f / 16.0f * InvPi * (1.0f + cosine * cosine));
                       }},
            medium.phase.model);
    }

    const Scene& scene_;
    transport::TimeSensor sensor_;
    Vec3f origin_;
    float scale_;
    ImageFootprint footprint_;
    std::vector<MediumTerms> media_;
};

/// Visible discs frame by frame, as bands hold one frame's sums; then from left to right, as neighbours share the
/// cache.
std::vector<uint32_t> drawingOrder(const std::vector<Disc>& discs, int width) {
    std::vector<std::pair<uint64_t, uint32_t>> places;
    places.reserve(discs.size());
    for (size_t i = 0; i < discs.size(); ++i)
        if (discs[i].frame >= 0)
            places.emplace_back(uint64_t(discs[i].frame) * uint64_t(width) + uint64_t(discs[i].image.area.left), i);
    tbb::parallel_sort(places);
    std::vector<uint32_t> order;
    order.reserve(places.size());
    for (const auto& place : places) order.push_back(place.second);
    return order;
}

/// In drawing order: the sums do not depend on the threads.
std::vector<std::vector<uint32_t>> discsByBand(const std::vector<Disc>& discs, const Vec2i& resolution) {
    std::vector<std::vector<uint32_t>> byBand(ImageBand::count(resolution.y));
    for (const uint32_t i : drawingOrder(discs, resolution.x)) {
        const PixelArea& area = discs[i].image.area;
        for (int band = area.top / ImageBand::Rows; band <= area.bottom / ImageBand::Rows; ++band)
            byBand[size_t(band)].push_back(i);
    }
    return byBand;
}

} // namespace

uint64_t Points::splat(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecords& records,
                       const Selection<Photon>& photons, double scale, Film& film, const ProgressToken& watch) {
    const PointSplatter splatter(scene, sensor, scale);
    std::vector<Disc> discs(photons.records.size());
    tbb::parallel_for(size_t(0), discs.size(), [&](size_t i) {
        watch.advanceWithin(1024, i);
        discs[i] = splatter.disc(photons.records[i], photons.radii[i], photons.radii.edges(i).nearest);
    });
    const auto byBand = discsByBand(discs, scene.camera.resolution);
    watch.stage("splat", byBand.size());
    std::atomic<uint64_t> total = 0;
    tbb::parallel_for(size_t(0), byBand.size(), [&](size_t number) {
        const auto& drawn = byBand[number];
        if (drawn.empty()) return;
        uint64_t gathered = 0;
        for (const CameraRecord* record : records) {
            ImageBand band(*record, number);
            for (size_t i = 0; i < drawn.size(); ++i) {
                watch.advanceWithin(64, i);
                prefetch(discs[drawn[std::min(i + DrawnAhead, drawn.size() - 1)]]);
                const int frame = discs[drawn[i]].frame;
                gathered += splatter.draw(discs[drawn[i]], band);
                band.countDrawn();
                if (i + 1 == drawn.size() || discs[drawn[i + 1]].frame != frame) band.addToFilm(frame, film);
            }
        }
        total += gathered;
        watch.advance();
    });
    return total;
}

} // namespace tungsten::photon
