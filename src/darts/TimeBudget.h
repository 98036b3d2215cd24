#pragma once
// What is left of a path: how far the target is, and between which lengths the rest of the path must stay to arrive
// inside the time gate.

#include "darts/Ellipse.h"
#include "darts/EscapeGeometry.h"
#include "darts/Vec3.h"

#include <cstdint>

namespace darts {

/// The time during which the sensor is open. Times from the pulse's emission; a delta gate has begin = end.
struct TimeGate {
    double begin = 0, end = 0;
};

/// Consecutive gates of one width.
struct FrameSequence {
    double begin = 0, width = 0; ///< of the first frame; of each frame
    int frames = 1;

    [[nodiscard]] TimeGate frame(int index) const { return {begin + index * width, begin + (index + 1) * width}; }
    [[nodiscard]] TimeGate all() const { return {begin, begin + frames * width}; }
    /// The frame that sample `index` of a run aims at: every frame equally often in any `frames` consecutive samples,
    /// in an order that u in [0, 1) shifts. Its probability is 1 / frames.
    [[nodiscard]] int stratified(uint64_t index, float u) const {
        const auto shift = uint64_t(std::min(int(u * float(frames)), frames - 1));
        return int((index + shift) % uint64_t(frames));
    }
};

/// Path lengths [low, high) = v (gate - elapsed) that the rest of a path may have. Doubles: with lengths of 1e3 and
/// gates of 1e-3 a float loses the gate.
struct LengthInterval {
    double low = 0, high = 0;
    static LengthInterval of(const TimeGate& gate, double elapsed, double speed) {
        return {speed * (gate.begin - elapsed), speed * (gate.end - elapsed)};
    }
};

struct Heading;

/// The rest of a path seen from a vertex at distance C from its target, in excess lengths delta = S - C.
struct TimeBudget {
    Vec3 axis;           ///< unit, towards the target; arbitrary at C = 0
    float C = 0;         ///< distance to the target
    float excess = 0;    ///< S_hi - C: nothing arrives in time if it is not positive
    float low = 0;       ///< of the connections' range of excess lengths [max(S_lo - C, 0), S_hi - C]
    float width = 0;     ///< of that range, formed in double; 0 at a delta gate
    double shortest = 0; ///< max(S_lo, C): the range's lower end as a length, in double
    EscapeModel model = EscapeModel::Infinite; ///< which model shapes the sampling; any is exact
    EscapeGeometry escape;                     ///< of EscapeModel::Bounded

    /// `toTarget` = target - position.
    static TimeBudget of(const Vec3& toTarget, const LengthInterval& range) {
        const double x = double(toTarget.x), y = double(toTarget.y), z = double(toTarget.z);
        const double C = std::sqrt(x * x + y * y + z * z), low = std::max(range.low - C, 0.0);
        TimeBudget r;
        r.C = float(C);
        r.axis = C > 0 ? Vec3{float(x / C), float(y / C), float(z / C)} : Vec3{0, 0, 1};
        r.excess = float(range.high - C);
        r.low = float(low);
        r.width = float(range.high - C - low);
        r.shortest = C + low;
        r.escape.gate = float(range.high - std::max(range.low, 0.0));
        return r;
    }
    /// For sensors whose clock stops at the last scattering: its distance along the ray alone must lie in the range.
    /// The vertex itself as target: with C = 0 a connection of length S turns at S / 2 in any direction.
    static TimeBudget withoutTarget(const LengthInterval& range) {
        return of({0, 0, 0}, {2 * range.low, 2 * range.high});
    }
    /// Something can still arrive inside the gate. The relative guard keeps walks from ending in ever smaller steps on
    /// the needle.
    [[nodiscard]] bool alive() const { return excess > 1e-6f * C && excess > 0; }
    /// Along a ray with h = 1 - cos to the axis, at the latest arrival.
    [[nodiscard]] Ellipse<float> latest(float h) const { return {C, excess, h}; }
    /// Unit direction.
    [[nodiscard]] inline Heading heading(const Vec3& direction) const;
};

/// Where a ray goes: a unit direction, and h = 1 - cos to the target's.
struct Heading {
    Vec3 direction;
    float h = 0;
};

inline Heading TimeBudget::heading(const Vec3& direction) const {
    return {direction, oneMinusCosine(direction, axis)};
}

} // namespace darts
