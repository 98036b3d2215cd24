// Whole scenes: what the format's fields become, and what bad scenes say.

#include "scene/problems_of.h"

#include "support/Folders.h"

#include "tungsten/io/Writers.h"
#include "tungsten/scene/Interaction.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

using test::problemsOf;
using test::SceneFile;

const char* const Fog = R"({
    "media": [{"name": "fog", "type": "homogeneous", "sigma_s": [1, 2, 3], "sigma_a": 0.5, "density": 2, "speed_of_light": 0.75,
               "phase_function": {"type": "henyey_greenstein", "g": 0.7}}],
    "bsdfs": [{"name": "white", "type": "lambert", "albedo": 0.5}],
    "primitives": [
        {"name": "box", "type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"}},
        {"name": "floor", "type": "quad", "bsdf": "white", "transform": {"position": [0, -2, 0], "scale": 4}},
        {"name": "lamp", "type": "point", "power": 12.566370614359172, "emission_time": 1.5,
         "transform": {"position": [0, 3, 0]}}],
    "camera": {"type": "pinhole", "resolution": [8, 4], "transform": {"position": [0, 0, 5], "look_at": [0, 0, 0]}},
    "integrator": {"type": "path_tracer", "max_bounces": 7, "transient_time_center": 4, "transient_time_width": 2},
    "renderer": {"spp": 3, "timeout": "0.5"}
})";

TEST(SceneLoader, ScenesMaySayHowLongTheirUnitIs) {
    EXPECT_DOUBLE_EQ(loadScene(SceneFile(R"({"primitives": []})").path()).scene->lengthUnit, 0.0);
    EXPECT_DOUBLE_EQ(loadScene(SceneFile(R"({"primitives": [], "length_unit": "mm"})").path()).scene->lengthUnit, 1e-3);
    EXPECT_NE(problemsOf(R"({"length_unit": "metre"})").find("length_unit: expected km, m, cm, mm, um, in or ft"),
              std::string::npos);
}

TEST(SceneLoader, FieldsBecomeTypedValues) {
    const SceneFile file(Fog);
    const LoadedScene loaded = loadScene(file.path());
    const Scene& scene = *loaded.scene;
    ASSERT_EQ(scene.media.size(), 1u);
    EXPECT_EQ(scene.media[0].sigmaS(), Rgb(2, 4, 6));
    EXPECT_EQ(scene.media[0].sigmaA(), Rgb(1, 1, 1));
    EXPECT_FLOAT_EQ(scene.media[0].phase.g(), 0.7f);
    ASSERT_EQ(scene.primitives.size(), 2u);
    EXPECT_EQ(scene.primitives[0].inside.medium, 0);
    EXPECT_FLOAT_EQ(scene.primitives[0].inside.speed, 0.75f);
    EXPECT_EQ(scene.primitives[0].outside.medium, -1);
    ASSERT_EQ(scene.emitters.size(), 1u);
    EXPECT_DOUBLE_EQ(scene.emitters[0].emissionTime, 1.5);
    EXPECT_NEAR(std::get<PointEmitter>(scene.emitters[0].model).intensity.x, 1.0f, 1e-6f);
    EXPECT_EQ(scene.transport.maxBounces, 7);
    EXPECT_FALSE(scene.transport.gate.steadyState);
    EXPECT_DOUBLE_EQ(scene.transport.gate.start, 3.0);
    EXPECT_DOUBLE_EQ(scene.transport.gate.end(), 5.0);
    EXPECT_EQ(loaded.renderer.spp, 3);
    EXPECT_DOUBLE_EQ(loaded.renderer.timeoutSeconds, 30.0);
    EXPECT_TRUE(loaded.diagnostics->warnings.empty());
}

