#pragma once
// Where camera rays meet collapsed flights, with 50 digits: flights and ray as columns of one system of space and time
// (docs/photon-primitives.md, section 2), solved by elimination.

#include "support/Exact.h"
#include "support/LogUniform.h"

#include "tungsten/core/Random.h"
#include "tungsten/core/Types.h"

#include <array>

namespace tungsten::photon {

using test::Exact;

template <size_t N>
using ExactColumn = std::array<Exact, N>;

/// In space, and in time or another number.
template <typename Real>
ExactColumn<4> exactColumn(const Imath::Vec3<Real>& v, const Exact& time = 0) {
    return {Exact(v.x), Exact(v.y), Exact(v.z), time};
}

/// Space alone where N is 3.
template <size_t N>
struct ExactSystem {
    std::array<ExactColumn<4>, N> columns;

    /// The unknowns, and the determinant's absolute value.
    std::array<Exact, N> solve(const ExactColumn<4>& right, Exact& determinant) const {
        std::array<std::array<Exact, N + 1>, N> rows;
        for (size_t r = 0; r < N; ++r) {
            for (size_t k = 0; k < N; ++k) rows[r][k] = columns[k][r];
            rows[r][N] = right[r];
        }
        determinant = 1;
        for (size_t k = 0; k < N; ++k) {
            size_t pivot = k;
            for (size_t r = k; r < N; ++r)
                if (abs(rows[r][k]) > abs(rows[pivot][k])) pivot = r;
            std::swap(rows[k], rows[pivot]);
            determinant *= abs(rows[k][k]);
            for (size_t r = 0; r < N; ++r) {
                if (r == k) continue;
                const Exact factor = rows[r][k] / rows[k][k];
                for (size_t c = k; c <= N; ++c) rows[r][c] -= factor * rows[k][c];
            }
        }
        std::array<Exact, N> unknowns;
        for (size_t k = 0; k < N; ++k) unknowns[k] = rows[k][N] / rows[k][k];
        return unknowns;
    }
};

/// K flights from a base that meet a ray, whose length counts in times if `warped`.
template <typename Real, size_t K>
struct MeetingFlights {
    std::array<Imath::Vec3<Real>, K> directions;
    Imath::Vec3<Real> toOrigin, ray; ///< from the base to the ray's origin; unit
    bool warped;
    Real residual; ///< path length
    Real size;     ///< about the longest of all lengths

    /// The meeting's point: all lengths, and that along the ray last.
    std::array<Exact, K + 1> point(Exact& jacobian) const {
        ExactSystem<K + 1> system;
        for (size_t i = 0; i < K; ++i) system.columns[i] = exactColumn(directions[i], 1);
        system.columns[K] = exactColumn(ray * Real(-1), warped ? 1 : 0);
        return system.solve(exactColumn(toOrigin, residual), jacobian);
    }
    /// Lengths as offset + slope t.
    void line(std::array<Exact, K>& offset, std::array<Exact, K>& slope, Exact& jacobian) const {
        ExactSystem<K> system;
        for (size_t i = 0; i < K; ++i) system.columns[i] = exactColumn(directions[i], 1);
        offset = system.solve(exactColumn(toOrigin, residual), jacobian);
        slope = system.solve(exactColumn(ray, warped ? -1 : 0), jacobian);
    }
};

/// Meets at lengths of its own choice, but for rounding; every third one has directions that are close to each other.
template <typename Real, size_t K>
MeetingFlights<Real, K> someMeeting(uint32_t seed, uint64_t i, double nearest) {
    Sampler s(seed, RandomStream::Test, 0, i);
    const auto direction = [&] {
        const double z = 2.0 * s.nextDouble() - 1.0, phi = 6.28 * s.nextDouble(), r = std::sqrt(1.0 - z * z);
        return Vec3d(r * std::cos(phi), r * std::sin(phi), z);
    };
    std::array<Vec3d, K> w;
    for (size_t k = 0; k < K; ++k) w[k] = direction();
    if (i % 3 == 0) w[1] = (w[0] + direction() * test::logUniform(s, nearest, 0.1)).normalized();
    MeetingFlights<Real, K> met;
    const auto rounded = [](const Vec3d& v) { return Imath::Vec3<Real>(Real(v.x), Real(v.y), Real(v.z)); };
    const double scale = test::logUniform(s, 1e-3, 1e3), along = scale * test::logUniform(s, 1e-2, 1.0);
    const Vec3d ray = direction();
    Vec3d toOrigin = ray * -along;
    double sum = 0.0;
    for (size_t k = 0; k < K; ++k) {
        const double length = scale * test::logUniform(s, 1e-2, 1.0);
        toOrigin += w[k] * length;
        sum += length;
        met.directions[k] = rounded(w[k]);
    }
    met.toOrigin = rounded(toOrigin);
    met.ray = rounded(ray);
    met.warped = s.next1D() < 0.5f;
    met.residual = Real(sum + (met.warped ? along : 0.0));
    met.size = Real(sum + along);
    return met;
}

} // namespace tungsten::photon
