// Scenes that mean harm, or hold values nothing can be done with: each is refused with its place, soon.

#include "scene/problems_of.h"

#include "tungsten/io/Writers.h"
#include "tungsten/scene/JsonWriter.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

using test::problemsOf;
using test::SceneFile;

const char* const Lit = R"({
    "media": [{"name": "fog", "type": "homogeneous", "sigma_s": 1}],
    "bsdfs": [{"name": "grey", "type": "lambert", "albedo": 0.5}],
    "primitives": [{"name": "lamp", "type": "point", "emission": 1},
                   {"name": "box", "type": "cube", "bsdf": "grey", "int_medium": "fog"}],
    "camera": {"type": "thinlens", "resolution": [4, 4], "transform": {"position": [0, 0, 5], "look_at": [0, 0, 0]}},
    "integrator": {"type": "path_tracer"}})";

std::string times(const std::string& text, size_t count) {
    std::string all;
    for (size_t i = 0; i < count; ++i) all += text;
    return all;
}

TEST(HostileScene, NestingHasALimit) {
    struct Nest {
        std::string open, inner, close, field;
    };
    const std::vector<Nest> nests{
        {"[", "", "]", "camera.extra"},
        {R"({"a":)", "1", "}", "camera.extra"},
        {R"({"type":"transparency","base":)", "\"grey\"", "}", "primitives.box.bsdf"},
        {R"({"type":"mixed","bsdf0":"grey","bsdf1":)", "\"grey\"", "}", "primitives.box.bsdf"}};
    for (const Nest& nest : nests) {
        const auto value = [&](size_t levels) {
            return times(nest.open, levels) + nest.inner + times(nest.close, levels);
        };
        EXPECT_NE(problemsOf(Lit, {nest.field + "=" + value(60000)}).find("nested more than 256 levels"),
                  std::string::npos);
        EXPECT_EQ(problemsOf(Lit, {nest.field + "=" + value(100)}), "");
        const std::string text = problemsOf("{\n \"x\": " + value(60000) + "}");
        EXPECT_NE(text.find("line 2, column"), std::string::npos) << text.substr(0, 200);
        EXPECT_NE(text.find("nested more than 256 levels"), std::string::npos);
    }
}

/// Names of files would end there, and the parser does.
TEST(HostileScene, ZeroBytesAreRefused) {
    EXPECT_NE(problemsOf(std::string(Lit) + std::string("\n\0 garbage", 10)).find("line 8, column 1: a zero byte"),
              std::string::npos);
    EXPECT_NE(problemsOf(Lit, {R"(renderer.output_file="q.png\u0000.exe")"}).find("a zero byte in a string"),
              std::string::npos);
    EXPECT_NE(problemsOf(R"({"primitives": [{"na\u0000me": "x"}]})").find("a zero byte in a string"),
              std::string::npos);
}

/// A terminal would act on them.
TEST(HostileScene, ControlCharactersArePrintedAsNumbers) {
    const std::string text = problemsOf(Lit, {R"(primitives.box.bsdf="\u001b]0;x\u0007\u009b2J\n\u00e9")"});
    EXPECT_NE(text.find("'\\x1b]0;x\\x07\\x9b2J\\x0a\xc3\xa9'"), std::string::npos) << text;
    const std::string length = problemsOf(Lit, {"primitives.box.bsdf=" + times("x", 1000000)});
    EXPECT_LT(length.size(), 5000u);
}

TEST(HostileScene, ADeepOrBranchingBsdfIsRefused) {
    std::string bsdfs = R"({"bsdfs": [{"name": "m0", "type": "lambert"})";
    for (int i = 1; i <= 60; ++i) {
        const std::string part = "\"m" + std::to_string(i - 1) + "\"";
        bsdfs += R"(, {"name": "m)" + std::to_string(i) + R"(", "type": "mixed", "bsdf0": )" + part +
                 ", \"bsdf1\": " + part + "}";
    }
    const std::string text = problemsOf(bsdfs + "]}");
    EXPECT_NE(text.find("bsdfs[8]: consists of more than 256 BSDFs"), std::string::npos) << text;
    EXPECT_EQ(problemsOf(R"({"primitives": [],
        "bsdfs": [{"type": "mixed", "bsdf0": {"type": "mirror"}, "bsdf1": {"type": "lambert"}}]})"),
              "");
}

struct BadValue {
    std::string assignment, expected;
};

void expectRefused(const std::vector<BadValue>& values) {
    for (const auto& [assignment, expected] : values) {
        const std::string text = problemsOf(Lit, {assignment});
        EXPECT_NE(text.find(expected), std::string::npos) << assignment << " gives: " << text;
    }
}

