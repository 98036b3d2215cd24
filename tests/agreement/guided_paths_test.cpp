// Guided paths against plain ones: every switch alone, limits of bounces and orders, emitters of every kind.

#include "support/AgreementScenes.h"
#include "support/GroundTruthScenes.h"

#include <gtest/gtest.h>

namespace tungsten::test {
namespace {

Method switched(const std::string& name, const std::string& fields) {
    return guidedPathMethod(name, {R"(darts={"preset": "best", "plain_share": 0, )" + fields + "}"}, 5);
}

void expectAgreement(const AgreementScene& scene, const Method& method, const BlockMeans& reference) {
    SCOPED_TRACE(scene.name + ", " + method.name);
    const Agreement agreement = compare(renderBlocks(scene, method), reference);
    EXPECT_LE(agreement.score(), 1.0) << agreement;
    EXPECT_LT(agreement.wholeError, 0.05) << "too noisy to be a proof: " << agreement;
}

const Method Plain = pathMethod("plain", {}, 1),
             // Hardly noisier than plain ones; beside plain ones, in between.
    Best = guidedPathMethod("best", {R"(darts={"plain_share": 0})"}, 4, 0.125),
             BesidePlain = guidedPathMethod("beside plain", {R"(darts={"plain_share": 0.2})"}, 18, 0.6);

class SwitchesAlone : public testing::TestWithParam<const char*> {};

TEST_P(SwitchesAlone, AgreeWithPlainPaths) {
    std::vector<AgreementScene> scenes = singleGateScenes();
    AgreementScene& scene =
        *std::find_if(scenes.begin(), scenes.end(), [](const AgreementScene& s) { return s.name == GetParam(); });
    const bool glass = scene.name == "glass-tank";
    scene.effort.pathSamples = glass ? 32 : 12;
    const BlockMeans reference = renderBlocks(scene, Plain);
    // Glass makes a difference to what is connected and how far flights go, not to where they go.
    std::vector<Method> methods{guidedPathMethod("elliptical only", {"enable_elliptical=true"}, 3),
                                switched("unbounded", R"("bounded": false)"),
                                switched("no light vertices", R"("surface_connections": false)"),
                                switched("diffusion", R"("greens_function": "diffusion")")};
    if (!glass) {
        expectAgreement(scene, guidedPathMethod("guiding only", {"enable_guiding=true"}, 2), reference);
        for (const char* direction : {"phase", "eda"})
            methods.push_back(switched(direction, R"("direction": ")" + std::string(direction) + "\""));
        methods.push_back(guidedPathMethod(
            "ris", {R"(darts={"preset": "published", "direction": "ris", "length_first": true, "bounded": true})"}, 5));
    }
    // Through glass they are as noisy as plain paths, else much less so.
    if (!glass) scene.effort.pathSamples /= 4;
    for (const Method& method : methods) expectAgreement(scene, method, reference);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SwitchesAlone, testing::Values("cornell-fog", "glass-tank"),
                         [](const auto& instance) { return instance.param[0] == 'c' ? "CornellFog" : "GlassTank"; });

/// Fog with a wall and a floor that scatter, an index-matched glass pane across, and `light`; colours on purpose.
std::string fogRoom(const std::string& light) {
    return R"({"media": [{"name": "fog", "type": "guided_homo", "sigma_a": [0.05, 0.1, 0.15], "sigma_s": [0.4, 0.3, 0.25]}],
     "bsdfs": [{"name": "grey", "type": "lambert", "albedo": [0.7, 0.6, 0.5]},
               {"name": "gloss", "type": "rough_conductor", "roughness": 0.4, "material": "Al"}],
     "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"}, "transform": {"scale": 5}},
                    {"type": "quad", "bsdf": "grey", "int_medium": "fog", "ext_medium": "fog", "transform": {"position": [0, -1.2, 0], "scale": 3}},
                    {"type": "quad", "bsdf": "gloss", "int_medium": "fog", "ext_medium": "fog",
                     "transform": {"position": [0, 0, -1.3], "rotation": [90, 0, 0], "scale": 3}}, )" +
           light + R"(],
     "camera": {"type": "pinhole", "fov": 40, "reconstruction_filter": "box",
                "transform": {"position": [0, 0.5, 6], "look_at": [0, -0.3, 0], "up": [0, 1, 0]}},
     "integrator": {"max_bounces": 12, "transient_time_center": 8.5, "transient_time_width": 0.6}})";
}
const std::string Ball = R"({"type": "sphere", "ext_medium": "fog", "bsdf": {"type": "null"}, "emission": 20,
    "transform": {"position": [0.7, 0.3, 0.4], "scale": 0.25}})";

/// A scene by what is special about it: an emitter in the room, or settings.
struct RoomCase {
    const char* name;
    std::string light;
    std::vector<std::string> settings;  ///< of the integrator, "field=value"
    std::vector<std::string> overrides; ///< elsewhere
};

// Outside the fog, where connections to points have finite variance.
const std::string Above = R"("transform": {"position": [1.5, 3.2, 1], "look_at": [0, -0.5, 0], "up": [0, 0, 1]}})";
const std::string Unwarped = "camera_unwarped=true", UnwarpedCentre = "transient_time_center=3.5";

std::vector<RoomCase> roomCases() {
    return {
        {"ThreeBounces", Ball, {"min_bounces=3", "max_bounces=4"}, {}},
        {"TwoFlights", Ball, {}, {"media.0.max_bounces=2"}},
        {"HighOrders", Ball, {"low_order_scattering=false"}, {}},
        {"NoSurfaces", Ball, {"include_surfaces=false"}, {}},
        {"UnwarpedThreeBounces", Ball, {Unwarped, UnwarpedCentre, "min_bounces=3", "max_bounces=4"}, {}},
        {"ConsistencyChecks", Ball, {"enable_consistency_checks=true", "enable_two_sided_shading=false"}, {}},
        {"Spot", R"({"type": "spot", "emission": 60, "cone_angle": 25, )" + Above, {}, {}},
        {"Disk",
         R"({"type": "disk", "bsdf": {"type": "null"}, "emission": 60,
                 "transform": {"position": [0, 3, 0.5], "rotation": [180, 0, 0], "scale": 0.5}})",
         {},
         {}},
        {"Laser", R"({"type": "collimated", "emission": 30, )" + Above, {}, {}},
        {"BallAndLatePoint", Ball + R"(, {"type": "point", "emission": 30, "emission_time": 0.8, )" + Above, {}, {}}};
}

class GuidedRoom : public testing::TestWithParam<RoomCase> {};

TEST_P(GuidedRoom, AgreesWithPlainPaths) {
    AgreementScene scene = builtScene(GetParam().name, fogRoom(GetParam().light), 0.1, {32, 32, 0, 0});
    scene.overrides = GetParam().overrides;
    for (const std::string& field : GetParam().settings) scene.overrides.push_back("integrator." + field);
    const BlockMeans reference = renderBlocks(scene, Plain);
    for (const Method& method : {Best, BesidePlain}) expectAgreement(scene, method, reference);
}

INSTANTIATE_TEST_SUITE_P(Cases, GuidedRoom, testing::ValuesIn(roomCases()),
                         [](const auto& instance) { return std::string(instance.param.name); });

} // namespace
} // namespace tungsten::test
