#pragma once
// One walk through an infinite homogeneous medium towards a target, told by the library's Guide. Path mode: from a
// receiver's ray towards a point emitter; photon mode: from a point emitter towards the camera.

#include "darts/Guide.h"

#include <limits>

namespace infinite_medium {

/// What the walk goes from and to. Lengths and times are one: the speed of light is 1.
struct Route {
    darts::Vec3 start, target;
    darts::TimeGate gate; ///< of the whole path's length
    int mostScatterings = std::numeric_limits<int>::max();
};

/// What the walk leaves to plain sampling, or does not do.
struct Parts {
    bool controlVertices = true;
    bool guidedEmission = true;
};

/// The method's reading of two formulas that were published with errors; tests put those in its place.
struct DerivedForm {
    [[nodiscard]] static darts::ConnectionSample connection(const darts::Guide& guide, const darts::TimeBudget& budget,
                                                            float u) {
        return guide.sampleConnection(budget, u);
    }
    /// What bounds and shapes distances: the latest arrival.
    [[nodiscard]] static const darts::TimeBudget& distanceRange(const darts::TimeBudget& budget,
                                                                const darts::ConnectionSample&) {
        return budget;
    }
    /// 1 / density along the ray of the control vertex.
    [[nodiscard]] static float inversePdf(const darts::ControlVertex& vertex, const darts::ConnectionSample&) {
        return vertex.inversePdf;
    }
};

/// A vertex where light scatters towards the target.
struct LastScattering {
    darts::Vec3 position, before; ///< before: direction of travel up to it
    darts::Vec3 toTarget;         ///< unit
    double distance = 0;          ///< to the target
    double throughput = 0;        ///< sigmaS and the density of the place included, 1 / gate width not
    int order = 1;                ///< scatterings up to and with this one
};

template <typename Form = DerivedForm>
class Walk {
  public:
    Walk(const darts::Guide& guide, const Route& route, const Parts& parts = {})
        : guide_(guide), route_(route), parts_(parts), sigmaS_(guide.medium().sigmaS.x),
          sigmaT_(guide.medium().sigmaT().x) {}

    /// Along a given ray, as a receiver's: use(LastScattering) for every connection. Returns the number of rays.
    template <typename Random, typename Use>
    int fromRay(const darts::Vec3& direction, Random&& random, Use&& use) const {
        State state = first(1.0f);
        if (!state.budget.alive()) return 0;
        const auto connection = Form::connection(guide_, state.budget, random());
        state.direction = direction;
        const float h = oneMinusCosine(direction, state.budget.axis);
        return run(state, connection, h, random, use);
    }
    /// From an emitter of intensity 1 per steradian.
    template <typename Random, typename Use>
    int fromEmitter(Random&& random, Use&& use) const {
        const darts::HenyeyGreenstein isotropic{{0, 0, 1}, 0.0f};
        State state = first(4.0f * darts::Pi);
        if (!state.budget.alive()) return 0;
        const auto connection = Form::connection(guide_, state.budget, random());
        darts::DirectionSample sample;
        if (parts_.guidedEmission) {
            sample = guide_.sampleDirection(state.budget, connection, isotropic, random);
        } else {
            const float u = random(), v = random();
            sample.direction = isotropic.sample(u, v);
            sample.h = oneMinusCosine(sample.direction, state.budget.axis);
            sample.inversePdf = 4.0f * darts::Pi;
        }
        state.direction = sample.direction;
        state.throughput = sample.inversePdf;
        return run(state, connection, sample.h, random, use);
    }

  private:
    struct State {
        darts::Vec3 position, direction;
        darts::TimeBudget budget;
        double elapsed = 0;
        float throughput = 1;
        float contributionAtStart = 0; ///< logarithm; before a direction is drawn, so that it is the same for all walks
    };

