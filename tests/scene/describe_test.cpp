// Fields are declared where they are read: what a describing reader collects, and that every type of the host is whole.

#include "scene/expect_described.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

const Field* fieldOf(const Description& description, const std::string& name) {
    for (const Field& field : description.fields)
        if (field.name == name) return &field;
    return nullptr;
}

std::shared_ptr<Description> typeCalled(const std::string& kind, const std::string& name) {
    for (const DescribedKind& described : describeScene())
        for (const auto& type : described.types)
            if (described.kind == kind && type->name == name) return type;
    return nullptr;
}

TEST(DescribingReader, CollectsWhatReadingCallsSay) {
    auto description = std::make_shared<Description>();
    const ObjectReader reader = ObjectReader::describing(description, "thing");
    EXPECT_EQ(reader.number("radius", 0.25, {"length", "how far"}, Range::positive()), 0.25);
    EXPECT_EQ(reader.integer("count", 3, {"none", "how many"}, {1, 2e9}), 3);
    EXPECT_FALSE(reader.flag("on", false, {"none", "whether", "true on Sundays"}));
    EXPECT_EQ(reader.choice("type", "", {"thing", "other"}, {"none", "which"}), "thing");
    EXPECT_EQ(reader.rgb("colour", Rgb(0.5f), {"none", "what colour"}), Rgb(0.5f));
    const std::vector<Field> expected{{"type", "thing or other", "none", "none", "which"},
                                      {"radius", "a positive number", "0.25", "length", "how far"},
                                      {"count", "a whole number from 1 to 2e9", "3", "none", "how many"},
                                      {"on", "true or false", "true on Sundays", "none", "whether"},
                                      {"colour", "a finite number, or an array of 3", "0.5", "none", "what colour"}};
    EXPECT_EQ(description->fields, expected);
    EXPECT_TRUE(reader.diagnostics()->problems.empty());
}

TEST(DescribingReader, BlocksAreVisitedAndOtherObjectsAreNot) {
    auto description = std::make_shared<Description>();
    const ObjectReader reader = ObjectReader::describing(description, "");
    EXPECT_FALSE(reader.object("medium", {"none", "of a type of its own"}));
    (void)reader.choice("switches", "off", {"on", "off"}, {"none", "a word"});
    const auto block = reader.block("switches", {"none", "or single ones"});
    ASSERT_TRUE(block);
    (void)block->flag("first", true, {"none", "the first"});
    ASSERT_EQ(description->blocks.size(), 1u);
    EXPECT_EQ(description->blocks[0]->name, "switches");
    EXPECT_NE(fieldOf(*description->blocks[0], "first"), nullptr);
    EXPECT_EQ(fieldOf(*description, "switches")->accepted, "on or off, or an object");
}

TEST(DescribingReader, TellsFieldsThatAreLookedUpButNotDeclared) {
    auto description = std::make_shared<Description>();
    const ObjectReader reader = ObjectReader::describing(description, "");
    if (reader.has("forgotten")) FAIL();
    reader.accept({"dead", "width"});
    (void)reader.number("width", 1.0, {"length", "across"});
    EXPECT_EQ(description->undeclared(), std::vector<std::string>{"forgotten"});
    EXPECT_EQ(description->ignored(), std::vector<std::string>{"dead"});
}

TEST(DescribeScene, EveryTypeAndBlockIsWhole) {
    const std::vector<DescribedKind> kinds = describeScene();
    EXPECT_EQ(kinds.front().kind, "blocks");
    const auto types = sceneTypes();
    ASSERT_EQ(kinds.size(), types.size() + 1);
    for (size_t i = 0; i < types.size(); ++i) {
        EXPECT_EQ(kinds[i + 1].kind, types[i].first);
        ASSERT_EQ(kinds[i + 1].types.size(), types[i].second.size());
        for (size_t j = 0; j < types[i].second.size(); ++j) EXPECT_EQ(kinds[i + 1].types[j]->name, types[i].second[j]);
    }
    for (const DescribedKind& kind : kinds)
        for (const auto& type : kind.types) test::expectDescribed(*type);
}

TEST(DescribeScene, TypesReadWhatIsTheirs) {
    for (const char* field : {"fov", "focus_distance", "aperture_size", "focus_pivot", "medium", "transform"})
        EXPECT_NE(fieldOf(*typeCalled("cameras", "thinlens"), field), nullptr) << field;
    EXPECT_EQ(fieldOf(*typeCalled("cameras", "orthographic"), "fov"), nullptr);
    EXPECT_EQ(fieldOf(*typeCalled("bsdfs", "rough_plastic"), "roughness")->fallback, "0.02");
    EXPECT_EQ(fieldOf(*typeCalled("bsdfs", "rough_conductor"), "roughness")->fallback, "0.1");
    EXPECT_EQ(fieldOf(*typeCalled("phase functions", "rayleigh"), "g"), nullptr);
    EXPECT_EQ(fieldOf(*typeCalled("media", "homogeneous"), "sigma_s")->unit, "1/length");
    EXPECT_EQ(fieldOf(*typeCalled("primitives", "spot"), "edge_angle")->accepted, "a number from 0 to cone_angle");
    EXPECT_EQ(fieldOf(*typeCalled("primitives", "mesh"), "file")->fallback, "required");
    EXPECT_EQ(fieldOf(*typeCalled("blocks", "renderer"), "spp")->fallback, "32");
}

} // namespace
} // namespace tungsten
