// Names of the files a render writes, and what is in them.

#include "app/command.h"
#include "session/fake_integrator.h"

#include "tungsten/image/ReadImage.h"
#include "tungsten/image/ToneMap.h"
#include "tungsten/io/Outputs.h"
#include "tungsten/io/Result.h"
#include "tungsten/texture/Texture.h"

#include <gtest/gtest.h>

#include <array>

namespace tungsten {
namespace {

namespace fs = std::filesystem;
using test::SessionFixture;
using test::ThreeFrames;
using test::tinyScene;

RendererSettings settings(const std::string& ldr, const std::string& hdr = "") {
    RendererSettings renderer;
    renderer.outputFile = ldr;
    renderer.hdrOutputFile = hdr;
    return renderer;
}

std::string errorOf(const OutputFiles& outputs) {
    try {
        checkOutputs(outputs, {});
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(Outputs, NamesAreRelativeToTheOutputDirectoryOfTheScene) {
    RendererSettings renderer = settings("a.png", "sub/b.exr");
    renderer.outputDirectory = "out";
    renderer.transients.push_back({"frames/f.png", ""});
    const OutputFiles outputs = resolveOutputs(renderer, "scenes/box/scene.json", {});
    EXPECT_EQ(outputs.ldr, "scenes/box/out/a.png");
    EXPECT_EQ(outputs.hdr, "scenes/box/out/sub/b.exr");
    EXPECT_EQ(outputs.state, "scenes/box/out/aState.dat");
    ASSERT_EQ(outputs.series.size(), 1u);
    EXPECT_EQ(outputs.series[0].ldrFile, "scenes/box/out/frames/f.png");
    EXPECT_EQ(outputs.series[0].hdrFile, "");
    EXPECT_TRUE(outputs.statistics.empty());
}

TEST(Outputs, TheCommandLineWins) {
    OutputOverrides overrides;
    overrides.ldr = "mine.png";
    EXPECT_EQ(resolveOutputs(settings("a.png"), "scenes/s.json", overrides).ldr, "mine.png")
        << "-o is relative to the process";
    overrides.directory = "there";
    const OutputFiles outputs = resolveOutputs(settings("a.png", "b.pfm"), "scenes/s.json", overrides);
    EXPECT_EQ(outputs.ldr, "there/mine.png") << "-d rebases -o";
    EXPECT_EQ(outputs.hdr, "there/b.pfm") << "and the scene's names";
    EXPECT_EQ(outputs.state, "there/mineState.dat");
    for (auto* name :
         {&overrides.ldr, &overrides.hdr, &overrides.statistics, &overrides.page, &overrides.sheet, &overrides.video})
        *name = "x/file";
    const OutputFiles all = resolveOutputs(settings("a.png"), "scenes/s.json", overrides);
    for (const auto& file : {all.ldr, all.hdr, all.statistics, all.page, all.sheet, all.video})
        EXPECT_EQ(file, "there/x/file") << "-d rebases whatever the command line names";
    overrides.statistics = "/else/where";
    EXPECT_EQ(resolveOutputs(settings("a.png"), "scenes/s.json", overrides).statistics, "/else/where")
        << "but not what is absolute";
    for (const auto& [folder, name, expected] :
         {std::array{"out", "out/a.json", "out/a.json"}, std::array{"a/b/", "./a/b/c.json", "./a/b/c.json"},
          std::array{"out", "outer/a.json", "out/outer/a.json"}, std::array{".", "a.json", "./a.json"},
          std::array{"a/b", "a/c.json", "a/b/a/c.json"}}) {
        overrides.directory = folder;
        EXPECT_EQ(overrides.placed(name), expected) << "what lies there already stays";
    }
    const test::TemporaryFolder folder;
    const auto link = std::filesystem::relative(folder.path() / "link"), file = link.parent_path() / "file";
    std::filesystem::create_symlink("target", link);
    std::ofstream(file) << "old";
    overrides.directory = "out";
    EXPECT_EQ(overrides.placed(link), link);
    EXPECT_EQ(overrides.placed(file), "out" / file);
}

TEST(Outputs, ExistingFilesAreKeptWhenTheSceneSaysSo) {
    const test::TemporaryFolder folder;
    RendererSettings renderer = settings("a.png", "b.pfm");
    renderer.overwriteOutputFiles = false;
    const fs::path scene = folder.path() / "scene.json";
    EXPECT_EQ(resolveOutputs(renderer, scene, {}).ldr, folder.path() / "a.png");
    std::ofstream(folder.path() / "a.png") << "old";
    EXPECT_EQ(resolveOutputs(renderer, scene, {}).ldr, folder.path() / "a001.png");
    std::ofstream(folder.path() / "a001.png") << "old";
    const OutputFiles outputs = resolveOutputs(renderer, scene, {});
    EXPECT_EQ(outputs.ldr, folder.path() / "a002.png");
    EXPECT_EQ(outputs.hdr, folder.path() / "b.pfm");
}

TEST(Outputs, UnknownExtensionsNameTheAcceptedOnes) {
    const test::TemporaryFolder folder;
    EXPECT_NE(errorOf({folder.path() / "a.jpg", {}, {}, {}, {}, {}, {}}).find("accepted: .png"), std::string::npos);
    EXPECT_NE(errorOf({folder.path() / "a.png", folder.path() / "b.hdr", {}, {}, {}, {}, {}})
                  .find("accepted: .exr, .npz, .h5, .pfm or .npy"),
              std::string::npos);
    EXPECT_EQ(errorOf({folder.path() / "a.PNG", folder.path() / "b.EXR", {}, {}, {}, {}, {}}), "");
}

/// Their permissions would let the superuser write, as whom tests may run; others are refused by those.
TEST(Outputs, FoldersThatTakeNoFilesAreReported) {
    for (const char* folder : {"/sys", "/dev/pts"}) {
        if (!fs::is_directory(folder)) continue;
        const std::string text = errorOf({fs::path(folder) / "a.png", {}, {}, {}, {}, {}, {}});
        EXPECT_NE(text.find("cannot be created or written to"), std::string::npos) << folder << ": " << text;
    }
}

TEST(Outputs, MissingFoldersAreCreatedAndImpossibleOnesReported) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(errorOf({folder.path() / "x" / "y" / "a.png", {}, {}, {}, {}, {}, {}}), "");
    EXPECT_TRUE(fs::is_directory(folder.path() / "x" / "y"));
    std::ofstream(folder.path() / "file") << "not a folder";
    const std::string text = errorOf({folder.path() / "file" / "a.png", {}, {}, {}, {}, {}, {}});
    EXPECT_NE(text.find("cannot be created or written to"), std::string::npos) << text;
    EXPECT_NE(text.find("-d DIRECTORY"), std::string::npos) << text;
    EXPECT_NE(errorOf({folder.path() / "x", {}, {}, {}, {}, {}, {}}), "") << "no extension";
}

/// OpenEXR holds a header for every frame.
TEST(Outputs, AnExrOfTooManyFramesIsRefused) {
    const test::TemporaryFolder folder;
    const OutputFiles exr{folder.path() / "a.png", folder.path() / "a.exr", {}, {}, {}, {}, {}, {}, {}, false};
    EXPECT_NO_THROW(checkOutputs(exr, {10000}));
    try {
        checkOutputs(exr, {10001});
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("a.exr: cannot hold 10001 frames; .exr takes 10000"),
                  std::string::npos)
            << error.what();
    }
    OutputFiles further{folder.path() / "a.png", {}, {}, {}, {}, {}, {}, {}, {}, false};
    further.colors = {{"", (folder.path() / "b.exr").string()}};
    EXPECT_THROW(checkOutputs(further, {10001}), InputError);
    const OutputFiles npy{folder.path() / "a.png", folder.path() / "a.npy", {}, {}, {}, {}, {}, {}, {}, false};
    EXPECT_NO_THROW(checkOutputs(npy, {1000000}));
}

TEST(Outputs, AFolderInTheWayIsReported) {
    const test::TemporaryFolder folder;
    fs::create_directories(folder.path() / "a.png");
    EXPECT_NE(errorOf({folder.path() / "a.png", {}, {}, {}, {}, {}, {}}).find("a folder has this name"),
              std::string::npos);
}

TEST(Outputs, ASteadyStateExrHoldsTheImageAndItsStandardError) {
    SessionFixture session(tinyScene("", R"("spp": 8, "spp_step": 2, "hdr_output_file": "image.exr")"));
    const SessionResult& result = session.run();
    EXPECT_EQ(exrPartCount(session.outputs.hdr), 1);
    const Image colour = readExr(session.outputs.hdr), error = readExr(session.outputs.hdr, 0, "stderr.");
    EXPECT_EQ(colour.pixels, result.film.mean(0).pixels);
    EXPECT_EQ(error.pixels, result.film.standardError(0).pixels);
    EXPECT_GT(error.at(3, 2).x, 0.0f);
    EXPECT_FALSE(session.has("image.npy")) << "cubes are for sequences";
}

TEST(Outputs, ASequenceBecomesAMultiPartExrACubeAndASeries) {
    SessionFixture session(tinyScene(ThreeFrames, R"("spp": 4, "spp_step": 2, "hdr_output_file": "image.exr")"));
    const SessionResult& result = session.run();
    ASSERT_EQ(exrPartCount(session.outputs.hdr), 3);
    for (int frame = 0; frame < 3; ++frame)
        EXPECT_EQ(readExr(session.outputs.hdr, frame).pixels, result.film.mean(frame).pixels);
    for (const char* name : {"TungstenRender.png", "TungstenRender_00.png", "TungstenRender_02.png", "image.npy"})
        EXPECT_TRUE(session.has(name)) << name;
    EXPECT_FALSE(session.has("TungstenRender_03.png"));
    EXPECT_FALSE(session.has("image_00.exr")) << "the EXR file holds every frame";
    EXPECT_EQ(result.written.size(), 7u) << "and metadata beside the cube";
    // 128 bytes of header at most, then 3 frames of 4 x 6 pixels of 3 floats.
    EXPECT_EQ(fs::file_size(session.folder() / "image.npy") % 64, (3 * 4 * 6 * 3 * 4) % 64);
}

TEST(Outputs, AnExrSaysWhatWasRenderedAndAnNpyHasItBeside) {
    SessionFixture session(tinyScene(ThreeFrames, R"("spp": 4, "spp_step": 2, "hdr_output_file": "image.exr")"));
    session.run();
    const std::string metadata = readExrMetadata(session.outputs.hdr);
    EXPECT_EQ(metadata, test::contentOf(session.folder() / "image.npy.json"));
    for (const char* part :
         {"\"format\": \"darts-tungsten result\"", "\"frame_num\":3", "\"passes\": 2", "\"kind\": \"frames\""})
        EXPECT_NE(metadata.find(part), std::string::npos) << part << " is not in " << metadata;
}

/// All frames are in one file: no series beside it, and no NPY.
TEST(Outputs, ResultFilesHoldAllFrames) {
    for (const std::string extension : {".npz", ".h5"}) {
        SessionFixture session(tinyScene(ThreeFrames, R"("spp": 4, "hdr_output_file": "image)" + extension + "\""));
        session.run();
        EXPECT_TRUE(session.has("image" + extension));
        EXPECT_FALSE(session.has("image.npy")) << extension;
    }
}

TEST(Outputs, APfmSequenceIsASeriesAndTheMeanOverTheGate) {
    SessionFixture session(tinyScene(ThreeFrames, R"("spp": 4, "spp_step": 2, "hdr_output_file": "image.pfm")"));
    const SessionResult& result = session.run();
    EXPECT_EQ(readPfm(session.folder() / "image.pfm").pixels, result.film.meanOverFrames().pixels);
    EXPECT_EQ(readPfm(session.folder() / "image_01.pfm").pixels, result.film.mean(1).pixels);
    EXPECT_TRUE(session.has("image.npy"));
}

TEST(Outputs, TransientsBuffersNameTheSeries) {
    SessionFixture session(tinyScene(ThreeFrames, R"("spp": 4, "spp_step": 2, "output_buffers": [{"type": "transients",
        "ldr_output_file": "t/ldr.png", "hdr_output_file": "t/hdr.exr"}])"));
    const SessionResult& result = session.run();
    EXPECT_TRUE(session.has("t/ldr_02.png"));
    EXPECT_EQ(readExr(session.folder() / "t" / "hdr_02.exr").pixels, result.film.mean(2).pixels);
    EXPECT_EQ(readExr(session.folder() / "t" / "hdr_02.exr", 0, "stderr.").pixels, result.film.standardError(2).pixels);
    EXPECT_FALSE(session.has("TungstenRender_00.png"));
}

