#pragma once
// How densely guided light paths leave what a plain one leaves: asked of the guided steps, along the way that the plain
// path took.

#include "photon/light/StepsToCamera.h"

#include "transport/WalkRecord.h"

namespace tungsten::photon {

/// What a plain light path has passed. Densities are only asked for where it leaves something: the guided steps then go
/// the same way, with the throughput that a guided path would have, from where they were led last. Memory is kept from
/// path to path.
///
/// All answers are logarithms of densities, guided over plain (docs/method.md, section 11).
class PhotonTrail {
  public:
    /// A new path; `steps` as they start. `densities` counts flights that are asked about.
    void start(const StepsToCamera& steps, uint64_t& densities);
    /// It leaves a point of an emitter that shines in more than a single direction.
    void emit(const transport::PathState& start, const Emitter& emitter, const SurfaceSample& from,
              const Vec3f& direction) {
        emission_ = Emission{start, &emitter, from, direction};
    }
    // What the path does, in order.
    void fly(const transport::PathState& start, const transport::Ahead& ahead) { record_.fly(start, ahead); }
    void arrive(const transport::PathState& at, const transport::Ahead& ahead, const transport::Flight& flight) {
        record_.arrive(at, ahead, flight);
    }
    void leave(const transport::Way& way) { record_.leave(way); }

    /// Logarithm of density ratios of the way up to the flight at hand, its direction included.
    [[nodiscard]] float onFlight();
    /// The same logarithm up to the flight's end.
    [[nodiscard]] float there();
    /// Logarithm for photons at its end, in a medium: guided paths leave control vertices, too.
    [[nodiscard]] float inMedium();
    /// Logarithm for what is left at the flight's end by paths that have not ended there.
    [[nodiscard]] float atVertex();

  private:
    struct Emission {
        transport::PathState start;
        const Emitter* emitter;
        SurfaceSample from;
        Vec3f direction;
    };
    [[nodiscard]] transport::PathState guided(const transport::PathState& plain) const;
    /// Leads the steps along the flight at hand, from the one before.
    void follow();
    void fly(const transport::WalkRecord::Step& step);
    void reach(const transport::WalkRecord::Step& step);
    /// At the vertex that ends a flight: whether guided paths go on; then by the way that the plain one took.
    void stop(size_t index);
    void pass(size_t index);

    std::optional<StepsToCamera> steps_;
    std::optional<Emission> emission_;
    transport::WalkRecord record_;
    uint64_t* densities_ = nullptr;
    size_t flown_ = 0, reached_ = 0, stopped_ = 0; ///< so many flights, their ends, the vertices there
    std::optional<SurfaceInteraction> surface_;    ///< of the last of these
    bool alive_ = true;                            ///< guided paths may come there
    float onFlight_ = 0.0f, logRatio_ = 0.0f;
};

} // namespace tungsten::photon
