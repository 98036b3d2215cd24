#pragma once
// Light that reaches visible surfaces from the vertices of light paths: instead of waiting for photons to hit a surface
// just in time, vertices look for surface points that the camera sees at the right time.

#include "photon/Deposits.h"
#include "photon/Sensor.h"
#include "photon/SensorRecord.h"

#include "darts/ResidualRange.h"

#include <array>

namespace tungsten::photon {

/// Surfaces that connections end on. Through a glossy lobe alone they find its peak too rarely: photons are left to it.
inline bool receivesConnections(const Bsdf& bsdf) {
    return (bsdf.lobes() & lobe::DiffuseReflection) != 0;
}

/// A vertex of a light path that can be connected to.
struct LightVertex {
    Vec3f position;
    bool onSurface;
    double time;
    int bounce; ///< interactions up to and including the vertex
    Region region;
    Rgb power;
};

/// The sensor points of a pass in random order. A vertex tests a run of them for arrival inside its gate and connects
/// to at most MostCandidates of those that pass, which stand for all that do.
///
/// Such connections have a weak singularity where vertex and point are close, which photons hitting surfaces have not:
/// the two share paths by d^2 / (d^2 + a^2) and a^2 / (d^2 + a^2), d the length of the last flight. Sharing spreads
/// what arrives close by, so photons get less than where both find a point equally often: a^2 = NearFieldShare (area
/// per sensor point) (points) / (4 pi points tested).
class SurfaceConnections {
  public:
    /// `sensor` has the pass's gate.
    SurfaceConnections(const Scene& scene, const Sensor& sensor, const SensorRecord& record, const PassInfo& pass);

    [[nodiscard]] size_t points() const { return points_.size(); }
    /// a^2; 0 when there is no sensor point.
    [[nodiscard]] float nearField() const { return nearField_; }
    /// Appends what a vertex sends to sensor points. `scattering(direction)` is the vertex's BSDF or phase function
    /// times cosine, or an emitter's intensity. Adds the rays traced to `rays`.
    template <typename Scattering>
    void connect(const LightVertex& vertex, const darts::TimeGate& gate, const Scattering& scattering, Sampler& sampler,
                 std::vector<SurfaceArrival>& arrivals, uint64_t& rays) const {
        Candidates candidates;
        find(vertex, gate, sampler, candidates);
        const float share = candidates.found * perTested_;
        for (int i = 0; i < candidates.count; ++i) {
            const Candidate& c = candidates.list[size_t(i)];
            const Rgb scale = vertex.power * scattering(c.direction) * share;
            if (!isBlack(scale)) arrive(vertex, gate, c, scale, arrivals, rays);
        }
    }

  private:
    static constexpr size_t Tested = 512;
    static constexpr double NearFieldShare = 0.03; ///< flat between 0.01 and 0.1 (cbox, no bound on sharing)
    static constexpr size_t MostCandidates = 8;

    struct Candidate {
        uint32_t point; ///< in the shuffled order
        float distance;
        Vec3f direction; ///< from the vertex
    };
    struct Candidates {
        std::array<Candidate, MostCandidates> list;
        int count = 0;
        float found = 1.0f; ///< candidates in time over candidates listed
    };
    void find(const LightVertex& vertex, const darts::TimeGate& gate, Sampler& sampler, Candidates& candidates) const;
    void arrive(const LightVertex& vertex, const darts::TimeGate& gate, const Candidate& candidate, const Rgb& scale,
                std::vector<SurfaceArrival>& arrivals, uint64_t& rays) const;

    const Scene& scene_;
    Sensor sensor_;
    const std::vector<SensorPoint>& points_;
    double speed_;
    float nearField_ = 0.0f, perTested_ = 0.0f;
    std::vector<uint32_t> order_;                 ///< the shuffled order, its beginning repeated at the end
    std::vector<float> x_, y_, z_, cameraLength_; ///< in that order
};

} // namespace tungsten::photon
