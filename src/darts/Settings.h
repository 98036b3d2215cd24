#pragma once
// Every switch of the sampling, and the two presets that set them all.

#include "darts/Vec3.h"

#include <limits>

namespace darts {

/// Coefficients per unit of length in three colour channels; equal ones are treated as grey: a draw of a distance takes
/// 107 instead of 156 ns (micro).
struct Medium {
    Vec3 sigmaA, sigmaS;
    float g = 0; ///< mean cosine of the phase function

    [[nodiscard]] Vec3 sigmaT() const { return sigmaA + sigmaS; }
    /// sigmaS (1 - g), mean over the channels; never 0.
    [[nodiscard]] float reducedSigmaS() const { return std::max(mean(sigmaS) * (1.0f - g), 1e-20f); }
    /// How far light goes straight on after a scattering, on the average: 1 / (sigmaS (1 - g)) - 1 / sigmaS.
    [[nodiscard]] float persistenceLength() const { return g / reducedSigmaS(); }
    [[nodiscard]] bool isGrey() const {
        const auto equal = [](const Vec3& a) { return a.x == a.y && a.y == a.z; };
        return equal(sigmaA) && equal(sigmaS);
    }
};

/// Whose sampler it is.
enum class Preset {
    /// He et al. 2024: distances are resampled from candidates by the light still to arrive, directions suit the
    /// longest length, what an emitter sends is not guided.
    Published,
    /// Every draw has a density that is known: distances are log-linear (LogLinearDistance), by the light still to
    /// arrive times the part of the gate that is still reachable; directions suit the median length, and half of the
    /// lengths forward peaks (g >= 0.5). What an emitter sends is guided as well.
    Best,
};

/// What the walk's target is: the emitter, connected to at once (path tracing), or the camera, for which control
/// vertices are stored as photons.
enum class Mode { Path, Photon };

/// How directions are drawn.
enum class Direction {
    Phase,      ///< the phase function (or emission, or BSDF) alone
    Eda,        ///< one-sample MIS with the elliptical diffusion approximation's table (He et al. 2024)
    Connection, ///< one-sample MIS with the lobe of the connection's weight
    Product,    ///< peaked phase functions times the lobe (DirectionStrata); other scatterers as Connection
    Ris,        ///< resampled from both; phase-aware, for |g| >= 0.5
};

/// What shapes distances: the light that is still to arrive from the next vertex.
enum class Greens { None, Diffusion, Causal };

/// Where candidate distances come from.
enum class Proposals {
    Exponential,  ///< transmittance, truncated
    MixedUniform, ///< half of them uniform up to the bound
    MixedQuarter, ///< half of them exponential of a quarter of the rate
    Equiangular,  ///< about the target (Kulla and Fajardo 2012)
};

/// Which lobe Direction::Connection and Ris use; the mode's own unless an experiment asks for the other.
enum class Lobe { Path, Photon };

struct Settings {
    Preset preset = Preset::Best;
    Mode mode = Mode::Path;

    Direction direction = Direction::Connection;
    Lobe lobe = Lobe::Path;
    float alpha = 0.1f;          ///< share of the phase function: gamma = (C/S) / (C/S + alpha) is the guide's
    int directionCandidates = 4; ///< of Direction::Ris: half phase function, half lobe; even, at most 8
    bool lengthFirst = false;    ///< the connection's length is drawn before the direction, and shapes it

    bool bounded = true; ///< distances end where no path can be in time any more
    Greens greens = Greens::Causal;
    Proposals proposals = Proposals::MixedUniform;
    int candidates = 8; ///< of Preset::Published: 1, 4, 8 or 16

    /// What finds a path can be weighed against what else does: switches leave every density known.
    [[nodiscard]] bool hasDensities() const {
        return preset == Preset::Best && bounded && !lengthFirst && direction != Direction::Ris;
    }

    float roulette = 0.1f;    ///< walks end at random below this part of their first expected contribution; 0: never
    float rouletteOut = 0.1f; ///< the same on the way out of bodies
    /// Walks split that expect more than so many times their first contribution. Bench: a closed white box,
    /// docs/notebook.md; 3 and 10 do the same to it, and nothing to other scenes.
    static constexpr float SplitAbove = 4.0f;
    float splitOut = SplitAbove; ///< the same on the way out of bodies, beside SplittingSchedule
};

/// The sampler of He et al. 2024: eight exponential candidates against the diffusion approximation, the EDA table mixed
/// with the phase function, control vertices drawn after the direction.
inline Settings published(Mode mode) {
    Settings s;
    s.preset = Preset::Published;
    s.mode = mode;
    s.direction = Direction::Eda;
    s.lobe = mode == Mode::Path ? Lobe::Path : Lobe::Photon;
    s.alpha = 0.5f;
    s.bounded = false;
    s.greens = Greens::Diffusion;
    s.proposals = Proposals::Exponential;
    s.roulette = s.rouletteOut = 0.0f;
    return s;
}

/// What the study of sampling found best, for a phase function of mean cosine g; roulette and the camera's share as
/// benchmarks/infinite_medium found them better still. Distances and directions have densities that are known, so that
/// what finds a path can be weighed against what else does. What differs out of bodies: bench study bodies, and
/// docs/notebook.md ("Drift and splits").
inline Settings best(Mode mode, float g) {
    const bool peaked = std::abs(g) >= 0.5f;
    Settings s;
    s.mode = mode;
    s.direction = peaked ? Direction::Product : Direction::Connection;
    if (mode == Mode::Photon) {
        s.lobe = Lobe::Photon;
        s.alpha = 0.2f;
        s.roulette = s.rouletteOut = peaked ? 0.1f : 0.3f;
        s.greens = peaked ? Greens::Causal : Greens::Diffusion;
    } else {
        s.roulette = 0.03f;
        s.rouletteOut = 0.3f;
        s.splitOut = std::numeric_limits<float>::infinity(); // the schedule is enough: 1.1 to 1.5 times the cost at 4
        s.greens = peaked ? Greens::Diffusion : Greens::Causal;
    }
    return s;
}

/// These settings with plain free flights: one exponential candidate.
inline Settings plainFlights(Settings s) {
    s.greens = Greens::None;
    s.proposals = Proposals::Exponential;
    s.candidates = 1;
    return s;
}

} // namespace darts
