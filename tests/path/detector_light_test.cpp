// Light that nothing has scattered, in detectors: every kind of light by every integrator, against closed forms.

#include "tungsten/scene/Scene.h"

#include "support/PathsAndPhotons.h"
#include "support/Quadrature.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace tungsten::path {
namespace {

/// By one integrator, steady or in frames.
struct DetectorMethod {
    std::string name, integrator; ///< fields of the integrator's block, its type first
    bool light = false, photons = false, progressive = false;
};

const std::vector<DetectorMethod>& detectorMethods() {
    static const std::vector<DetectorMethod> methods{
        {"paths", R"("type": "path_tracer")"},
        {"best paths", R"("type": "path_tracer", "darts": "best")"},
        {"light paths", R"("type": "light_tracer")", true},
        {"points", R"("type": "photon_map")", false, true},
        {"best points", R"("type": "progressive_photon_map", "darts": "best")", false, true, true},
        {"beams", R"("type": "progressive_photon_map", "volume_photon_type": "beams")", false, true, true}};
    return methods;
}

/// Power at each detector by frame. `fields`: more of the integrator's block, the gate included.
struct Powers {
    std::vector<std::vector<double>> mean, error;
};

Powers powersBy(const DetectorMethod& method, const std::string& scene, const std::string& fields, double width,
                const test::RenderOptions& options) {
    const std::string photons = R"(, "photon_count": 500, "volume_photon_count": 500, "gather_radius": 0.1)";
    std::string integrator = method.integrator;
    if (method.photons && fields.find("frame_num") != std::string::npos)
        integrator.insert(integrator.find("photon_map"), "transient_");
    const test::SceneFile file("{" + scene + R"(, "integrator": {)" + integrator + photons + fields + "}}");
    const auto rendered = method.light     ? test::renderLightFile(file.path(), options)
                          : method.photons ? test::renderPhotonFile(file.path(), options, method.progressive)
                                           : test::renderPathFile(file.path(), options);
    const auto& row = std::get<Detectors>(rendered->scene->camera.model).row;
    Powers powers;
    for (int frame = 0; frame < rendered->film.frames(); ++frame) {
        powers.mean.emplace_back();
        powers.error.emplace_back();
        for (size_t i = 0; i < row.size(); ++i) {
            const double scale = row[i].etendue() * width;
            powers.mean.back().push_back(double(rendered->film.mean(frame).at(int(i), 0).y) * scale);
            powers.error.back().push_back(double(rendered->film.standardError(frame).at(int(i), 0).y) * scale);
        }
    }
    return powers;
}

constexpr double ThinFogSigmaT = 0.5, LampHeight = 2.0, BucketRadius = 0.5;
const std::string ThinFog = R"("media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0.1, "sigma_s": 0.4}],)";

/// Two detectors about the origin that look up: a bucket, and one of a narrow cone.
std::string detectorsIn(const std::string& medium) {
    return R"("camera": {"type": "detectors", )" + (medium.empty() ? "" : R"("medium": ")" + medium + R"(", )") +
           R"("detectors": [{"direction": [0, 0, 1], "radius": 0.5, "numerical_aperture": 1},
                            {"direction": [0, 0, 1], "radius": 0.5, "numerical_aperture": 0.1}]})";
}

/// A point of unit power straight above: the part within a cone about the axis, behind an even depth of fog.
double partOfAPoint(double leastCosine, double sigma) {
    return 0.5 * test::integrate<31>([&](double c) { return std::exp(-sigma * LampHeight / c); }, leastCosine, 1.0);
}

struct DetectorLamp {
    std::string name, json; ///< fields of the primitive
    bool extended = false;  ///< it has no one time, nor one depth of fog, and the ball not one direction
    /// Power in bucket and narrow cone with the extinction of what is on the way.
    std::function<std::array<double, 2>(double sigma)> expected;
};