TEST(SceneLoader, OverridesChangeTheSceneAndItsHash) {
    const SceneFile file(Fog);
    const uint64_t plain = loadScene(file.path()).hash;
    EXPECT_EQ(plain, loadScene(file.path()).hash);
    const LoadedScene changed = loadScene(file.path(), {{}, {"media.fog.sigma_a=0", "camera.resolution=[2,2]"}});
    EXPECT_EQ(changed.scene->media[0].sigmaA(), Rgb(0.0f));
    EXPECT_EQ(changed.scene->camera.resolution, Vec2i(2, 2));
    EXPECT_NE(changed.hash, plain);
    EXPECT_EQ(loadScene(file.path(), {{}, {"renderer.spp=99"}}).hash, plain);
}

TEST(SceneLoader, GatesOfEveryKind) {
    const SceneFile file(Fog);
    const auto gate = [&](std::vector<std::string> overrides) {
        return loadScene(file.path(), {{}, std::move(overrides)}).scene->transport.gate;
    };
    EXPECT_TRUE(gate({"integrator.transient_time_width=0"}).steadyState);
    EXPECT_TRUE(gate({"integrator.transient_time_center=-1"}).steadyState);
    const TimeGate frames =
        gate({"integrator.frame_num=5", "integrator.start_time=1", "integrator.transient_time_width=0.5"});
    EXPECT_EQ(frames.frames, 5);
    EXPECT_DOUBLE_EQ(frames.end(), 3.5);
    EXPECT_EQ(frames.frameOf(0.999), -1);
    EXPECT_EQ(frames.frameOf(1.0), 0);
    EXPECT_EQ(frames.frameOf(3.49), 4);
    EXPECT_EQ(frames.frameOf(3.5), -1);
    EXPECT_TRUE(gate({"integrator.type=progressive_photon_map"}).steadyState);
    EXPECT_TRUE(gate({"integrator.delta_time_gate=true", "integrator.type=progressive_transient_photon_map"}).delta);
}

TEST(SceneLoader, EveryProblemIsListedWithItsPath) {
    const std::string text = problemsOf(R"({
        "media": [{"name": "fog", "type": "homogenous", "sigma_s": -1}],
        "bsdfs": [{"name": "white", "type": "lambert", "albedo": "missing.png"}],
        "primitives": [{"type": "mesh", "file": "missing.wo3", "bsdf": "whit", "int_medium": "frog"},
                       {"type": "cylinder"}, {"type": "qaud"}, {"type": "point", "emission": 1}],
        "camera": {"fov": 200}, "integrator": {"max_bounces": "many"}, "renderer": {"timeout": 5}})");
    for (const char* expected :
         {"media[0].type: expected homogeneous or guided_homo, found the string \"homogenous\"; did you mean "
          "'homogeneous'?",
          "media[0].sigma_s", "bsdfs[0].albedo", "missing.png", "primitives[0].file", "missing.wo3",
          "primitives[0].bsdf: there is no BSDF called 'whit' above it; did you mean 'white'?",
          "primitives[0].int_medium: there is no medium called 'frog'", "did you mean 'fog'?",
          "primitives[1].type: 'cylinder' is not supported: use a mesh; supported: ", "did you mean 'quad'?",
          "camera.fov", "integrator.max_bounces", "renderer.timeout"})
        EXPECT_NE(text.find(expected), std::string::npos) << "missing: " << expected << "\nin:\n" << text;
}

