#pragma once
// What the camera subpaths of a pass meet, recorded before the photons come: the straight ray of every pixel, in
// segments of one medium each, and the surface points where light is wanted.

#include "photon/view/CameraSubpath.h"
#include "transport/Vertex.h"

#include "tungsten/integrator/Integrator.h"

#include <vector>

namespace tungsten::photon {

/// A point on a surface that receivesConnections() and that a pixel sees, directly or in mirrors. Not a vertex, but
/// what makes it again where light has come: a pass keeps up to millions of them, of 136 bytes instead of 224.
struct VisiblePoint {
    SurfaceHit hit;
    Vec3f direction; ///< of the camera ray that found it
    Rgb throughput;  ///< of the camera path up to the point, over the pixel's paths
    double time;     ///< of flight from the camera to the point
    uint32_t pixel;
    int interactions; ///< before the point
    Region region;    ///< of the camera ray

    [[nodiscard]] transport::Vertex vertex(const Scene& scene) const {
        return {scene, makeInteraction(scene, hit, direction), direction, TransportMode::Radiance, region};
    }
};

/// Every pixel's straight ray inside one medium, as arrays over the pixels. Pixels without such a segment have end 0.
struct MediumSegment {
    std::vector<float> start, end; ///< along the ray
    std::vector<int16_t> medium;
    std::vector<uint16_t> interactions;
    std::vector<Rgb> throughput; ///< at `start`
};

/// A segment of a camera subpath, and the surface at its end.
struct CameraSegmentRecord {
    CameraSubpath state;
    std::optional<SurfaceHit> hit;
};

/// Those of the paths of a row of pixels, in their order.
struct SegmentRow {
    std::vector<CameraSegmentRecord> segments;
    std::vector<uint32_t> ends; ///< by pixel
};

/// What to record besides medium segments.
struct CameraRecordParts {
    bool points = false; ///< surface points
    uint32_t samples =
        1; ///< camera paths of a pixel that look for them: what a narrow gate lights is finer than pixels
    bool segments = false; ///< the first path's, to be visited again once photons are there
};

struct CameraRecord {
    int width = 0, height = 0;
    uint32_t sample = 0;                       ///< of the pixels
    uint32_t samples = 1;                      ///< camera paths of a pixel that have left points
    Vec3f origin;                              ///< of every ray, if the camera has one position
    std::vector<Vec3f> origins;                ///< otherwise, by pixel
    std::vector<float> x, y, z;                ///< unit direction of every pixel's ray
    std::vector<MediumSegment> mediumSegments; ///< first, second, ... piece of every ray
    std::vector<VisiblePoint> points;          ///< in pixel order
    std::vector<SegmentRow> segments;          ///< by row of pixels

    /// Shows the segments of a pixel's path (visitSegment).
    template <typename Shown>
    void replay(const Scene& scene, size_t pixel, Shown&& shown) const {
        const SegmentRow& row = segments[pixel / size_t(width)];
        const size_t column = pixel % size_t(width);
        if (row.ends.empty()) return;
        for (size_t i = column > 0 ? row.ends[column - 1] : 0; i < row.ends[column]; ++i) {
            CameraSubpath state = row.segments[i].state;
            visitSegment(scene, state, row.segments[i].hit, shown);
        }
    }
};

using CameraRecords = std::vector<const CameraRecord*>;

/// Traces one camera path per pixel: the sample with this index.
CameraRecord recordCameraSubpaths(const Scene& scene, const CameraSubpathRules& rules, uint64_t seed, uint32_t sample,
                                  const CameraRecordParts& parts, Statistics& statistics,
                                  const ProgressToken& watch = {});

} // namespace tungsten::photon