/// At (0, 0, 2), looking down.
std::vector<DetectorLamp> detectorLamps() {
    const double bucket = LampHeight / std::hypot(LampHeight, BucketRadius), narrow = std::sqrt(1.0 - 0.01);
    const double cone = std::cos(M_PI / 6.0);
    const auto beam = [](double part) {
        return [=](double sigma) {
            const double power = part * std::exp(-sigma * LampHeight);
            return std::array{power, power};
        };
    };
    const double disc = M_PI * M_PI * BucketRadius * BucketRadius;
    return {
        {"point", R"("type": "point", "power": 1)", false,
         [=](double sigma) {
             return std::array{partOfAPoint(bucket, sigma), partOfAPoint(narrow, sigma)};
         }},
        {"spot", R"("type": "spot", "power": 1, "cone_angle": 30, "edge_angle": 0)", false,
         [=](double sigma) {
             const double share = 2.0 / (1.0 - cone);
             return std::array{share * partOfAPoint(bucket, sigma), share * partOfAPoint(narrow, sigma)};
         }},
        {"directional_point", R"("type": "directional_point", "emission": 0.07957747154594767)", false, beam(1.0)},
        {"collimated", R"("type": "collimated", "radius": 0.2, "emission": 7.957747154594767)", false, beam(1.0)},
        {"wide collimated", R"("type": "collimated", "radius": 1, "emission": 0.3183098861837907)", false, beam(0.25)},
        {"collimated line", R"("type": "collimated", "emission": 1)", false, beam(1.0)},
        {"environment", R"("type": "infinite_sphere", "emission": 3)", true,
         [=](double) {
             return std::array{3.0 * disc, 0.03 * disc};
         }},
        // What passes through a plane that has all of the ball on one side is what a point in its middle sends.
        {"sphere", R"("type": "sphere", "bsdf": {"type": "null"}, "power": 1)", true,
         [=](double) {
             return std::array{partOfAPoint(bucket, 0.0), double(NAN)};
         }},
    };
}

std::string lampAbove(const DetectorLamp& lamp, const std::string& medium) {
    const std::string scale = lamp.name == "sphere" ? R"(, "scale": 0.3)" : "";
    return R"({"name": "lamp", )" + lamp.json + (medium.empty() ? "" : R"(, "ext_medium": ")" + medium + R"(")") +
           R"(, "transform": {"position": [0, 0, 2], "look_at": [0, 0, 0], "up": [0, 1, 0])" + scale + "}}";
}

void expectPower(const Powers& powers, size_t frame, size_t column, double expected) {
    const double mean = powers.mean[frame][column], error = powers.error[frame][column];
    EXPECT_NEAR(mean, expected, 4.5 * error + 2e-4 * expected) << "column " << column << " frame " << frame;
    EXPECT_LT(error, 0.06 * expected + 1e-5) << "too noisy to see a wrong value";
}

test::RenderOptions detectorEffort(const DetectorLamp& lamp, const DetectorMethod& method) {
    const bool met = lamp.name == "sphere" && !method.light; // by rays of the detector, and rarely
    return {{}, 20, met ? 10000u : 400u};
}

class DetectorLamps : public testing::TestWithParam<DetectorLamp> {};

TEST_P(DetectorLamps, ShineStraightIntoDetectors) {
    const DetectorLamp& lamp = GetParam();
    for (const DetectorMethod& method : detectorMethods())
        for (const bool fog : {false, true}) {
            if (fog && lamp.extended) continue;
            SCOPED_TRACE(method.name + (fog ? " in fog" : ""));
            const std::string scene = (fog ? ThinFog : "") + R"("primitives": [)" + lampAbove(lamp, fog ? "fog" : "") +
                                      "]," + detectorsIn(fog ? "fog" : "");
            const auto expected = lamp.expected(fog ? ThinFogSigmaT : 0.0);
            const auto effort = detectorEffort(lamp, method);
            const Powers steady = powersBy(method, scene, R"(, "max_bounces": 1)", 1.0, effort);
            for (size_t i = 0; i < 2; ++i)
                if (!std::isnan(expected[i])) expectPower(steady, 0, i, expected[i]);
            if (lamp.extended) continue;
            // From 2 to 2.07: all is in the frame from 2 to 2.5.
            const std::string gate =
                R"(, "max_bounces": 1, "start_time": 0.99, "transient_time_width": 0.5, "frame_num": 4)";
            const Powers frames = powersBy(method, scene, gate, 0.5, effort);
            for (size_t i = 0; i < 2; ++i)
                for (size_t frame = 0; frame < 4; ++frame)
                    expectPower(frames, frame, i, frame == 2 ? expected[i] : 0.0);
        }
}