TEST(SceneLoader, TypesOfTheFormatThatAreNotReadSayWhatToUse) {
    const auto expect = [](const std::string& blocks, const std::string& said) {
        const std::string text = problemsOf("{" + blocks + R"(, "primitives": [{"type": "point", "emission": 1}]})");
        EXPECT_NE(text.find(said), std::string::npos) << said << "\n" << text;
        EXPECT_EQ(text.find("did you mean"), std::string::npos) << text;
    };
    for (const std::string medium : {"voxel", "atmosphere", "exponential", "heterogeneous"})
        expect(R"("media": [{"type": ")" + medium + "\"}]",
               "media[0].type: '" + medium + "' is not supported: media are homogeneous");
    expect(R"("media": [{"type": "homogeneous", "transmittance": {"type": "davis"}}])",
           "media[0].transmittance: 'davis' is not supported: light dies away exponentially");
    for (const std::string bsdf : {"phong", "smooth_coat", "hair", "thinsheet"})
        expect(R"("bsdfs": [{"type": ")" + bsdf + "\"}]", "bsdfs[0].type: '" + bsdf + "' is not supported: ");
    expect(R"("bsdfs": [{"type": "conductor", "material": "TiN"}])",
           "bsdfs[0].material: 'TiN' is not supported: give its eta and k");
    expect(R"("bsdfs": [{"type": "lambert", "albedo": {"type": "ies"}}])", "'ies' is not supported: use a spot");
    expect(R"("camera": {"type": "cubemap"})", "camera.type: 'cubemap' is not supported: use six of pinhole");
    expect(R"("bsdfs": [{"type": "conductor", "material": "Fe"}])", "expected Ag, Al, Au, Cr, Cu, Li or VN, found");
}

TEST(SceneLoader, BlocksThatAreNoObjectsAreProblems) {
    for (const char* block : {"camera", "integrator", "renderer"})
        EXPECT_NE(problemsOf(std::string("{\"") + block + "\": 5}").find(std::string(block) + ": expected an object"),
                  std::string::npos)
            << block;
}

TEST(SceneLoader, LightThatNeverArrivesIsAnError) {
    const std::string gated = R"("integrator": {"transient_time_center": 1, "transient_time_width": 1})";
    EXPECT_NE(problemsOf("{" + gated + "}").find("nothing emits light"), std::string::npos);
    EXPECT_NE(problemsOf(R"({"primitives": [{"type": "infinite_sphere", "emission": 1}], )" + gated + "}")
                  .find("never arrives"),
              std::string::npos);
    EXPECT_EQ(problemsOf(R"({"primitives": [{"type": "infinite_sphere", "emission": 1}]})"), "");
}

TEST(SceneLoader, TextIsUtf8WithOrWithoutAMark) {
    const std::string scene = R"({"primitives": []})";
    EXPECT_EQ(problemsOf("\xEF\xBB\xBF" + scene), "");
    std::string little, big;
    for (const char c : scene) {
        little += {c, '\0'};
        big += {'\0', c};
    }
    for (const std::string& wide : {little, big, "\xFF\xFE" + little, "\xFE\xFF" + big})
        EXPECT_NE(problemsOf(wide).find("scene.json: text in UTF-16 or UTF-32, which is not read; save it as UTF-8"),
                  std::string::npos);
}

/// What another program's JSON would be without primitives: an empty white scene.
TEST(SceneLoader, AFileWithoutPrimitivesIsNoScene) {
    const std::string others = problemsOf(R"({"camera": {"type": "pinhole"}, "materials": [], "entities": [{}]})");
    for (const char* part : {"scene.json: not a scene: there are no 'primitives'",
                             "found 'camera', 'materials', 'entities'", "media, bsdfs, camera, integrator"})
        EXPECT_NE(others.find(part), std::string::npos) << others;
    EXPECT_NE(problemsOf("{}").find("found nothing"), std::string::npos);
    // All else the format lets a scene leave out.
    EXPECT_EQ(problemsOf(R"({"primitives": []})"), "");
    EXPECT_EQ(problemsOf("{}", {"primitives=[]"}), "");
}

TEST(SceneLoader, NoLightMeansAWhiteEnvironment) {
    const SceneFile file(R"({"primitives": []})");
    const LoadedScene loaded = loadScene(file.path());
    ASSERT_EQ(loaded.scene->emitters.size(), 1u);
    EXPECT_TRUE(loaded.scene->emitters[0].isInfinite());
    EXPECT_EQ(loaded.scene->camera.resolution, Vec2i(1000, 563));
    EXPECT_EQ(loaded.diagnostics->warnings.size(), 1u);
}

