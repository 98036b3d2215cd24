#pragma once
// What the camera paths of a pass look at, recorded before the photons come: the straight ray of every pixel, in
// pieces of one medium each, and the surface points where light is wanted.

#include "photon/view/SensorPath.h"

#include "tungsten/render/Integrator.h"

#include <vector>

namespace tungsten::photon {

/// A point on a surface that receivesConnections() and that a pixel sees, directly or in mirrors.
struct SensorPoint {
    SurfaceHit hit;
    Vec3f direction; ///< of the camera ray that found it
    Rgb throughput;  ///< of the camera path up to the point, over the pixel's paths
    double time;     ///< of flight from the camera to the point
    uint32_t pixel;
    int interactions; ///< before the point
    Region region;    ///< of the camera ray
};

/// Every pixel's straight ray inside one medium, as arrays over the pixels. Pixels without such a piece have end 0.
struct StraightPiece {
    std::vector<float> start, end; ///< along the ray
    std::vector<int16_t> medium;
    std::vector<uint16_t> interactions;
    std::vector<Rgb> throughput; ///< at `start`
};

struct SensorRecord {
    int width = 0, height = 0;
    uint32_t samples = 1;              ///< camera paths of a pixel that have left points
    Vec3f origin;                      ///< of every ray, if the camera has one position
    std::vector<Vec3f> origins;        ///< otherwise, by pixel
    std::vector<float> x, y, z;        ///< unit direction of every pixel's ray
    std::vector<StraightPiece> pieces; ///< first, second, ... piece of every ray
    std::vector<SensorPoint> points;   ///< in pixel order
};

/// Traces the camera rays of the pass's first sample; they are those of the sensor pass that follows. For a camera with
/// a single position; with `samples` above 1 further paths look for surface points alone: what a narrow gate
/// lights is finer than pixels.
SensorRecord recordSensorPaths(const Scene& scene, bool includeSurfaces, const SensorPathRules& rules,
                               const PassInfo& pass, uint32_t samples, Statistics& statistics);

} // namespace tungsten::photon
