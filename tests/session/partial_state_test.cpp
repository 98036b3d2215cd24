// Passes of one render taken apart (`--passes`) and put together again (`tungsten merge`).

#include "app/rendered_scene.h"

#include "tungsten/image/ReadImage.h"
#include "tungsten/session/PartialState.h"
#include "tungsten/session/Passes.h"

#include <sys/resource.h>

namespace tungsten {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::contentOf;
using test::tungsten;

/// A scene of 8 passes, the last of which is a short one.
class Partial : public test::RenderedScene {
  protected:
    [[nodiscard]] CommandResult run(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), {"--quiet", "-d", out().string()});
        arguments.push_back(scene.path().string());
        return tungsten(arguments);
    }
    [[nodiscard]] CommandResult passes(const std::string& range, std::vector<std::string> more = {}) const {
        more.insert(more.end(), {"--passes", range, "--spp", "15", "-t", "1"});
        return run(std::move(more));
    }
    [[nodiscard]] std::string state(const std::string& range) const {
        return (out() / ("box_passes_" + range + ".state")).string();
    }
    /// What one run gives, as "whole.EXTENSION".
    [[nodiscard]] std::string whole(const std::string& extension, std::vector<std::string> more = {}) const {
        more.insert(more.end(), {"--spp", "15", "-o", "whole.png", "-e", "whole" + extension});
        EXPECT_EQ(run(std::move(more)).exitCode, 0);
        return (out() / ("whole" + extension)).string();
    }
    [[nodiscard]] std::string target(const std::string& extension) const {
        return (out() / ("merged" + extension)).string();
    }
    void refusesToMerge(std::vector<std::string> states, int code, const std::vector<std::string>& expected) const {
        states.insert(states.begin(), {"merge", "-e", target(".exr")});
        const CommandResult result = tungsten(states);
        EXPECT_EQ(result.exitCode, code) << result.all();
        for (const std::string& part : expected)
            EXPECT_NE(result.err.find(part), std::string::npos) << "'" << part << "' is not in: " << result.err;
        EXPECT_FALSE(fs::exists(target(".exr")));
    }
};

TEST_F(Partial, SevenStatesOfPathsAreWhatOneRunGivesBitForBit) {
    const std::vector<std::string> frames{"--set", "integrator.start_time=3",
                                          "--set", "integrator.transient_time_width=0.5",
                                          "--set", "integrator.frame_num=4"};
    std::vector<std::string> merge{"merge", "--quiet", "-e", target(".pfm"), "-o", target(".png")};
    for (const std::string range : {"7-8", "0-1", "1-2", "2-4", "5-6", "4-5", "6-7"}) {
        std::string colon = range;
        colon[range.find('-')] = ':';
        ASSERT_EQ(passes(colon, frames).exitCode, 0);
        merge.push_back(state(range));
    }
    const CommandResult result = tungsten(merge);
    ASSERT_EQ(result.exitCode, 0) << result.all();
    (void)whole(".pfm", frames);
    for (const std::string name : {".pfm", ".png", "_00.pfm", "_03.pfm", "_02.png", ".npy"}) {
        EXPECT_FALSE(contentOf(target(name)).empty()) << name;
        EXPECT_EQ(contentOf(target(name)), contentOf(out() / ("whole" + name))) << name;
    }
}

TEST_F(Partial, ErrorsAndMetadataAreThoseOfOneRun) {
    ASSERT_EQ(passes("0:3").exitCode, 0);
    ASSERT_EQ(passes("3:8").exitCode, 0);
    const std::string statistics = (out() / "merged.json").string();
    ASSERT_EQ(tungsten({"merge", state("0-3"), state("3-8"), "-e", target(".exr"), "--stats", statistics}).exitCode, 0);
    const std::string one = whole(".exr", {"--stats", (out() / "whole.json").string()});
    EXPECT_EQ(readExr(target(".exr"), 0, "stderr.").pixels, readExr(one, 0, "stderr.").pixels);
    const auto field = [](const std::string& json, const std::string& name) {
        const size_t at = json.find("\"" + name + "\": ");
        return at == std::string::npos ? "missing" : json.substr(at, json.find('\n', at) - at);
    };
    for (const char* name : {"seed", "passes", "samples per pixel", "relative standard error", "relative error bound"})
        EXPECT_EQ(field(contentOf(statistics), name), field(contentOf(out() / "whole.json"), name));
    const std::string merged = readExrMetadata(target(".exr")), single = readExrMetadata(one);
    for (const char* name : {"quantity", "scene", "kind", "speed of light in vacuum", "integrator"})
        EXPECT_EQ(field(merged, name), field(single, name));
    EXPECT_NE(merged.find("\"first pass\": 3"), std::string::npos);
}