INSTANTIATE_TEST_SUITE_P(All, DetectorLamps, testing::ValuesIn(detectorLamps()), [](const auto& test) {
    std::string name = test.param.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
});

/// What lies between a lamp and the detectors.
struct DetectorWay {
    std::string name, surfaces, lamp;
    std::array<double, 3> powers; ///< in the bucket: from 1.5 to 2.5 after the flash, and so on
};

std::string levelQuad(double height, const std::string& bsdf) {
    return R"({"type": "quad", "bsdf": )" + bsdf +
           R"(, "transform": {"rotation": [90, 0, 0], "scale": 20, "position": [0, 0, )" + std::to_string(height) +
           "]}},";
}
/// Of unit power, at 2.
std::string detectorLaser(double towards) {
    return R"({"type": "collimated", "radius": 0.1, "emission": 31.83098861837907,
               "transform": {"position": [0, 0, 2], "look_at": [0, 0, )" +
           std::to_string(towards) + R"(], "up": [0, 1, 0]}})";
}
const std::string DetectorPoint = R"({"type": "point", "power": 1, "transform": {"position": [0, 0, 2]}})";

std::vector<DetectorWay> detectorWays() {
    const double straight = partOfAPoint(LampHeight / std::hypot(LampHeight, BucketRadius), 0.0);
    const std::string boundary = levelQuad(1.0, R"({"type": "forward"})");
    const std::string sheet = levelQuad(1.0, R"({"type": "transparency", "alpha": 0.3, "base": {"type": "null"}})");
    // Above the point at 2, a mirror at 3 shows it at 4.
    const std::string mirror = levelQuad(3.0, R"({"type": "mirror", "albedo": 0.8})");
    const double shown = 0.8 * 0.5 * (1.0 - 4.0 / std::hypot(4.0, BucketRadius));
    // A cube from 0.9 to 1.1: both faces send back 0.04, and what goes back and forth inside gets out as well.
    const std::string pane =
        R"({"type": "cube", "bsdf": {"type": "dielectric", "ior": 1.5}, "transform": {"position": [0, 0, 1],
            "scale": [4, 4, 0.2]}},)";
    return {{"laser", "", detectorLaser(0), {1.0, 0.0, 0.0}},
            {"laser past", "", detectorLaser(3), {0.0, 0.0, 0.0}},
            {"laser through boundary", boundary, detectorLaser(0), {1.0, 0.0, 0.0}},
            {"point through boundary", boundary, DetectorPoint, {straight, 0.0, 0.0}},
            {"laser through sheet", sheet, detectorLaser(0), {0.7, 0.0, 0.0}},
            {"point through sheet", sheet, DetectorPoint, {0.7 * straight, 0.0, 0.0}},
            {"laser by mirror", mirror, detectorLaser(3), {0.0, 0.0, 0.8}},
            {"point by mirror", mirror, DetectorPoint, {straight, 0.0, shown}},
            {"laser through glass", pane, detectorLaser(0), {0.96 / 1.04, 0.0, 0.0}}};
}

class DetectorWays : public testing::TestWithParam<DetectorWay> {};

TEST_P(DetectorWays, BringLightToDetectors) {
    const DetectorWay& way = GetParam();
    const std::string scene = R"("primitives": [)" + way.surfaces + way.lamp + "]," + detectorsIn("");
    const double all = way.powers[0] + way.powers[1] + way.powers[2];
    for (const DetectorMethod& method : detectorMethods()) {
        SCOPED_TRACE(method.name);
        const test::RenderOptions effort{{}, 20, way.name == "point by mirror" ? 4000u : 200u};
        expectPower(powersBy(method, scene, "", 1.0, effort), 0, 0, all);
        const std::string gate = R"(, "transient_time_width": 1, "frame_num": 3, "start_time": )";
        const Powers frames = powersBy(method, scene, gate + "1.5", 1.0, effort);
        for (size_t i = 0; i < 3; ++i) expectPower(frames, i, 0, way.powers[i]);
        // All of the way is the camera's.
        const Powers unwarped = powersBy(method, scene, gate + R"(-0.5, "camera_unwarped": true)", 1.0, effort);
        for (size_t i = 0; i < 3; ++i) expectPower(unwarped, i, 0, i == 0 ? all : 0.0);
    }
}

