// Who names another medium than what it sees is told, and nobody else.

#include "scene/problems_of.h"

#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tungsten {
namespace {

using test::warningsOf;

/// A scene of bodies of index-matched surfaces in media a and b (c scatters nothing), lit from far away.
std::string sceneOf(const std::string& bodies, const std::string& camera,
                    const std::string& lamp = R"("transform": {"position": [0, 50, 0]})") { // far away
    return R"({"media": [{"name": "a", "type": "homogeneous", "sigma_s": 1}, {"name": "b", "type": "homogeneous",
        "sigma_s": 2}, {"name": "c", "type": "homogeneous"}], "bsdfs": [{"name": "open", "type": "forward"}],
        "primitives": [{"name": "lamp", "type": "point", "emission": 1, )" +
           lamp + "}" + (bodies.empty() ? "" : ", ") + bodies + R"(], "camera": {)" + camera + "}}";
}

/// One body about the origin, or elsewhere.
std::string body(const std::string& name, const std::string& type, const std::string& scale, const std::string& media,
                 const std::string& position = "[0, 0, 0]") {
    return R"({"name": ")" + name + R"(", "type": ")" + type + R"(", "bsdf": "open", )" + media +
           R"("transform": {"position": )" + position + R"(, "scale": )" + scale + "}}";
}

const std::string FarIn = R"("transform": {"position": [0, 50, 0]}, "ext_medium": )";
const std::string Inside = R"("transform": {"position": [0.1, 0.1, 0.2], "look_at": [0, 0, -5]})";
const std::string Outside = R"("transform": {"position": [0.1, 0.1, 9], "look_at": [0, 0, -5]})";

void expectOne(const std::string& warnings, const std::vector<std::string>& parts) {
    EXPECT_EQ(std::count(warnings.begin(), warnings.end(), '\n'), 1) << warnings;
    for (const std::string& part : parts) EXPECT_NE(warnings.find(part), std::string::npos) << part << "\n" << warnings;
}

/// A box of six quads about the origin: their normals look out.
std::string boxOfQuads(const std::string& media, int quads = 6) {
    const char* placements[] = {
        R"("position": [0, 0, 1], "rotation": [90, 0, 0])",   R"("position": [0, 0, -1], "rotation": [-90, 0, 0])",
        R"("position": [1, 0, 0], "rotation": [0, 0, -90])",  R"("position": [-1, 0, 0], "rotation": [0, 0, 90])",
        R"("position": [0, -1, 0], "rotation": [180, 0, 0])", R"("position": [0, 1, 0])"};
    std::string box;
    for (int i = 0; i < quads; ++i)
        box += std::string(i > 0 ? ", " : "") + R"({"type": "quad", "bsdf": "open", )" + media +
               R"("transform": {"scale": 2, )" + placements[i] + "}}";
    return box;
}

TEST(MediaAgreement, CamerasInABodyWhoseMediumTheyDoNotNameAreWarnedAbout) {
    const std::string fog = R"("int_medium": "a", )";
    for (const std::string& bodies : {body("fog", "sphere", "2", fog), body("fog", "cube", "4", fog), boxOfQuads(fog),
                                      // the innermost of nested ones, through glass that names nothing
                                      body("outer", "cube", "6", R"("int_medium": "b", )") + ", " +
                                          body("fog", "sphere", "2", R"("int_medium": "a", "ext_medium": "b", )") +
                                          R"(, {"type": "sphere", "bsdf": {"type": "dielectric"}})"})
        for (const std::string type :
             {R"("pinhole")", R"("thinlens")", R"("orthographic", "orthographic_size": 0.3)"}) {
            SCOPED_TRACE(type + " in " + bodies);
            const std::string camera = R"("type": )" + type + ", " + Inside;
            expectOne(warningsOf(sceneOf(bodies, camera)), {"camera.medium: the camera is in medium 'a'", "vacuum"});
            expectOne(warningsOf(sceneOf(bodies, camera + R"(, "medium": "c")")), {"camera.medium", "'c'", "'a'"});
            EXPECT_EQ(warningsOf(sceneOf(bodies, camera + R"(, "medium": "a")")), "");
            EXPECT_EQ(warningsOf(sceneOf(bodies, R"("type": )" + type + ", " + Outside)), "");
        }
}

TEST(MediaAgreement, DetectorsInABodyAreWarnedAbout) {
    const std::string row = R"("type": "detectors", "detectors": [{"position": [0, 0, 5], "direction": [0, 0, -1]},
                               {"name": "probe", "position": [0, 0, 0.5], "direction": [1, 0, 0]}])";
    const std::string fog = body("fog", "sphere", "2", R"("int_medium": "a", )");
    expectOne(warningsOf(sceneOf(fog, row)), {"camera.medium", "'probe' is in medium 'a'", "'fog'"});
    // Named, the medium is wrong of the one outside: what it looks at names none there.
    expectOne(warningsOf(sceneOf(fog, row + R"(, "medium": "a")", FarIn + "\"a\"")),
              {"primitives[1].ext_medium", "detector 0", "'a'"});
    EXPECT_EQ(warningsOf(sceneOf(body("fog", "sphere", "0.4", R"("int_medium": "a", )"), row)), "");
}

