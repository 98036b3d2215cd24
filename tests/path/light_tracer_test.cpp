// The light tracer shows what the path tracer does, pixel by pixel and frame by frame, from the other end.

#include "path/light/LightTracer.h"
#include "tungsten/core/Errors.h"
#include "tungsten/scene/SceneLoader.h"

#include "support/AgreementScenes.h"
#include "support/PathsAndPhotons.h"
#include "support/SeedShift.h"

#include <gtest/gtest.h>

namespace tungsten::test {
namespace {

/// A floor whose shading normals lean towards the camera; lies beside every scene.
constexpr const char* LeaningFloor = "v -2 0 -2\nv -2 0 2\nv 2 0 2\nv 2 0 -2\nvn 0 0.8 0.6\n"
                                     "f 1//1 2//1 3//1\nf 1//1 3//1 4//1\n";

/// Means over independent renders, and their standard errors: by frame and pixel (channel means), and of whole frames,
/// whose pixels may share light paths.
struct FilmEstimate {
    std::vector<double> mean, error, frameMean, frameError;
};
using RenderFile = std::unique_ptr<Rendered>(const std::filesystem::path&, const RenderOptions&);
FilmEstimate estimate(RenderFile& render, const std::filesystem::path& scene, RenderOptions options, uint64_t renders) {
    FilmEstimate e;
    for (uint64_t i = 0; i < renders; ++i) {
        options.seed += 1;
        const auto rendered = render(scene, options);
        EXPECT_EQ(rendered->statistics.counter("non-finite samples"), 0u);
        const Film& film = rendered->film;
        const size_t pixels = size_t(film.width()) * size_t(film.height());
        for (auto* list : {&e.mean, &e.error}) list->resize(pixels * size_t(film.frames()));
        for (auto* list : {&e.frameMean, &e.frameError}) list->resize(size_t(film.frames()));
        for (int frame = 0; frame < film.frames(); ++frame) {
            const Image image = film.mean(frame);
            double sum = 0.0;
            for (size_t p = 0; p < pixels; ++p) {
                const double value = double(meanComponent(image.pixels[p]));
                e.mean[size_t(frame) * pixels + p] += value;
                e.error[size_t(frame) * pixels + p] += value * value;
                sum += value / double(pixels);
            }
            e.frameMean[size_t(frame)] += sum;
            e.frameError[size_t(frame)] += sum * sum;
        }
    }
    const auto finish = [n = double(renders)](std::vector<double>& means, std::vector<double>& errors) {
        for (size_t i = 0; i < means.size(); ++i) {
            means[i] /= n;
            errors[i] = std::sqrt(std::max(errors[i] / n - means[i] * means[i], 0.0) / (n - 1.0));
        }
    };
    finish(e.mean, e.error);
    finish(e.frameMean, e.frameError);
    return e;
}

struct Samples {
    uint32_t pathSamples = 16, lightSamples = 16;
    uint64_t renders = 24;
    double wholeError = 0.03; ///< of a frame's mean: more would prove nothing
};

void expectAgreement(const std::string& json, const std::vector<std::string>& overrides, const Samples& effort) {
    const FileFolder folder;
    folder.write("leaning.obj", LeaningFloor);
    const std::filesystem::path scene = folder.write("scene.json", json);
    RenderOptions options;
    options.overrides = overrides;
    options.overrides.insert(options.overrides.end(), {"camera.resolution=[6,6]"});
    options.passes = 1;
    options.samplesPerPass = effort.pathSamples;
    options.seed = 1000;
    const FilmEstimate path = estimate(renderPathFile, scene, options, effort.renders);
    options.samplesPerPass = effort.lightSamples;
    options.seed = 2000;
    const FilmEstimate light = estimate(renderLightFile, scene, options, effort.renders);
    constexpr double Sigmas = 5.0;
    for (size_t frame = 0; frame < path.frameMean.size(); ++frame) {
        const double error = std::hypot(path.frameError[frame], light.frameError[frame]);
        EXPECT_NEAR(light.frameMean[frame], path.frameMean[frame], Sigmas * error) << "frame " << frame;
        ASSERT_GT(path.frameMean[frame], 0.0);
        EXPECT_LT(error, effort.wholeError * path.frameMean[frame]) << "frame " << frame;
    }
    double squares = 0.0;
    for (size_t i = 0; i < path.mean.size(); ++i) {
        // Slivers in the filter's tail are seen by so few samples that their errors are unknown.
        const double sliver = 1e-3 * path.frameMean[i / (path.mean.size() / path.frameMean.size())];
        const double deviation = (light.mean[i] - path.mean[i]) / std::hypot(path.error[i], light.error[i], sliver);
        EXPECT_LT(std::abs(deviation), Sigmas) << "pixel " << i << ": " << light.mean[i] << " " << path.mean[i];
        squares += deviation * deviation;
    }
    // Of normal deviations.
    const double pixels = double(path.mean.size()), limit = 1.0 + 4.0 * std::sqrt(2.0 / pixels);
    EXPECT_LT(squares / pixels, limit) << "pixels differ by more than their errors";
}

/// A room without fog, two lights with an area and one without; the blocks have shading normals and gloss.
std::string room(const std::string& integrator, const std::string& camera = R"("type": "pinhole", "fov": 55)") {
    return R"({"bsdfs": [{"name": "grey", "type": "lambert", "albedo": 0.6},
                         {"name": "red", "type": "oren_nayar", "albedo": [0.7, 0.2, 0.1], "roughness": 0.6},
                         {"name": "metal", "type": "rough_conductor", "material": "Cu", "roughness": 0.4}],
     "primitives": [
      {"type": "quad", "bsdf": "grey", "transform": {"position": [0, -1, 0], "scale": [3, 1, 3]}},
      {"type": "quad", "bsdf": "red", "transform": {"position": [0, 0, -1.5], "rotation": [90, 0, 0], "scale": [3, 1, 3]}},
      {"type": "sphere", "bsdf": "metal", "transform": {"position": [0.5, -0.5, 0], "scale": 0.5}},
      {"type": "sphere", "bsdf": "red", "emission": [3, 4, 5], "emission_time": 0.4,
       "transform": {"position": [-0.8, 0.6, -0.5], "scale": 0.2}},
      {"type": "disk", "bsdf": {"type": "null"}, "emission": 12, "cone_angle": 60,
       "transform": {"position": [0.8, 1.2, 0.3], "rotation": [180, 0, 0], "scale": 0.3}},
      {"type": "point", "emission": 4, "transform": {"position": [-0.6, 0.2, 0.9]}}],
     "camera": {)" +
           camera + R"(, "reconstruction_filter": "tent",
                "transform": {"position": [0.3, 0.4, 4], "look_at": [0, -0.1, 0], "up": [0, 1, 0]}},
     "integrator": {"max_bounces": 6)" +
           integrator + "}}";
}

