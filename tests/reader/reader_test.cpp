// Reading JSON: the grammar, durations, values and their problems, overrides.

#include "tungsten/reader/Duration.h"
#include "tungsten/reader/Json.h"

#include <gtest/gtest.h>

#include <limits>

#include <cmath>
#include <fstream>

#include <unistd.h>

namespace tungsten {
namespace {

class JsonFile {
  public:
    explicit JsonFile(const std::string& text)
        : path_(std::filesystem::temp_directory_path() /
                ("reader_test_" + std::to_string(::getpid()) + "_" + std::to_string(count_++) + ".json")) {
        std::ofstream(path_, std::ios::binary) << text;
    }
    ~JsonFile() { std::filesystem::remove(path_); }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    static inline int count_ = 0;
    std::filesystem::path path_;
};

constexpr Meaning Any{"none", "any field"};

ObjectReader readerOf(const std::string& text, const std::shared_ptr<Diagnostics>& diagnostics) {
    const JsonFile file(text);
    const auto document = parseJsonFile(file.path());
    diagnostics->file = "test.json";
    return {document, nodeOf(*document), "", diagnostics};
}

TEST(Duration, SumsTokensAndDefaultsToMinutes) {
    EXPECT_DOUBLE_EQ(*parseDuration("0.3"), 18.0);
    EXPECT_DOUBLE_EQ(*parseDuration("10"), 600.0);
    EXPECT_DOUBLE_EQ(*parseDuration("1h 30m"), 5400.0);
    EXPECT_DOUBLE_EQ(*parseDuration("250ms"), 0.25);
    EXPECT_DOUBLE_EQ(*parseDuration("2 D 5 Seconds"), 2 * 86400.0 + 5.0);
    EXPECT_FALSE(parseDuration(""));
    EXPECT_FALSE(parseDuration("soon"));
    EXPECT_FALSE(parseDuration("5 parsecs"));
}

TEST(Json, AcceptsCommentsTrailingCommasNanAndByteOrderMark) {
    auto diagnostics = std::make_shared<Diagnostics>();
    const auto reader =
        readerOf("\xEF\xBB\xBF{ /* a */ \"x\": 1e4, // b\n \"y\": [1, 2, 3,], \"n\": NaN, }", diagnostics);
    EXPECT_EQ(reader.integer("x", 0, Any), 10000);
    EXPECT_EQ(reader.vec3("y", Vec3f(0.0f), Any), Vec3f(1, 2, 3));
    EXPECT_TRUE(diagnostics->problems.empty());
    EXPECT_EQ(reader.number("n", 7.0, Any), 7.0); // parsed, but not a usable number
    ASSERT_EQ(diagnostics->problems.size(), 1u);
    EXPECT_EQ(diagnostics->problems[0].path, "n");
}

TEST(Json, SyntaxErrorsNameLineAndColumn) {
    const JsonFile file("{\n  \"a\": 1,\n  \"b\": ]\n}");
    try {
        parseJsonFile(file.path());
        FAIL() << "accepted broken JSON";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("line 3, column 8"), std::string::npos) << error.what();
    }
    EXPECT_THROW(parseJsonFile("/no/such/scene.json"), InputError);
}

TEST(Json, DeepNestingIsNoCrash) {
    const JsonFile file(std::string(200000, '['));
    EXPECT_THROW(parseJsonFile(file.path()), InputError);
}

TEST(ObjectReader, BadValuesBecomeProblemsWithPathFoundAndAccepted) {
    auto diagnostics = std::make_shared<Diagnostics>();
    const auto reader = readerOf(R"({"a": "text", "b": -1, "c": [1, 2], "d": "tnet", "e": 1, "f": 3})", diagnostics);
    EXPECT_EQ(reader.number("a", 5.0, Any), 5.0);
    EXPECT_EQ(reader.number("b", 5.0, Any, Range::nonNegative()), 5.0);
    EXPECT_EQ(reader.rgb("c", Rgb(0.25f), Any), Rgb(0.25f));
    EXPECT_EQ(reader.choice("d", "box", {"box", "tent"}, Any), "box");
    EXPECT_TRUE(reader.flag("e", true, Any));
    EXPECT_EQ(reader.durationSeconds("f", 9.0, Any), 9.0);
    ASSERT_EQ(diagnostics->problems.size(), 6u);
    EXPECT_EQ(diagnostics->problems[1].text(), "test.json: b: expected a number of at least 0, found the number -1");
    EXPECT_NE(diagnostics->problems[3].message.find("did you mean 'tent'"), std::string::npos);
}

TEST(ObjectReader, WarnsAboutUnknownFieldsOnceWithTheNearestName) {
    auto diagnostics = std::make_shared<Diagnostics>();
    const auto reader = readerOf(R"({"gather_radius": 1, "gather_radios": 2, "zzz": 3})", diagnostics);
    EXPECT_EQ(reader.number("gather_radius", 0.0, Any), 1.0);
    reader.warnAboutUnknown();
    reader.warnAboutUnknown();
    ASSERT_EQ(diagnostics->warnings.size(), 2u);
    EXPECT_NE(diagnostics->warnings[0].message.find("did you mean 'gather_radius'"), std::string::npos);
    EXPECT_EQ(diagnostics->warnings[1].message, "unknown field, ignored");
}

TEST(ObjectReader, WarnsAboutFieldsGivenTwice) {
    auto diagnostics = std::make_shared<Diagnostics>();
    const auto reader = readerOf(R"({"alpha": 0.3, "beta": 1, "alpha": 0.5, "alpha": 0.7})", diagnostics);
    EXPECT_EQ(reader.number("alpha", 0.0, Any), 0.3);
    EXPECT_EQ(reader.number("beta", 0.0, Any), 1.0);
    reader.warnAboutUnknown();
    reader.warnAboutUnknown();
    ASSERT_EQ(diagnostics->warnings.size(), 1u);
    EXPECT_EQ(diagnostics->warnings[0].message, "given more than once; the first counts");
}

TEST(ObjectReader, TransformsInBothForms) {
    auto diagnostics = std::make_shared<Diagnostics>();
    const auto reader = readerOf(
        R"({"a": [1,0,0,5, 0,2,0,6, 0,0,3,7, 0,0,0,1], "b": {"position": [1,2,3], "look_at": [1,2,4]}, "c": {"position": [1,1,1], "look_at": [1,1,1]}})",
        diagnostics);
    EXPECT_EQ(reader.transform("a", Any).point(Vec3f(1, 1, 1)), Vec3f(6, 8, 10));
    EXPECT_EQ(reader.transform("b", Any).point(Vec3f(0, 0, 2)), Vec3f(1, 2, 5));
    EXPECT_TRUE(diagnostics->problems.empty());
    (void)reader.transform("c", Any);
    EXPECT_EQ(diagnostics->problems.size(), 1u);
}

TEST(Override, SetsByIndexByNameAndNewFields) {
    const JsonFile file(
        R"({"media": [{"name": "gas.a", "sigma_s": 1}], "integrator": {}, "camera": {"transform": {}}})");
    const auto document = parseJsonFile(file.path());
    applyOverride(*document, "media.0.type=homogeneous");
    applyOverride(*document, "media.gas.a.sigma_s=[1,2,3]");
    applyOverride(*document, "integrator.enable_guiding=false");
    applyOverride(*document, "renderer.timeout=30s");
    EXPECT_STREQ((*document)["media"][0]["type"].GetString(), "homogeneous");
    EXPECT_EQ((*document)["media"][0]["sigma_s"][2].GetDouble(), 3.0);
    EXPECT_FALSE((*document)["integrator"]["enable_guiding"].GetBool());
    EXPECT_STREQ((*document)["renderer"]["timeout"].GetString(), "30s");
}

TEST(Override, AStarStandsForAllElements) {
    const JsonFile file(
        R"({"media": [{"name": "gas"}, {"type": "x"}], "bsdfs": [], "primitives": [{"name": "*"}, {}]})");
    const auto document = parseJsonFile(file.path());
    applyOverride(*document, "media.*.type=guided_homo");
    for (const int i : {0, 1}) EXPECT_STREQ((*document)["media"][i]["type"].GetString(), "guided_homo");
    applyOverride(*document, "primitives.*.power=3"); // a name goes first
    EXPECT_FALSE((*document)["primitives"][1].HasMember("power"));
    for (const char* bad : {"bsdfs.*.albedo=1", "media.*.=1", "media.0.=1", "media.=1", "*.0=1"})
        EXPECT_THROW(applyOverride(*document, bad), UsageError) << bad;
}

TEST(Override, WhatReplacesANamedObjectKeepsItsName) {
    const JsonFile file(R"({"media": [{"name": "gas", "sigma_s": 1}], "bsdfs": [{"name": "wall", "type": "null"}],
                            "primitives": [{"name": "lamp", "type": "point"}], "camera": {"name": "c"}})");
    const auto document = parseJsonFile(file.path());
    applyOverride(*document, R"(media.gas={"type": "homogeneous"})");
    applyOverride(*document, R"(bsdfs.0={"type": "mirror"})");
    applyOverride(*document, R"(primitives.*={"type": "quad"})");
    applyOverride(*document, R"(bsdfs.wall.type="lambert")");
    for (const auto& [block, name] : {std::pair{"media", "gas"}, {"bsdfs", "wall"}, {"primitives", "lamp"}})
        EXPECT_STREQ((*document)[block][0]["name"].GetString(), name);
    EXPECT_FALSE((*document)["media"][0].HasMember("sigma_s"));
    applyOverride(*document, R"(media.gas={"name": "fog"})");
    EXPECT_STREQ((*document)["media"][0]["name"].GetString(), "fog");
    applyOverride(*document, "bsdfs.wall=3");
    EXPECT_EQ((*document)["bsdfs"][0].GetDouble(), 3.0);
}

