#pragma once
// Single orders of scattering by planes, volumes, balls and hypervolumes, from their geometry alone: the rows of the
// verified values without a renderer. Analog walks in an infinite medium, or beside an absorbing plane.

#include "photon/primitives/sliced/Ball.h"
#include "photon/primitives/sliced/Hypervolume.h"
#include "photon/primitives/sliced/Plane.h"
#include "photon/primitives/sliced/Volume.h"
#include "photon/primitives/sliced/VolumeBallMis.h"

#include "support/SlicedRows.h"

#include "tungsten/core/Random.h"

#include <tbb/parallel_for.h>

namespace tungsten::test {

struct SlicedMean {
    double mean = 0.0, error = 0.0;
};
using SlicedMeans = std::array<SlicedMean, size_t(Sliced::Count)>;

class SlicedOrder {
  public:
    explicit SlicedOrder(const VerifiedValue& value) : value_(value) {
        const double centre = !value.unwarped ? 5.5 : value.configuration == 'C' ? 3.5 : value.delta ? 2.2 : 2.5;
        low_ = value.delta ? centre : centre - 0.5 * value.gateWidth;
        high_ = value.delta ? centre : centre + 0.5 * value.gateWidth;
        g_ = value.configuration == 'B' ? 0.6 : value.configuration == 'C' ? 0.3 : 0.0;
        sight_ = {Vec3d(0.0), Vec3d(0, 0, 1), 0.0, wall(), !value.unwarped};
    }

    /// Of `paths` walks, in batches whose spread is the error.
    [[nodiscard]] SlicedMeans means(uint64_t paths, uint64_t seed) const {
        constexpr size_t Batches = 200;
        const uint64_t perBatch = std::max<uint64_t>(paths / Batches, 1);
        std::array<std::array<double, size_t(Sliced::Count)>, Batches> batches{};
        tbb::parallel_for(size_t(0), Batches, [&](size_t batch) {
            for (uint64_t i = 0; i < perBatch; ++i) {
                Sampler sampler(seed, RandomStream::Test, uint32_t(batch), i);
                walk(sampler, batches[batch]);
            }
        });
        SlicedMeans means;
        for (size_t row = 0; row < means.size(); ++row) {
            double sum = 0.0, squares = 0.0;
            for (const auto& batch : batches) {
                const double mean = batch[row] / double(perBatch);
                sum += mean;
                squares += mean * mean;
            }
            const double mean = sum / Batches;
            means[row] = {mean, std::sqrt(std::max(squares / Batches - mean * mean, 0.0) / (Batches - 1))};
        }
        return means;
    }

  private:
    using Sums = std::array<double, size_t(Sliced::Count)>;
    static constexpr int MostVertices = 8;
    static constexpr double SigmaS = 0.5, SigmaT = 0.6, Least = 1e-9, NearJacobian = 0.05;
    static constexpr photon::Coefficients<double> Medium{SigmaS, SigmaT};

    /// y_k, the direction and sampled length of the flight from there, power leaving; whether a real path got there.
    struct Walk {
        std::array<Vec3d, MostVertices> position, direction;
        std::array<double, MostVertices> flight{}, length{}, power{};
        std::array<bool, MostVertices> real{};
        double slice = 0.0; ///< length inside the gate
        double u = 0.0;
    };

    [[nodiscard]] double wall() const {
        return value_.configuration == 'W' ? 2.6 : std::numeric_limits<double>::infinity();
    }
    [[nodiscard]] double phase(const Vec3d& before, const Vec3d& after) const {
        const double d = 1.0 + g_ * g_ - 2.0 * g_ * before.dot(after);
        return (1.0 - g_ * g_) / (4.0 * M_PI * d * std::sqrt(d));
    }
    [[nodiscard]] Vec3d scatter(const Vec3d& before, Sampler& sampler) const {
        const double u = double(sampler.next1D()), phi = 2.0 * M_PI * double(sampler.next1D());
        const double q = (1.0 - g_ * g_) / (1.0 - g_ + 2.0 * g_ * u);
        const double cosine = g_ == 0.0 ? 1.0 - 2.0 * u : (1.0 + g_ * g_ - q * q) / (2.0 * g_);
        const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
        const Vec3d side = (std::abs(before.x) > 0.5 ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0)).cross(before).normalized();
        return (before * cosine + side * (sine * std::cos(phi)) + before.cross(side) * (sine * std::sin(phi)))
            .normalized();
    }
    [[nodiscard]] bool inside(const Vec3d& point) const { return point.z < wall(); }

