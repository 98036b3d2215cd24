// The film's moments, image files, tone maps.

#include "support/SceneFile.h"

#include "tungsten/core/Errors.h"
#include "tungsten/core/Random.h"
#include "tungsten/film/Film.h"
#include "tungsten/film/FilmErrors.h"
#include "tungsten/film/FilmRows.h"
#include "tungsten/image/AtomicFile.h"
#include "tungsten/image/ReadImage.h"
#include "tungsten/io/Outputs.h"
#include "tungsten/io/Writers.h"

#include <gtest/gtest.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <sstream>

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

/// What is told when something is brought to the disk: whether that is a folder. Its error number is returned.
std::function<int(bool)> onSync;

} // namespace

/// Stands before the system's, also for the library under test.
extern "C" __attribute__((visibility("default"))) int fsync(int descriptor) {
    struct stat status {};
    if (!onSync || ::fstat(descriptor, &status) != 0) return int(::syscall(SYS_fsync, descriptor));
    errno = onSync(S_ISDIR(status.st_mode));
    return errno == 0 ? 0 : -1;
}

namespace tungsten {
namespace {

using test::TemporaryFolder;

Image gradient(int width, int height) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image.at(x, y) = Rgb(float(x) + 0.25f, float(y) * 0.5f, 1e-3f * float(x * y));
    return image;
}

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

TEST(ImageIo, PfmRoundTripsAndNamesDamage) {
    const TemporaryFolder folder;
    const Image image = gradient(5, 3);
    writePfm(folder.path() / "a.pfm", image);
    EXPECT_EQ(readPfm(folder.path() / "a.pfm").pixels, image.pixels);
    std::filesystem::resize_file(folder.path() / "a.pfm", 100);
    EXPECT_THROW(readPfm(folder.path() / "a.pfm"), InputError);
    EXPECT_THROW(readPfm(folder.path() / "none.pfm"), InputError);
}

TEST(ImageIo, ExrKeepsLayersAndParts) {
    const TemporaryFolder folder;
    const Image image = gradient(7, 4), error = gradient(7, 4);
    writeExr(folder.path() / "one.exr", {ExrPart{"", image, error, true, 1.5, 2.0}});
    EXPECT_EQ(exrPartCount(folder.path() / "one.exr"), 1);
    EXPECT_EQ(readExr(folder.path() / "one.exr").pixels, image.pixels);
    EXPECT_EQ(readExr(folder.path() / "one.exr", 0, "stderr.").pixels, error.pixels);
    std::vector<ExrPart> parts;
    for (int i = 0; i < 3; ++i)
        parts.push_back({"frame." + std::to_string(i), image, error, true, double(i), double(i) + 1.0});
    parts[2].colour.at(0, 0) = Rgb(42.0f);
    writeExr(folder.path() / "many.exr", parts);
    EXPECT_EQ(exrPartCount(folder.path() / "many.exr"), 3);
    EXPECT_EQ(readExr(folder.path() / "many.exr", 2).at(0, 0), Rgb(42.0f));
    EXPECT_THROW(readExr(folder.path() / "one.exr", 0, "nothing."), InputError);
}

/// As the format stores it: the attribute's name and type, a size, and the value.
double doubleAttribute(const std::string& exr, const std::string& name) {
    const std::string start = name + '\0' + "double" + '\0' + std::string("\x08\0\0\0", 4);
    const size_t at = exr.find(start);
    double value = std::numeric_limits<double>::quiet_NaN();
    if (at != std::string::npos) std::memcpy(&value, exr.data() + at + start.size(), sizeof value);
    return value;
}

TEST(ImageIo, AnExrSaysWhenItsFrameStartsAndEnds) {
    const TemporaryFolder folder;
    writeExr(folder.path() / "a.exr", {ExrPart{"", gradient(2, 2), {}, true, 1.5, 2.25}});
    std::ifstream in(folder.path() / "a.exr", std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(in), {});
    EXPECT_EQ(doubleAttribute(bytes, "timeStart"), 1.5);
    EXPECT_EQ(doubleAttribute(bytes, "timeEnd"), 2.25);
}

/// Bytes.
double peakMemory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * double(usage.ru_maxrss);
}

TEST(ImageIo, ManyPartsOfAnExrTakeLittleMemory) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "what is freed stays";
#endif
    const TemporaryFolder folder;
    constexpr int Parts = 400;
    Image noise(256, 64);
    Sampler random(7, RandomStream::Test, 0, 0);
    for (Rgb& pixel : noise.pixels) pixel = Rgb(random.next1D(), random.next1D(), random.next1D());
    const double before = peakMemory();
    writeExr(folder.path() / "many.exr", Parts, [&](int i) {
        return ExrPart{"frame." + std::to_string(i), noise, noise, true, double(i), double(i) + 1.0};
    });
    EXPECT_LT(peakMemory() - before, 40e6) << "131 MB in blocks of 16 lines, which are kept for each part";
    EXPECT_EQ(readExr(folder.path() / "many.exr", Parts - 1, "stderr.").pixels, noise.pixels);
}

