// Which photons can still be seen in the gate.

#include "photon/store/ArrivalCulling.h"

#include "tungsten/core/Random.h"
#include "tungsten/core/Warp.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

/// What a ray of the lens sees inside the gate counts, wherever on the lens it starts.
TEST(ArrivalCulling, AScaledLensLosesNothing) {
    for (const float scale : {1.0f, 10.0f}) {
        Scene scene;
        scene.camera.model = ThinLens{60.0f, 1.0f, 0.1f};
        scene.camera.toWorld.x *= scale;
        scene.camera.toWorld.y *= scale;
        scene.transport.gate = {false, false, 0.0, 2.0, 1};
        const ArrivalCulling arrival(scene, {});
        int inside = 0;
        for (uint64_t i = 0; i < 2000; ++i) {
            Sampler s(2, RandomStream::Test, 0, i);
            const Ray ray = scene.camera.generateRay({500, 280}, {0.5f, 0.5f}, s.next2D());
            const float distance = 2.5f * s.next1D();
            if (distance >= 1.999f) continue;
            ++inside;
            EXPECT_TRUE(arrival.mayCount(ray.at(distance), 0.0)) << scale << " " << distance;
        }
        EXPECT_GT(inside, 1000);
    }
}

} // namespace
} // namespace tungsten::photon
