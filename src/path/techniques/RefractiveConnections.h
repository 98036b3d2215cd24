#pragma once
// Where light of surfaces outside gets into sealed bodies, seen from inside: the last vertex of a camera path aims
// through a face of its body at a point of an emitter that it reaches inside the gate (docs/method.md, section 10.5).

#include "path/techniques/RefractedView.h"

#include "transport/BoundedMedium.h"

#include "tungsten/core/Distribution.h"

namespace tungsten::path {

/// A vertex in a sealed body.
struct SealedVertex {
    Vec3f position;
    Vec3f before; ///< direction of propagation up to here
    double time;  ///< of the path so far
    Region region;
    ChannelDensities channels{1.0f}; ///< of the path so far
};

class RefractiveConnections {
  public:
    /// Some emitter is one that it can aim at.
    static bool helpsWith(const Scene& scene);

    /// For a sealed scene. `leftOut`: emitters, by index; empty: none.
    void prepare(const Scene& scene, const std::vector<bool>& leftOut, const ProgressToken& watch);
    /// Points of emitters for a pass.
    void trace(const PassInfo& pass);

    /// A direction to go on in; whatever it brings by way of that face from that emitter is to be multiplied by
    /// `weight` over density(). None where no light of the chosen emitter may arrive in time.
    struct Drawn {
        Vec3f direction;
        float weight;
        size_t face;
        int emitter;
    };
    [[nodiscard]] std::optional<Drawn> draw(const SealedVertex& vertex, Sampler& sampler) const;
    /// The mean number of draws per solid angle about `direction`, each counted `weight` times.
    [[nodiscard]] float density(const SealedVertex& vertex, const Vec3f& direction, size_t face, int emitter) const;
    /// Number of faces of the body of a medium; spheres have one.
    [[nodiscard]] size_t faces(int medium) const;
    /// The face of the body of a medium that a way leaves through where the outward normal is this.
    [[nodiscard]] size_t faceOf(int medium, const Vec3f& normal) const;
    /// The boundary of the body of a medium.
    [[nodiscard]] const Primitive* boundary(int medium) const { return bodies_[size_t(medium)].primitive; }

  private:
    static constexpr size_t MostFaces = 12;
    /// How long after the view's time light of an emitter really arrives, from the least to the most: other boundaries
    /// on the way.
    struct Delay {
        float least = 0.0f, most = 0.0f;
        /// Whether a way that takes the view a time from `low` to `high` is possible with this delay.
        [[nodiscard]] bool covers(float time, float low, float high) const {
            return time >= low - most && time < high - least;
        }
    };
    /// Equally likely intervals of delay: between neighbouring quantiles of the pilots, and a few that contain all of
    /// them, for rare paths.
    using Delays = std::vector<Delay>;
    /// What is known of one body and emitter.
    struct Pair {
        float index = 1.0f;         ///< refractive, inside over that about the emitter
        std::vector<Delays> delays; ///< by face
    };
    /// Probability, by face, that draw() chooses it at a vertex.
    struct Odds {
        std::array<float, MostFaces> faces{};
        size_t count = 0;
        float sum = 0.0f;
    };
    [[nodiscard]] Odds oddsOf(const Vec3f& position, const Region& region, size_t lamp) const;
    /// The plane that a view has for it.
    [[nodiscard]] transport::BoundedMedium::Face face(const Vec3f& position, const Region& region, size_t index,
                                                      size_t lamp) const;
    [[nodiscard]] const Pair& pair(int medium, size_t lamp) const { return pairs_[size_t(medium)][lamp]; }
    [[nodiscard]] RefractedView view(const Vec3f& position, const Region& region, size_t face, size_t lamp) const;
    /// One of the emitter's points by what it may bring, its way lasting from `low` to `high`; weight as in Drawn.
    [[nodiscard]] std::optional<Drawn> choose(const RefractedView& view, const SealedVertex& vertex, float low,
                                              float high, const Vec2f& u) const;
    /// Moments at which light leaves the vertex on a way that arrives inside the gate, relative to it.
    [[nodiscard]] std::pair<float, float> window(const SealedVertex& vertex, const RefractedEmitter& lamp) const;

    [[nodiscard]] float indexTowards(int medium, const RefractedEmitter& lamp) const;
    /// At least one; those given are sorted; `all`: holds any.
    static Delays quantiles(std::vector<float>& delays, const Delay& all);
    [[nodiscard]] std::vector<Delays> delaysOf(int medium, size_t lamp, const Sampler& sampler) const;
    /// Until light that starts at a vertex in a body, as seen from there, is met on the emitter; none if it is not.
    [[nodiscard]] std::optional<double> timeTo(const RefractedEmitter& lamp, const Ray& ray, const Region& region,
                                               const Sampler& sampler) const;

    const Scene* scene_ = nullptr;
    TimeGate gate_;                                ///< of arrivals
    std::vector<transport::BoundedMedium> bodies_; ///< by medium
    std::vector<RefractedEmitter> lamps_;
    Distribution1D choice_;                ///< by emitter
    std::vector<int> lampOf_;              ///< by emitter, -1: none
    std::vector<std::vector<Pair>> pairs_; ///< by medium, lamp
};

} // namespace tungsten::path
