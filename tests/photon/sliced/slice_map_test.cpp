// Sliced primitives as integrators render them, against the verified values.

#include "support/PathsAndPhotons.h"
#include "support/VerifiedValues.h"

#include "photon/primitives/sliced/Slices.h"
#include "tungsten/core/Errors.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

using test::Overrides;
using test::Rendered;
using test::setting;
using test::VerifiedValue;

std::unique_ptr<Rendered> renderSlices(const std::string& type, const std::string& json, Overrides overrides,
                                       uint32_t passes, uint64_t seed = 1) {
    overrides.insert(overrides.begin(), "integrator.volume_photon_type=" + type);
    return test::renderPhotons(json, {overrides, passes, 1, seed});
}

/// With every value instead of these seven: 243 of 246 within 4 standard errors, the others planes that turn back in B,
/// which hardly any light path makes. Every order is complete with every kind: lower primitives make what the kind's
/// own cannot.
class SliceOrders : public testing::TestWithParam<std::tuple<SliceName, VerifiedValue>> {};

TEST_P(SliceOrders, MatchVerifiedValues) {
    const auto& [kind, value] = GetParam();
    Overrides overrides = test::gateOf(value, 0.05);
    overrides.insert(overrides.end(), {setting("volume_gather_radius", 0.1), setting("photon_count", 4000)});
    const auto rendered = renderSlices(kind.type, test::sceneOf(value), overrides, 40);
    const double error = rendered->pixelError(), exact = value.radiance;
    // Beams where light has one direction, planes at delta gates.
    const bool kernel =
        (value.configuration == 'C' && value.order == 1) || (kind.kind == SliceKind::Planes && value.delta);
    EXPECT_NEAR(rendered->mean(), exact, 4.0 * std::hypot(error, value.uncertainty) + (kernel ? 0.01 : 1e-3) * exact)
        << "standard error " << error;
    RecordProperty("deviation in standard errors", std::to_string((rendered->mean() - exact) / error));
    RecordProperty("relative standard error", std::to_string(error / exact));
    EXPECT_EQ(rendered->statistics.counter("non-finite samples"), 0u);
    const bool singular = kind.kind == SliceKind::Planes || kind.kind == SliceKind::Balls;
    if (!singular) {
        EXPECT_LT(error, 0.25 * exact) << "the test would not see a wrong value";
    }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, SliceOrders,
    testing::Combine(testing::ValuesIn(SliceNames),
                     testing::Values(test::verified("A2UnwarpedBox"), test::verified("A3WarpedBox"),
                                     test::verified("A3UnwarpedDelta"), test::verified("A4UnwarpedBox"),
                                     test::verified("B3UnwarpedBox"), test::verified("C3WarpedDelta"),
                                     test::verified("W4WarpedDelta"))),
    [](const auto& test) { return std::string(std::get<0>(test.param).type) + test::nameOf(std::get<1>(test.param)); });

/// What no primitive can do, or not yet, is said with the field's name.
TEST(SliceMap, ImpossibleCombinationsAreExplained) {
    const std::string gate = R"("transient_time_center": 8, "transient_time_width": 4)";
    const auto messageOf = [](const std::string& type, const std::string& json, Overrides overrides) -> std::string {
        try {
            renderSlices(type, json, std::move(overrides), 1);
        } catch (const InputError& error) {
            return error.what();
        }
        return {};
    };
    for (const char* type : {"balls", "volumes_balls", "mis_volumes_balls", "hypervolumes"}) {
        const std::string message =
            messageOf(type, test::fogOverFloor(test::SteadyState), {"integrator.type=progressive_photon_map"});
        EXPECT_NE(message.find("volume_photon_type"), std::string::npos) << message;
        EXPECT_NE(message.find("needs a time gate"), std::string::npos) << message;
    }
    for (const SliceName& name : SliceNames) {
        const std::string json = test::fogOverFloor(gate);
        EXPECT_EQ(messageOf(name.type, json, {"integrator.photon_count=100"}), "") << name.type;
        EXPECT_EQ(messageOf(name.type, json, {"integrator.photon_count=100", "integrator.darts=best"}), "")
            << name.type;
        EXPECT_NE(messageOf(name.type, json, {"integrator.volume_gather_radius=1e30"}).find("volume_gather_radius"),
                  std::string::npos);
    }
    // Without surfaces and beams of light there is nothing that needs a radius.
    EXPECT_EQ(messageOf("balls", test::configurationA(2, true),
                        {"integrator.volume_gather_radius=1e30", "integrator.photon_count=100"}),
              "");
}

} // namespace
} // namespace tungsten::photon
