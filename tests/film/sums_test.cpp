// Sums of a pass in single precision.

#include "tungsten/film/Film.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tungsten {
namespace {

/// Rounded to the nearest, sums of so many equal values are up to 1e-2 off; at random, some 2e-5, and nowhere in the
/// mean.
TEST(FilmSums, OfEqualValuesDoNotDrift) {
    constexpr int Splats = 1000000, Values = 32;
    Film film(Values, 1, 1);
    film.beginPass();
    const auto value = [](int x) { return 0.1f + 0.013f * float(x); };
    for (int i = 0; i < Splats; ++i)
        for (int x = 0; x < Values; ++x) film.add(0, x, 0, Rgb(value(x), 1e-3f, 0.0f));
    double drift = 0.0;
    for (int x = 0; x < Values; ++x) {
        const double off = double(film.passPixel(0, x, 0).x) / (double(value(x)) * Splats) - 1.0;
        EXPECT_LT(std::abs(off), 1e-4) << value(x);
        EXPECT_EQ(film.passPixel(0, x, 0).z, 0.0f);
        drift += off / Values;
    }
    EXPECT_LT(std::abs(drift), 2e-5) << "six standard errors";
}

TEST(FilmSums, OfFewValuesAreExactWhereFloatsAre) {
    Film film(1, 1, 1, {.channels = 1});
    film.beginPass();
    for (int i = 0; i < 1000; ++i) film.add(0, 0, 0, Rgb(0.25f));
    EXPECT_NEAR(film.passPixel(0, 0, 0).x, 250.0f, 1e-4f);
    film.set(0, 0, 0, Rgb(0.1f));
    EXPECT_EQ(film.passPixel(0, 0, 0).x, luminanceOf(Rgb(0.1f)));
}

} // namespace
} // namespace tungsten