TEST(LightTracer, ShowsSurfacesInSteadyState) {
    expectAgreement(room(""), {}, {128, 256});
}

TEST(LightTracer, ShowsSurfacesInTimeOfArrivalAndWithoutTheCamerasTime) {
    const std::string frames = R"(, "start_time": 4, "transient_time_width": 1, "frame_num": 3)";
    expectAgreement(room(frames), {}, {256, 384});
    const std::string unwarped =
        R"(, "camera_unwarped": true, "transient_time_center": 2, "transient_time_width": 1.5)";
    expectAgreement(room(unwarped), {}, {192, 256});
}

TEST(LightTracer, ShowsSurfacesThroughALens) {
    const std::string lens = R"("type": "thinlens", "fov": 45, "focus_distance": 3, "aperture_size": 0.4)";
    const std::string gate = R"(, "transient_time_center": 5.5, "transient_time_width": 1.5)";
    expectAgreement(room(gate, lens), {}, {192, 256});
}

TEST(LightTracer, ShowsSurfacesAlongParallelRays) {
    expectAgreement(room("", R"("type": "orthographic", "orthographic_size": 1.4)"), {}, {128, 256});
}

/// A wall that a floor with leaning shading normals alone lights: the walk over the floor goes on with their factor.
TEST(LightTracer, KeepsTheFactorOfShadingNormals) {
    const test::OtherSeeds seeds(1);
    const std::string scene = R"({"bsdfs": [{"name": "grey", "type": "lambert", "albedo": 0.8}],
        "primitives": [
          {"type": "mesh", "file": "leaning.obj", "smooth": true, "bsdf": "grey"},
          {"type": "quad", "bsdf": "grey", "transform": {"position": [0, 3, -2], "rotation": [90, 0, 0], "scale": 4}},
          {"type": "disk", "bsdf": {"type": "null"}, "emission": 12, "cone_angle": 30,
           "transform": {"position": [0, 1.5, -0.5], "rotation": [180, 0, 0], "scale": 0.5}}],
        "camera": {"type": "pinhole", "fov": 30, "reconstruction_filter": "tent",
                   "transform": {"position": [0, 3.5, 4], "look_at": [0, 3.5, -2], "up": [0, 1, 0]}},
        "integrator": {"max_bounces": 3}})";
    expectAgreement(scene, {}, {128, 256});
}

/// A laser through slow, dark glass onto a coat of varnish on the left, out of sight, and from there onto the right
/// wall, out of sight too: what is seen is lit by what the laser scatters there.
TEST(LightTracer, ShowsALaserThroughSlowGlassAndOffVarnish) {
    const std::string scene = R"({
        "media": [{"name": "dark", "type": "homogeneous", "sigma_a": 0.3, "sigma_s": 0, "speed_of_light": 0.5}],
        "bsdfs": [{"name": "grey", "type": "lambert", "albedo": 0.7},
                  {"name": "varnish", "type": "plastic", "albedo": 0.05, "ior": 3}],
        "primitives": [
          {"type": "quad", "bsdf": "grey", "transform": {"position": [0, 0, -1.5], "rotation": [90, 0, 0], "scale": 6}},
          {"type": "quad", "bsdf": "varnish",
           "transform": {"position": [-2.9, 0.3, 0.5], "rotation": [0, 0, -90], "scale": 0.5}},
          {"type": "quad", "bsdf": "grey", "transform": {"position": [3, 0, 0.5], "rotation": [0, 0, 90], "scale": 4}},
          {"type": "cube", "bsdf": {"type": "forward"}, "int_medium": "dark",
           "transform": {"position": [0.2, 0.75, 1], "scale": 0.8}},
          {"type": "collimated", "power": 100,
           "transform": {"position": [2.8, 1.2, 1.5], "look_at": [-2.9, 0.3, 0.5], "up": [0, 1, 0]}}],
        "camera": {"type": "pinhole", "fov": 40, "reconstruction_filter": "tent",
                   "transform": {"position": [0, 0, 4], "look_at": [0, 0, -1.5], "up": [0, 1, 0]}},
        "integrator": {"max_bounces": 10)";
    expectAgreement(scene + "}}", {}, {128, 256});
    const std::string frames = R"(, "start_time": 20.5, "transient_time_width": 1, "frame_num": 3}})";
    expectAgreement(scene + frames, {}, {256, 512});
}

