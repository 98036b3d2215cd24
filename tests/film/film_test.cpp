// The film's moments, and its state.

#include "tungsten/core/Errors.h"
#include "tungsten/core/Random.h"
#include "tungsten/film/Film.h"
#include "tungsten/film/FilmErrors.h"
#include "tungsten/film/FilmRows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <sstream>

namespace tungsten {
namespace {

Film randomFilm(int passes, int frames) {
    Film film(3, 2, frames);
    for (int pass = 0; pass < passes; ++pass) {
        Sampler s(4, RandomStream::Test, uint32_t(pass), 0);
        film.beginPass();
        for (int frame = 0; frame < frames; ++frame)
            for (int y = 0; y < 2; ++y)
                for (int x = 0; x < 3; ++x) film.set(frame, x, y, Rgb(s.next1D(), s.next1D() * 2.0f, 1.0f));
        film.endPass(pass % 3 == 0 ? 2.0 : 1.0);
    }
    return film;
}

TEST(Film, MomentsMatchDirectFormulas) {
    Film film(1, 1, 1);
    const std::vector<std::pair<double, double>> passes{{1.0, 2.0}, {3.0, 1.0}, {2.5, 4.0}, {0.5, 1.0}};
    double weight = 0.0, mean = 0.0, moment = 0.0;
    for (const auto& [value, w] : passes) {
        film.beginPass();
        film.set(0, 0, 0, Rgb(float(value)));
        film.endPass(w);
        weight += w;
        mean += value * w;
    }
    mean /= weight;
    for (const auto& [value, w] : passes) moment += w * (value - mean) * (value - mean);
    EXPECT_NEAR(double(film.mean(0).at(0, 0).x), mean, 1e-6);
    EXPECT_NEAR(double(film.standardError(0).at(0, 0).y), std::sqrt(moment / 3.0 / weight), 1e-6);
    EXPECT_NEAR(relativeStandardError(film), std::sqrt(moment / 3.0 / weight) / mean, 1e-6);
}

TEST(Film, StandardErrorIsUnknownWithOnePassAndRelativelyWithABlackFilm) {
    Film film(1, 1, 2);
    for (uint32_t pass = 0; pass < 2; ++pass) {
        EXPECT_TRUE(std::isnan(film.standardError(1).at(0, 0).x)) << pass;
        EXPECT_TRUE(std::isnan(film.standardErrorOverFrames().at(0, 0).x)) << pass;
        EXPECT_TRUE(std::isnan(relativeStandardError(film))) << pass;
        film.beginPass();
        film.endPass(1.0);
    }
    EXPECT_EQ(film.standardError(1).at(0, 0).x, 0.0f);
    EXPECT_TRUE(std::isnan(relativeStandardError(film)));
}

TEST(Film, StandardErrorPredictsTheSpreadOfMeans) {
    // 400 films of 25 passes: the spread of their means against their own claims.
    double sum = 0.0, squared = 0.0, claimed = 0.0;
    constexpr int Films = 400;
    for (uint32_t f = 0; f < Films; ++f) {
        Film film(1, 1, 1);
        for (uint32_t pass = 0; pass < 25; ++pass) {
            Sampler s(6, RandomStream::Test, pass, f);
            film.beginPass();
            film.set(0, 0, 0, Rgb(s.next1D() * s.next1D()));
            film.endPass(1.0);
        }
        const double mean = double(film.mean(0).at(0, 0).x);
        sum += mean;
        squared += mean * mean;
        claimed += std::pow(double(film.standardError(0).at(0, 0).x), 2.0);
    }
    const double variance = squared / Films - (sum / Films) * (sum / Films);
    EXPECT_NEAR(claimed / Films / variance, 1.0, 5.0 * std::sqrt(2.0 / Films));
    EXPECT_NEAR(sum / Films, 0.25, 5.0 * std::sqrt(variance / Films));
}

/// Passes mostly a little below the mean and rarely far above it: a share of 1e-3 / 1e5 of the mean is less than half a
/// float's last bit. With means rounded to the nearest the image was 15 standard errors (0.15 %) too bright here.
TEST(Film, ManyPassesDoNotDrift) {
    constexpr int Passes = 100000, Values = 64;
    constexpr float Below = 1e-3f, Rare = 1e-3f;
    Film film(Values, 1, 1);
    std::vector<double> sums(Values, 0.0);
    for (int pass = 0; pass < Passes; ++pass) {
        film.beginPass();
        for (int x = 0; x < Values; ++x) {
            Sampler s(11, RandomStream::Test, uint32_t(pass), uint64_t(x));
            const float value = s.next1D() < Rare ? 1.0f + Below * (1.0f - Rare) / Rare : 1.0f - Below;
            film.add(0, x, 0, Rgb(value, 0.1f, 0.0f));
            sums[size_t(x)] += double(value);
        }
        film.endPass(1.0);
    }
    const Image mean = film.mean(0), error = film.standardError(0);
    double drift = 0.0;
    for (int x = 0; x < Values; ++x) {
        const double exact = sums[size_t(x)] / Passes;
        EXPECT_NEAR(double(mean.at(x, 0).x), exact, 0.25 * double(error.at(x, 0).x));
        EXPECT_NEAR(double(error.at(x, 0).x), double(Below) * std::sqrt((1.0 - double(Rare)) / double(Rare) / Passes),
                    3e-5);
        EXPECT_EQ(mean.at(x, 0).y, 0.1f) << "constant values stay as they are";
        EXPECT_EQ(mean.at(x, 0).z, 0.0f);
        drift += (double(mean.at(x, 0).x) - exact) / Values;
    }
    EXPECT_LT(std::abs(drift), 3e-6) << "even rounding drifts nowhere";
}

TEST(Film, WholeGateIsTheMeanOverFrames) {
    const Film film = randomFilm(5, 4);
    double sum = 0.0;
    for (int frame = 0; frame < 4; ++frame) sum += double(film.mean(frame).at(1, 1).y) / 4.0;
    EXPECT_NEAR(double(film.meanOverFrames().at(1, 1).y), sum, 1e-6);
    // Frames vary independently here, so the whole varies less than any of them.
    EXPECT_LT(film.standardErrorOverFrames().at(1, 1).y, film.standardError(0).at(1, 1).y);
}

TEST(Film, NonFiniteSamplesAreCountedAndLeaveNoTrace) {
    Film film(1, 1, 1);
    film.beginPass();
    film.set(0, 0, 0, Rgb(std::numeric_limits<float>::quiet_NaN()));
    film.endPass(1.0);
    film.beginPass();
    film.set(0, 0, 0, Rgb(2.0f));
    film.endPass(1.0);
    EXPECT_EQ(film.nonFiniteSamples(), 1u);
    EXPECT_EQ(film.mean(0).at(0, 0), Rgb(1.0f));
}

TEST(Film, StateRoundTripsBitForBitAndRefusesDamage) {
    Film film = randomFilm(4, 3);
    film.countNonFinite(7);
    std::stringstream stream;
    FilmRows::writeState(film, stream);
    Film loaded(3, 2, 3);
    std::stringstream whole(stream.str());
    FilmRows::readState(loaded, whole, "state");
    EXPECT_EQ(loaded.passes(), 4u);
    EXPECT_EQ(loaded.nonFiniteSamples(), 7u);
    for (int frame = 0; frame < 3; ++frame) {
        EXPECT_EQ(loaded.mean(frame).pixels, film.mean(frame).pixels);
        EXPECT_EQ(loaded.standardError(frame).pixels, film.standardError(frame).pixels);
    }
    EXPECT_EQ(loaded.standardErrorOverFrames().pixels, film.standardErrorOverFrames().pixels);
    std::stringstream cut(stream.str().substr(0, stream.str().size() - 5));
    EXPECT_THROW(FilmRows::readState(loaded, cut, "state"), InputError);
    EXPECT_EQ(loaded.passes(), 4u) << "a failed read must leave the film alone";
    std::stringstream foreign("not a state at all, but long enough to look like one ..........................");
    EXPECT_THROW(FilmRows::readState(loaded, foreign, "state"), InputError);
    Film other(4, 2, 3);
    std::stringstream again(stream.str());
    EXPECT_THROW(FilmRows::readState(other, again, "state"), InputError);
}

TEST(Film, AbsurdSizesAreRefused) {
    EXPECT_THROW(Film(60000, 60000, 1000), InputError);
}

} // namespace
} // namespace tungsten
