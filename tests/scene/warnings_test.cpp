// What loads, but may not be what was meant, is said.

#include "scene/problems_of.h"

#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

using test::SceneFile;
using test::warningsOf;

/// Warnings of a lamp at `height` above a unit cube of fog, seen from outside or from within fog that is everywhere.
std::string warningsOfLamp(const std::string& lamp, double height, bool everywhere) {
    return warningsOf(R"({"media": [{"name": "haze", "type": "homogeneous", "sigma_s": 1}], "primitives": [
        {"name": "cloud", "type": "cube", "int_medium": "haze", )" +
                      std::string(everywhere ? R"("ext_medium": "haze", )" : "") + R"("bsdf": {"type": "forward"}},
        {"name": "bulb", "emission": 3, )" +
                      lamp + R"(, "transform": {"position": [0.1, )" + std::to_string(height) +
                      R"(, 0], "scale": 0.2}}], "camera": {)" + (everywhere ? R"("medium": "haze", )" : "") +
                      R"("transform": {"position": [0, 0, 5], "look_at": [0, 0, 0]}}})");
}

/// The format casts numbers.
TEST(SceneWarnings, BrokenWholeNumbersAreWarnedAbout) {
    const auto warnings = [](const std::string& bounces, const std::string& width) {
        return warningsOf(R"({"primitives": [{"type": "point", "emission": 1}], "camera": {"resolution": [)" + width +
                          R"(, 8]}, "integrator": {"max_bounces": )" + bounces + "}}");
    };
    EXPECT_EQ(warnings("8.0", "1e1"), "");
    const std::string text = warnings("1.5", "8.7");
    EXPECT_NE(text.find("integrator.max_bounces: a whole number is meant: 1.5 counts as 1"), std::string::npos) << text;
    EXPECT_NE(text.find("camera.resolution: a whole number is meant: 8.7 counts as 8"), std::string::npos) << text;
}

TEST(SceneWarnings, LightsInAMediumTheyDoNotNameAreWarnedAbout) {
    for (const std::string lamp :
         {R"("type": "point")", R"("type": "sphere", "bsdf": {"type": "null"})", R"("type": "quad")"}) {
        SCOPED_TRACE(lamp);
        const std::string named = lamp + R"(, "ext_medium": "haze")";
        for (const auto& [height, everywhere] : {std::pair{0.0, false}, {2.0, true}}) {
            const std::string warning = warningsOfLamp(lamp, height, everywhere);
            for (const char* part : {"primitives[1].ext_medium", "'bulb'", "'haze'"})
                EXPECT_NE(warning.find(part), std::string::npos) << part << " in " << warning;
            EXPECT_EQ(warningsOfLamp(named, height, everywhere), "");
        }
        EXPECT_EQ(warningsOfLamp(lamp, 2.0, false), "");
    }
}

TEST(SceneWarnings, LightsInThePlaneOfASurfaceAreWarnedAbout) {
    const auto warnings = [](const std::string& type, const std::string& height) {
        return warningsOf(R"({"primitives": [{"name": "ceiling", "type": "quad", "transform": {"position": [0, 2, 0]}},
            {"name": "bulb", "emission": 1, "type": ")" +
                          type + R"(", "transform": {"position": [0.1, )" + height + R"(, 0]}}]})");
    };
    for (const std::string type : {"point", "spot", "directional_point"}) {
        const std::string warning = warnings(type, "2");
        for (const char* part : {"primitives[1].transform", "'bulb'", "'ceiling'", "rounding"})
            EXPECT_NE(warning.find(part), std::string::npos) << part << " in " << warning;
        EXPECT_EQ(warnings(type, "1.999"), "");
    }
}

TEST(SceneWarnings, WhatIsNotDoneIsSaid) {
    const std::string lamp = R"({"primitives": [{"type": "point", "emission": 1}], )";
    const std::string lens = lamp + R"("camera": {"type": "thinlens", "cateye": )";
    EXPECT_NE(warningsOf(lens + "0.5}}").find("camera.cateye"), std::string::npos);
    EXPECT_EQ(warningsOf(lens + "0}}"), "");
    const std::string gate = lamp + R"("integrator": {"type": "path_tracer", "transient_time_width": 0.5)";
    EXPECT_NE(warningsOf(gate + R"(, "transient_time_center": -2}})").find("steady state"), std::string::npos);
    EXPECT_NE(warningsOf(gate + "}}").find("steady state"), std::string::npos);
    for (const char* more : {R"(, "transient_time_center": 2}})", R"(, "frame_num": 2}})",
                             R"(, "temporal_response": {"type": "box", "end": 1}}})"})
        EXPECT_EQ(warningsOf(gate + more).find("steady state"), std::string::npos) << more;
}

