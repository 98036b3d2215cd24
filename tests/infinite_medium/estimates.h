#pragma once
// Means of walks in an infinite medium, order by order, with standard errors from batches.

#include "Image.h"
#include "Statistics.h"
#include "Walk.h"

#include "tungsten/core/Random.h"

#include <array>
#include <cmath>

namespace infinite_medium::test {

inline constexpr int Orders = 4; ///< index 0: the sum of all orders

/// Means over paths [0, paths) of what sample(random, add(order, value)) adds per path.
template <typename Sample>
std::array<Estimate, Orders> orderMeans(uint64_t paths, uint64_t seed, Sample&& sample) {
    constexpr uint64_t Batches = 40;
    std::array<std::vector<double>, Orders> batches;
    for (uint64_t batch = 0; batch < Batches; ++batch) {
        std::array<double, Orders> sums{};
        for (uint64_t i = 0; i < paths / Batches; ++i) {
            tungsten::Sampler sampler(seed, tungsten::RandomStream::Test, uint32_t(batch), i);
            sample([&] { return sampler.next1D(); },
                   [&](int order, double value) {
                       sums[0] += value;
                       if (order < Orders) sums[size_t(order)] += value;
                   });
        }
        for (size_t order = 0; order < Orders; ++order) batches[order].push_back(sums[order] / double(paths / Batches));
    }
    std::array<Estimate, Orders> means;
    for (size_t order = 0; order < Orders; ++order) means[order] = batchMeans(batches[order]);
    return means;
}

/// Path mode: radiance along the ray from route.start, averaged over the gate.
template <typename Form = DerivedForm>
std::array<Estimate, Orders> radianceByOrder(const darts::Settings& settings, const darts::Medium& medium,
                                             const Route& route, const darts::Vec3& direction, uint64_t paths,
                                             uint64_t seed) {
    const darts::Guide guide(settings, medium);
    const Walk<Form> walk(guide, route, {.guidedEmission = settings.preset == darts::Preset::Best});
    return orderMeans(paths, seed, [&](auto&& random, auto&& add) {
        walk.fromRay(direction, random,
                     [&](const LastScattering& last) { add(last.order, radiance(last, medium, route.gate)); });
    });
}

/// Photon mode: the same radiance at the route's target, for a ray that looks along z; the 2-D biweight kernel spreads
/// it over `kernelRadius`.
template <typename Form = DerivedForm>
std::array<Estimate, Orders> gatheredByOrder(const darts::Settings& settings, const darts::Medium& medium,
                                             const Route& route, float kernelRadius, uint64_t paths, uint64_t seed) {
    const darts::Guide guide(settings, medium);
    const Walk<Form> walk(guide, route, {.guidedEmission = settings.preset == darts::Preset::Best});
    const double width = route.gate.end - route.gate.begin;
    return orderMeans(paths, seed, [&](auto&& random, auto&& add) {
        walk.fromEmitter(random, [&](const LastScattering& last) {
            const darts::Vec3 seen = last.position - route.target;
            const float across = std::hypot(seen.x, seen.y) / kernelRadius;
            if (!(seen.z > 0) || across >= 1) return;
            const double support = (1 - double(across) * double(across)) / double(kernelRadius);
            const darts::HenyeyGreenstein scatterer{last.before, medium.g};
            add(last.order, last.throughput * 3 / double(darts::Pi) * support * support *
                                double(scatterer.pdf({0, 0, -1})) *
                                std::exp(-double(medium.sigmaT().x) * double(seen.z)) / width);
        });
    });
}

} // namespace infinite_medium::test
