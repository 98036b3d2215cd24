#include "photon/light/RecordImportance.h"

#include "photon/Tuning.h"
#include "photon/primitives/sliced/RecordBudget.h"
#include "photon/view/CameraSubpath.h"

#include "tungsten/integrator/SceneElements.h"

namespace tungsten::photon {

namespace {

constexpr float OffSurface = 1e-4f; ///< of the distance to the camera: rays that start on a surface must not meet it

} // namespace

RecordImportance::RecordImportance(const Scene& scene, const PhotonSettings& settings,
                                   const transport::TimeSensor& sensor)
    : scene_(scene), sensor_(sensor), frame_(scene.camera.toWorld.rotation()),
      radius_(settings.volumeRadius < 1e20f ? settings.volumeRadius : 0.0f),
      surfaceRadius_(settings.gatherRadius < 1e20f ? settings.gatherRadius : 0.0f),
      reuse_(ReuseKernel::of(
          settings.gatherRadius,
          surfaceRadiusFactor(settings.progressive ? uint32_t(tuning::MiddlePass) : 0, settings.alpha))),
      placed_(!scene.camera.hasParallelRays()),
      direct_(!elementsWithBsdf(scene, [](const Bsdf& bsdf) {
                   return (bsdf.lobes() & lobe::Specular) != 0 || isGlossyOnly(bsdf);
               }).any()) {
    if (placed_) camera_ = scene.camera.position();
    const float plane = placed_ ? scene.camera.fieldOfView().value_or(FieldOfView()).planeDistance : 1.0f;
    const float width = 2.0f / (float(scene.camera.resolution.x) * plane);
    pixel_ = width * width;
}

Vec3f RecordImportance::toCamera(const Vec3f& position) const {
    const Vec3f way = camera_ - position;
    const float distance = way.length();
    return placed_ && distance > 0.0f ? way / distance : frame_.n * -1.0f;
}

bool RecordImportance::inView(const Vec3f& position, float margin) const {
    if (scene_.camera.detectors()) return true;
    const auto raster = scene_.camera.project(position);
    const Vec2i& size = scene_.camera.resolution;
    return raster && raster->x > -margin && raster->x < float(size.x) + margin && raster->y > -margin &&
           raster->y < float(size.y) + margin;
}

auto RecordImportance::segmentToCamera(Ray ray, float reach, Region region) const -> std::optional<Segment> {
    constexpr int MostSurfaces = 16;
    Segment segment;
    ray.tMax = reach;
    float left = reach;
    for (int surface = 0; surface < MostSurfaces; ++surface) {
        const auto hit = scene_.geometry->intersect(ray);
        const float length = hit ? hit->t : placed_ ? left : 0.0f;
        if (const Medium* medium = scene_.medium(region))
            segment.transmittance *= meanComponent(medium->transmittance(length));
        segment.time += double(length / region.speed);
        if (!hit) return segment;
        if ((scene_.bsdfOf(*hit).lobes() & lobe::AnyTransmission) == 0) return std::nullopt;
        region = regionBeyond(makeInteraction(scene_, *hit, ray.direction), ray.direction, region);
        ray = hit->rest(ray);
        left -= length;
    }
    return std::nullopt;
}

Contribution RecordImportance::at(const Vec3f& position, double time, const Region& region, float power,
                                  float area) const {
    const Vec3f direction = toCamera(position);
    const float least = std::max(std::sqrt(area), 1e-30f);
    const float distance = placed_ ? std::max((camera_ - position).length(), least) : 1.0f;
    const float solid = std::max(area / (distance * distance), pixel_);
    if (direct_ && !inView(position, std::sqrt(solid / pixel_))) return {};
    const auto segment = segmentToCamera({position, direction}, placed_ ? distance : Infinity, region);
    if (!segment) return {};
    power *= segment->transmittance;
    const double arrival = time + (scene_.transport.cameraUnwarped ? 0.0 : segment->time);
    const int frame = placed_ ? sensor_.frameOf(arrival) : std::max(sensor_.frameOf(arrival), 0);
    if (frame < 0) return {};
    power *= sensor_.weight(arrival);
    // Cells are about as wide as what the record covers, at least as pixels: a power of two of these.
    const float width = std::exp2(std::round(0.5f * std::log2(solid / pixel_)));
    const Vec3f local = frame_.toLocal(direction * -1.0f);
    const float across = 1.0f / (std::max(std::abs(local.z), 1e-3f) * std::sqrt(pixel_) * width);
    const auto column = int(std::floor(std::clamp(local.x * across, -1e4f, 1e4f))),
               row = int(std::floor(std::clamp(local.y * across, -1e4f, 1e4f)));
    const uint32_t cell =
        (uint32_t(frame) * 31u + uint32_t(width)) * 0x9E3779B1u + uint32_t(row) * 0x85EBCA6Bu + uint32_t(column);
    return {power / (distance * distance * std::sqrt(pixel_ * solid)), int(cell & 0x7FFFFFFFu)};
}

auto RecordImportance::of(const Photon& photon) const -> Contributions {
    const PhaseFunction& phase = scene_.media[size_t(photon.medium)].phase;
    const float power = meanComponent(photon.power) * phase.eval(photon.direction, toCamera(photon.position));
    return {at(photon.position, photon.time, regionOf(photon.medium), power, Pi * radius_ * radius_)};
}

auto RecordImportance::of(const PhotonBeam& beam) const -> Contributions {
    const Medium& medium = scene_.media[size_t(beam.medium)];
    Contributions parts;
    // What is farther than some mean free paths from the base shows little.
    constexpr float Farthest = 8.0f;
    const float end = std::min(beam.tEnd, beam.tStart + Farthest / std::max(meanComponent(medium.sigmaT()), 1e-20f));
    const float length = (end - beam.tStart) / float(Parts);
    for (size_t i = 0; i < Parts; ++i) {
        const float along = beam.tStart + (float(i) + 0.5f) * length;
        const Vec3f position = beam.base + beam.direction * along;
        const float power = meanComponent(beam.power * medium.sigmaS() * medium.transmittance(along)) * length *
                            medium.phase.eval(beam.direction, toCamera(position));
        parts[i] = at(position, beam.time + double(along / medium.speedOfLight), regionOf(beam.medium), power,
                      2.0f * radius_ * length);
    }
    return parts;
}

auto RecordImportance::of(const SliceRecord& flights) const -> Contributions {
    const double soonest = std::max(sensor_.gate.start, flights.time);
    // They show in much of the image: all of a path may meet.
    return {Contribution{float(std::exp(std::clamp(logSliceLight(scene_, flights, soonest), -60.0, 60.0))), 0}};
}

Contribution RecordImportance::onSurface(const Photon& photon) const {
    // Seen through whatever is there: the record does not know.
    return at(photon.position + toCamera(photon.position) * (OffSurface * (camera_ - photon.position).length()),
              photon.time, scene_.cameraRegion, meanComponent(photon.power) * InvPi, Pi * sqr(surfaceRadius_));
}

Contribution RecordImportance::ofConnection(const ConnectionRecord& light, const VisiblePoint& point) const {
    // Neighbours share what arrives (ReuseKernel): those of a disc in the image, which may be cut by one in the scene.
    const Vec3f way = point.hit.position - camera_;
    const float pixel = std::sqrt(pixel_) * (placed_ ? way.length() : 1.0f);
    const float radius = std::min(reuse_.pixels, reuse_.distance / std::max(pixel, 1e-30f));
    const float covered = std::max(Pi * sqr(radius), 1.0f);
    // Cells are squares of about that size.
    const auto side = uint32_t(std::lround(std::sqrt(covered)));
    const auto width = uint32_t(scene_.camera.resolution.x), column = point.pixel % width, row = point.pixel / width;
    const uint32_t cell = uint32_t(light.frame) * 0x9E3779B1u + row / side * 0x85EBCA6Bu + column / side;
    const Rgb radiance = point.vertex(scene_).scattering(light.from) * light.light * point.throughput;
    return {meanComponent(radiance) / std::sqrt(covered), int(cell & 0x7FFFFFFFu)};
}

} // namespace tungsten::photon