TEST_F(Partial, PhotonMapsMergeToRounding) {
    const std::vector<std::string> photons{"--set", "integrator={" + std::string(test::Photons) + "}"};
    ASSERT_EQ(passes("0:5", photons).exitCode, 0);
    ASSERT_EQ(passes("5:8", photons).exitCode, 0);
    ASSERT_EQ(tungsten({"merge", state("0-5"), state("5-8"), "-e", target(".pfm")}).exitCode, 0);
    const Image one = readPfm(whole(".pfm", photons)), merged = readPfm(target(".pfm"));
    double difference = 0.0, sum = 0.0;
    for (size_t i = 0; i < one.pixels.size(); ++i) {
        difference += std::abs(double(one.pixels[i].x) - double(merged.pixels[i].x));
        sum += double(one.pixels[i].x);
    }
    EXPECT_GT(sum, 0.0);
    EXPECT_LT(difference, 1e-6 * sum);
}

TEST_F(Partial, ExposureAndBatchesAreThoseOfOneRun) {
    const std::vector<std::string> more{"--set", "renderer.exposure=3.5", "--set", "film.batches=4"};
    ASSERT_EQ(passes("0:3", more).exitCode, 0);
    ASSERT_EQ(passes("3:8", more).exitCode, 0);
    const std::vector<std::string> states{"merge", "--quiet", state("0-3"), state("3-8")};
    const auto merge = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), states.begin(), states.end());
        EXPECT_EQ(tungsten(arguments).exitCode, 0);
    };
    merge({"-e", target(".npz"), "-o", target(".png")});
    const std::string one = whole(".npz", more);
    EXPECT_EQ(contentOf(target(".png")), contentOf(out() / "whole.png"));
    const auto member = [](const std::string& file, const std::string& name) {
        const std::string bytes = contentOf(file);
        const size_t at = bytes.find(name);
        return bytes.substr(at, bytes.find("PK\x03\x04", at) - at);
    };
    for (const char* name : {"mean.npy", "standard_error.npy", "batch_means.npy", "batch_weights.npy"})
        EXPECT_EQ(member(target(".npz"), name), member(one, name)) << name;
    merge({"-o", target(".png"), "--exposure", "-2"});
    const std::string dark = contentOf(target(".png"));
    EXPECT_NE(dark, contentOf(out() / "whole.png"));
    ASSERT_EQ(run({"--spp", "15", "-o", "dark.png", "--exposure", "-2"}).exitCode, 0);
    EXPECT_EQ(dark, contentOf(out() / "dark.png"));
    EXPECT_EQ(tungsten({"merge", state("0-3"), "-o", target(".png"), "--exposure", "bright"}).exitCode, 2);
}

TEST_F(Partial, DetectorsKeepTheirNamesAndEtendues) {
    const std::vector<std::string> fibres{"--set", R"(camera={"type":"detectors","medium":"fog","detectors":[
            {"name":"fibre","position":[0,1.2,3.5],"direction":[0,-0.2,-1],"radius":0.25,"numerical_aperture":0.4},
            {"position":[1,1.2,3.5],"direction":[0,-0.2,-1],"radius":0.125}]})"};
    ASSERT_EQ(passes("0:3", fibres).exitCode, 0);
    ASSERT_EQ(passes("3:8", fibres).exitCode, 0);
    ASSERT_EQ(tungsten({"merge", state("0-3"), state("3-8"), "-e", target(".exr")}).exitCode, 0);
    const auto detectors = [](const std::string& metadata) {
        const size_t at = metadata.find("\"etendues\"");
        return at == std::string::npos ? "missing" : metadata.substr(metadata.find("\"detectors\""), at + 120 - at);
    };
    const std::string merged = detectors(readExrMetadata(target(".exr")));
    EXPECT_NE(merged, "missing");
    EXPECT_NE(merged.find("fibre"), std::string::npos) << merged;
    EXPECT_EQ(merged, detectors(readExrMetadata(whole(".exr", fibres))));
}

