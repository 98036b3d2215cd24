// How often the error that was made is beyond the one that was promised.

#include "tungsten/core/Random.h"
#include "tungsten/film/Film.h"
#include "tungsten/film/FilmErrors.h"
#include "tungsten/film/FilmRows.h"

#include <gtest/gtest.h>

#include <functional>
#include <sstream>

namespace tungsten {
namespace {

constexpr int Side = 16, Seeds = 200;
constexpr uint32_t PassCount = 32;

/// A pixel's value with mean 1, of independent numbers u and v in [0, 1).
using Noise = std::function<double(double u, double v)>;

double normal(double u, double v) {
    return std::sqrt(-2.0 * std::log1p(-u)) * std::cos(2.0 * M_PI * v);
}

struct Promise {
    double beyondError = 0.0, beyondBound = 0.0; ///< parts of the films whose error is larger
    double factor = 0.0;                         ///< mean of bound / standard error
};

/// `alike`: so many pixels in a row, or rows, share their noise.
Promise promiseOf(const Noise& noise, int alike) {
    Promise promise;
    for (uint32_t seed = 0; seed < Seeds; ++seed) {
        Film film(Side, Side, 1);
        for (uint32_t pass = 0; pass < PassCount; ++pass) {
            film.beginPass();
            for (int y = 0; y < Side; ++y)
                for (int x = 0; x < Side; ++x) {
                    Sampler sampler(seed, RandomStream::Test, pass, uint64_t((y * Side + x) / alike));
                    const double u = double(sampler.next1D());
                    film.set(0, x, y, Rgb(float(noise(u, double(sampler.next1D())))));
                }
            film.endPass(1.0);
        }
        const Image mean = film.mean(0);
        double squares = 0.0, sum = 0.0;
        for (const Rgb& pixel : mean.pixels) {
            squares += std::pow(double(pixel.x) - 1.0, 2.0);
            sum += double(pixel.x);
        }
        const double pixels = Side * Side, error = std::sqrt(squares / pixels) / (sum / pixels);
        promise.beyondError += error > relativeStandardError(film) ? 1.0 / Seeds : 0.0;
        promise.beyondBound += error > relativeErrorBound(film) ? 1.0 / Seeds : 0.0;
        promise.factor += relativeErrorBound(film) / relativeStandardError(film) / Seeds;
    }
    return promise;
}

TEST(ErrorConfidence, TheErrorStaysBelowItsBound) {
    const double most = 0.05 + 4.0 * std::sqrt(0.05 * 0.95 / Seeds);
    const Noise even = [](double u, double v) { return 1.0 + normal(u, v); };
    const Noise lognormal = [](double u, double v) { return std::exp(1.5 * normal(u, v) - 1.125); };
    const Noise pareto = [](double u, double) { return std::pow(1.0 - u, -1.0 / 2.2) * 1.2 / 2.2; };
    const Noise sparse = [](double u, double) { return u < 0.02 ? 50.0 : 0.0; };
    const Noise rare = [](double u, double) { return u < 1e-3 ? 100.9 : 0.9; };
    struct Case {
        const char* name;
        Noise noise;
        int alike;
        double mostFactor;
    };
    for (const Case& c :
         {Case{"even", even, 1, 1.1}, Case{"even, in rows of 16", even, 16, 1.6}, Case{"log-normal", lognormal, 1, 2.0},
          Case{"log-normal, in rows of 16", lognormal, 16, 2.5}, Case{"tail of power 3.2", pareto, 1, 1.6},
          Case{"rare samples", rare, 1, 2.2}, Case{"few photons", sparse, 1, 1.35},
          Case{"few photons, in rows of 16", sparse, 16, 2.0}, Case{"even, all alike", even, Side * Side, 2.4}}) {
        const Promise promise = promiseOf(c.noise, c.alike);
        EXPECT_LT(promise.beyondBound, most) << c.name;
        EXPECT_GT(promise.beyondError, 0.2) << c.name << ": the standard error alone would do";
        EXPECT_LT(promise.factor, c.mostFactor) << c.name;
    }
}

/// Each pass is uneven, the mean of many is not: what passes have in common is left.
TEST(ErrorConfidence, ManyUnevenPassesMakeAnEvenMean) {
    const auto factorOf = [](int alike) {
        Film film(Side, Side, 1);
        for (uint32_t pass = 0; pass < 1024; ++pass) {
            film.beginPass();
            for (int i = 0; i < Side * Side; ++i) {
                Sampler sampler(77, RandomStream::Test, pass, uint64_t(i / alike));
                film.set(0, i % Side, i / Side, Rgb(sampler.next1D() < 0.01f ? 100.0f : 0.0f));
            }
            film.endPass(1.0);
        }
        return boundFactor(film);
    };
    const auto exact = [](double independent) {
        return std::sqrt(1.0 + ErrorConfidence::Deviations * std::sqrt(2.0 / independent));
    };
    EXPECT_LT(factorOf(1), exact(Side * Side) * 1.1);
    EXPECT_GT(factorOf(1), exact(Side * Side));
    // The bound has two standard errors of this number in it, and what rare passes bring.
    for (const int alike : {16, 64, 256}) {
        const double independent = double(Side * Side / alike);
        EXPECT_GT(factorOf(alike), exact(independent)) << alike;
        EXPECT_LT(factorOf(alike), 1.3 * exact(independent)) << alike;
    }
}

TEST(ErrorConfidence, IsUnknownAtFirstAndOneWherePassesAreAlike) {
    ErrorConfidence scatter;
    for (int i = 0; i < 3; ++i) {
        EXPECT_TRUE(std::isnan(scatter.boundFactor())) << i;
        scatter.add(uint32_t(1 + i), {});
    }
    scatter.add(4, {});
    EXPECT_EQ(scatter.boundFactor(), 1.0);
}

/// Many passes are kept as means of pairs: nearly the same bound, in bounded memory.
TEST(ErrorConfidence, ManyPassesTakeLittleMemory) {
    ErrorConfidence few, many;
    for (uint64_t i = 0; i < 40 * ErrorConfidence::MostGroups; ++i) {
        Sampler sampler(5, RandomStream::Test, 0, i);
        const double value = 1.0 + 0.2 * normal(double(sampler.next1D()), double(sampler.next1D()));
        if (i + 1 < ErrorConfidence::MostGroups) few.add(uint32_t(1 + i), {value, 0.0, 0.0});
        many.add(uint32_t(1 + i), {value, 0.0, 0.0});
    }
    EXPECT_LE(many.memoryBytes(), 2 * ErrorConfidence::MostGroups * sizeof(double));
    EXPECT_NEAR(many.boundFactor(), few.boundFactor(), 0.01);
}

TEST(ErrorConfidence, ASavedFilmKeepsItsBound) {
    Film film(3, 2, 1), other(3, 2, 1);
    for (uint32_t pass = 0; pass < 9; ++pass) {
        film.beginPass();
        for (int x = 0; x < 3; ++x) film.set(0, x, 1, Rgb(float(pass * pass + uint32_t(x))));
        film.endPass(2.0);
    }
    std::stringstream state;
    FilmRows::writeState(film, state);
    FilmRows::readState(other, state, "state");
    EXPECT_GT(relativeErrorBound(film), relativeStandardError(film));
    EXPECT_EQ(relativeErrorBound(other), relativeErrorBound(film));
}

} // namespace
} // namespace tungsten
