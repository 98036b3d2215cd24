// Faces that lie on one another: rays meet all of them, bodies are left before others are entered, and rounding decides
// nothing of it. The reference is what geometry says: who is in which body where.

#include "geometry/test_scene.h"

#include <set>

namespace tungsten {
namespace {

using test::randomDirection;
using test::TestScene;

/// Scaled and moved inside of the whole scene's transform.
Transform within(const Transform& scene, const Vec3f& centre, const Vec3f& size) {
    return {scene.x * size.x, scene.y * size.y, scene.z * size.z, scene.point(centre)};
}

TriangleMesh cubeAt(const Transform& scene, const Vec3f& centre, const Vec3f& size) {
    return makeCube(within(scene, centre, size));
}

TriangleMesh floorAt(const Transform& scene, const Vec3f& centre, float size, bool flipped = false) {
    TriangleMesh mesh = makeQuad(within(scene, centre, Vec3f(size)));
    for (Triangle& triangle : mesh.triangles)
        if (flipped) std::swap(triangle.v[1], triangle.v[2]);
    return mesh;
}

/// The same in one mesh.
TriangleMesh joined(TriangleMesh a, const TriangleMesh& b) {
    const auto first = uint32_t(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    a.uvs.clear();
    a.normals.clear();
    for (const Triangle& t : b.triangles) a.triangles.push_back({{t.v[0] + first, t.v[1] + first, t.v[2] + first}});
    return a;
}

/// As it stands, turned, and turned far from the origin.
std::vector<Transform> places() {
    const Vec3f degrees(31.0f, -17.0f, 64.0f);
    return {Transform{}, test::turned(degrees, Vec3f(1.0f), {0.3f, -0.7f, 0.1f}),
            test::turned(degrees, Vec3f(1.0f), {300.0f, -700.0f, 100.0f})};
}

struct Step {
    uint32_t shape;
    bool entered;
};

/// All that a straight ray meets.
std::vector<Step> walk(const SceneGeometry& geometry, Ray ray) {
    std::vector<Step> steps;
    while (steps.size() < 100) {
        const auto hit = geometry.intersect(ray);
        if (!hit) break;
        steps.push_back({hit->shape, ray.direction.dot(hit->ng) < 0.0f});
        ray = hit->rest(ray);
    }
    return steps;
}

/// Which bodies a ray is in is consistent with what it meets: it enters what it is not in, leaves what it is in, and
/// ends outside of all. `allowed` says which it may be in at once.
template <typename Allowed>
void expectConsistent(const SceneGeometry& geometry, const Ray& ray, const std::set<uint32_t>& sheets,
                      const Allowed& allowed, int& wrong) {
    std::set<uint32_t> inside;
    bool right = true;
    for (const Step& step : walk(geometry, ray)) {
        if (sheets.count(step.shape) != 0) continue;
        if (step.entered) {
            right = right && inside.insert(step.shape).second;
        } else {
            right = right && inside.erase(step.shape) == 1;
        }
        right = right && allowed(inside);
    }
    wrong += !right || !inside.empty();
}

template <typename MakeShapes, typename Allowed>
void expectConsistentEverywhere(const MakeShapes& make, const std::set<uint32_t>& sheets, const Allowed& allowed) {
    for (const Transform& place : places()) {
        const TestScene scene(make(place));
        Sampler random(7, RandomStream::Test, 0, 0);
        int wrong = 0;
        for (int i = 0; i < 20000; ++i) {
            const Vec3f target = place.point(
                {1.2f * (random.next1D() - 0.5f), 1.2f * (random.next1D() - 0.5f), 1.2f * (random.next1D() - 0.5f)});
            const Vec3f direction = randomDirection(random);
            expectConsistent(scene.geometry, {target - direction * 5.0f, direction}, sheets, allowed, wrong);
        }
        // Rays that meet an edge within rounding may be told either way, the more the farther from the origin.
        const float size = std::max(place.translation.length(), 1.0f);
        EXPECT_LE(float(wrong), 0.02f * size) << "of 20000 at " << place.translation;
    }
}

bool oneAtMost(const std::set<uint32_t>& inside) {
    return inside.size() <= 1;
}
/// Later ones are inside of earlier ones.
bool nested(const std::set<uint32_t>& inside) {
    uint32_t next = 0;
    return std::all_of(inside.begin(), inside.end(), [&](uint32_t shape) { return shape == next++; });
}

TEST(CoincidentFaces, BodiesSideBySideAreLeftBeforeEntered) {
    expectConsistentEverywhere(
        [](const Transform& place) {
            return std::vector<Shape>{cubeAt(place, {-0.25f, 0, 0}, {0.5f, 1, 1}),
                                      cubeAt(place, {0.25f, 0, 0}, {0.5f, 1, 1})};
        },
        {}, oneAtMost);
}

TEST(CoincidentFaces, ASmallBodyOnPartOfALargeFace) {
    expectConsistentEverywhere(
        [](const Transform& place) {
            return std::vector<Shape>{cubeAt(place, {0, -0.25f, 0}, {1, 0.5f, 1}),
                                      cubeAt(place, {0.2f, 0.1f, -0.1f}, {0.3f, 0.2f, 0.4f})};
        },
        {}, oneAtMost);
}

TEST(CoincidentFaces, ABodyInsideAnotherWithFacesShared) {
    for (const Vec3f& centre : {Vec3f(0, 0.25f, 0), Vec3f(0.25f, 0.25f, -0.25f)})
        expectConsistentEverywhere(
            [&](const Transform& place) {
                return std::vector<Shape>{cubeAt(place, {0, 0, 0}, {1, 1, 1}),
                                          cubeAt(place, centre, {0.5f, 0.5f, 0.5f})};
            },
            {}, nested);
}

TEST(CoincidentFaces, ThreeBodiesAndASheetAtOnePlace) {
    // Inner ones come first however the scene lists them.
    expectConsistentEverywhere(
        [](const Transform& place) {
            return std::vector<Shape>{
                cubeAt(place, {0, 0, 0}, {1, 1, 1}), cubeAt(place, {0, 0.1f, 0}, {0.8f, 0.8f, 0.8f}),
                cubeAt(place, {0, 0.2f, 0}, {0.6f, 0.6f, 0.6f}), floorAt(place, {0, 0.5f, 0}, 0.9f)};
        },
        {3}, nested);
}

TEST(CoincidentFaces, BodiesOfOneMesh) {
    for (const Transform& place : places()) {
        const TestScene scene(
            {joined(cubeAt(place, {-0.25f, 0, 0}, {0.5f, 1, 1}), cubeAt(place, {0.25f, 0, 0}, {0.5f, 1, 1}))});
        Sampler random(3, RandomStream::Test, 0, 0);
        for (int i = 0; i < 2000; ++i) {
            const Vec3f through = place.point({0.0f, 0.8f * (random.next1D() - 0.5f), 0.8f * (random.next1D() - 0.5f)});
            const Vec3f across = place.x * (i % 2 == 0 ? 1.0f : -1.0f);
            const Vec3f direction = (across + randomDirection(random) * 0.1f).normalized();
            const std::vector<Step> steps = walk(scene.geometry, {through - direction * 3.0f, direction});
            ASSERT_EQ(steps.size(), 4u);
            for (size_t k = 0; k < 4; ++k) EXPECT_EQ(steps[k].entered, k % 2 == 0);
        }
    }
}

TEST(CoincidentFaces, SpheresOfOneRadius) {
    expectConsistentEverywhere(
        [](const Transform& place) {
            return std::vector<Shape>{Sphere{place.translation, 0.5f, Frame{}},
                                      Sphere{place.translation, 0.5f, Frame{}}};
        },
        {}, [](const std::set<uint32_t>&) { return true; });
}

/// The floor's place among what rays meet, whichever way its normal points, tells on which side of it the body is.
TEST(CoincidentFaces, ABodyOnAFloor) {
    for (const Transform& place : places()) {
        const TestScene scene({floorAt(place, {0, 0, 0}, 3.0f), cubeAt(place, {0, 0.5f, 0}, {1, 1, 1})});
        Sampler random(5, RandomStream::Test, 0, 0);
        for (int i = 0; i < 2000; ++i) {
            const Vec3f at = place.point({0.6f * (random.next1D() - 0.5f), 0.0f, 0.6f * (random.next1D() - 0.5f)});
            const Vec3f direction = (place.y * -1.0f + randomDirection(random) * 0.4f).normalized();
            // From within the body: its face, then the floor, then nothing.
            const auto face = scene.geometry.intersect({at - direction * 0.3f, direction});
            ASSERT_TRUE(face);
            EXPECT_EQ(face->shape, 1u);
            const auto ground = scene.geometry.intersect(face->spawnRay(direction));
            ASSERT_TRUE(ground);
            EXPECT_EQ(ground->shape, 0u);
            EXPECT_FALSE(scene.geometry.intersect(ground->spawnRay(direction)));
            // Back from the floor: through the face into the body, and out of it at its other side.
            const Vec3f up = (place.y + randomDirection(random) * 0.9f).normalized();
            const auto back = scene.geometry.intersect(ground->spawnRay(up));
            ASSERT_TRUE(back);
            EXPECT_EQ(back->shape, 1u);
            EXPECT_LT(up.dot(back->ng), 0.0f);
            const auto out = scene.geometry.intersect(back->spawnRay(up));
            ASSERT_TRUE(out);
            EXPECT_GT(up.dot(out->ng), 0.0f);
            EXPECT_TRUE(scene.geometry.occluded(ground->spawnRay(up)));
            // And reflected by the body's face alone, never the floor.
            EXPECT_GT(scene.geometry.intersect(face->spawnRay(up))->t, 0.0f);
        }
    }
}

TEST(CoincidentFaces, ALampOnACeilingShines) {
    for (const Transform& place : places()) {
        for (const bool flipped : {false, true}) {
            // The ceiling's normal is up or down; the lamp's down. A vast ceiling's plane is rounded far more coarsely.
            const float size = flipped ? 3.0f : 3e4f;
            const TestScene scene({floorAt(place, {0, 1, 0}, size, flipped), floorAt(place, {0, 1, 0}, 0.5f, true)});
            const auto seen = scene.geometry.intersect({place.point({0.1f, 0, 0.05f}), place.y});
            ASSERT_TRUE(seen);
            EXPECT_EQ(seen->shape, 1u);
            Sampler random(9, RandomStream::Test, 0, 0);
            AreaSampler sampler(scene.shapes[1]);
            for (int i = 0; i < 2000; ++i) {
                SurfaceSample start = sampler.sample(scene.shapes[1], random.next2D());
                start.face.shape = 1;
                const Vec3f direction = (place.y * -1.0f + randomDirection(random) * 0.99f).normalized();
                EXPECT_FALSE(scene.geometry.intersect(start.spawnRay(direction)));
            }
        }
    }
}

TEST(CoincidentFaces, FacesThatOnlyShareEdgesAreNone) {
    const auto coincident = [](const std::vector<Shape>& shapes) {
        std::vector<const Shape*> pointers;
        for (const Shape& shape : shapes) pointers.push_back(&shape);
        return CoincidentFaces(pointers).any();
    };
    for (const Transform& place : places()) {
        // Tiles of a floor, walls of a room, a body above a floor.
        EXPECT_FALSE(coincident({floorAt(place, {-0.5f, 0, 0}, 1.0f), floorAt(place, {0.5f, 0, 0}, 1.0f)}));
        EXPECT_FALSE(coincident({cubeAt(place, {0, 0, 0}, {1, 1, 1}), cubeAt(place, {1, 1, 0}, {1, 1, 1})}));
        EXPECT_FALSE(coincident({floorAt(place, {0, 0, 0}, 1.0f), cubeAt(place, {0, 0.51f, 0}, {1, 1, 1})}));
        EXPECT_TRUE(coincident({floorAt(place, {0, 0, 0}, 9.0f), cubeAt(place, {0, 0.5f, 0}, {1, 1, 1})}));
        EXPECT_TRUE(
            coincident({Disk{place.point({0, 0.5f, 0}), 0.2f, Frame(place.y)}, cubeAt(place, {0, 0, 0}, {1, 1, 1})}));
    }
    // Opaque bodies hide where they touch.
    const std::vector<Shape> standing{floorAt({}, {0, 0, 0}, 9.0f), cubeAt({}, {0, 0.5f, 0}, {1, 1, 1})};
    EXPECT_FALSE(CoincidentFaces({&standing[0], &standing[1]}, {true, true}).any());
    EXPECT_TRUE(CoincidentFaces({&standing[0], &standing[1]}, {true, false}).any());
    EXPECT_FALSE(coincident({Sphere{{0, 0, 0}, 1.0f, Frame{}}, Sphere{{0, 0, 0}, 1.001f, Frame{}}}));
}

} // namespace
} // namespace tungsten