TEST(SceneLoader, InlineMediaAndBsdfsWork) {
    const SceneFile file(R"({"primitives": [
        {"type": "sphere", "int_medium": {"type": "homogeneous", "sigma_a": 1}, "emission": 2,
         "bsdf": {"type": "mixed", "bsdf0": {"type": "mirror"}, "bsdf1": {"type": "transparency", "alpha": 0.25}}}]})");
    const LoadedScene loaded = loadScene(file.path());
    EXPECT_EQ(loaded.scene->media.size(), 1u);
    EXPECT_EQ(loaded.scene->primitives[0].inside.medium, 0);
    EXPECT_NEAR(loaded.scene->primitives[0].bsdfs[0]->forwardWeight({0, 0}).x, 0.5f * 0.75f, 1e-6f);
    EXPECT_TRUE(loaded.scene->emitters[0].primitive().has_value());
}

TEST(SceneLoader, BitmapsThatDifferInAScaleFarBelowOneAreTwo) {
    const SceneFile file(R"({"bsdfs": [
        {"name": "a", "type": "lambert", "albedo": {"type": "bitmap", "file": "grey.pfm", "scale": 1e-7}},
        {"name": "b", "type": "lambert", "albedo": {"type": "bitmap", "file": "grey.pfm", "scale": 3e-7}}],
        "primitives": [{"type": "quad", "bsdf": "a"}, {"type": "quad", "bsdf": "b"}]})");
    Image grey(2, 2);
    for (Rgb& pixel : grey.pixels) pixel = Rgb(0.5f);
    writePfm(file.path().parent_path() / "grey.pfm", grey);
    const LoadedScene loaded = loadScene(file.path());
    const auto albedo = [&](size_t i) { return loaded.scene->primitives[i].bsdfs[0]->albedo.rgb({0.5f, 0.5f}).x; };
    EXPECT_FLOAT_EQ(albedo(0), 0.5e-7f);
    EXPECT_FLOAT_EQ(albedo(1), 1.5e-7f);
}

TEST(SceneLoader, ABitmapThatIsClampedAndOneThatIsNotAreTwo) {
    const SceneFile file(R"({"bsdfs": [
        {"name": "a", "type": "lambert", "albedo": {"type": "bitmap", "file": "grey.pfm", "interpolate": false}},
        {"name": "b", "type": "lambert", "albedo": {"type": "bitmap", "file": "grey.pfm", "interpolate": false,
                                                    "clamp": true}}],
        "primitives": [{"type": "quad", "bsdf": "a"}, {"type": "quad", "bsdf": "b"}]})");
    Image grey(2, 1);
    grey.pixels = {Rgb(0.25f), Rgb(0.75f)};
    writePfm(file.path().parent_path() / "grey.pfm", grey);
    const LoadedScene loaded = loadScene(file.path());
    const auto beyond = [&](size_t i) { return loaded.scene->primitives[i].bsdfs[0]->albedo.rgb({1.25f, 0.5f}).x; };
    EXPECT_FLOAT_EQ(beyond(0), 0.25f);
    EXPECT_FLOAT_EQ(beyond(1), 0.75f);
}

TEST(SceneLoader, OrenNayarTakesRoughnessOrTheFacetsDeviation) {
    const SceneFile file(R"({"primitives": [{"type": "quad", "bsdf": {"type": "oren_nayar", "sigma": 0.4}},
        {"type": "quad", "bsdf": {"type": "oren_nayar", "sigma": 0.4, "roughness": 0.3}}]})");
    const LoadedScene loaded = loadScene(file.path());
    const auto roughness = [&](size_t i) {
        return std::get<OrenNayar>(loaded.scene->primitives[i].bsdfs[0]->model).roughness.scalar({0, 0});
    };
    EXPECT_FLOAT_EQ(roughness(0), std::sqrt(2.0f) * 0.4f);
    EXPECT_FLOAT_EQ(roughness(1), 0.3f);
}