    void walk(Sampler& sampler, Sums& sums) const {
        Walk w;
        const int n = value_.order;
        w.position[0] = Vec3d(1.2, 0.5, 2.0);
        w.power[0] = value_.configuration == 'C' ? 1.0 : 4.0 * M_PI;
        w.real[0] = true;
        for (size_t k = 0; k < size_t(n); ++k) {
            if (k > 0) {
                w.direction[k] = scatter(w.direction[k - 1], sampler);
                w.power[k] = w.power[k - 1] * (SigmaS / SigmaT);
            } else if (value_.configuration == 'C') {
                w.direction[0] = Vec3d(-2, -0.5, 1).normalized();
            } else {
                const double z = 1.0 - 2.0 * double(sampler.next1D()), phi = 2.0 * M_PI * double(sampler.next1D());
                w.direction[0] = {std::sqrt(1.0 - z * z) * std::cos(phi), std::sqrt(1.0 - z * z) * std::sin(phi), z};
            }
            w.flight[k] = -std::log1p(-double(sampler.next1D())) / SigmaT;
            w.position[k + 1] = w.position[k] + w.direction[k] * w.flight[k];
            w.length[k + 1] = w.length[k] + w.flight[k];
            w.real[k + 1] = w.real[k] && inside(w.position[k + 1]);
        }
        w.slice = low_ + (high_ - low_) * double(sampler.next1D());
        w.u = double(sampler.next1D());
        if (n >= 2 && !value_.delta) planes(w, sums);
        if (n >= 3) volumes(w, sums);
        if (n >= 4) hypervolumes(w, sums);
        if (value_.configuration != 'C' || n >= 2) balls(w, sums);
    }

    static void add(Sums& sums, Sliced row, double value) { sums[size_t(row)] += value; }
    /// Of K flights before the last direction: directions from the base on.
    template <size_t K>
    static std::array<Vec3d, K> directionsOf(const Walk& w, size_t base) {
        std::array<Vec3d, K> d;
        for (size_t i = 0; i < K; ++i) d[i] = w.direction[base + i];
        return d;
    }
    template <size_t K>
    static bool withinFlights(const Walk& w, size_t base, const std::array<double, K>& t) {
        for (size_t i = 0; i < K; ++i)
            if (t[i] > w.flight[base + i]) return false;
        return true;
    }
    /// All vertices of the collapsed flights lie before the wall.
    template <size_t K>
    [[nodiscard]] bool unoccluded(const Walk& w, size_t base, const std::array<double, K>& t) const {
        Vec3d point = w.position[base];
        for (size_t i = 0; i < K; ++i)
            if (!inside(point += w.direction[base + i] * t[i])) return false;
        return true;
    }

    void planes(const Walk& w, Sums& sums) const {
        const size_t base = size_t(value_.order) - 2;
        const auto met = photon::crossPlane(w.position[base], directionsOf<2>(w, base), sight_, Least);
        if (!w.real[base] || !met) return;
        const double length = w.length[base] + met->flightLength() + sight_.warp() * met->alongRay;
        if (!(length >= low_ && length < high_)) return;
        const double power = w.power[base] * phase(w.direction[base + 1], -sight_.direction) / (high_ - low_);
        add(sums, Sliced::Planes, power * met->weight(Medium));
        if (withinFlights(w, base, met->lengths)) add(sums, Sliced::ShortPlanes, power * met->weight(Medium, false));
    }

    void volumes(const Walk& w, Sums& sums) const {
        const size_t base = size_t(value_.order) - 3;
        if (!w.real[base]) return;
        const auto d = directionsOf<3>(w, base);
        const double power = w.power[base] * phase(d[2], -sight_.direction);
        if (!value_.delta) chords(w, base, d, power, sums);
        const auto slice = photon::sliceVolume(w.position[base], d, sight_, w.slice - w.length[base], Least);
        if (!slice || !unoccluded(w, base, slice->lengths)) return;
        const auto& t = slice->lengths;
        const double value = power * slice->weight(Medium);
        if (value_.delta) {
            add(sums, Sliced::Volumes, value);
            if (withinFlights(w, base, t)) {
                add(sums, Sliced::ShortVolumes, power * slice->weight(Medium, false));
                if (w.real[base + 2]) add(sums, Sliced::ShortWithoutGhosts, power * slice->weight(Medium, false));
            }
        } else {
            add(sums, Sliced::SlicedVolumes, value);
        }
        const double jacobian = t[2] * t[2] * std::abs(d[2].dot(sight_.direction) + sight_.warp());
        const double ratio = shared(d, t[0], t[1], t[2], true), plain = shared(d, t[0], t[1], t[2], false);
        if (jacobian < NearJacobian) add(sums, Sliced::NearBalls, value * photon::volumeWeight(ratio));
        add(sums, Sliced::Shared, value * photon::volumeWeight(ratio));
        add(sums, Sliced::SharedPlainly, value * photon::volumeWeight(plain));
    }

