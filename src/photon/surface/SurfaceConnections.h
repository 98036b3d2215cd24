#pragma once
// Light that reaches visible surfaces from the vertices of light paths: instead of waiting for photons to hit a surface
// just in time, vertices look for surface points that the camera sees at the right time.

#include "photon/Tuning.h"
#include "photon/surface/ReceivedLight.h"
#include "photon/surface/SensorClusters.h"
#include "photon/surface/SpreadLight.h"
#include "photon/view/SensorRecord.h"
#include "transport/Sensor.h"

#include "darts/ResidualRange.h"

#include <array>

namespace tungsten::photon {

/// A vertex of a light path that can be connected to.
struct LightVertex {
    Vec3f position;
    SurfaceMargin margin; ///< of the surface it is on, if any
    double time;
    int bounce; ///< interactions up to and including the vertex
    Region region;
    Rgb power;
    float meanScattering; ///< above 0: what scattering (below) is about, whatever the direction
};

/// How far light from close by is spread about sensor points (SpreadLight.h): `pixels` square roots of the area that
/// a pixel covers on the surface, `most` (a length) at most.
struct Spread {
    float pixels, most;

    /// Shrinks from pass to pass as `factor` (of gather radii) does.
    static Spread of(float gatherRadius, float factor) {
        return {tuning::SpreadPixels * factor, gatherRadius * factor};
    }
};

/// Each vertex looks for sensor points that its light reaches inside its gate and connects to so many that every
/// connection brings about the same: light that comes from close by lights few points, but those a lot.
///
/// Such connections have a weak singularity where vertex and point are closer than points are to each other: light from
/// close by is spread over the surface about the point (SpreadLight.h), a blur that shrinks with gather radii.
class SurfaceConnections {
  public:
    /// `sensor` has the pass's gate.
    SurfaceConnections(const Scene& scene, const transport::Sensor& sensor, const SensorRecord& record,
                       const PassInfo& pass, const Spread& spread);

    [[nodiscard]] size_t points() const { return points_.size(); }
    /// Appends what a vertex sends to sensor points. `scattering(direction)` is the vertex's BSDF or phase function
    /// times cosine, or an emitter's intensity. Adds the rays traced to `rays`.
    template <typename Scattering>
    void connect(const LightVertex& vertex, const darts::TimeGate& gate, const Scattering& scattering, Sampler& sampler,
                 std::vector<PointDraw>& draws, std::vector<ReceivedLight>& received, uint64_t& rays) const {
        find(vertex, gate, sampler, draws);
        for (const PointDraw& draw : draws) {
            if (vertex.margin.onSurface() && isBlack(scattering(draw.direction))) continue; // not on this side
            const SpreadLight spread = seenFrom(draw);
            const Rgb power = vertex.power * spread.light(scattering) * (draw.inverseExpectation * perKept_);
            if (!isBlack(power)) receive(vertex, gate, draw, {draw.point, 0, spread.from, power}, received, rays);
        }
    }
    /// About what connect() would bring in all.
    [[nodiscard]] float expectedLight(const LightVertex& vertex, const darts::TimeGate& gate) const;
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
    [[nodiscard]] Ranges openRanges(const LightVertex& vertex, const darts::TimeGate& gate) const;
    void find(const LightVertex& vertex, const darts::TimeGate& gate, Sampler& sampler,
              std::vector<PointDraw>& draws) const;
    [[nodiscard]] SpreadLight seenFrom(const PointDraw& draw) const {
        return spreadLight(-draw.direction * draw.distance, points_[draw.point].hit.ng, spread_[draw.point]);
    }
    /// If it does, in time and not occluded: `light` lacks frame, transmittance and the sensor's weight.
    void receive(const LightVertex& vertex, const darts::TimeGate& gate, const PointDraw& draw, ReceivedLight light,
                 std::vector<ReceivedLight>& received, uint64_t& rays) const;

    const Scene& scene_;
    transport::Sensor sensor_;
    const std::vector<SensorPoint>& points_;
    double speed_;
    float perKept_ = 0.0f;
    std::vector<float> spread_; ///< of points
    std::optional<float> lightPerConnection_;
    std::unique_ptr<SensorClusters> clusters_;
};

/// What each connection is to bring, so that vertices of which so much light is expected connect `wanted` times in all,
/// counting none more often than 64 times: a single one must not set it. 0 where nothing is expected.
float lightPerConnection(std::vector<float> expected, double wanted);

} // namespace tungsten::photon
