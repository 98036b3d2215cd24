#pragma once
// The rows of the verified values' tables by sliced primitives.

#include "support/VerifiedValues.h"

namespace tungsten::test {

/// `NearBalls` shares with volumes only where the ball's jacobian is small.
enum class Sliced {
    Planes,
    ShortPlanes,
    Volumes,
    ShortVolumes,
    SlicedVolumes, ///< a random slice of the box
    ShortWithoutGhosts,
    Hypervolumes,
    ShortHypervolumes,
    Balls, ///< a random slice of the box
    BallChords,
    ShortBallChords,
    NearBalls,
    Shared,
    SharedPlainly, ///< the ratio without exponentials
    Count
};
inline constexpr std::array SlicedNames{"planes",
                                        "planes short",
                                        "volumes",
                                        "volumes short",
                                        "volumes, random slice",
                                        "volumes short, no ghosts",
                                        "hypervolumes",
                                        "hypervolumes short",
                                        "balls",
                                        "balls, box by (13)",
                                        "balls short, box by (13)",
                                        "balls, shared near the ray",
                                        "volumes and balls",
                                        "the same, plain ratio"};
static_assert(SlicedNames.size() == size_t(Sliced::Count));

/// Whether the row exists for the value: flights enough, a gate with a width, a vertex that scatters.
constexpr bool exists(Sliced row, const VerifiedValue& v) {
    const int chain = v.order;
    switch (row) {
    case Sliced::Planes:
    case Sliced::ShortPlanes:
        return chain >= 2 && !v.delta;
    case Sliced::Volumes:
    case Sliced::ShortVolumes:
        return chain >= 3;
    case Sliced::SlicedVolumes:
        return chain >= 3 && !v.delta;
    case Sliced::ShortWithoutGhosts:
        return v.configuration == 'W';
    case Sliced::Hypervolumes:
    case Sliced::ShortHypervolumes:
        return chain >= 4 && (row == Sliced::Hypervolumes || v.configuration != 'W');
    case Sliced::Balls:
        return chain >= (v.configuration == 'C' ? 2 : 1);
    case Sliced::BallChords:
    case Sliced::ShortBallChords:
        return chain >= (v.configuration == 'C' ? 2 : 1) && !v.delta;
    case Sliced::NearBalls:
        return chain >= 3 && v.delta;
    case Sliced::Shared:
    case Sliced::SharedPlainly:
        return chain >= 3;
    case Sliced::Count:
        break;
    }
    return false;
}
/// Balls at one length: means are usually too low and standard errors too small. Ball chords have them finite but for a
/// logarithm.
constexpr bool infiniteVariance(Sliced row) {
    return row == Sliced::Balls;
}

} // namespace tungsten::test
