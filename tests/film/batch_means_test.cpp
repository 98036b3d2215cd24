// Batches of passes, and films that are folded apart by rows.

#include "tungsten/film/Film.h"
#include "tungsten/film/FilmRows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

namespace tungsten {
namespace {

constexpr int BatchedWidth = 7, BatchedHeight = 6,
              BatchedFrames = 3; // blocks of 4: 2 columns, the last of 3 pixels; 2 rows, the last of 2
constexpr FilmContents Batched{3, true, 5, 4};

/// A pass with light in some rows of frames only; what varies from pass to pass is one number.
void addPass(Film& film, float value, uint32_t pass) {
    film.beginPass();
    for (int frame = 0; frame < BatchedFrames; ++frame)
        for (int y = 0; y < BatchedHeight; ++y)
            for (int x = 0; x < BatchedWidth; ++x)
                if (frame != 2 || pass > 3)
                    film.add(frame, x, y, Rgb(value * float(1 + frame), value * float(x), 1.0f));
}

std::vector<float> passValues(uint32_t count) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal(5.0f, 1.0f);
    std::vector<float> values(count);
    for (float& value : values) value = normal(random);
    return values;
}

Film rendered(const FilmContents& contents, uint32_t passes) {
    Film film(BatchedWidth, BatchedHeight, BatchedFrames, contents);
    const std::vector<float> values = passValues(passes);
    for (uint32_t pass = 0; pass < passes; ++pass) {
        addPass(film, values[pass], pass);
        film.endPass(pass + 1 == passes ? 1.0 : 2.0);
    }
    return film;
}

float batchValue(const BatchMeans& batches, int batch, int frame, int row, int column, int channel) {
    const size_t at = (((size_t(batch) * BatchedFrames + size_t(frame)) * size_t(batches.rows()) + size_t(row)) *
                           size_t(batches.columns()) +
                       size_t(column)) *
                          3 +
                      size_t(channel);
    return batches.means()[at];
}

TEST(BatchMeans, TheirMeanIsTheFilmsOverTheBlock) {
    const Film film = rendered(Batched, 23);
    const BatchMeans& batches = film.batches();
    ASSERT_EQ(batches.columns(), 2);
    ASSERT_EQ(batches.rows(), 2);
    for (int frame = 0; frame < BatchedFrames; ++frame) {
        const Image mean = film.mean(frame);
        double inBatches = 0.0, inFilm = 0.0;
        for (int batch = 0; batch < 5; ++batch)
            inBatches += batches.weights()[size_t(batch)] * double(batchValue(batches, batch, frame, 1, 1, 1));
        for (int y = 4; y < 6; ++y)
            for (int x = 4; x < 7; ++x) inFilm += double(mean.at(x, y).y) / 6.0;
        EXPECT_NEAR(inBatches / film.totalWeight(), inFilm, 1e-5 * inFilm) << frame;
    }
}

TEST(BatchMeans, TheirSpreadIsTheErrorOfWhatVariesAsOne) {
    constexpr uint32_t Passes = 5000;
    const BatchMeans batches = rendered({3, true, 50, 4}, Passes).batches();
    double sum = 0.0, squares = 0.0;
    for (int batch = 0; batch < 50; ++batch) {
        const double value = double(batchValue(batches, batch, 0, 0, 0, 0));
        sum += value / 50.0;
        squares += value * value / 50.0;
    }
    const double error = std::sqrt((squares - sum * sum) / 49.0), expected = 1.0 / std::sqrt(double(Passes));
    EXPECT_NEAR(error, expected, 4.0 * expected / std::sqrt(2.0 * 49.0)); // pixels as independent: a quarter of it
}

TEST(BatchMeans, CostNothingWithoutThem) {
    const Film film = rendered({}, 3);
    EXPECT_EQ(film.batches().count(), 0);
    EXPECT_TRUE(film.batches().means().empty());
}

std::string stateOf(const Film& film) {
    std::ostringstream out;
    FilmRows::writeState(film, out);
    return out.str();
}

TEST(FilmRows, FoldedApartAndPutTogetherAreOneFilm) {
    for (const FilmContents& contents : {FilmContents{}, Batched, FilmContents{1, false}}) {
        constexpr uint32_t Passes = 12;
        const std::vector<float> values = passValues(Passes);
        Film parts[] = {Film(BatchedWidth, BatchedHeight, BatchedFrames, contents),
                        Film(BatchedWidth, BatchedHeight, BatchedFrames, contents)};
        const int bounds[] = {0, 4, BatchedHeight};
        for (uint32_t pass = 0; pass < Passes; ++pass) {
            Film whole(BatchedWidth, BatchedHeight, BatchedFrames, contents);
            addPass(whole, values[pass], pass);
            AccumulatedPass folded;
            for (int part = 0; part < 2; ++part) {
                parts[part].beginPass();
                for (int frame = 0; frame < BatchedFrames; ++frame)
                    for (int y = bounds[part]; y < bounds[part + 1]; ++y) {
                        const auto row = size_t(frame * BatchedHeight + y);
                        if (!FilmRows::isLit(whole, row)) continue;
                        std::vector<float> rowOf(FilmRows::values(whole));
                        FilmRows::readPass(whole, row, rowOf.data());
                        FilmRows::setPass(parts[part], row, rowOf.data());
                    }
                const AccumulatedPass some =
                    FilmRows::accumulate(parts[part], pass + 1 == Passes ? 1.0 : 2.0, bounds[part], bounds[part + 1]);
                folded.pass = some.pass;
                folded.weight = some.weight;
                folded.weightBefore = some.weightBefore;
                folded.squaresBefore = some.squaresBefore;
                folded.rows.insert(folded.rows.end(), some.rows.begin(), some.rows.end());
            }
            FilmRows::finish(parts[0], folded);
        }
        std::stringstream rows;
        FilmRows::write(parts[1], rows, 4, BatchedHeight);
        FilmRows::read(parts[0], rows, 4, BatchedHeight);
        EXPECT_EQ(stateOf(parts[0]), stateOf(rendered(contents, Passes)));
    }
}

TEST(FilmRows, StatesHoldBatches) {
    const Film film = rendered(Batched, 6);
    std::stringstream state(stateOf(film)), again(stateOf(film));
    Film loaded(BatchedWidth, BatchedHeight, BatchedFrames, Batched),
        other(BatchedWidth, BatchedHeight, BatchedFrames, {3, true, 5, 3});
    FilmRows::readState(loaded, state, "state");
    EXPECT_EQ(loaded.batches().means(), film.batches().means());
    EXPECT_EQ(loaded.batches().weights(), film.batches().weights());
    EXPECT_ANY_THROW(FilmRows::readState(other, again, "state"));
}

} // namespace
} // namespace tungsten