TEST_F(Partial, PassesThatOverlapOrMissAreNamed) {
    for (const char* range : {"0:3", "2:4", "5:8"}) ASSERT_EQ(passes(range).exitCode, 0);
    refusesToMerge({state("0-3"), state("2-4")}, 1,
                   {state("2-4") + ": holds passes 2 to 3, and " + state("0-3") + " passes 0 to 2: they overlap"});
    refusesToMerge({state("5-8"), state("0-3")}, 1,
                   {state("5-8") + ": passes 3 to 4 before its own are missing: no state holds them"});
    refusesToMerge({state("2-4")}, 1, {"passes 0 to 1 before its own are missing"});
    refusesToMerge({state("0-3"), state("0-3")}, 1, {"overlap"});
    ASSERT_EQ(passes("4:8").exitCode, 0);
    refusesToMerge({state("0-3"), state("4-8")}, 1, {state("4-8") + ": pass 3 before its own are missing"});
}

TEST_F(Partial, StatesOfOtherRendersAreRefused) {
    ASSERT_EQ(passes("0:3").exitCode, 0);
    ASSERT_EQ(passes("3:5", {"-s", "9"}).exitCode, 0);
    refusesToMerge({state("0-3"), state("3-5")}, 1, {state("3-5") + ": belongs to a render with another seed than"});
    ASSERT_EQ(passes("3:5", {"--set", "media.fog.sigma_s=0.7"}).exitCode, 0);
    refusesToMerge({state("0-3"), state("3-5")}, 1, {"another scene (or a changed file or --set)"});
    ASSERT_EQ(passes("3:5", {"--set", "renderer.spp_step=3"}).exitCode, 0);
    refusesToMerge({state("0-3"), state("3-5")}, 1, {"another spp_step"});
    // A last pass of one sample stands in the midst.
    ASSERT_EQ(run({"--passes", "0:3", "--spp", "5"}).exitCode, 0);
    ASSERT_EQ(passes("3:8").exitCode, 0);
    refusesToMerge({state("0-3"), state("3-8")}, 1,
                   {state("0-3") + ": pass 2 is the last of a render with fewer samples"});
}

TEST_F(Partial, WhatIsNoStateIsRefused) {
    ASSERT_EQ(passes("0:3").exitCode, 0);
    const std::string bytes = contentOf(state("0-3")), damaged = (out() / "damaged.state").string();
    for (const size_t size : {size_t(0), size_t(40), bytes.size() / 2, bytes.size() - 1}) {
        std::ofstream(damaged, std::ios::binary) << bytes.substr(0, size);
        refusesToMerge({damaged}, 1, {"damaged"});
    }
    std::string changed = bytes;
    changed[bytes.size() / 2] = char(changed[bytes.size() / 2] ^ 1);
    std::ofstream(damaged, std::ios::binary) << changed;
    refusesToMerge({state("0-3"), damaged}, 1, {"its checksum is wrong"});
    changed = bytes;
    changed[7] = '9';
    std::ofstream(damaged, std::ios::binary) << changed;
    refusesToMerge({damaged}, 1, {"of another version"});
    ASSERT_EQ(run({"-c", "1h"}).exitCode, 0);
    refusesToMerge({(out() / "boxState.dat").string()}, 1, {"not a partial state"});
    refusesToMerge({(out() / "nothing.state").string(), damaged}, 1, {"nothing.state", "of another version"});
}

TEST_F(Partial, UsageIsChecked) {
    const auto refused = [&](const std::vector<std::string>& arguments, const std::string& expected) {
        const CommandResult result = run(arguments);
        EXPECT_EQ(result.exitCode, 2) << result.all();
        EXPECT_NE(result.err.find(expected), std::string::npos) << "'" << expected << "' is not in: " << result.err;
    };
    for (const std::string range : {"3", "3:3", "4:2", "a:b", "0:3x", "0:99999999999"})
        refused({"--passes", range}, "--passes " + range + ": expected A:B");
    refused({"--passes", "6:9", "--spp", "15"}, "--passes 6:9: the render has 8 passes");
    refused({"--passes", "0:2", "-c", "1h"}, "--passes: goes without -c");
    for (const std::string option : {"--bias", "--plan-cost"})
        refused({"--passes", "0:2", option}, "--passes: goes without -c");
    refused({"--passes", "0:2", "-e", "box.exr"}, "tungsten merge");
    EXPECT_TRUE(!fs::exists(out()) || filesOf(out()).empty());
    EXPECT_EQ(tungsten({"merge", "a.state"}).exitCode, 2);
    EXPECT_EQ(tungsten({"merge", "-e", "a.exr"}).exitCode, 2);
    ASSERT_EQ(passes("0:2").exitCode, 0);
    EXPECT_EQ(tungsten({"merge", state("0-2"), "-e", target(".tiff")}).exitCode, 1);
    EXPECT_EQ(tungsten({"merge", state("0-2"), "-e", state("0-2")}).exitCode, 1);
}