TEST(Outputs, ColorBuffersAreFurtherFilesOfTheImageWithoutItsToneMap) {
    SessionFixture session(tinyScene("", R"("spp": 4, "output_buffers": [{"type": "color",
        "ldr_output_file": "c/linear.png", "hdr_output_file": "c/color.pfm", "sample_variance": true}])"));
    const SessionResult& result = session.run();
    EXPECT_EQ(readPfm(session.folder() / "c/color.pfm").pixels, result.film.mean(0).pixels);
    const auto linear = loadBitmap(session.folder() / "c/linear.png"),
               toned = loadBitmap(session.folder() / "TungstenRender.png");
    const Image image = result.film.mean(0);
    for (size_t i = 0; i < image.pixels.size(); ++i) EXPECT_EQ(linear->ldr[4 * i], toLdr(image.pixels[i])[0]) << i;
    EXPECT_NE(linear->ldr, toned->ldr);
    ASSERT_EQ(session.loaded.diagnostics->warnings.size(), 1u);
    EXPECT_NE(session.loaded.diagnostics->warnings[0].path.find("sample_variance"), std::string::npos);
}

TEST(Outputs, IntegralsAreMeansTimesTheFrameWidth) {
    const std::string renderer = R"("spp": 4, "spp_step": 2, "hdr_output_file": "image.pfm")";
    // A width of 1 leaves a frame's integral equal to its mean, but not that of the sequence.
    for (const float width : {0.5f, 1.0f}) {
        SessionFixture session(tinyScene(R"("start_time": 0, "frame_num": 3, "time_normalization": "integral",
            "transient_time_width": )" + std::to_string(width),
                                         renderer));
        const SessionResult& result = session.run();
        const Image frame = readPfm(session.folder() / "image_01.pfm"), whole = readPfm(session.folder() / "image.pfm");
        for (size_t i = 0; i < frame.pixels.size(); ++i) {
            EXPECT_FLOAT_EQ(frame.pixels[i].x, width * result.film.mean(1).pixels[i].x);
            EXPECT_FLOAT_EQ(whole.pixels[i].x, 3 * width * result.film.meanOverFrames().pixels[i].x);
        }
    }
}