TEST(ImageIo, PartsAreMadeOneByOneAndWrittenAsIfAllWereThere) {
    const TemporaryFolder folder;
    const auto named = [&](const char* name) { return folder.path() / name; };
    const auto bytesOf = [](const std::filesystem::path& file) {
        std::ifstream in(file, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    std::vector<Image> images;
    std::vector<ExrPart> parts;
    for (int i = 0; i < 3; ++i) {
        images.push_back(gradient(5, 3));
        images.back().at(0, 0) = Rgb(float(40 + i));
        parts.push_back({"frame." + std::to_string(i), images.back(), gradient(5, 3), true, 1.0 * i, 1.0 + i});
    }
    std::vector<int> asked;
    const auto part = [&](int i) {
        asked.push_back(i);
        return parts[size_t(i)];
    };
    writeExr(named("all.exr"), parts, "what it is");
    writeExr(named("each.exr"), 3, part, "what it is");
    EXPECT_EQ(bytesOf(named("each.exr")), bytesOf(named("all.exr")));
    EXPECT_EQ(asked, (std::vector<int>{0, 1, 2, 0, 1, 2}));
    const std::vector<Image> frames(4, images[0]);
    writeNpy(named("all.npy"), frames);
    writeNpy(named("each.npy"), 4, [&](int i) { return frames[size_t(i)]; });
    EXPECT_EQ(bytesOf(named("each.npy")), bytesOf(named("all.npy")));
}

TEST(ImageIo, NumpyReadsTheCube) {
    if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0)
        GTEST_SKIP() << "python3-numpy is not installed";
    const TemporaryFolder folder;
    writeNpy(folder.path() / "cube.npy", {gradient(5, 3), gradient(5, 3), gradient(5, 3), gradient(5, 3)});
    const std::string script = "import numpy as n; a = n.load('" + (folder.path() / "cube.npy").string() +
                               "'); assert a.shape == (4, 3, 5, 3) and a.dtype == n.float32, a.shape; "
                               "assert a[2, 1, 4, 0] == 4.25 and a[3, 2, 0, 1] == 1.0";
    EXPECT_EQ(std::system(("/usr/bin/python3 -c \"" + script + "\"").c_str()), 0);
}

TEST(ImageIo, FailedWritesKeepTheOldFile) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "image.pfm";
    writePfm(file, gradient(2, 2));
    EXPECT_THROW(writePfm(folder.path() / "missing" / "image.pfm", gradient(2, 2)), InputError);
    // An EXR that cannot be made (parts of one name twice) leaves neither a new file nor a temporary one.
    EXPECT_THROW(writeExr(file, {ExrPart{"same", gradient(2, 2), {}, false, 0, 0},
                                 ExrPart{"same", gradient(2, 2), {}, false, 0, 0}}),
                 InputError);
    EXPECT_EQ(readPfm(file).pixels, gradient(2, 2).pixels);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

/// The bytes before the name, then the name: a crash leaves the old file or the new one.
TEST(AtomicFile, IsBroughtToTheDiskBeforeAndAfterItHasItsName) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "a.txt";
    std::vector<std::string> synced;
    onSync = [&](bool isFolder) {
        const std::string name = std::filesystem::exists(file) ? ", named" : ", unnamed";
        synced.push_back((isFolder ? "folder" : "file") + name);
        return 0;
    };
    writeAtomically(file, [](std::ostream& out) { out << "new"; });
    EXPECT_EQ(synced, (std::vector<std::string>{"file, unnamed", "folder, named"}));
    // A disk that fails then.
    onSync = [](bool isFolder) { return isFolder ? 0 : EIO; };
    EXPECT_THROW(writeAtomically(file, [](std::ostream& out) { out << "newer"; }), InputError);
    onSync = {};
    std::string content;
    std::ifstream(file) >> content;
    EXPECT_EQ(content, "new");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

/// However long its writer has not touched it.
TEST(AtomicFile, IsNotRemovedWhileItIsWritten) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "a.txt";
    writeAtomically(file, [&](std::ostream& out) {
        for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
            std::filesystem::last_write_time(entry,
                                             std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
        removeAbandonedFiles(folder.path());
        EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
        out << "whole";
    });
    EXPECT_TRUE(std::filesystem::exists(file));
}

TEST(ImageIo, FrameNamesSortAsFramesDo) {
    EXPECT_EQ(framePath("out/result.pfm", 7, 8), "out/result_07.pfm");
    EXPECT_EQ(framePath("out/result.pfm", 99, 100), "out/result_99.pfm");
    EXPECT_EQ(framePath("out/result.pfm", 99, 101), "out/result_099.pfm");
    EXPECT_EQ(framePath("out/result.pfm", 1000, 1001), "out/result_1000.pfm");
}

TEST(ToneMap, Values) {
    EXPECT_FLOAT_EQ(applyToneMap(ToneMap::Linear, Rgb(-1.0f)).x, 0.0f);
    EXPECT_NEAR(applyToneMap(ToneMap::Gamma, Rgb(0.5f)).x, 0.72974f, 1e-5f);
    EXPECT_NEAR(applyToneMap(ToneMap::Reinhard, Rgb(1.0f)).x, 0.72974f, 1e-5f);
    EXPECT_NEAR(applyToneMap(ToneMap::Pbrt, Rgb(0.002f)).x, 0.02584f, 1e-5f);
    EXPECT_NEAR(applyToneMap(ToneMap::Pbrt, Rgb(0.5f)).x, 0.735357f, 1e-5f);
    const double x = 0.496;
    EXPECT_NEAR(double(applyToneMap(ToneMap::Filmic, Rgb(0.5f)).x), x * (6.2 * x + 0.5) / (x * (6.2 * x + 1.7) + 0.06),
                1e-5);
    EXPECT_EQ(toLdr(Rgb(0.999f, 1.0f, 3.0f)), (std::array<uint8_t, 3>{254, 255, 255}));
    EXPECT_EQ(toneMapNames().size(), 5u);
}

} // namespace
} // namespace tungsten
