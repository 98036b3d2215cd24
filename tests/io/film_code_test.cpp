// What a page keeps of a film: decoded here as tungsten/page/codec.js does, from the header's description.

#include "tungsten/core/Random.h"
#include "tungsten/io/FilmCode.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <zlib.h>

namespace tungsten {
namespace {

struct Decoded {
    std::vector<double> values;             ///< frames x pixels
    std::vector<double> red, green, errors; ///< frames x blocks
};

size_t blocksOf(const FilmCode& code) {
    const auto along = [&](int size) { return size_t((size + code.block - 1) / code.block); };
    return along(code.width) * along(code.height) * size_t(code.frames);
}

Decoded decode(const FilmCode& code) {
    const size_t samples = size_t(code.width) * size_t(code.height) * size_t(code.frames), blocks = blocksOf(code);
    std::vector<uint8_t> bytes(2 * samples + blocks * (code.hasError ? 3 : 2));
    uLongf size = bytes.size();
    EXPECT_EQ(uncompress(bytes.data(), &size, code.deflated.data(), code.deflated.size()), Z_OK);
    EXPECT_EQ(size, bytes.size());
    Decoded decoded;
    uint16_t value = 0;
    for (size_t i = 0; i < samples; ++i) {
        const int zigzag = bytes[i] + 256 * bytes[samples + i];
        value = uint16_t(value + (zigzag % 2 == 0 ? zigzag / 2 : -(zigzag + 1) / 2));
        decoded.values.push_back(value == 0 ? 0.0 : std::exp2(code.top - (65535 - value) * code.step));
    }
    const auto plane = [&](size_t index, auto&& meaning) {
        std::vector<double> found;
        uint8_t byte = 0;
        for (size_t i = 0; i < blocks; ++i) {
            byte = uint8_t(byte + bytes[2 * samples + index * blocks + i]);
            found.push_back(meaning(byte));
        }
        return found;
    };
    decoded.red = plane(0, [](int byte) { return byte / 255.0; });
    decoded.green = plane(1, [](int byte) { return byte / 255.0; });
    if (code.hasError)
        decoded.errors = plane(2, [&](int byte) {
            return byte == 0 ? 0.0 : std::exp2(code.errorTop - (255 - byte) * FilmCode::ErrorStep);
        });
    return decoded;
}

/// Colours over six orders of magnitude, some black, with errors of a tenth.
FilmImages noisyFilm(int width, int height, int frames) {
    FilmImages film;
    Sampler sampler(1, RandomStream::Test, 0, 0);
    for (int frame = 0; frame < frames; ++frame) {
        film.means.emplace_back(width, height);
        film.standardErrors.emplace_back(width, height);
        for (size_t i = 0; i < film.means.back().pixels.size(); ++i) {
            const float value = i % 7 == 0 ? 0.0f : std::pow(10.0f, 6.0f * sampler.next1D() - 4.0f);
            const Rgb mean = value * Rgb(sampler.next1D(), sampler.next1D(), sampler.next1D());
            film.means.back().pixels[i] = mean;
            film.standardErrors.back().pixels[i] = 0.1f * mean;
        }
    }
    return film;
}

double mean(const Rgb& c) {
    return (double(c.x) + double(c.y) + double(c.z)) / 3.0;
}

TEST(FilmCode, ValuesColoursAndErrorsAreWithinHalfAStep) {
    const FilmImages film = noisyFilm(13, 9, 3);
    const FilmCode code = encodeFilm(film, 1e6);
    EXPECT_EQ(code.step, 1.0 / 1024);
    EXPECT_EQ(code.block, 1);
    ASSERT_TRUE(code.hasError);
    const Decoded decoded = decode(code);
    const double rounding = 1e-5; // of 32-bit logarithms
    for (size_t frame = 0, i = 0; frame < 3; ++frame)
        for (size_t pixel = 0; pixel < 13 * 9; ++pixel, ++i) {
            const Rgb& c = film.means[frame].pixels[pixel];
            if (mean(c) == 0.0) {
                EXPECT_EQ(decoded.values[i], 0.0);
                EXPECT_EQ(decoded.errors[i], 0.0);
                continue;
            }
            EXPECT_NEAR(std::log2(decoded.values[i] / mean(c)), 0.0, 0.5 * code.step + rounding);
            EXPECT_NEAR(std::log2(decoded.errors[i] / (0.1 * mean(c))), 0.0, 0.5 * FilmCode::ErrorStep + rounding);
            EXPECT_NEAR(decoded.red[i], double(c.x) / (3.0 * mean(c)), 0.5 / 255 + rounding);
            EXPECT_NEAR(decoded.green[i], double(c.y) / (3.0 * mean(c)), 0.5 / 255 + rounding);
        }
}

TEST(FilmCode, PrecisionGivesWayToTheBudget) {
    const FilmImages film = noisyFilm(101, 67, 8);
    size_t before = 10000000;
    for (const double budget : {1e6, 1e5, 7e4}) {
        const FilmCode code = encodeFilm(film, budget);
        EXPECT_LT(double(code.deflated.size()), 1.05 * budget);
        EXPECT_LT(code.deflated.size(), before);
        before = code.deflated.size();
        const Decoded decoded = decode(code);
        for (size_t pixel = 0; pixel < 101 * 67; ++pixel) {
            const double expected = mean(film.means[0].pixels[pixel]);
            EXPECT_NEAR(decoded.values[pixel], expected, (std::exp2(0.501 * code.step) - 1.0) * expected);
        }
    }
    const FilmCode coarse = encodeFilm(film, 7e4);
    EXPECT_GT(coarse.block, 1);
    EXPECT_GT(coarse.step, 1.0 / 1024);
}

TEST(FilmCode, BlocksHoldSharesOfTheSumsAndRmsErrors) {
    FilmImages film{{Image(3, 1)}, {Image(3, 1)}};
    film.means[0].pixels = {Rgb(3.0f, 0.0f, 0.0f), Rgb(0.0f, 1.0f, 0.0f), Rgb(0.0f, 0.0f, 1.0f)};
    film.standardErrors[0].pixels = {Rgb(3.0f), Rgb(4.0f), Rgb(1.0f)};
    FilmCode code = encodeFilm(film, 0.0); // the largest blocks: all three pixels are one
    ASSERT_EQ(code.block, 8);
    const Decoded decoded = decode(code);
    ASSERT_EQ(decoded.red.size(), 1u);
    EXPECT_NEAR(decoded.red[0], 0.6, 0.5 / 255);
    EXPECT_NEAR(decoded.green[0], 0.2, 0.5 / 255);
    EXPECT_NEAR(decoded.errors[0], std::sqrt(26.0 / 3.0), 1e-5) << "the only error is the scale's top";
}

TEST(FilmCode, WhatIsNoNumberIsBlack) {
    FilmImages film{{Image(4, 1)}, {}};
    film.means[0].pixels = {Rgb(std::nanf("")), Rgb(-1.0f), Rgb(std::numeric_limits<float>::infinity()), Rgb(8.0f)};
    const FilmCode code = encodeFilm(film, 1e6);
    EXPECT_FALSE(code.hasError);
    const Decoded decoded = decode(code);
    EXPECT_EQ(decoded.values, (std::vector<double>{0.0, 0.0, 0.0, 8.0}));
    EXPECT_NEAR(decoded.red[0], 1.0 / 3.0, 1e-9) << "black is grey";
}

TEST(FilmCode, Base64) {
    const auto encoded = [](const std::string& text) { return base64({text.begin(), text.end()}); };
    EXPECT_EQ(encoded(""), "");
    EXPECT_EQ(encoded("f"), "Zg==");
    EXPECT_EQ(encoded("fo"), "Zm8=");
    EXPECT_EQ(encoded("foobar"), "Zm9vYmFy"); // from the examples of RFC 4648
    EXPECT_EQ(base64({0xfb, 0xff}), "+/8=");
}

} // namespace
} // namespace tungsten