TEST(Outputs, AnImageThatFailsDoesNotKeepTheOthersFromBeingWritten) {
    SessionFixture session(tinyScene("", R"("spp": 4, "spp_step": 2, "hdr_output_file": "image.pfm")"));
    session.integrator.afterPass = [&](const PassInfo&) {
        fs::create_directories(session.folder() / "TungstenRender.png" / "in the way");
    };
    EXPECT_THROW(session.run(), InputError);
    EXPECT_TRUE(session.has("image.pfm"));
}

TEST(Outputs, CheckpointsAreOfTheMainImagesOnly) {
    OutputFiles outputs;
    outputs.ldr = "a.png";
    outputs.hdr = "b.pfm";
    outputs.colors = {{"c.png", "d.exr"}};
    outputs.series = {{"e.png", ""}};
    std::vector<fs::path> files;
    for (const OutputImage& image : plannedImages(outputs, 3, "_checkpoint")) files.push_back(image.file);
    EXPECT_EQ(files, (std::vector<fs::path>{"a_checkpoint.png", "b_checkpoint.pfm"}));
    EXPECT_EQ(plannedImages(outputs, 3, "").size(), 9u) << "four, the cube with its metadata, and three frames";
}

/// Two frames of half a unit from 3 on, in a scene of centimetres where light takes two units of time for one.
TEST(ResultDescription, EdgesAndUnitsAreThoseOfTheScene) {
    Scene scene;
    scene.transport.gate = {false, false, 3.0, 0.5, 2};
    scene.transport.vacuumSpeed = 0.5f;
    EXPECT_EQ(frameEdges(scene.transport.gate), (std::vector<double>{3.0, 3.5, 4.0}));
    EXPECT_TRUE(frameEdgesInPicoseconds(scene).empty()) << "the scene does not say how long its unit is";
    scene.lengthUnit = 0.01;
    const double picoseconds = 1e12 * 0.5 * 0.01 / 299792458.0;
    EXPECT_DOUBLE_EQ(picosecondsPerTime(scene), picoseconds);
    const std::vector<double> edges = frameEdgesInPicoseconds(scene);
    ASSERT_EQ(edges.size(), 3u);
    for (size_t i = 0; i < 3; ++i) EXPECT_DOUBLE_EQ(edges[i], (3.0 + 0.5 * double(i)) * picoseconds);
}

TEST(ResultDescription, BatchMeansHaveTheUnitsOfTheMean) {
    Film film(4, 4, 1, FilmContents{3, true, 2, 4});
    for (const float value : {2.0f, 6.0f}) {
        film.beginPass();
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) film.set(0, x, y, Rgb(value));
        film.endPass(1.0);
    }
    Scene scene;
    scene.transport.gate = {false, false, 3.0, 0.25, 1};
    for (const bool integrate : {false, true}) {
        scene.transport.integrateOverGate = integrate;
        const float units = integrate ? 0.25f : 1.0f;
        EXPECT_EQ(batchMeans(film, scene).values,
                  (std::vector<float>{2 * units, 2 * units, 2 * units, 6 * units, 6 * units, 6 * units}));
    }
}

} // namespace
} // namespace tungsten
