// volume_photon_type auto: what a pilot chooses from, and what it chooses.

#include "photon/PhotonIntegrator.h"
#include "photon/PrimitivePilot.h"

#include "support/SceneFile.h"

#include "tungsten/film/FilmErrors.h"
#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

#include <tbb/global_control.h>

namespace tungsten::photon {
namespace {

struct Loaded {
    std::shared_ptr<const Scene> scene;
    PhotonSettings settings;

    [[nodiscard]] MeasuredPrimitive measured() const {
        PhotonIntegrator integrator(scene, settings);
        SceneFacts facts = analyseScene(*scene);
        Features features;
        integrator.plan(facts, features);
        return measurePrimitives(scene, settings, facts, {});
    }
};

/// A ball of fog of `scattering` a unit seen from outside, with a lamp beside it, and a gate.
Loaded load(const std::string& scattering, const std::vector<std::string>& further = {},
            const std::string& boundary = "forward") {
    const test::SceneFile file(R"({
        "media": [{"name": "fog", "type": "homogeneous", "sigma_s": )" +
                               scattering + R"(}],
        "camera": {"type": "pinhole", "fov": 30, "resolution": 16, "transform": {"position": [0, 0, -4]}},
        "primitives": [
            {"type": "sphere", "int_medium": "fog", "bsdf": {"type": ")" +
                               boundary + R"("}},
            {"type": "sphere", "emission": 10, "bsdf": {"type": "null"},
             "transform": {"position": [1.5, 0, 0], "scale": 0.3}}],
        "integrator": {"type": "progressive_transient_photon_map", "volume_photon_type": "auto", "darts": "best",
            "photon_count": 20000, "volume_photon_count": 200000, "fixed_volume_radius": true,
            "volume_gather_radius": 0.02, "transient_time_center": 6, "transient_time_width": 0.6}})");
    const LoadedScene loaded = loadScene(file.path(), {{}, further});
    return {loaded.scene, readPhotonSettings(loaded.integratorSettings, *loaded.scene, true)};
}

std::vector<std::string> alternativesOf(const Loaded& loaded) {
    std::vector<std::string> types;
    for (const VolumePrimitive& one : loaded.settings.alternatives)
        types.push_back(
            std::visit(Overloaded{[](const Slices& slices) { return std::string(sliceName(slices.kind).type); },
                                  [](const auto& kernels) { return std::string(kernels.Type); }},
                       one));
    return types;
}
using Types = std::vector<std::string>;

TEST(PrimitivePilot, ChoosesFromWhatTheSceneAllows) {
    EXPECT_EQ(alternativesOf(load("2")), (Types{"points", "beams", "mis_volumes_balls", "hypervolumes"}));
    EXPECT_EQ(alternativesOf(load("0")), Types{"points"}) << "nothing scatters";
    EXPECT_EQ(alternativesOf(load("2", {"media.fog.speed_of_light=0.5"})), (Types{"points", "beams"}))
        << "slices need one speed of light";
    EXPECT_EQ(alternativesOf(load("2", {"integrator.volume_gather_radius=1e30"})), Types{"points"})
        << "no radius for beams, to which slices leave what comes in through surfaces";
    EXPECT_EQ(alternativesOf(load("2", {"integrator.volume_photon_type=beams"})), Types{"beams"});
    const auto peaked = [](const std::string& g) {
        return load("2", {R"(media.fog.phase_function={"type": "henyey_greenstein", "g": )" + g + "}"});
    };
    EXPECT_EQ(alternativesOf(peaked("0.9")), Types{"points"}) << "a pilot would be misled";
    EXPECT_EQ(alternativesOf(peaked("-0.9")), Types{"points"});
    EXPECT_EQ(alternativesOf(peaked("0.5")).size(), 4u);
}

/// One scattering on the way: a beam says more of it than a point. With many, and behind glass, points do.
TEST(PrimitivePilot, ChoosesByVarianceAndCost) {
    const MeasuredPrimitive thin = load("0.05").measured(), milk = load("40", {}, "dielectric").measured();
    EXPECT_TRUE(std::holds_alternative<Beams>(thin.primitive)) << thin.reason;
    EXPECT_TRUE(std::holds_alternative<Points>(milk.primitive)) << milk.reason;
}

TEST(PrimitivePilot, ChoosesAlikeWithAnyThreads) {
    const Loaded loaded = load("3");
    std::vector<MeasuredPrimitive> measured;
    for (const size_t threads : {1, 2}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        measured.push_back(loaded.measured());
    }
    EXPECT_EQ(measured[0].reason, measured[1].reason);
    EXPECT_EQ(measured[0].passes, measured[1].passes);
}

Film render(const Loaded& loaded, const PhotonSettings& settings, uint64_t passes) {
    PhotonIntegrator integrator(loaded.scene, settings);
    SceneFacts facts = analyseScene(*loaded.scene);
    Features features;
    integrator.plan(facts, features);
    Statistics statistics;
    integrator.prepare(facts, {}, statistics);
    Film film(16, 16, 1);
    for (uint64_t pass = 0; pass < passes; ++pass) {
        film.beginPass();
        integrator.renderPass({.seed = pass}, film, statistics);
        film.endPass(1.0);
    }
    return film;
}
PhotonSettings only(PhotonSettings settings, const VolumePrimitive& primitive) {
    settings.primitive = primitive;
    settings.alternatives = {primitive};
    return settings;
}

/// The pilot's random numbers are its own.
TEST(PrimitivePilot, RendersAsTheChosenPrimitive) {
    const Loaded loaded = load("0.05");
    const Film asked = render(loaded, loaded.settings, 1),
               chosen = render(loaded, only(loaded.settings, loaded.measured().primitive), 1);
    ASSERT_GT(meanValue(asked), 0.0);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) EXPECT_EQ(asked.mean(0).at(x, y), chosen.mean(0).at(x, y)) << x << ' ' << y;
}

/// Rays that look for records find an empty store, as in a room with haze so thin that few paths scatter in it.
TEST(PrimitivePilot, GathersFromEmptyStores) {
    const Loaded loaded = load("1e-6", {"camera.type=thinlens", "camera.aperture_size=0.1", "camera.focus_distance=4"});
    for (const VolumePrimitive& primitive : {VolumePrimitive(Points{}), VolumePrimitive(Beams{})}) {
        PhotonSettings settings = only(loaded.settings, primitive);
        settings.photonCount = 1;
        EXPECT_TRUE(std::isfinite(meanValue(render(loaded, settings, 4))));
    }
}

/// Also where nothing arrives at all, and nothing can be told.
TEST(PrimitivePilot, EndsWhereAllIsBlack) {
    const MeasuredPrimitive dark =
        load("1", {"integrator.transient_time_center=4.2", "integrator.transient_time_width=0.01"}).measured();
    EXPECT_FALSE(dark.reason.empty());
}

} // namespace
} // namespace tungsten::photon
