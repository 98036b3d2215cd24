// What a film keeps when asked for less, and what rows without light cost.

#include "tungsten/core/Errors.h"
#include "tungsten/core/Random.h"
#include "tungsten/film/Film.h"
#include "tungsten/film/FilmErrors.h"
#include "tungsten/film/FilmRows.h"

#include <gtest/gtest.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

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
    EXPECT_GT(meanValue(grey), 0.0);
    EXPECT_LT(grey.memoryBytes(), colours.memoryBytes() / 2);
}

TEST(FilmContents, WithoutMomentsTheWholeFilmsErrorIsKnown) {
    const Film with = litBetween({}), without = litBetween({3, false});
    EXPECT_EQ(relativeStandardError(without), relativeStandardError(with));
    EXPECT_EQ(relativeErrorBound(without), relativeErrorBound(with));
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
    EXPECT_NEAR(relativeStandardError(film), std::sqrt(square / Values) / (mean / Values), 1e-5);
}

TEST(FilmContents, RowsAndTilesWithoutLightCostNothing) {
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

TEST(FilmContents, TilesAreOfSixteenPixels) {
    constexpr int Wide = 40; // the third tile has 8 pixels
    const size_t tile = 16 * 9 * sizeof(float);
    Film film(Wide, 2, 2);
    const size_t none = film.memoryBytes();
    for (const int x : {3, 15, 16, 39}) {
        film.beginPass();
        film.add(1, x, 1, Rgb(1.0f + float(x), 2.0f, 0.5f));
        film.endPass(1.0);
        EXPECT_NEAR(double(film.memoryBytes() - none), double(tile * (x < 16 ? 1 : x < 32 ? 2 : 3)), 64.0) << x;
    }
    std::stringstream state;
    FilmRows::writeState(film, state);
    Film loaded(Wide, 2, 2);
    FilmRows::readState(loaded, state, "state");
    const Film copy = loaded;
    for (int x = 0; x < Wide; ++x) {
        const bool lit = x == 3 || x == 15 || x == 16 || x == 39;
        EXPECT_EQ(copy.mean(1).at(x, 1), film.mean(1).at(x, 1)) << x;
        EXPECT_FLOAT_EQ(copy.mean(1).at(x, 1).x, lit ? (1.0f + float(x)) / 4.0f : 0.0f) << x;
        EXPECT_EQ(copy.standardError(1).at(x, 1), film.standardError(1).at(x, 1)) << x;
        EXPECT_EQ(copy.mean(0).at(x, 1), Rgb(0.0f)) << x;
    }
}

TEST(FilmContents, ThreadsMakeTilesTogether) {
    // Neighbours by different threads: each tile is asked for by many at once.
    constexpr int Wide = 64, Deep = 400;
    Film film(Wide, 1, Deep);
    for (int pass = 0; pass < 3; ++pass) {
        film.beginPass();
        tbb::parallel_for(tbb::blocked_range<int>(0, Wide, 1), [&](const tbb::blocked_range<int>& columns) {
            for (int frame = 0; frame < Deep; ++frame)
                for (int x = columns.begin(); x < columns.end(); ++x) film.add(frame, x, 0, Rgb(float(x + frame)));
        });
        film.endPass(1.0);
    }
    EXPECT_EQ(film.memoryBytes(), Film(film).memoryBytes());
    for (int frame = 0; frame < Deep; ++frame)
        for (int x = 0; x < Wide; ++x) ASSERT_EQ(film.mean(frame).at(x, 0), Rgb(float(x + frame))) << frame << ' ' << x;
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
    EXPECT_EQ(meanValue(film), 0.0);
}

TEST(FilmContents, PassesMoveAsRows) {
    Film film(Width, Height, Frames), copy(Width, Height, Frames);
    for (Film* f : {&film, &copy}) f->beginPass();
    film.add(2, 1, 3, Rgb(1.0f, 2.0f, 3.0f));
    std::vector<float> values(FilmRows::values(film));
    for (size_t row = 0; row < FilmRows::count(film); ++row) {
        FilmRows::readPass(film, row, values.data());
        if (FilmRows::isLit(film, row)) FilmRows::setPass(copy, row, values.data());
    }
    film.endPass(2.0);
    copy.endPass(2.0);
    EXPECT_EQ(copy.mean(2).pixels, film.mean(2).pixels);
    EXPECT_EQ(copy.memoryBytes(), film.memoryBytes());
}

TEST(FilmContents, StatesAreOfTheirContents) {
    for (const FilmContents& contents : {FilmContents{1, true}, FilmContents{3, false}, FilmContents{1, false}}) {
        const Film film = litBetween(contents);
        std::stringstream state;
        FilmRows::writeState(film, state);
        Film loaded(Width, Height, Frames, contents), other(Width, Height, Frames);
        FilmRows::readState(loaded, state, "state");
        for (int frame = 0; frame < Frames; ++frame) EXPECT_EQ(loaded.mean(frame).pixels, film.mean(frame).pixels);
        EXPECT_EQ(relativeErrorBound(loaded), relativeErrorBound(film));
        EXPECT_NEAR(double(loaded.memoryBytes()), double(film.memoryBytes()), 64.0); // of the passes' variances
        std::stringstream again(state.str());
        EXPECT_THROW(FilmRows::readState(other, again, "state"), InputError);
    }
}

} // namespace
} // namespace tungsten