INSTANTIATE_TEST_SUITE_P(All, DetectorWays, testing::ValuesIn(detectorWays()), [](const auto& test) {
    std::string name = test.param.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
});

/// A laser at 30 degrees to the axis is outside the narrow cone; one from behind, and one that starts behind, outside
/// both.
TEST(DetectorLight, IsAcceptedWithinTheConeFromInFront) {
    const auto scene = [](const std::string& from, const std::string& to) {
        return R"("primitives": [{"type": "directional_point", "emission": 0.07957747154594767, "transform": {"position": )" +
               from + R"(, "look_at": )" + to + R"(, "up": [0, 1, 0]}}],)" + detectorsIn("");
    };
    for (const DetectorMethod& method : detectorMethods()) {
        SCOPED_TRACE(method.name);
        const test::RenderOptions effort{{}, 4, 200};
        const Powers tilted = powersBy(method, scene("[1.1547005, 0, 2]", "[0, 0, 0]"), "", 1.0, effort);
        const Powers behind = powersBy(method, scene("[0, 0, -2]", "[0, 0, 0]"), "", 1.0, effort);
        const Powers beyond = powersBy(method, scene("[0, 0, -2]", "[0, 0, -3]"), "", 1.0, effort);
        expectPower(tilted, 0, 0, 1.0);
        expectPower(tilted, 0, 1, 0.0);
        for (size_t column = 0; column < 2; ++column) {
            expectPower(behind, 0, column, 0.0);
            expectPower(beyond, 0, column, 0.0);
        }
    }
}

/// By what it meets, surfaces of its way included; and what leaves out light without scattering.
TEST(DetectorLight, CountsAsAPathOfSoManyBounces) {
    const DetectorWay way = detectorWays()[6];
    ASSERT_EQ(way.name, "laser by mirror");
    const std::string scene = R"("primitives": [)" + way.surfaces + way.lamp + "]," + detectorsIn("");
    for (const DetectorMethod& method : detectorMethods()) {
        SCOPED_TRACE(method.name);
        for (int bounces = 0; bounces < 3; ++bounces) {
            const std::string only =
                R"(, "min_bounces": )" + std::to_string(bounces) + R"(, "max_bounces": )" + std::to_string(bounces + 1);
            expectPower(powersBy(method, scene, only, 1.0, {{}, 4, 100}), 0, 0, bounces == 1 ? 0.8 : 0.0);
        }
        expectPower(powersBy(method, scene, R"(, "include_surfaces": false)", 1.0, {{}, 4, 100}), 0, 0, 0.0);
    }
}

/// What rays of detectors meet in mirrors, after all that walls scatter.
TEST(DetectorLight, OfARoomWithAMirrorAgrees) {
    const std::string walls =
        R"({"type": "quad", "bsdf": {"type": "lambert", "albedo": 0.6}, "transform": {"position": [0, -1, 0], "scale": [4, 1, 4]}},
           {"type": "quad", "bsdf": {"type": "mirror", "albedo": 0.9},
            "transform": {"position": [0, 0, -2], "rotation": [90, 0, 0], "scale": [4, 1, 4]}},)";
    const std::string ball = R"({"type": "sphere", "bsdf": {"type": "null"}, "emission": 6,
                                 "transform": {"position": [0.5, 0.6, 0], "scale": 0.3}})";
    const std::string point = R"({"type": "point", "emission": 2, "transform": {"position": [0.5, 0.6, 0]}})";
    const std::string sky = R"({"type": "infinite_sphere", "emission": 1})";
    const std::string detector = R"("camera": {"type": "detectors", "detectors": [
        {"position": [0, 0, 2], "direction": [0, -0.2, -1], "radius": 0.4, "numerical_aperture": 0.8}]})";
    const std::string frames = R"(, "transient_time_width": 1.5, "frame_num": 4, "start_time": )", gate = frames + "1";
    const std::string unwarped = frames + R"(-0.5, "camera_unwarped": true)";
    const auto& methods = detectorMethods();
    for (const auto& [lamp, fields] : {std::pair{ball, std::string()},
                                       {ball, gate},
                                       {ball, unwarped},
                                       {point, gate},
                                       {point, unwarped},
                                       {sky, std::string()}}) {
        SCOPED_TRACE(lamp + fields);
        const std::string scene = R"("primitives": [)" + walls + lamp + "]," + detector;
        const std::string all = R"(, "max_bounces": 4)" + fields;
        // Paths from points by way of the mirror to the floor are what the path tracer misses: no floor in its sight.
        const bool floorless = lamp == point;
        const std::string lit =
            floorless ? R"("primitives": [)" + walls.substr(walls.find("}},") + 3) + lamp + "]," + detector : scene;
        const Powers paths = powersBy(methods[0], lit, all, 1.5, {{}, 20, 3000});
        const Powers light = powersBy(methods[2], lit, all, 1.5, {{}, 20, 6000});
        double total = 0.0;
        for (size_t frame = 0; frame < paths.mean.size(); ++frame) {
            const double error = std::hypot(paths.error[frame][0], light.error[frame][0]);
            EXPECT_NEAR(light.mean[frame][0], paths.mean[frame][0], 4.5 * error + 1e-6) << frame;
            EXPECT_LT(error, 0.1 * paths.mean[frame][0] + 5e-3) << frame;
            total += paths.mean[frame][0];
        }
        EXPECT_GT(total, 0.05);
    }
}

