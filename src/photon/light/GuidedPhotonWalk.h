#pragma once
// One light path aimed at the camera inside the time gate: elliptical control vertices in place of volume photons,
// resampled distances, guided directions (method of He et al. 2024 and its successor presets; see src/darts).

#include "photon/light/PhotonGuidance.h"
#include "photon/light/PhotonWalk.h"
#include "photon/surface/SurfaceConnections.h"

namespace tungsten::photon {

class GuidedPhotonWalk : private PhotonWalk {
  public:
    /// `path` is the path's index in the run: frames are chosen in turn.
    /// `connections` may be null.
    GuidedPhotonWalk(const WalkContext& context, const PhotonGuidance& guidance, const SurfaceConnections* connections,
                     Sampler sampler, uint64_t path, Deposits& deposits, WalkCounters& counters);
    void run();

  private:
    void goOn();
    void aimAtFrame(uint64_t path);
    bool emit();
    /// From a point of an emitter that shines in more than one direction; `guide` null: by the emitter's distribution.
    bool emitFromPoint(const Emitter& emitter, const darts::Guide* guide);
    template <typename Scattering>
    void connectToSurfaces(const SurfaceMargin& margin, float usual, const Scattering& scattering);
    bool meetSurface(const SurfaceHit& hit);
    /// A flight through a scattering medium: its control vertex, then the next vertex. False ends the path.
    bool crossMedium(const Medium& medium, const darts::Guide& guide);
    bool scatter(const Medium& medium, const darts::Guide& guide, float distance);
    /// From a vertex in the medium, reached in the direction `before`.
    bool leave(const Medium& medium, const darts::Guide& guide, const Vec3f& before);
    /// See darts::Splits; the copies share the power.
    void split(const darts::Guide& guide, const Medium& medium, const Vec3f& before);
    /// A flight, for a primitive and what comes at its end.
    struct Flight {
        const Medium& medium;
        const darts::Guide& guide;
        float h, surface;
    };
    /// Points: the control vertex.
    void leaveOn(const Flight& flight, DepositList<Photon>& points);
    /// Beams: in direct view only what the camera's image shows; the store's room is for what can count.
    void leaveOn(const Flight& flight, DepositList<PhotonBeam>& beams);
    /// Slices have plain paths.
    void leaveOn(const Flight&, DepositList<CollapsedFlights>&) {}
    /// Points: ordinary photons share with control vertices where sensor paths can fold.
    void leaveAt(float distance, const Flight& flight, DepositList<Photon>& points);
    void leaveAt(float distance, const Flight& flight, DepositList<PhotonBeam>& beams);
    void leaveAt(float, const Flight&, DepositList<CollapsedFlights>&) {}
    /// Ordinary photons share with the control vertices of this flight, by the balance heuristic: where these alone are
    /// not complete, and in bodies that light must leave, whose directions do not follow the connections so closely.
    [[nodiscard]] bool storesPhotons() const {
        return !guidance_.directView() || (residual_.way != darts::Way::Through && !guidance_.meetsDeltaGate());
    }
    void store(DepositList<Photon>& points, const ArrivalCulling& arrival, const Vec3f& position, double time,
               const Rgb& power, int bounce);
    [[nodiscard]] bool storesVertices() const {
        return context_.storeVolume && std::holds_alternative<DepositList<Photon>>(deposits_.volume);
    }
    bool survives(const darts::Guide& guide);
    /// Residual at the ray's origin, and the length of the next connection.
    bool look(const darts::Guide& guide, const transport::Start& start);
    /// From a vertex with this residual.
    darts::ConnectionSample drawConnection(const darts::Guide& guide, const darts::Residual& residual);
    /// Draws the direction of the flight ahead; the ray's origin and residual_ are set.
    template <typename Scatterer>
    float redirect(const darts::Guide& guide, const Scatterer& scatterer);

    const PhotonGuidance& guidance_;
    const SurfaceConnections* connections_;
    std::vector<PointDraw> draws_; ///< of the vertex at hand
    darts::TimeGate gate_;
    darts::Residual residual_;
    darts::Residual reachable_; ///< residual_ with the range that connection_ was drawn from
    darts::ConnectionSample connection_;
    bool connected_ = false; ///< connection_ was drawn before the flight's direction
    darts::Splits splits_;
    bool looked_ = false; ///< residual_ belongs to the ray's origin
    float firstUsefulness_ = 0.0f;
    bool started_ = false; ///< firstUsefulness_ is known
    int rouletteMedium_ = -1;
    darts::Way rouletteWay_ = darts::Way::Through;
};

} // namespace tungsten::photon