TEST(Override, PathsThatLeadNowhereNameTheNearest) {
    const JsonFile file(R"({"media": [{"name": "gas", "sigma_s": 1}], "integrator": {}})");
    const auto document = parseJsonFile(file.path());
    for (const char* bad : {"media.gaz.sigma_s=1", "media.7.sigma_s=1", "nothing", "=3", "integrator.a.b=2",
                            "media.0.sigma_s.x=1", "render.spp=4", "spp=4", ""})
        EXPECT_THROW(applyOverride(*document, bad), UsageError) << bad;
    try {
        applyOverride(*document, "media.gaz.sigma_s=1");
    } catch (const UsageError& error) {
        EXPECT_NE(std::string(error.what()).find("did you mean 'gas'"), std::string::npos) << error.what();
    }
    try { // a block that the file leaves out is known all the same
        applyOverride(*document, "rendrer.spp=4");
        FAIL() << "accepted";
    } catch (const UsageError& error) {
        EXPECT_NE(std::string(error.what()).find("did you mean 'renderer'"), std::string::npos) << error.what();
    }
}

} // namespace
/// What RapidJSON reads as 10^80 and 10^-118, depending on the compiler.
TEST(Reader, TakesZerosWithLargeExponentsForZero) {
    for (const char* zero : {"0e99", "-0e99", "0e-99", "0.000e300", "1e-400"}) {
        const auto document = parseJson(std::string("{\"x\": ") + zero + "}", "a.json");
        EXPECT_EQ((*document)["x"].GetDouble(), 0.0) << zero;
    }
}

TEST(Reader, ReadsNumbersExactly) {
    const auto document = parseJson(
        R"({"x": [18446744073709551615, -9223372036854775808, 0.1, 4.9e-324, 123456789012345678901]})", "a.json");
    const auto& numbers = (*document)["x"];
    EXPECT_EQ(numbers[0].GetUint64(), 18446744073709551615u);
    EXPECT_EQ(numbers[1].GetInt64(), std::numeric_limits<int64_t>::min());
    EXPECT_EQ(numbers[2].GetDouble(), 0.1);
    EXPECT_EQ(numbers[3].GetDouble(), std::numeric_limits<double>::denorm_min());
    EXPECT_EQ(numbers[4].GetDouble(), 123456789012345678901.0);
    EXPECT_THROW(parseJson(R"({"x": 1e400})", "a.json"), InputError);
    EXPECT_THROW(parseJson(R"({"x": -1e400})", "a.json"), InputError);
}

} // namespace tungsten
