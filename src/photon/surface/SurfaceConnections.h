#pragma once
// Light that reaches visible surfaces from the vertices of light paths: instead of waiting for photons to hit a surface
// just in time, vertices look for surface points that the camera sees at the right time.

#include "photon/Tuning.h"
#include "photon/surface/VisiblePointClusters.h"
#include "photon/view/CameraRecord.h"

#include "transport/TimeSensor.h"
#include "transport/Vertex.h"

#include "darts/TimeBudget.h"

#include "tungsten/core/Types.h"

#include <array>
#include <cstdint>

namespace tungsten::photon {

/// Light that a connection brought to a visible point.
struct ConnectionRecord {
    uint32_t point; ///< index in the CameraRecord
    int32_t frame;
    float offCentre; ///< of its arrival in the frame: -1 at the start, 1 at the end
    Vec3f from;      ///< unit direction it came from
    Rgb light;       ///< of one path: times BSDF and cosine, radiance times the frame's width
};

/// A flight from a vertex as a visible point sees it.
struct RegularisedConnection {
    Vec3f from;   ///< unit direction towards the vertex, where it is seen
    float weight; ///< instead of 1 / squared distance; at most 1 / spread^2

    /// What arrives, to be reflected as coming along `from`; `intensity(direction)` is the vertex's, away from it.
    template <typename Intensity>
    [[nodiscard]] auto light(const Intensity& intensity) const {
        return intensity(-from) * weight;
    }
};

/// `toVertex` leads from the point to the vertex, `normal` is the surface's, on any side; `spread` >= 0, a length,
/// keeps the light of vertices that are closer from falling on one point alone: they are seen lifted off the surface to
/// that height.
///
/// On a plane, a vertex leaves the same flux at any height, whatever it sends where. The others stay where they are, so
/// that the error is of second order in the spread, where vertices are near surfaces as often as elsewhere; and light
/// is never negative, nor more than the one place brings.
inline RegularisedConnection regularisedConnection(const Vec3f& toVertex, const Vec3f& normal, float spread) {
    const float height = toVertex.dot(normal), lift = std::max(spread - std::abs(height), 0.0f);
    const Vec3f seen = toVertex + normal * std::copysign(lift, height);
    const float squared = seen.length2();
    if (!(squared > 0.0f)) return {normal, 0.0f};
    return {seen / std::sqrt(squared), 1.0f / squared};
}

/// A vertex of a light path that is connected to visible points.
struct ConnectingVertex : transport::SubpathEnd {
    double time;
    int bounce;           ///< interactions up to and including the vertex
    float meanScattering; ///< above 0: over the directions into which it scatters, or of the intensity
};

/// How far light from close by is spread about visible points (RegularisedConnection): `pixels` square roots of the
/// area that a pixel covers on the surface, `most` (a length) at most.
struct ConnectionBlur {
    float pixels, most;

    /// Shrinks from pass to pass as `factor` (of gather radii) does.
    static ConnectionBlur of(float gatherRadius, float factor) {
        return {tuning::SpreadPixels * factor, gatherRadius * factor};
    }
};

/// Each vertex looks for visible points that its light reaches inside its gate and connects to so many that every
/// connection brings about the same: light that comes from close by lights few points, but those a lot.
///
/// Such connections have a weak singularity where vertex and point are closer than points are to each other: light from
/// close by is spread over the surface about the point (RegularisedConnection), a blur that shrinks with gather
/// radii.
class SurfaceConnections {
  public:
    /// `sensor` has the pass's gate.
    SurfaceConnections(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecord& record,
                       const PassInfo& pass, const ConnectionBlur& spread, bool forwardBoundaries);

    [[nodiscard]] size_t points() const { return points_.size(); }
    /// False where nothing that leaves a vertex at this time can.
    [[nodiscard]] bool mayArrive(double time, const darts::TimeGate& gate) const {
        return !points_.empty() && time < gate.end;
    }
    /// Appends what a vertex sends to visible points. Adds the rays traced to `rays`.
    void connect(const ConnectingVertex& from, const darts::TimeGate& gate, Sampler& sampler,
                 std::vector<VisiblePointSample>& draws, std::vector<ConnectionRecord>& received, uint64_t& rays) const;
    /// About what connect() would bring in all.
    [[nodiscard]] float expectedLight(const ConnectingVertex& from, const darts::TimeGate& gate) const;
    /// About what each connection is to bring; 0: nobody knows, vertices connect a few times each. Needed before
    /// connect().
    void setLightPerConnection(float light) { lightPerConnection_ = light; }
    [[nodiscard]] bool knowsLightPerConnection() const { return lightPerConnection_.has_value(); }

  private:
    static constexpr size_t MostRanges = 8;

    struct Ranges {
        std::array<LengthRange, MostRanges> list;
        size_t count = 0;
    };
    /// When flights from the vertex end in time, as lengths; a little wide.
    [[nodiscard]] Ranges openRanges(const ConnectingVertex& from, const darts::TimeGate& gate) const;
    void find(const ConnectingVertex& from, const darts::TimeGate& gate, Sampler& sampler,
              std::vector<VisiblePointSample>& draws) const;
    [[nodiscard]] RegularisedConnection spreadAt(const VisiblePointSample& draw) const {
        return regularisedConnection(-draw.direction * draw.distance, points_[draw.point].hit.ng, spread_[draw.point]);
    }
    /// If it does, in time and not occluded: `light` lacks frame, transmittance and the sensor's weight.
    void receive(const ConnectingVertex& from, const darts::TimeGate& gate, const VisiblePointSample& draw,
                 ConnectionRecord light, std::vector<ConnectionRecord>& received, uint64_t& rays) const;

    const Scene& scene_;
    transport::TimeSensor sensor_;
    transport::Connector connector_;
    const std::vector<VisiblePoint>& points_;
    double speed_;
    float perKept_ = 0.0f;
    std::vector<float> spread_; ///< of points
    std::optional<float> lightPerConnection_;
    std::unique_ptr<VisiblePointClusters> clusters_;
};

/// What each connection is to bring, so that vertices of which so much light is expected connect `wanted` times in all,
/// counting none more often than 64 times: a single one must not set it. 0 where nothing is expected.
float lightPerConnection(std::vector<float> expected, double wanted);

} // namespace tungsten::photon