    [[nodiscard]] State first(float throughput) const {
        State state;
        state.position = route_.start;
        state.budget = residualAt(state);
        state.throughput = throughput;
        state.contributionAtStart = guide_.logExpectedContribution(state.budget, throughput);
        return state;
    }
    [[nodiscard]] darts::TimeBudget residualAt(const State& state) const {
        return darts::TimeBudget::of(route_.target - state.position,
                                     darts::LengthInterval::of(route_.gate, state.elapsed, 1.0));
    }
    template <typename Random, typename Use>
    int run(State state, darts::ConnectionSample connection, float h, Random&& random, Use&& use) const {
        constexpr float Surface = std::numeric_limits<float>::infinity();
        for (int order = 1;; ++order) {
            if (parts_.controlVertices) connect(state, connection, h, order, use);
            if (order == route_.mostScatterings && parts_.controlVertices) return order;
            const float throughput = state.throughput;
            const auto step = guide_.sampleDistance(Form::distanceRange(state.budget, connection), {state.direction, h},
                                                    Surface, {throughput, throughput, throughput}, random);
            if (!(step.transmittanceOverPdf.x > 0)) return order;
            state.throughput *= sigmaS_ * step.transmittanceOverPdf.x;
            state.position = state.position + state.direction * step.distance;
            state.elapsed += double(step.distance);
            state.budget = residualAt(state);
            if (!state.budget.alive()) return order;
            if (!parts_.controlVertices) connectByChance(state, order, use);
            if (order == route_.mostScatterings) return order;
            const float survival =
                guide_.survival(state.budget.model, guide_.logExpectedContribution(state.budget, state.throughput),
                                state.contributionAtStart);
            if (survival < 1 && !(random() < survival)) return order;
            const darts::HenyeyGreenstein scatterer{state.direction, guide_.medium().g};
            connection = Form::connection(guide_, state.budget, random());
            const auto sample = guide_.sampleDirection(state.budget, connection, scatterer, random);
            if (!(sample.inversePdf > 0)) return order;
            state.throughput *= scatterer.pdf(sample.direction) * sample.inversePdf / survival;
            state.direction = sample.direction;
            h = sample.h;
        }
    }
    /// The control vertex on the ray.
    template <typename Use>
    void connect(const State& state, const darts::ConnectionSample& connection, float h, int order, Use&& use) const {
        const auto vertex = guide_.controlVertex(state.budget, connection, h, std::numeric_limits<float>::infinity());
        if (!vertex) return;
        const darts::Vec3 leg = state.direction * vertex->distance;
        const darts::Vec3 onward = state.budget.axis * state.budget.C - leg;
        // In double: a connection straight through a dense medium underflows a float.
        const double throughput = double(state.throughput * sigmaS_ * Form::inversePdf(*vertex, connection)) *
                                  std::exp(-double(sigmaT_) * double(vertex->distance));
        use(LastScattering{state.position + leg, state.direction, onward * (1.0f / std::max(length(onward), 1e-30f)),
                           double(vertex->toTarget), throughput, order});
    }
    /// Plain sampling: the walk's own vertex counts if the rest of the path happens to end in the gate.
    template <typename Use>
    void connectByChance(const State& state, int order, Use&& use) const {
        const darts::TimeBudget& budget = state.budget;
        if (budget.low > 0) return;
        use(LastScattering{state.position, state.direction, budget.axis, double(budget.C), double(state.throughput),
                           order});
    }

    const darts::Guide& guide_;
    Route route_;
    Parts parts_;
    float sigmaS_, sigmaT_;
};

/// Path mode: what a connection to an isotropic emitter of intensity 1 per steradian adds to the radiance, averaged
/// over the gate.
inline double radiance(const LastScattering& last, const darts::Medium& medium, const darts::TimeGate& gate) {
    const darts::HenyeyGreenstein scatterer{last.before, medium.g};
    return last.throughput * double(scatterer.pdf(last.toTarget)) *
           std::exp(-double(medium.sigmaT().x) * last.distance) /
           (last.distance * last.distance * (gate.end - gate.begin));
}

} // namespace infinite_medium