/// Where nothing is refracted light goes on, as through a smooth interface.
TEST(SceneLoader, RoughDielectricsWithoutContrastLetEverythingThrough) {
    for (const char* ior : {"1", "1.00001", "0.99999"}) {
        const SceneFile file(R"({"primitives": [{"type": "quad", "bsdf": {"type": "rough_dielectric", "roughness": 0.3,
            "ior": )" + std::string(ior) +
                             "}}]}");
        const LoadedScene loaded = loadScene(file.path());
        const Bsdf& bsdf = *loaded.scene->primitives[0].bsdfs[0];
        const Vec3f wi(0.6f, 0.0f, 0.8f);
        for (const float u : {0.1f, 0.5f, 0.9f}) {
            const auto drawn = bsdf.sample({}, wi, {{u, 0.4f}, u});
            ASSERT_TRUE(drawn) << ior;
            EXPECT_EQ(drawn->weight, Rgb(1.0f)) << ior;
            EXPECT_LT((drawn->wo + wi).length(), 1e-6f) << ior;
        }
    }
}

TEST(Visibility, TimeTransmittanceAndCrossingsThroughABoundary) {
    const SceneFile file(Fog);
    const auto loaded = loadScene(file.path());
    uint64_t rays = 0;
    // Straight down through the unit cube of fog (speed 0.75) in vacuum (speed 1), from y = 1 to y = -1.
    const Visibility through =
        traceVisibility(*loaded.scene, {Vec3f(0.1f, 1, 0.1f), Vec3f(0, -1, 0), 0, 2}, 2.0f, Region{-1, 1.0f}, rays);
    EXPECT_EQ(through.crossings, 2);
    EXPECT_NEAR(through.time, 1.0 + 1.0 / 0.75, 1e-6);
    EXPECT_NEAR(through.transmittance.x, std::exp(-3.0f), 1e-6f);
    EXPECT_NEAR(through.transmittance.z, std::exp(-7.0f), 1e-6f);
    const Visibility blocked =
        traceVisibility(*loaded.scene, {Vec3f(0.1f, 1, 0.1f), Vec3f(0, -1, 0), 0, 4}, 4.0f, Region{-1, 1.0f}, rays);
    EXPECT_EQ(blocked.transmittance, Rgb(0.0f));
    // From inside the fog outward: one crossing.
    const Visibility outward =
        traceVisibility(*loaded.scene, {Vec3f(0, 0, 0), Vec3f(1, 0, 0), 0, 1}, 1.0f, Region{0, 0.75f}, rays);
    EXPECT_EQ(outward.crossings, 1);
    EXPECT_NEAR(outward.time, 0.5 / 0.75 + 0.5, 1e-6);
}

TEST(SceneLoader, SharedScenesLoadUnchanged) {
    const std::filesystem::path folder = test::sharedFolder() / "scenes";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the shared scenes are not here";
    for (const char* name :
         {"cbox/transient.json", "cbox/scene.json", "cbox/path_tracer.json", "cbox/transient-beams.json",
          "dragon/scene-points-darts-short.json", "dragon/transient.json", "dragon/path_trace.json",
          "staircase/scene-points-darts-short.json", "staircase/scene-steady.json", "staircase/transient.json"}) {
        SCOPED_TRACE(name);
        const LoadedScene loaded = loadScene(folder / name);
        EXPECT_GT(loaded.scene->geometry->triangleCount(), 30u);
        EXPECT_FALSE(loaded.scene->emitters.empty());
        // The integrator block is its plugin's to read; everything else must be known.
        for (const Problem& warning : loaded.diagnostics->warnings)
            EXPECT_EQ(warning.path.find("primitives["), std::string::npos) << warning.text();
    }
}

} // namespace
} // namespace tungsten
