#pragma once
// One light path aimed at the camera inside the time gate: elliptical control vertices in place of volume photons,
// resampled distances, guided directions (method of He et al. 2024 and its successor presets; see src/darts).

#include "photon/light/LightPath.h"
#include "photon/light/PhotonGuidance.h"
#include "photon/surface/SurfaceConnections.h"

#include "transport/GuidedSteps.h"

namespace tungsten::photon {

class GuidedPhotonWalk {
  public:
    /// `path` is the path's index in the run: frames are chosen in turn.
    /// `connections` may be null.
    GuidedPhotonWalk(const WalkContext& context, const PhotonGuidance& guidance, const SurfaceConnections* connections,
                     const Sampler& sampler, uint64_t path, Deposits& deposits, WalkCounters& counters);
    void run();

  private:
    /// A flight, for a primitive and what comes at its end.
    struct Flight {
        const Medium& medium;
        const darts::Guide& guide;
        float h, surface;
    };

    void aimAtFrame(uint64_t path);
    bool emit();
    /// From a point of an emitter that shines in more than one direction; `guide` null: by the emitter's distribution.
    bool emitFromPoint(const Emitter& emitter, float probability, const darts::Guide* guide);
    void goOn();

    // The stages of a step (transport::GuidedSteps). False ends the path.
    bool look(const darts::Guide& guide, const transport::Start& start);
    bool survives(const darts::Guide& guide);
    /// The copies share the power.
    void split(const darts::Guide& guide, const Medium& medium, const Vec3f& before);
    /// Of a connection from a vertex with this residual.
    darts::ConnectionSample drawConnection(const darts::Guide& guide, const darts::Residual& residual);
    /// Draws the direction of the straight way ahead; 1 / its density.
    template <typename Scatterer>
    float redirect(const darts::Guide& guide, const Scatterer& scatterer);
    /// A flight through a scattering medium: its control vertex, then the next vertex.
    bool crossMedium(const Medium& medium, const darts::Guide& guide);

    // Vertices. False ends the path.
    bool scatter(const Medium& medium, const darts::Guide& guide, float distance);
    /// From a vertex in the medium, reached in the direction `before`.
    bool leave(const Medium& medium, const darts::Guide& guide, const Vec3f& before);
    bool meetSurface(const SurfaceHit& hit);
    void connectToSurfaces(const transport::Vertex& vertex, float meanScattering);

    // What is left for a primitive.
    /// Points: the control vertex.
    void leaveOn(const Flight& flight, DepositList<Photon>& points);
    /// Beams: in direct view only what the camera's image shows; the store's room is for what can count.
    void leaveOn(const Flight& flight, DepositList<PhotonBeam>& beams);
    void leaveOn(const Flight& flight, DepositList<CollapsedFlights>& flights);
    /// Points: ordinary photons share with control vertices where sensor paths can fold.
    void leaveAt(float distance, const Flight& flight, DepositList<Photon>& points);
    void leaveAt(float distance, const Flight& flight, DepositList<PhotonBeam>& beams);
    void leaveAt(float distance, const Flight& flight, DepositList<CollapsedFlights>& flights);
    /// Slices: what is seen of a light in this medium, in whatever direction the path goes on.
    void leaveLight(DepositList<CollapsedFlights>& flights, const Emitter& emitter, float probability,
                    const SurfaceSample& start);
    void leaveLight(OneOf<DepositList<Photon>, DepositList<PhotonBeam>> auto&, const Emitter&, float,
                    const SurfaceSample&) {}
    [[nodiscard]] bool storesVertices() const {
        return path_.context.storeVolume &&
               std::visit([](const auto& p) { return p.AtVertices; }, path_.context.settings.primitive);
    }
    void store(DepositList<Photon>& points, const ArrivalCulling& culling, const Vec3f& position, const Rgb& power);

    LightPath path_;
    const Scene& scene_;
    const PhotonGuidance& guidance_;
    const SurfaceConnections* connections_;
    std::vector<PointDraw> draws_; ///< of the vertex at hand
    darts::TimeGate gate_;
    transport::GuidedSteps step_;
    FlightChain chain_; ///< of the flights since the last light or surface, for slices
};

} // namespace tungsten::photon
