// The bias of kernels as a number: what noise brings to it is taken off, and its bound holds.

#include "tungsten/core/Random.h"
#include "tungsten/film/FilmErrors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tungsten {
namespace {

constexpr int BoardSide = 12;

float gaussian(Sampler& sampler) {
    const float u = std::max(sampler.next1D(), 1e-12f), v = sampler.next1D();
    return std::sqrt(-2.0f * std::log(u)) * std::cos(2.0f * Pi * v);
}

/// Passes whose pixels are `values` in a checkerboard of signs, with Gaussian noise.
void addPasses(Film& film, uint32_t passes, float values, float noise, uint32_t seed) {
    for (uint32_t pass = 0; pass < passes; ++pass) {
        const uint32_t standsFor = passesOfItsBias(pass);
        if (standsFor == 0) continue;
        Sampler sampler(seed, RandomStream::Test, pass, 0);
        film.beginPass();
        for (int y = 0; y < BoardSide; ++y)
            for (int x = 0; x < BoardSide; ++x)
                film.set(0, x, y, Rgb(((x + y) % 2 == 0 ? values : -values) + noise * gaussian(sampler)));
        film.endPass(double(standsFor));
    }
}

Film even(float value) {
    Film film(BoardSide, BoardSide, 1);
    film.beginPass();
    for (int y = 0; y < BoardSide; ++y)
        for (int x = 0; x < BoardSide; ++x) film.set(0, x, y, Rgb(value));
    film.endPass(1.0);
    return film;
}

TEST(KernelBias, MeasuredPassesStandForAllOfThem) {
    uint32_t stoodFor = 0, measured = 0;
    for (uint32_t pass = 0; pass < 4096; ++pass) {
        const uint32_t group = passesOfItsBias(pass);
        stoodFor += group;
        measured += group > 0 ? 1 : 0;
        EXPECT_LE(std::abs(int(stoodFor) - int(pass + 1)), 4) << pass;
    }
    EXPECT_EQ(stoodFor, 4096u);
    EXPECT_LT(measured, 4096u / 3);
    for (uint32_t pass = 0; pass < 16; ++pass) EXPECT_EQ(passesOfItsBias(pass), 1u);
}

/// Films of passes of one variance and unlike weights: the spread of their means against what they claim.
TEST(KernelBias, StandardErrorOfUnlikeWeightsIsThatOfTheirMean) {
    constexpr uint32_t Films = 600, Passes = 40;
    double squared = 0.0, claimed = 0.0, pixels = 0.0;
    for (uint32_t f = 0; f < Films; ++f) {
        Film film(BoardSide, BoardSide, 1, {}, PassWeight::Repeats);
        addPasses(film, Passes, 0.0f, 1.0f, f);
        claimed += film.meanSquaredError();
        for (const Rgb& pixel : film.mean(0).pixels) squared += double(pixel.x) * double(pixel.x);
        pixels += BoardSide * BoardSide;
    }
    // Relative standard error of a variance: sqrt(2 / n).
    EXPECT_NEAR(claimed / Films, squared / pixels, 5.0 * std::sqrt(2.0 / pixels) * squared / pixels);
}

TEST(KernelBias, NoiseIsTakenOff) {
    constexpr int Films = 200;
    const Film film = even(2.0f);
    for (const float bias : {0.0f, 0.2f, 0.4f}) {
        double estimate = 0.0, noise = 0.0, above = 0.0;
        for (uint32_t f = 0; f < Films; ++f) {
            Film biases(BoardSide, BoardSide, 1, {}, PassWeight::Repeats);
            addPasses(biases, 64, bias, 0.5f, 1000 + f);
            const RelativeBias relative = RelativeBias::of(film, biases);
            EXPECT_GE(relative.bound, relative.estimate);
            estimate += relative.estimate / Films;
            noise += std::sqrt(biases.meanSquaredError()) / 2.0 / Films;
            above += relative.estimate > 0.0 ? 1.0 / Films : 0.0;
        }
        const double exact = double(bias) / 2.0;
        EXPECT_GT(noise, 0.05) << "nothing had to be taken off";
        EXPECT_LT(estimate, exact + 0.25 * noise) << bias;
        EXPECT_GT(estimate, 0.75 * exact) << bias;
        if (bias == 0.0f) {
            EXPECT_LT(above, 0.16 + 4.0 * std::sqrt(0.16 * 0.84 / Films)) << "one standard deviation";
        }
    }
}

TEST(KernelBias, IsBeyondItsBoundInOneRenderOfTwenty) {
    constexpr int Films = 200;
    for (const float bias : {0.02f, 0.1f}) {
        const Film film = even(1.0f);
        double beyond = 0.0;
        for (uint32_t f = 0; f < Films; ++f) {
            Film biases(BoardSide, BoardSide, 1, {}, PassWeight::Repeats);
            addPasses(biases, 32, bias, 0.5f, 5000 + f);
            beyond += RelativeBias::of(film, biases).bound < double(bias) ? 1.0 / Films : 0.0;
        }
        EXPECT_LE(beyond, 0.05 + 4.0 * std::sqrt(0.05 * 0.95 / Films)) << bias;
    }
}

/// What a box of this radius adds to a step from 0 to 1 between two pixels, in the mean of the pixel `offset` pixels
/// Where row y of the board steps from 0 to 1: aslant through the pixels.
double stepOf(int y) {
    return BoardSide / 2 - 0.5 + (y + 0.5) / BoardSide;
}

/// What a box of this radius adds to a step from 0 to 1, in the mean of the pixel that begins `offset` pixels beyond
/// it.
double boxBesideStep(double offset, double radius) {
    constexpr int Parts = 64;
    double sum = 0.0;
    for (int part = 0; part < Parts; ++part) {
        const double place = offset + (part + 0.5) / Parts;
        sum += std::clamp(0.5 + 0.5 * place / radius, 0.0, 1.0) - (place > 0.0 ? 1.0 : 0.0);
    }
    return sum / Parts;
}

/// A body's outline: half of the image is dark. Kernels of half a pixel to four pixels; noise makes one bound in
/// twenty too low.
TEST(KernelBias, BoundHoldsBesideAStep) {
    constexpr int Films = 200, Passes = 32;
    for (const double radius : {0.5, 1.0, 2.0, 4.0}) {
        double exact = 0.0, beyond = 0.0, tooLow = 0.0;
        Film film(BoardSide, BoardSide, 1);
        film.beginPass();
        for (int y = 0; y < BoardSide; ++y)
            for (int x = 0; x < BoardSide; ++x) {
                film.set(0, x, y, Rgb(std::clamp(float(x + 1 - stepOf(y)), 0.0f, 1.0f)));
                exact += std::pow(boxBesideStep(x - stepOf(y), radius), 2) / (BoardSide * BoardSide);
            }
        film.endPass(1.0);
        exact = std::sqrt(exact) / meanValue(film);
        for (uint32_t f = 0; f < Films; ++f) {
            Film biases(BoardSide, BoardSide, 1, {}, PassWeight::Repeats);
            for (uint32_t pass = 0; pass < Passes; ++pass) {
                Sampler sampler(9000 + f, RandomStream::Test, pass, 0);
                biases.beginPass();
                for (int y = 0; y < BoardSide; ++y)
                    for (int x = 0; x < BoardSide; ++x) {
                        const double difference = boxBesideStep(x - stepOf(y), radius) -
                                                  boxBesideStep(x - stepOf(y), radius * std::sqrt(0.5));
                        biases.set(0, x, y, Rgb(float(2.0 * difference) + 0.1f * gaussian(sampler)));
                    }
                biases.endPass(double(passesOfItsBias(0)));
            }
            const RelativeBias relative = RelativeBias::of(film, biases);
            beyond += relative.bound < exact ? 1.0 / Films : 0.0;
            tooLow += relative.estimate < 0.9 * exact ? 1.0 / Films : 0.0;
        }
        EXPECT_GT(tooLow, 0.5) << radius << ": the estimate alone would not do";
        EXPECT_LE(beyond, 0.05 + 4.0 * std::sqrt(0.05 * 0.95 / Films)) << radius;
    }
}

TEST(KernelBias, IsUnknownWithoutFiveMeasuredPasses) {
    const Film film = even(1.0f);
    Film biases(BoardSide, BoardSide, 1, {}, PassWeight::Repeats);
    EXPECT_TRUE(std::isnan(RelativeBias::of(film, biases).estimate));
    addPasses(biases, 4, 0.1f, 0.0f, 1);
    EXPECT_TRUE(std::isnan(RelativeBias::of(film, biases).estimate));
    addPasses(biases, 1, 0.1f, 0.0f, 2);
    EXPECT_NEAR(RelativeBias::of(film, biases).estimate, 0.1, 1e-6);
    EXPECT_NEAR(RelativeBias::of(film, biases).bound, 0.1 * (1.0 - 0.5) / (1.0 - std::sqrt(0.5)), 1e-4)
        << "were it beside an edge";
    EXPECT_TRUE(std::isnan(RelativeBias::of(even(0.0f), biases).estimate)) << "black";
}

} // namespace
} // namespace tungsten