TEST(SceneWarnings, TimesThatAreNotLookedAtAreSaid) {
    const std::string gate = R"({"primitives": [{"type": "point", "emission": 1}],
                                 "integrator": {"type": "path_tracer", )";
    const std::string film = gate + R"("transient_time_width": 0.5, "frame_num": 2, "start_time": 1.25)";
    EXPECT_EQ(warningsOf(film + "}}"), "");
    EXPECT_NE(warningsOf(film + R"(, "transient_time_center": 3}})")
                  .find("integrator.transient_time_center: not looked at beside frame_num: the first frame starts at "
                        "start_time (1.25)"),
              std::string::npos);
    EXPECT_NE(warningsOf(film + R"(, "transient_time_center": 3, "delta_time_gate": true}})")
                  .find("integrator.frame_num: not looked at beside delta_time_gate"),
              std::string::npos);
    const std::string centre = warningsOf(gate + R"("transient_time_center": 3}})");
    EXPECT_NE(centre.find("integrator.transient_time_center: no gate without a transient_time_width"),
              std::string::npos)
        << centre;
    EXPECT_EQ(warningsOf(gate + R"("transient_time_center": -1}})"), "");
    EXPECT_EQ(warningsOf(gate + R"("transient_time_center": 1, "temporal_response": {"type": "box", "end": 1}}})"), "");
    EXPECT_EQ(warningsOf(gate + R"("transient_time_center": 1, "delta_time_gate": true, "darts": "best"}})"), "");
}

std::string sceneOfSpeeds(const std::string& integrator, const std::string& medium) {
    return R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 1)" + medium + R"(}],
               "primitives": [{"type": "point", "emission": 1, "ext_medium": "fog"}], "camera": {"medium": "fog"},
               "integrator": {"type": "path_tracer")" +
           integrator + "}}";
}

TEST(SceneWarnings, MediaWithoutASpeedBesideAnotherVacuumAreWarnedAbout) {
    const std::string gate = R"(, "transient_time_width": 0.5, "transient_time_center": 3)";
    const std::string slow = gate + R"(, "vacuum_speed_of_light": 0.3)";
    EXPECT_NE(warningsOf(sceneOfSpeeds(slow, ""))
                  .find("media[0].speed_of_light: not given: light travels at 1 here, and at 0.3 outside media"),
              std::string::npos);
    EXPECT_EQ(warningsOf(sceneOfSpeeds(slow, R"(, "speed_of_light": 1)")), "");
    EXPECT_EQ(warningsOf(sceneOfSpeeds(gate, "")), "");
    EXPECT_EQ(warningsOf(sceneOfSpeeds(R"(, "vacuum_speed_of_light": 0.3)", "")), "")
        << "in steady state it is all one";
}

TEST(SceneLoader, BothSpellingsOfTheVacuumAreRead) {
    const auto speedOf = [](const std::string& fields) {
        const SceneFile file(sceneOfSpeeds(fields, ""));
        return loadScene(file.path()).scene->transport.vacuumSpeed;
    };
    EXPECT_EQ(speedOf(""), 1.0f);
    EXPECT_EQ(speedOf(R"(, "vacuum_speed_of_light": 0.3)"), 0.3f);
    EXPECT_EQ(speedOf(R"(, "vaccum_speed_of_light": 0.3)"), 0.3f);
    EXPECT_EQ(speedOf(R"(, "vacuum_speed_of_light": 0.3, "vaccum_speed_of_light": 0.3)"), 0.3f);
    try {
        speedOf(R"(, "vacuum_speed_of_light": 0.3, "vaccum_speed_of_light": 0.31)");
        FAIL() << "two speeds";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("integrator.vacuum_speed_of_light: is 0.3, but vaccum_speed_of_light"),
                  std::string::npos)
            << error.what();
    }
}

} // namespace
} // namespace tungsten