TEST(MediaAgreement, CamerasThatNameAMediumThatWhatTheySeeDoesNotNameAreWarnedAbout) {
    const std::string fog = body("fog", "cube", "2", R"("int_medium": "a", )");
    expectOne(warningsOf(sceneOf(fog, Outside + R"(, "medium": "b")", FarIn + "\"b\"")),
              {"primitives[1].ext_medium", "the camera", "'b'"});
    const std::string both = body("fog", "cube", "2", R"("int_medium": "a", "ext_medium": "b", )");
    EXPECT_EQ(warningsOf(sceneOf(both, Outside + R"(, "medium": "b")", FarIn + "\"b\"")), "");
}

TEST(MediaAgreement, LightsThatNameAnotherMediumAreWarnedAbout) {
    const std::string fog = body("fog", "cube", "2", R"("int_medium": "a", )");
    expectOne(warningsOf(sceneOf(fog, Outside, R"("ext_medium": "b")")), {"primitives[0].ext_medium", "'b'", "'a'"});
    EXPECT_EQ(warningsOf(sceneOf(fog, Outside, R"("ext_medium": "a")")), "");
    // In media without an end.
    expectOne(warningsOf(sceneOf("", Outside + R"(, "medium": "a")")), {"primitives[0].ext_medium", "'lamp'", "'a'"});
    expectOne(warningsOf(sceneOf("", Outside, R"("ext_medium": "a")")), {"primitives[0].ext_medium", "the camera"});
}

TEST(MediaAgreement, SurfacesThatDisagreeAreWarnedAbout) {
    const std::string ball = body("ball", "sphere", "2", R"("int_medium": "a", )");
    for (const std::string type : {"cube", "sphere"})
        for (const std::string scale : {"0.5", "0.01"}) {
            SCOPED_TRACE(type);
            const std::string named = R"("int_medium": "c", "ext_medium": "a", )", alone = R"("int_medium": "c", )";
            EXPECT_EQ(warningsOf(sceneOf(ball + ", " + body("bubble", type, scale, named), Outside)), "");
            expectOne(warningsOf(sceneOf(ball + ", " + body("bubble", type, scale, alone, "[0.3, 0.1, 0]"), Outside)),
                      {"primitives[2].ext_medium: 'bubble' names no ext_medium", "vacuum", "'ball'", "'a'"});
        }
    for (const std::string type : {"disk", "quad"})
        for (const std::string field : {"int_medium", "ext_medium"}) // a sheet whose other side agrees
            expectOne(
                warningsOf(sceneOf(ball + ", " + body("sheet", type, "0.5", "\"" + field + R"(": "a", )"), Outside)),
                {"primitives[2]", "'sheet' names no", "'ball'", "'a'"});
    const std::string bubble = body("bubble", "cube", "0.5", R"("int_medium": "c", "ext_medium": "b", )");
    expectOne(warningsOf(sceneOf(ball + ", " + bubble, Outside)), {"ext_medium", "'b'", "'a'", "'ball'", "'bubble'"});
    expectOne(warningsOf(sceneOf(body("ball", "sphere", "2", R"("ext_medium": "c", )") + ", " + bubble,
                                 Outside + R"(, "medium": "c")", FarIn + "\"c\"")),
              {"primitives[1].int_medium: 'ball' names no int_medium", "'bubble'", "'b'"});
}

/// What bounds bodies rightly, or bounds nothing.
TEST(MediaAgreement, WhatAgreesIsNotWarnedAbout) {
    const std::string left = R"("int_medium": "a", )", right = R"("int_medium": "b", )";
    const std::string opaque = R"({"type": "sphere", "bsdf": {"type": "lambert"}, "transform": {"scale": 0.3}})";
    for (const std::string& bodies :
         {// side by side, with the same face
          body("left", "cube", "2", left, "[-1, 0, 0]") + ", " + body("right", "cube", "2", right, "[1, 0, 0]"),
          // one on the other, of which only the upper one names the other
          body("low", "cube", "2", left, "[0, -1, 0]") + ", " +
              body("high", "cube", "[1, 2, 1]", R"("int_medium": "b", )", "[0, 1, 0]"),
          // on a floor
          body("fog", "cube", "2", left, "[0, 1, 0]") + R"(, {"type": "quad", "transform": {"scale": 100}})",
          // sheets: a half-space, a trough without a lid, one side of a slab
          body("sheet", "quad", "20", left), boxOfQuads(left, 5), boxOfQuads(left, 4), boxOfQuads(left, 1),
          // a hole, and what names nothing inside
          body("fog", "cube", "2", left) + ", " + body("hole", "sphere", "0.5", R"("ext_medium": "a", )") + ", " +
              opaque,
          // an opaque lid that names the inner side alone meets nothing on its outer side
          body("fog", "cube", "2", left) +
              R"(, {"type": "cube", "int_medium": "b", "bsdf": {"type": "lambert"}, "transform": {"scale": 0.2}})",
          // an opaque room of vacuum in a fog
          body("fog", "sphere", "9", left) + R"(, {"type": "cube", "transform": {"scale": 3}})"})
        for (const std::string& camera : {Outside}) EXPECT_EQ(warningsOf(sceneOf(bodies, camera)), "") << bodies;
    EXPECT_EQ(warningsOf(sceneOf(body("fog", "sphere", "9", left) + R"(, {"type": "cube", "transform": {"scale": 3}})",
                                 Inside, R"("transform": {"position": [0, 0.2, 0]})")),
              "");
}

} // namespace
} // namespace tungsten
