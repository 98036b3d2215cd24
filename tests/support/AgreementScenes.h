#pragma once
// The scenes on which methods must agree. Emitters have a surface: a connection to a point of light in a medium has
// infinite variance, so a path tracer's standard error would mean little.

#include "support/Agreement.h"
#include "support/Folders.h"

namespace tungsten::test {

/// A glowing ball in a cube of fog with an index-matched boundary, seen from outside.
inline std::string fogCube(const std::string& coefficients, double g) {
    return R"({"media": [{"name": "fog", "type": "homogeneous", )" + coefficients +
           R"(, "phase_function": {"type": "henyey_greenstein", "g": )" + std::to_string(g) + R"(}}],
     "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"}, "transform": {"scale": 3}},
                    {"type": "sphere", "ext_medium": "fog", "bsdf": {"type": "null"}, "emission": 20,
                     "transform": {"position": [0.5, 0.6, 0.3], "scale": 0.25}}],
     "camera": {"type": "pinhole", "fov": 44, "reconstruction_filter": "box",
                "transform": {"position": [0, 0, -5], "look_at": [0, 0, 0], "up": [0, 1, 0]}},
     "integrator": {"max_bounces": 12, "transient_time_center": 5.7, "transient_time_width": 0.3}})";
}

/// A cube of fog in which light is slower, behind an index-matched boundary, over a grey floor in vacuum.
inline std::string slowCloud() {
    return R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0.1, "sigma_s": [0.8, 0.6, 0.5],
                          "speed_of_light": 0.6}],
     "bsdfs": [{"name": "grey", "type": "lambert", "albedo": 0.6}],
     "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"},
                     "transform": {"position": [0, 1.2, 0], "scale": 1.6}},
                    {"type": "quad", "bsdf": "grey", "transform": {"scale": [6, 1, 6]}},
                    {"type": "sphere", "bsdf": {"type": "null"}, "emission": 20,
                     "transform": {"position": [-1.4, 1.8, 1], "scale": 0.25}}],
     "camera": {"type": "pinhole", "fov": 40, "reconstruction_filter": "box",
                "transform": {"position": [0, 1.8, 5], "look_at": [0, 0.9, 0], "up": [0, 1, 0]}},
     "integrator": {"max_bounces": 16, "transient_time_center": 6.7, "transient_time_width": 0.3}})";
}

/// A scene built from text, in a temporary file of its own.
inline AgreementScene builtScene(const std::string& name, const std::string& json, double radius, Effort effort) {
    auto file = std::make_shared<const SceneFile>(json);
    return {name, file->path(), {}, 24, 24, radius, effort, file, false};
}
inline AgreementScene shippedScene(const std::string& name, std::vector<std::string> overrides, double radius,
                                   Effort effort) {
    return {name, dataFolder() / "scenes" / name / "scene.json", std::move(overrides), 24, 24, radius, effort, nullptr,
            false};
}

/// Twenty frames that hold all scattered light there is; the ball itself is left out, which would outshine the rest.
inline AgreementScene fogSequence() {
    AgreementScene scene =
        builtScene("sequence", fogCube(R"("sigma_a": 0.1, "sigma_s": 0.6)", 0.0), 0.16, {32, 56, 18, 36000});
    scene.overrides = {"integrator.min_bounces=2", "integrator.start_time=5", "integrator.transient_time_width=0.5",
                       "integrator.frame_num=20", "integrator.transient_time_center=-1"};
    return scene;
}
inline constexpr double SequenceFrameWidth = 0.5;
inline AgreementScene fogInSteadyState() {
    AgreementScene scene = fogSequence();
    scene.name = "steady-state";
    scene.steadyState = true;
    scene.effort.photonPasses = 12;
    return scene;
}

/// Leave errors of a few per cent in a block; less is enough where faults are still seen (harness_test.cpp).
inline constexpr Effort Plenty{32, 128, 32, 40000}, Enough{32, 64, 32, 20000};

/// The proofs' scenes with a single gate, with the effort of a test.
inline std::vector<AgreementScene> singleGateScenes() {
    const std::string ball = R"(primitives.pulse={"name": "pulse", "type": "sphere", "ext_medium": "fog",
        "bsdf": {"type": "null"}, "emission": [260, 240, 195],
        "transform": {"position": [0.3, 1.65, 0.1], "scale": 0.12}})";
    return {
        shippedScene("cornell-fog", {ball}, 0.08, {32, 48, 20, 25000}),
        shippedScene("mirror-fog", {}, 0.12, {32, 128, 36, 50000}),
        shippedScene(
            "two-pulses",
            {"integrator.frame_num=0", "integrator.transient_time_center=7.6", "integrator.transient_time_width=0.3"},
            0.1, {32, 160, 36, 50000}),
        builtScene("forward-fog", fogCube(R"("sigma_a": 0.1, "sigma_s": 0.6)", 0.7), 0.12, Plenty),
        builtScene("backward-fog", fogCube(R"("sigma_a": 0.1, "sigma_s": 0.6)", -0.4), 0.12, Enough),
        builtScene("coloured-fog", fogCube(R"("sigma_a": [0.3, 0.15, 0.08], "sigma_s": [0.25, 0.5, 1])", 0.2), 0.12,
                   Enough),
        builtScene("slow-cloud", slowCloud(), 0.12, {32, 128, 48, 40000}),
        shippedScene("glass-tank", {}, 0.1, Enough),
    };
}
/// All of them.
inline std::vector<AgreementScene> agreementScenes() {
    std::vector<AgreementScene> scenes = singleGateScenes();
    scenes.insert(scenes.end(), {fogSequence(), fogInSteadyState()});
    return scenes;
}

} // namespace tungsten::test
