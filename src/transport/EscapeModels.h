#pragma once
// How light gets out of bodies of scattering media on its way to what a walk aims at (docs/method.md, section 10.4).

#include "transport/BoundedMedium.h"
#include "transport/Policy.h"

#include "darts/TimeBudget.h"

#include "tungsten/integrator/Features.h"

#include <array>
#include <memory>
#include <optional>
#include <string>

namespace tungsten::transport {

/// What a walk aims at: an emitter's point or the camera.
struct EscapeTarget {
    Vec3f position{0.0f};
    int medium = -1;        ///< about it
    SurfaceMargin margin{}; ///< of the surface it is on, if any
    /// Unit normals, outward, of the planes through the position inside which it looks, or shines; null: everywhere.
    const std::array<Vec3f, 4>* sides = nullptr;
};

/// Where a flight starts.
struct FlightStart {
    Vec3f position{0.0f};
    SurfaceMargin margin{}; ///< of the surface it is on, if any and the direction is not chosen yet
    Vec3f ahead{0.0f};      ///< unit direction of the flight, if it is chosen, and
    float clear = 0.0f;     ///< the length after which it is clear of the surface it starts on, 0 if there is none

    static FlightStart along(const Ray& flight) { return {flight.origin, {}, flight.direction, flight.tMin}; }
};

class EscapeModels {
  public:
    explicit EscapeModels(const Scene& scene);
    /// Null where all media may be taken for infinite: not asked for, or no scattering medium ends at a boundary that
    /// light passes.
    static std::unique_ptr<const EscapeModels> make(const Scene& scene, const Policy& policy);
    /// Says in the plan which models the media get.
    static void plan(const Scene& scene, const Policy& policy, Features& features);

    /// Chooses the model for what lies between the start of a flight through `region` and the aim: budget.model, and
    /// budget.escape but for its extraLength. Adds the rays traced to `rays`.
    void choose(const FlightStart& start, const Region& region, const EscapeTarget& aim, darts::TimeBudget& budget,
                uint64_t& rays) const;
    /// Light of a point in the medium `from` (-1: none) may have to get through a boundary of this one.
    [[nodiscard]] bool isBounded(int medium, int from) const;

  private:
    [[nodiscard]] bool any() const;
    /// Light hardly scatters twice on its way across.
    [[nodiscard]] static bool isThin(const BoundedMedium& body);
    /// The models that vertices in a medium get, in words.
    [[nodiscard]] std::string describe(int medium) const;
    /// Where the straight way leaves, and what is beyond.
    struct Boundary {
        BoundedMedium::BoundaryHit exit;
        float index;   ///< inside over outside
        bool straight; ///< index-matched
        Region beyond;
        SurfaceMargin margin;
    };
    /// The boundary through which a straight way from inside the region leaves its body for the aim, past what lies
    /// inside the body. None if the aim is inside, or something opaque hides it.
    [[nodiscard]] std::optional<Boundary> findBoundary(Ray way, const Region& region, uint64_t& rays) const;
    void setGeometry(const Boundary& boundary, const Vec3f& position, const Region& region, const EscapeTarget& aim,
                     darts::TimeBudget& budget, uint64_t& rays) const;
    /// Goes on through index-matched boundaries: what diffuses beyond the exit counts as depth, the rest as free.
    void addOuterDepth(const Boundary& boundary, const Ray& way, const Region& region, darts::TimeBudget& budget,
                       uint64_t& rays) const;

    const Scene& scene_;
    std::vector<BoundedMedium> bodies_; ///< by medium
    bool layered_ = false;              ///< several media scatter
};

} // namespace tungsten::transport
