// What a film keeps when asked for less, and what rows without light cost.

#include "tungsten/core/Errors.h"
#include "tungsten/core/Random.h"
#include "tungsten/film/Film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

namespace tungsten {
namespace {

constexpr int Width = 5, Height = 4, Frames = 6;

/// Light in the middle rows of every other frame, in some passes only.
Film litBetween(const FilmContents& contents, int passes = 6) {
    Film film(Width, Height, Frames, contents);
    for (int pass = 0; pass < passes; ++pass) {
        Sampler sampler(11, RandomStream::Test, uint32_t(pass), 0);
        film.beginPass();
        for (int frame = 0; frame < Frames; frame += 2)
            for (int y = 1; y < Height - 1 && pass % 3 != 0; ++y)
                for (int x = 0; x < Width; ++x)
                    film.add(frame, x, y, Rgb(sampler.next1D(), 2.0f * sampler.next1D(), 0.5f));
        film.endPass(1.0 + pass);
    }
    return film;
}

TEST(FilmContents, LuminanceIsThatOfTheColours) {
    const Film colours = litBetween({}), grey = litBetween({1, true});
    for (int frame = 0; frame < Frames; ++frame) {
        const Image whole = colours.mean(frame), mean = grey.mean(frame);
        for (size_t i = 0; i < whole.pixels.size(); ++i)
            EXPECT_NEAR(mean.pixels[i].x, luminanceOf(whole.pixels[i]), 1e-6f);
    }
    EXPECT_GT(grey.meanValue(), 0.0);
    EXPECT_LT(grey.memoryBytes(), colours.memoryBytes() / 2);
}

TEST(FilmContents, WithoutMomentsTheWholeFilmsErrorIsKnown) {
    const Film with = litBetween({}), without = litBetween({3, false});
    EXPECT_EQ(without.relativeStandardError(), with.relativeStandardError());
    EXPECT_EQ(without.relativeErrorBound(), with.relativeErrorBound());
    EXPECT_EQ(without.standardErrorOverFrames().pixels, with.standardErrorOverFrames().pixels);
    for (int frame = 0; frame < Frames; ++frame) EXPECT_EQ(without.mean(frame).pixels, with.mean(frame).pixels);
    EXPECT_TRUE(std::isnan(without.standardError(0).at(2, 1).x));
    EXPECT_FALSE(std::isnan(with.standardError(0).at(2, 1).x));
}

/// The error of a whole film is that of its pixels.
TEST(FilmContents, TheFilmsErrorIsTheRootOfThePixelsSquares) {
    const Film film = litBetween({});
    double square = 0.0, mean = 0.0;
    for (int frame = 0; frame < Frames; ++frame) {
        for (const Rgb& error : film.standardError(frame).pixels)
            for (int c = 0; c < 3; ++c) square += double(error[c]) * double(error[c]);
        for (const Rgb& value : film.mean(frame).pixels) mean += double(value.x + value.y + value.z);
    }
    constexpr double Values = 3.0 * Width * Height * Frames;
    EXPECT_NEAR(film.relativeStandardError(), std::sqrt(square / Values) / (mean / Values), 1e-5);
}

TEST(FilmContents, RowsWithoutLightCostNothing) {
    const Film none(Width, Height, Frames), some = litBetween({}, 4);
    constexpr size_t LitRows = size_t(Frames / 2) * (Height - 2);
    EXPECT_GE(some.memoryBytes(), none.memoryBytes() + LitRows * Width * 9 * sizeof(float));
    EXPECT_LE(some.memoryBytes(), none.memoryBytes() + LitRows * Width * 9 * sizeof(float) + 64);
    // A film of 4 GiB of which one row has light: its pages are never touched, and a pass does not walk them.
    Film large(1024, 1024, 120);
    for (int pass = 0; pass < 200; ++pass) {
        large.beginPass();
        large.add(7, 3, 500, Rgb(1.0f));
        large.endPass(1.0);
    }
    EXPECT_FLOAT_EQ(large.mean(7).at(3, 500).x, 1.0f);
    EXPECT_EQ(large.mean(8).at(3, 500).x, 0.0f);
    EXPECT_LT(large.memoryBytes(), size_t(64) << 20);
}

TEST(FilmContents, AddingNothingAndSettingAgain) {
    Film film(2, 1, 1);
    film.beginPass();
    film.add(0, 0, 0, Rgb(0.0f));
    film.add(0, 1, 0, Rgb(2.0f));
    film.set(0, 1, 0, Rgb(3.0f));
    EXPECT_EQ(film.passPixel(0, 1, 0), Rgb(3.0f));
    film.set(0, 1, 0, Rgb(0.0f));
    EXPECT_EQ(film.passPixel(0, 1, 0), Rgb(0.0f));
    film.endPass(1.0);
    film.beginPass();
    EXPECT_EQ(film.passPixel(0, 1, 0), Rgb(0.0f));
    film.add(0, 0, 0, Rgb(std::numeric_limits<float>::infinity()));
    film.endPass(1.0);
    EXPECT_EQ(film.nonFiniteSamples(), 1u);
    EXPECT_EQ(film.meanValue(), 0.0);
}

TEST(FilmContents, PassesMoveAsArrays) {
    Film film(Width, Height, Frames), copy(Width, Height, Frames);
    for (Film* f : {&film, &copy}) f->beginPass();
    film.add(2, 1, 3, Rgb(1.0f, 2.0f, 3.0f));
    const LazyArray& pass = film.passValues();
    copy.setPassValues({pass.begin(), pass.end()});
    film.endPass(2.0);
    copy.endPass(2.0);
    EXPECT_EQ(copy.mean(2).pixels, film.mean(2).pixels);
    EXPECT_EQ(copy.memoryBytes(), film.memoryBytes());
}

TEST(FilmContents, StatesAreOfTheirContents) {
    for (const FilmContents& contents : {FilmContents{1, true}, FilmContents{3, false}, FilmContents{1, false}}) {
        const Film film = litBetween(contents);
        std::stringstream state;
        film.write(state);
        Film loaded(Width, Height, Frames, contents), other(Width, Height, Frames);
        loaded.read(state, "state");
        for (int frame = 0; frame < Frames; ++frame) EXPECT_EQ(loaded.mean(frame).pixels, film.mean(frame).pixels);
        EXPECT_EQ(loaded.relativeErrorBound(), film.relativeErrorBound());
        EXPECT_NEAR(double(loaded.memoryBytes()), double(film.memoryBytes()), 64.0); // of the passes' variances
        std::stringstream again(state.str());
        EXPECT_THROW(other.read(again, "state"), InputError);
    }
}

} // namespace
} // namespace tungsten
