#pragma once
// How long after an emitter's emission_time its light is recorded, beyond its time of flight: pulses and the sensor's
// response (docs/method.md, section 1).

#include "darts/TemporalResponse.h"
#include "darts/TimeBudget.h"

#include "tungsten/core/Random.h"
#include "tungsten/scene/Scene.h"

#include <memory>
#include <vector>

namespace tungsten::transport {

/// The delays of a scene whose sensor averages over frames; none in steady state.
class RecordingDelays {
  public:
    RecordingDelays() = default;
    static RecordingDelays of(const Scene& scene);

    [[nodiscard]] bool any() const { return !densities_.empty(); }
    /// Density of the delay per time; null for light that is recorded as it arrives. `emitter` is one of the scene's.
    [[nodiscard]] const darts::TemporalResponse* density(const Emitter& emitter) const {
        return any() ? densities_[size_t(&emitter - first_)].get() : nullptr;
    }
    /// A delay by that density. Draws a number only where there is one.
    [[nodiscard]] double sample(const Emitter& emitter, Sampler& sampler) const {
        const darts::TemporalResponse* delay = density(emitter);
        return delay ? delay->quantile(sampler.nextDouble()) : 0.0;
    }
    /// When light that is recorded in `gate` arrives, whichever emitter's: the gate widened by all delays.
    [[nodiscard]] TimeGate arrivals(const TimeGate& gate) const;

  private:
    const Emitter* first_ = nullptr;
    std::vector<std::shared_ptr<const darts::TemporalResponse>> densities_; ///< by emitter
    double least_ = 0.0, most_ = 0.0;
};

} // namespace tungsten::transport