TEST(LightTracer, WeighsTimeByTheSensorsResponse) {
    const std::string response = R"(, "temporal_response": {"type": "gaussian", "center": 5.5, "sigma": 0.4})";
    expectAgreement(room(response), {}, {192, 256});
}

TEST(LightTracer, StartsLightPathsWithDelays) {
    const std::string frames = R"(, "start_time": 4, "transient_time_width": 1, "frame_num": 3,
        "temporal_response": {"type": "exponential", "decay": 0.7})";
    expectAgreement(room(frames), {"primitives.3.pulse={\"type\": \"box\", \"start\": -0.5, \"end\": 0.8}"},
                    {256, 384});
}

TEST(LightTracer, ShowsFogBehindAnIndexMatchedBoundary) {
    const std::string fog = fogCube(R"("sigma_a": 0.1, "sigma_s": 0.6)", 0.5);
    expectAgreement(fog, {"integrator.start_time=5", "integrator.transient_time_width=1", "integrator.frame_num=3"},
                    {1024, 512});
}

TEST(LightTracer, ShowsSlowLight) {
    expectAgreement(slowCloud(), {"integrator.transient_time_width=1"}, {384, 384});
}

TEST(LightTracer, CountsBouncesAndOrdersAsThePathTracerDoes) {
    const std::string scene = slowCloud();
    for (const std::string rule : {"min_bounces=3", "max_bounces=4", "include_surfaces=false"})
        expectAgreement(scene, {"integrator.transient_time_center=-1", "integrator." + rule}, {192, 192});
    expectAgreement(scene, {"integrator.transient_time_center=-1", "integrator.low_order_scattering=false"},
                    {384, 384, 24, 0.06});
}

/// The same bits on any number of threads.
TEST(LightTracer, DoesNotDependOnThreads) {
    RenderOptions options;
    options.overrides = {"camera.resolution=[16,12]"};
    options.passes = 2;
    options.samplesPerPass = 20;
    options.threads = 1;
    const auto one = renderLight(room(""), options);
    options.threads = 4;
    const auto four = renderLight(room(""), options);
    const Image a = one->film.mean(0), b = four->film.mean(0);
    ASSERT_GT(one->mean(), 0.0);
    EXPECT_TRUE(a.pixels == b.pixels);
}

/// Loads, prepares nothing: problems and warnings of the scene with an override.
std::string complaints(const std::string& json, const std::string& override_) {
    const SceneFile file(json);
    const LoadedScene loaded = loadScene(file.path(), {{}, {override_}});
    const path::LightTracer tracer(loaded.scene, loaded.integratorSettings);
    std::string text;
    for (const Problem& problem : loaded.diagnostics->problems) text += "problem " + problem.text() + "\n";
    for (const Problem& warning : loaded.diagnostics->warnings) text += "warning " + warning.text() + "\n";
    return text;
}

TEST(LightTracer, SaysWhatItCannotShow) {
    EXPECT_EQ(complaints(room(""), "integrator.max_bounces=5"), "");
    EXPECT_EQ(complaints(room(""), "integrator.darts=\"off\""), "");
    EXPECT_NE(complaints(room(""), "integrator.delta_time_gate=true").find("problem"), std::string::npos);
    EXPECT_NE(complaints(room(""), "camera.reconstruction_filter=\"dirac\"").find("camera.reconstruction_filter"),
              std::string::npos);
    const std::string mirrors = complaints(room(""), R"(bsdfs.metal={"name": "metal", "type": "mirror"})");
    EXPECT_NE(mirrors.find("mirror or refract"), std::string::npos);
    EXPECT_EQ(mirrors.find("''"), std::string::npos) << "names what has no name: " << mirrors;
    EXPECT_NE(complaints(room(""), "integrator.darts=\"best\"").find("plain"), std::string::npos);
    for (const char* wrong : {"integrator.darts=5", "integrator.darts=\"nonsense\"", "integrator.darts=[]",
                              R"(integrator.darts={"alpha": -1})"})
        EXPECT_NE(complaints(room(""), wrong).find("problem"), std::string::npos) << wrong;
}

} // namespace
} // namespace tungsten::test
