#include "tungsten/integrator/BounceCuts.h"

#include "tungsten/integrator/EarliestArrival.h"
#include "tungsten/integrator/SceneElements.h"
#include "tungsten/reader/Field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tungsten {

namespace {

/// What is left of light in its medium when it is cut is told if it is more than e to the minus this of what was there.
constexpr double MostDecades = 14.0;

/// By which light that diffuses in a body dies away per time: its slowest mode between planes at the extrapolated
/// distance from the sides of its box (Contini et al. 1997), and absorption. `walls`: they reflect what arrives from
/// within by about this part.
double decayRate(double sigmaA, double reducedS, double speed, const Vec3f& size, double walls) {
    const double diffusion = 1.0 / (3.0 * (sigmaA + reducedS));
    const double beyond = 2.0 * diffusion * (1.0 + walls) / (1.0 - walls);
    double leaks = 0.0;
    for (const float side : {size.x, size.y, size.z})
        leaks += std::pow(double(Pi) / (double(side) + 2.0 * beyond), 2.0);
    return speed * (sigmaA + diffusion * leaks);
}

/// The widest body of a medium; none: it has no end.
struct Body {
    bool endless = true;
    Vec3f size{0.0f};
    double walls = 0.0;
};

Body bodyOf(const Scene& scene, int medium) {
    constexpr double RefractingWalls = 0.6; // of an index of 1.4, over all directions
    Body body;
    float widest = 0.0f;
    for (const Primitive& primitive : scene.primitives) {
        if (!primitive.boundsMedium || primitive.inside.medium != medium) continue;
        const Imath::Box3f box = boundsOf(primitive.shape);
        if (box.isEmpty()) continue;
        const Vec3f size = box.size();
        const float least = std::min({size.x, size.y, size.z});
        if (!(least > 0.0f)) return {}; // a sheet, of which others may make a body
        if (least <= widest) continue;
        widest = least;
        const bool straight = std::all_of(primitive.bsdfs.begin(), primitive.bsdfs.end(),
                                          [](const BsdfPtr& bsdf) { return bsdf->lobes() == lobe::Forward; });
        body = {false, size, straight ? 0.0 : RefractingWalls};
    }
    return body;
}

class Cuts {
  public:
    Cuts(const Scene& scene, const SceneFacts& facts)
        : scene_(scene), end_(lastTime(scene)), earliest_(earliestThroughMedia(scene, facts)) {}

    /// In the channel that scatters most: what arrives after this time is cut; Infinity where nothing is.
    [[nodiscard]] double cutAfter(int index, double limit) const {
        const Medium& medium = scene_.media[size_t(index)];
        const double scattering = double(maxComponent(medium.sigmaS())), speed = double(medium.speedOfLight);
        if (!(meanAtEnd(index) > limit)) return Never;
        const double before = earliest_[size_t(index)], time = limit / (scattering * speed);
        return leftAfter(index, time) ? before + time : Never;
    }
    /// How often what arrives last is scattered there on average, if it takes the straight way outside.
    [[nodiscard]] double meanAtEnd(int index) const {
        const Medium& medium = scene_.media[size_t(index)];
        return double(maxComponent(medium.sigmaS())) * double(medium.speedOfLight) * (end_ - earliest_[size_t(index)]);
    }

    static constexpr double Never = std::numeric_limits<double>::infinity();

  private:
    /// Whether there is light worth telling of in the medium after so long.
    [[nodiscard]] bool leftAfter(int index, double time) const {
        const Medium& medium = scene_.media[size_t(index)];
        const double speed = double(medium.speedOfLight);
        const Body body = bodyOf(scene_, index);
        double slowest = Never;
        for (int channel = 0; channel < 3; ++channel) {
            const double absorbed = double(medium.sigmaA()[channel]), scattered = double(medium.sigmaS()[channel]);
            const double reduced = scattered * (1.0 - double(medium.phase.g()));
            if (!(scattered > 0.0)) continue;
            slowest = std::min(slowest, body.endless ? speed * absorbed
                                                     : decayRate(absorbed, reduced, speed, body.size, body.walls));
        }
        return slowest * time < MostDecades;
    }

    const Scene& scene_;
    double end_;
    std::vector<double> earliest_; ///< by medium
};

} // namespace

void describeBounceCuts(const Scene& scene, const SceneFacts& facts, Features& features) {
    if (!facts.timeResolved)
        return features.describe(feature::LightCut, false, "steady state: it does not matter when light arrives");
    const Cuts cuts(scene, facts);
    const double most = double(scene.transport.maxBounces) - 1.0;
    SceneElements cut;
    for (const int index : reachableMedia(scene)) {
        const Medium& medium = scene.media[size_t(index)];
        if (!medium.isHomogeneous() || !medium.scatters()) continue;
        const double ofMedium = cuts.cutAfter(index, double(medium.maxBounces)), ofAll = cuts.cutAfter(index, most);
        const double after = std::min(ofMedium, ofAll);
        if (after == Cuts::Never) continue;
        const bool all = ofAll < ofMedium;
        cut.add("in " + nameOf(medium.name, size_t(index)) + " what arrives after about " + brief(after) + " (" +
                    std::to_string(all ? scene.transport.maxBounces : medium.maxBounces) +
                    (all ? " of the integrator" : " of the medium") + "; the latest is scattered some " +
                    brief(std::round(cuts.meanAtEnd(index))) + " times)",
                all ? "integrator.max_bounces" : medium.path + ".max_bounces");
    }
    features.describe(feature::LightCut, cut.any(),
                      cut.any() ? cut.names() : "no light that arrives in time is scattered more often", cut.paths());
}

} // namespace tungsten