TEST(HostileScene, NumbersThatFloatsCannotHoldAreRefused) {
    std::vector<BadValue> values{
        {"camera.focus_distance=3.5e38",
         "camera.focus_distance: expected a number from 1e-9 to 1e9, found the number 3.5e38"},
        {"camera.fov=NaN", "camera.fov"},
        {"camera.transform=[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,1]", "camera.transform"},
        {"camera.transform={\"scale\": 0}", "camera.transform"},
        {"camera.transform={\"position\": 1e30}", "camera.transform.position"},
        {"primitives.box.transform={\"scale\": 1e30}", "primitives[1].transform.scale"},
        {"primitives.lamp.emission_time=1e19", "emission_time"},
        {"primitives.lamp.emission=1e39", "primitives[0].emission"},
        {"media.fog.sigma_s=1e39", "media[0].sigma_s"},
        {"media.fog.speed_of_light=1e-300", "media[0].speed_of_light"},
        {"media.fog.speed_of_light=1e300", "media[0].speed_of_light"},
        {"primitives.box.int_speed_of_light=1e-300", "primitives[1].int_speed_of_light"},
        {"primitives.lamp.ext_speed_of_light=1e-300", "primitives[0].ext_speed_of_light"},
        {"integrator.vaccum_speed_of_light=1e-300", "integrator.vaccum_speed_of_light"},
        {"integrator={\"transient_time_center\": 1e19, \"transient_time_width\": 1}",
         "integrator.transient_time_center"},
        {"integrator={\"transient_time_center\": 1e12, \"transient_time_width\": 1, \"vaccum_speed_of_light\": 1e9}",
         "integrator: light would go"},
        {"integrator.temporal_response={\"times\": [0, 1e300], \"values\": [1, 1]}", "times[1]"},
    };
    // Each of the sixteen numbers, of camera and primitive.
    for (const char* field : {"camera.transform", "primitives.box.transform"})
        for (const char* bad : {"NaN", "Inf", "1e308", "1e30"})
            for (size_t i = 0; i < 12; ++i) {
                std::string matrix;
                for (size_t k = 0; k < 16; ++k)
                    matrix += (k ? "," : "") + (k == i ? std::string(bad) : std::string(k % 5 == 0 ? "1" : "0"));
                values.push_back({std::string(field) + "=[" + matrix + "]", "transform[" + std::to_string(i) + "]"});
            }
    expectRefused(values);
}

TEST(HostileScene, SurfacesThatWouldVanishAreRefused) {
    const test::FileFolder folder;
    folder.write("far.obj", "v 0 0 0\nv 3e9 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto file = folder.write("scene.json", R"({"primitives": [{"type": "mesh", "file": "far.obj"}]})");
    try {
        loadScene(file);
        FAIL() << "a mesh that far out is accepted";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("primitives[0].transform: the surface reaches beyond"),
                  std::string::npos)
            << error.what();
    }
}

TEST(HostileScene, ValuesOfTheWrongKindAreRefused) {
    expectRefused({{"camera=null", "camera: expected an object, found null"},
                   {"camera=5", "camera: expected an object"},
                   {"camera=[]", "camera: expected an object"},
                   {"renderer=true", "renderer: expected an object"},
                   {"media=null", "media: expected an array"},
                   {"primitives.box.bsdf=[]", "primitives[1].bsdf: expected at least one BSDF"},
                   {"primitives.box.bsdf={\"type\": \"rough_plastic\", \"albedo\": 2}",
                    "primitives[1].bsdf.albedo: expected one number or an array of 3, each a number from 0 to 1"}});
}

TEST(HostileScene, TexelsOutOfRangeAreRefused) {
    const test::FileFolder folder;
    Image image(2, 2);
    image.pixels = {Rgb(0.5f), Rgb(0.5f), Rgb(-0.25f), Rgb(0.5f)};
    writePfm(folder.path("negative.pfm"), image);
    image.pixels[2] = Rgb(1.5f);
    writePfm(folder.path("bright.pfm"), image);
    const auto problems = [&](const std::string& fields) -> std::string {
        const auto file = folder.write("scene.json", R"({"primitives": [{"type": "quad", )" + fields + "}]}");
        try {
            loadScene(file);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(problems(R"("emission": "negative.pfm")").find("found values from -0.25 to 0.5"), std::string::npos);
    EXPECT_NE(problems(R"("bsdf": {"type": "lambert", "albedo": "negative.pfm"})").find("-0.25"), std::string::npos);
    EXPECT_NE(problems(R"("bsdf": {"type": "lambert", "albedo": "bright.pfm"})").find("0.5 to 1.5"), std::string::npos);
    EXPECT_EQ(problems(R"("emission": "bright.pfm")"), "");
    EXPECT_EQ(problems(R"("bsdf": {"type": "lambert", "bump": "negative.pfm"})"), "") << "heights may be negative";
}

/// Misspelt references: as many as there are names would make every pair be compared.
TEST(HostileScene, ManyProblemsAreListedInPart) {
    std::string bsdfs, primitives;
    for (int i = 0; i < 20000; ++i) {
        bsdfs += (i ? "," : "") + std::string(R"({"type": "lambert", "name": "material )") + std::to_string(i) + "\"}";
        primitives +=
            (i ? "," : "") + std::string(R"({"type": "quad", "bsdf": "materail )") + std::to_string(i) + "\"}";
    }
    const SceneFile file("{\"bsdfs\": [" + bsdfs + "], \"primitives\": [" + primitives + "]}");
    try {
        loadScene(file.path());
        FAIL();
    } catch (const InputError& error) {
        ASSERT_EQ(error.problems().size(), Diagnostics::MostListed + 1);
        EXPECT_NE(error.problems()[0].message.find("did you mean 'material 0'?"), std::string::npos);
        EXPECT_EQ(error.problems().back().message, "and 19900 more");
    }
}

TEST(HostileScene, JsonOfStatisticsIsUtf8) {
    JsonWriter json;
    json.field("a", std::string("\xff \xc3\xa9 \xc0\x80 \xed\xa0\x80 \xf0\x9f\x98\x80 \xe2\x82"));
    const std::string text = json.finish(), bad = "\xef\xbf\xbd";
    EXPECT_NE(text.find(bad + " \xc3\xa9 " + bad + bad + " " + bad + bad + bad + " \xf0\x9f\x98\x80 " + bad + bad),
              std::string::npos)
        << text;
}

} // namespace
} // namespace tungsten