/// Light of a flash arrives at 2. A pulse from 0 to 2 arrives by and by; a response weighs times of arrival.
TEST(DetectorLight, IsRecordedByPulseAndResponse) {
    std::string laser = detectorLaser(0);
    const std::string pulse = R"("pulse": {"type": "box", "start": 0, "end": 2}, )";
    const std::string response = R"(, "transient_time_width": 2, "transient_time_center": 2,
        "temporal_response": {"times": [1, 2, 3], "values": [0, 1, 0]})";
    for (DetectorMethod method : detectorMethods()) {
        SCOPED_TRACE(method.name);
        const std::string flash = R"("primitives": [)" + laser + "]," + detectorsIn("");
        std::string lasting = flash;
        lasting.insert(lasting.find(R"("radius")"), pulse);
        const std::string gate = R"(, "start_time": 1.5, "transient_time_width": 1, "frame_num": 3)";
        const Powers frames = powersBy(method, lasting, gate, 1.0, {{}, 20, 2000});
        for (size_t i = 0; i < 3; ++i) expectPower(frames, i, 0, i == 1 ? 0.5 : 0.25);
        if (method.photons) method.integrator.insert(method.integrator.find("photon_map"), "transient_");
        expectPower(powersBy(method, flash, response, 1.0, {{}, 4, 200}), 0, 0, 1.0);
    }
}

/// Light of a laser that is scattered once: paths connect where it is to the detectors.
TEST(DetectorLight, OfALaserScatteredOnceAgrees) {
    const std::string laser = R"({"type": "collimated", "emission": 1, "ext_medium": "fog",
                                  "transform": {"position": [0, -0.2, 1], "look_at": [0, 3, 1]}})";
    const std::string scene = ThinFog + R"("primitives": [)" + laser + "]," + detectorsIn("fog");
    for (const std::string gate : {"", R"(, "start_time": 1, "transient_time_width": 1, "frame_num": 2)"}) {
        const std::string once = R"(, "min_bounces": 1, "max_bounces": 2)" + gate;
        const auto& methods = detectorMethods();
        const Powers light = powersBy(methods[2], scene, once, 1.0, {{}, 20, 2000});
        for (size_t m : {0, 1}) {
            SCOPED_TRACE(methods[m].name + gate);
            const Powers paths = powersBy(methods[m], scene, once, 1.0, {{}, 20, 2000});
            for (size_t frame = 0; frame < light.mean.size(); ++frame) {
                const double expected = light.mean[frame][0], error = light.error[frame][0];
                ASSERT_GT(expected, 0.0);
                EXPECT_NEAR(paths.mean[frame][0], expected, 4.5 * std::hypot(error, paths.error[frame][0]));
                EXPECT_LT(std::hypot(error, paths.error[frame][0]), 0.03 * expected);
            }
        }
    }
}

} // namespace
} // namespace tungsten::path