TEST_F(Partial, AFullDiskLeavesNoState) {
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit limit{3000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    const CommandResult result = passes("0:4");
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, SIG_DFL);
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_NE(result.err.find(state("0-4") + ": cannot be written"), std::string::npos) << result.err;
    EXPECT_TRUE(filesOf(out()).empty());
}

/// Rows that a pass leaves dark are dark, whatever the pass before has brought there.
TEST(PartialState, PassesOfOtherRowsAreFoldedApart) {
    const test::SceneFile file(test::foggyBox(test::Paths));
    const LoadedScene loaded = loadScene(file.path());
    const fs::path state = file.path().parent_path() / "a.state";
    const Vec2i size = loaded.scene->camera.resolution;
    const auto made = [&] { return Film(size.x, size.y, 1, loaded.scene->film); };
    Film one = made(), merged = made();
    std::ofstream out(state, std::ios::binary);
    PartialStateWriter writer(out, state.string(), PartialIdentity::of(loaded, 5, 2, {}), 0);
    for (const auto& [row, samples] : {std::pair{3, 2u}, {7, 2u}, {7, 1u}}) {
        one.beginPass();
        one.set(0, 1, row, Rgb(float(row)));
        writer.add(one, samples);
        one.endPass(double(samples));
    }
    writer.finish("{}", 1.5);
    out.close();
    const PartialStateReader reader(state);
    EXPECT_EQ(reader.samples(), (std::vector<uint32_t>{2, 2, 1}));
    EXPECT_EQ(reader.cpuSeconds(), 1.5);
    reader.fold(merged);
    EXPECT_EQ(merged.mean(0).pixels, one.mean(0).pixels);
    EXPECT_FLOAT_EQ(merged.mean(0).at(1, 3).x, 3.0f * 2.0f / 5.0f);
    EXPECT_FLOAT_EQ(merged.mean(0).at(1, 7).x, 7.0f * 3.0f / 5.0f);
    EXPECT_EQ(merged.standardError(0).pixels, one.standardError(0).pixels);
}

TEST(PartialStateHeader, KeepsWhatImagesAndMetadataNeed) {
    for (const bool integrate : {false, true}) {
        const auto scene = std::make_shared<Scene>();
        scene->camera.resolution = Vec2i(7, 5);
        scene->transport.gate = {false, false, 2.0, 0.5, 3};
        scene->transport.vacuumSpeed = 0.5f;
        scene->transport.integrateOverGate = integrate;
        scene->transport.cameraUnwarped = !integrate;
        scene->cameraRegion.speed = 0.25f;
        scene->lengthUnit = 0.01;
        PartialIdentity identity;
        identity.sppStep = 4;
        identity.scene = scene;
        const PartialStateHeader header = PartialStateHeader::of(identity, 3);
        EXPECT_TRUE(header.plausible());
        EXPECT_EQ(header.firstPass, 3u);
        const std::shared_ptr<Scene> kept = header.scene();
        EXPECT_EQ(kept->camera.resolution, Vec2i(7, 5));
        EXPECT_EQ(kept->transport.gate.start, 2.0);
        EXPECT_EQ(kept->transport.gate.end(), 3.5);
        EXPECT_EQ(kept->transport.gate.frames, 3);
        EXPECT_EQ(kept->transport.vacuumSpeed, 0.5f);
        EXPECT_EQ(kept->cameraRegion.speed, 0.25f);
        EXPECT_EQ(kept->transport.integrateOverGate, integrate);
        EXPECT_EQ(kept->transport.cameraUnwarped, !integrate);
        EXPECT_EQ(kept->lengthUnit, 0.01);
    }
}

/// Passes 0 to 7 of a render of 15 samples in steps of 2.
TEST(PlannedPass, PartsOfARenderHaveItsSamples) {
    SessionOptions options;
    options.spp = 15;
    options.sppStep = 2;
    EXPECT_EQ(samplesOf(options), 15u);
    options.passes = PassRange{2, 5};
    EXPECT_EQ(samplesOf(options), 6u);
    options.passes = PassRange{6, 8};
    EXPECT_EQ(samplesOf(options), 3u);
    const PlannedPass second{{2, 1.0, 2.0}, 1, 2.0}; // of a session that begins with the render's pass 6
    const PassInfo pass = second.info(6, 2, 9);
    EXPECT_EQ(pass.index, 7u);
    EXPECT_EQ(pass.firstSample, 14u);
    EXPECT_EQ(pass.seed, 9u);
}

} // namespace
} // namespace tungsten
