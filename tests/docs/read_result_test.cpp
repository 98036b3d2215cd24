// The reader of HDF5 that docs/results.md shows.

#include "read_result.h"

#include "tungsten/core/Errors.h"
#include "tungsten/io/Result.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace tungsten {
namespace {

TEST(Results, TheReaderOfThePageReadsWhatWasWritten) {
    const auto file = std::filesystem::temp_directory_path() / ("results-" + std::to_string(::getpid()) + ".h5");
    // More than one tile, not whole ones.
    ResultContent content{70, 65, 3, 3, {}, {}, "{}"};
    const auto value = [](int frame, size_t i) { return float(frame) + 0.5f * float(i % 1000); };
    content.images.push_back({"mean", [&](int frame) {
                                  Image image(content.width, content.height);
                                  for (size_t i = 0; i < image.pixels.size(); ++i)
                                      image.pixels[i] = Rgb(value(frame, i), -value(frame, i), 0.0f);
                                  return image;
                              }});
    writeHdf5(file, content);
    hsize_t shape[4] = {};
    const std::vector<float> values = readResult(file.c_str(), "mean", shape);
    std::filesystem::remove(file);
    EXPECT_EQ(std::vector<hsize_t>(shape, shape + 4), (std::vector<hsize_t>{3, 65, 70, 3}));
    ASSERT_EQ(values.size(), size_t(3 * 65 * 70 * 3));
    for (size_t i = 0; i < values.size(); i += 3) {
        const auto frame = int(i / (65 * 70 * 3));
        const size_t pixel = i / 3 % (65 * 70);
        ASSERT_EQ(values[i], value(frame, pixel)) << i;
        ASSERT_EQ(values[i + 1], -value(frame, pixel)) << i;
    }
}

} // namespace
} // namespace tungsten