    void chords(const Walk& w, size_t base, const std::array<Vec3d, 3>& d, double power, Sums& sums) const {
        auto chord = photon::volumeChord(w.position[base], d, sight_, Least);
        if (!chord) return;
        chord->keepGate({low_ - w.length[base], high_ - w.length[base]}, sight_.warp());
        add(sums, Sliced::Volumes, power / (high_ - low_) * photon::chordWeight(*chord, Medium));
        chord->keepFlights({w.flight[base], w.flight[base + 1], w.flight[base + 2]});
        add(sums, Sliced::ShortVolumes, power / (high_ - low_) * photon::chordWeight(*chord, Medium, false));
    }

    [[nodiscard]] double shared(const std::array<Vec3d, 3>& d, double t1, double t2, double t3,
                                bool exponentials) const {
        const double pdfs = SigmaT * SigmaT * (exponentials ? std::exp(-SigmaT * (t1 + t2)) : 1.0);
        return photon::SharedPath<double>{d, t3, phase(d[1], d[2]), pdfs}.ratio(sight_.direction, sight_.warped);
    }

    void hypervolumes(const Walk& w, Sums& sums) const {
        const size_t base = size_t(value_.order) - 4;
        if (!w.real[base]) return;
        const auto d = directionsOf<4>(w, base);
        auto chord = photon::sliceHypervolume(w.position[base], d, sight_, w.slice - w.length[base], Least);
        if (!chord) return;
        const double power = w.power[base] * phase(d[3], -sight_.direction);
        const double at = chord->start + w.u * (chord->end - chord->start);
        const std::array<double, 4> t{chord->length(0, at), chord->length(1, at), chord->length(2, at),
                                      chord->length(3, at)};
        if (unoccluded(w, base, t)) add(sums, Sliced::Hypervolumes, power * photon::chordWeight(*chord, Medium));
        chord->keepFlights({w.flight[base], w.flight[base + 1], w.flight[base + 2], w.flight[base + 3]});
        if (value_.configuration != 'W')
            add(sums, Sliced::ShortHypervolumes, power * photon::chordWeight(*chord, Medium, false));
    }

    void balls(const Walk& w, Sums& sums) const {
        const size_t centre = size_t(value_.order) - 1;
        if (!w.real[centre]) return;
        const Vec3d y = w.position[centre];
        const auto slice = photon::sliceBall(y, sight_, w.slice - w.length[centre]);
        for (int i = 0; i < slice.count; ++i) {
            const auto& reach = slice.hits[size_t(i)];
            const double value = scattered(w, centre, reach) * reach.weight(Medium);
            add(sums, Sliced::Balls, value);
            if (centre < 2) continue;
            const Vec3d last = (sight_.at(reach.alongRay) - y).normalized();
            const std::array<Vec3d, 3> d{w.direction[centre - 2], w.direction[centre - 1], last};
            const double t1 = w.flight[centre - 2], t2 = w.flight[centre - 1];
            const double share = photon::ballWeight(shared(d, t1, t2, reach.length, true));
            add(sums, Sliced::NearBalls, value * (reach.jacobian < NearJacobian ? share : 1.0));
            add(sums, Sliced::Shared, value * share);
            add(sums, Sliced::SharedPlainly, value * photon::ballWeight(shared(d, t1, t2, reach.length, false)));
        }
        if (value_.delta) return;
        const auto lit = photon::gateBall<double>(y, sight_, {low_ - w.length[centre], high_ - w.length[centre]});
        if (!(lit.angles() > 0.0)) return;
        const auto reach = lit.sample(w.u);
        const double power = scattered(w, centre, reach) / (high_ - low_);
        add(sums, Sliced::BallChords, power * lit.weight(reach, Medium));
        if (reach.length < w.flight[centre])
            add(sums, Sliced::ShortBallChords, power * lit.weight(reach, Medium, false));
    }
    /// Power times both phase functions.
    [[nodiscard]] double scattered(const Walk& w, size_t centre, const photon::BallHit<double>& reach) const {
        const Vec3d last = (sight_.at(reach.alongRay) - w.position[centre]).normalized();
        const double first = centre == 0 ? 0.25 / M_PI : phase(w.direction[centre - 1], last);
        return w.power[centre] * first * phase(last, -sight_.direction);
    }

    VerifiedValue value_;
    double low_ = 0.0, high_ = 0.0, g_ = 0.0;
    photon::CameraRay<double> sight_;
};

} // namespace tungsten::test
