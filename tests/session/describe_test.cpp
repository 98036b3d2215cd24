// `tungsten --describe`: integrators of plugins, every type of `--list`, and the page of tables.

#include "app/command.h"
#include "scene/expect_described.h"
#include "support/Folders.h"

#include "tungsten/session/Job.h"
#include "tungsten/session/Report.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tungsten {
namespace {

std::vector<DescribedKind> shippedDescriptions() {
    IntegratorRegistry registry;
    EXPECT_TRUE(loadPlugins({test::binaryFolder()}, registry).empty());
    return describeAll(registry);
}

std::vector<std::shared_ptr<Description>> typesOf(const std::vector<DescribedKind>& all, const std::string& kind) {
    return selectDescriptions(all, kind).at(0).types;
}

std::set<std::string> fieldsOf(const std::vector<DescribedKind>& all, const std::string& name) {
    std::set<std::string> names;
    for (const DescribedKind& kind : selectDescriptions(all, name))
        for (const auto& type : kind.types)
            for (const Field& field : type->fields) names.insert(field.name);
    return names;
}

TEST(Describe, IntegratorsOfPluginsAreWhole) {
    const auto all = shippedDescriptions();
    const auto integrators = typesOf(all, "integrators");
    EXPECT_EQ(integrators.size(), 8u);
    for (const auto& type : integrators) test::expectDescribed(*type);
    const auto photons = fieldsOf(all, "progressive_transient_photon_map"), paths = fieldsOf(all, "path_tracer");
    for (const char* field : {"gather_radius", "volume_photon_type", "frame_num", "max_bounces", "darts"})
        EXPECT_EQ(photons.count(field), 1u) << field;
    for (const char* field : {"enable_rr", "enable_light_sampling", "temporal_response", "darts"})
        EXPECT_EQ(paths.count(field), 1u) << field;
    EXPECT_EQ(paths.count("gather_radius"), 0u);
    EXPECT_EQ(fieldsOf(all, "photon_map").count("frame_num"), 0u) << "in steady state there are no frames";
}

TEST(Describe, TypesOfIntegratorsAreNamed) {
    const auto integrators = typesOf(shippedDescriptions(), "integrators");
    for (const auto& integrator : integrators) {
        const auto type = std::find_if(integrator->fields.begin(), integrator->fields.end(),
                                       [](const Field& field) { return field.name == "type"; });
        ASSERT_NE(type, integrator->fields.end());
        for (const auto& other : integrators)
            EXPECT_NE(type->accepted.find(other->name), std::string::npos) << other->name << " in " << type->accepted;
    }
}

TEST(Describe, BlocksWithinOthersStandOnce) {
    const auto all = shippedDescriptions();
    std::multiset<std::string> blocks;
    for (const auto& block : typesOf(all, "blocks")) blocks.insert(block->name);
    for (const char* block : {"scene", "renderer", "output_buffers", "temporal_response", "darts", "transform"})
        EXPECT_EQ(blocks.count(block), 1u) << block;
    for (const char* field : {"preset", "distance", "direction", "greens_function", "candidates", "proposals", "alpha",
                              "roulette", "bounded", "length_first", "direct_view", "surface_connections",
                              "single_frames", "bodies", "glossy_sensor_paths"})
        EXPECT_EQ(fieldsOf(all, "darts").count(field), 1u) << field;
}

TEST(Describe, EveryTypeOfTheListAnswers) {
    const test::CommandResult list = test::tungsten({"--list"});
    std::vector<std::string> names;
    for (const auto& [kind, types] : sceneTypes()) names.insert(names.end(), types.begin(), types.end());
    const auto all = shippedDescriptions();
    for (const auto& integrator : typesOf(all, "integrators")) names.push_back(integrator->name);
    for (const std::string& name : names) {
        EXPECT_NE(list.out.find(name), std::string::npos) << name;
        EXPECT_NO_THROW((void)selectDescriptions(all, name)) << name;
    }
    for (const char* name : {"rough_dielectric", "darts", "transient_path_tracer", "tent", "media"}) {
        const test::CommandResult result = test::tungsten({"--describe", name});
        EXPECT_EQ(result.exitCode, 0) << result.all();
        EXPECT_EQ(result.err, "");
    }
    const std::string fields = test::tungsten({"--describe", "henyey_greenstein"}).out;
    EXPECT_NE(fields.find("  g, default 0\n      mean cosine"), std::string::npos) << fields;
    EXPECT_NE(fields.find("accepts a number from -0.999 to 0.999"), std::string::npos) << fields;
}

TEST(Describe, AnUnknownTypeIsBadUsageAndNamesTheNearest) {
    const test::CommandResult result = test::tungsten({"--describe", "rough_plastik"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find("did you mean 'rough_plastic'?"), std::string::npos) << result.err;
    EXPECT_EQ(test::tungsten({"--markdown"}).exitCode, 2);
}

TEST(Describe, WithoutATypeEverythingIsPrinted) {
    const std::string page = test::tungsten({"--describe", "--markdown"}).out;
    for (const DescribedKind& kind : shippedDescriptions())
        for (const auto& type : kind.types) {
            EXPECT_NE(page.find(type->name), std::string::npos) << type->name;
            for (const Field& field : type->fields)
                EXPECT_NE(page.find("| `" + field.name + "` | "), std::string::npos) << type->name << "." << field.name;
        }
    EXPECT_NE(test::tungsten({"--describe"}).out.find("gather_radius [length], default unbounded"), std::string::npos);
}

} // namespace
} // namespace tungsten
