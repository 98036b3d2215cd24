#include "transport/BoundedMedium.h"

#include "tungsten/core/Overloaded.h"

#include <algorithm>

namespace tungsten::transport {

namespace {

/// Faces of a convex polyhedron; none if the mesh is not one, or has many faces.
std::vector<BoundedMedium::Face> convexFaces(const TriangleMesh& mesh) {
    constexpr size_t MostFaces = 12;
    const float tolerance = 1e-4f * boundsOf(mesh).size().length();
    std::vector<BoundedMedium::Face> faces;
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const BoundedMedium::Face face{mesh.positions[mesh.triangles[i].v[0]], mesh.faceNormal(i)};
        const auto height = [&](const Vec3f& point) { return (point - face.point).dot(face.normal); };
        const auto isSame = [&](const BoundedMedium::Face& other) {
            return other.normal.dot(face.normal) > 0.9999f && std::abs(height(other.point)) < tolerance;
        };
        if (std::any_of(faces.begin(), faces.end(), isSame)) continue;
        const auto isBehind = [&](const Vec3f& point) { return height(point) < tolerance; };
        if (faces.size() == MostFaces || !std::all_of(mesh.positions.begin(), mesh.positions.end(), isBehind))
            return {};
        faces.push_back(face);
    }
    return faces;
}

/// Closed by its faces on all sides: their normals span space.
bool isClosed(const std::vector<BoundedMedium::Face>& faces) {
    Imath::Box3f normals;
    for (const BoundedMedium::Face& face : faces) normals.extendBy(face.normal);
    return faces.size() >= 4 && normals.min.x < 0.0f && normals.min.y < 0.0f && normals.min.z < 0.0f &&
           normals.max.x > 0.0f && normals.max.y > 0.0f && normals.max.z > 0.0f;
}

void addBoundary(const Scene& scene, size_t index, std::vector<BoundedMedium>& bodies) {
    const Primitive& primitive = scene.primitives[index];
    if (primitive.inside.medium == primitive.outside.medium) return;
    const auto has = [&](bool (*property)(const Bsdf&)) {
        return std::any_of(primitive.bsdfs.begin(), primitive.bsdfs.end(),
                           [&](const BsdfPtr& bsdf) { return property(*bsdf); });
    };
    const bool straight = has(isIndexMatched), refracting = has(refracts);
    for (const int medium : {primitive.inside.medium, primitive.outside.medium}) {
        if (medium < 0 || !(straight || refracting)) continue;
        BoundedMedium& body = bodies[size_t(medium)];
        body.box.extendBy(boundsOf(primitive.shape));
        if (straight && body.straight < 0) body.straight = int(index);
        if (refracting && body.refracting < 0) body.refracting = int(index);
        if (medium != primitive.inside.medium) {
            body.insides += 2; // around something: no simple shape
        } else if (++body.insides == 1 && primitive.bsdfs.size() == 1) {
            body.primitive = &primitive;
            std::visit(Overloaded{[&](const Sphere& sphere) { body.sphere = &sphere; },
                                  [&](const TriangleMesh& mesh) { body.faces = convexFaces(mesh); },
                                  [](const Disk&) {}},
                       primitive.shape);
        }
    }
}

/// Light that crosses from one scattering medium into the next is not lost: what they fill together counts.
void joinTouching(const Scene& scene, std::vector<BoundedMedium>& bodies) {
    for (size_t round = 0; round < bodies.size(); ++round)
        for (const Primitive& primitive : scene.primitives) {
            const int in = primitive.inside.medium, out = primitive.outside.medium;
            if (!primitive.boundsMedium || in < 0 || out < 0) continue;
            BoundedMedium &a = bodies[size_t(in)], &b = bodies[size_t(out)];
            if (!a.scatters() || !b.scatters()) continue;
            a.box.extendBy(b.box);
            b.box = a.box;
        }
}

} // namespace

BoundedMedium::BoundaryHit BoundedMedium::intersectBoundary(const Vec3f& position, const Vec3f& direction) const {
    if (sphere) {
        const Vec3f from = position - sphere->centre;
        const float along = from.dot(direction), across = (from - direction * along).length2();
        const float distance = std::sqrt(std::max(sqr(sphere->radius) - across, 0.0f)) - along;
        const Vec3f normal = (from + direction * distance).normalized();
        return {{sphere->centre + normal * sphere->radius, normal}, std::max(distance, 0.0f)};
    }
    BoundaryHit exit{faces.front(), Infinity};
    for (const Face& face : faces) {
        const float cosine = direction.dot(face.normal);
        if (!(cosine > 0.0f)) continue;
        const float distance = std::max((face.point - position).dot(face.normal), 0.0f) / cosine;
        if (distance < exit.distance) exit = {face, distance};
    }
    return exit;
}

std::vector<BoundedMedium> boundedMediaOf(const Scene& scene) {
    std::vector<BoundedMedium> bodies(scene.media.size());
    for (size_t i = 0; i < bodies.size(); ++i) {
        const Medium& medium = scene.media[i];
        if (medium.scatters())
            bodies[i].reducedSigmaT =
                std::max(meanComponent(medium.sigmaA() + medium.sigmaS() * (1.0f - medium.phase.g())), 1e-20f);
    }
    for (size_t i = 0; i < scene.primitives.size(); ++i)
        if (scene.primitives[i].boundsMedium) addBoundary(scene, i, bodies);
    for (size_t i = 0; i < bodies.size(); ++i) {
        const auto lies = [&](const Emitter& emitter) { return emitter.medium == int(i); };
        const bool begins =
            scene.cameraRegion.medium == int(i) || std::any_of(scene.emitters.begin(), scene.emitters.end(), lies);
        if (!begins && !bodies[i].ends()) bodies[i].reducedSigmaT = 0.0f;
    }
    joinTouching(scene, bodies);
    for (BoundedMedium& body : bodies) {
        const bool simple = body.insides == 1 && (body.sphere || isClosed(body.faces));
        if (simple) continue;
        body.primitive = nullptr;
        body.sphere = nullptr;
        body.faces.clear();
    }
    return bodies;
}

std::vector<MediumSphere> spheresAboutMedia(const Scene& scene) {
    const auto scatters = [&](int medium) { return medium >= 0 && scene.media[size_t(medium)].scatters(); };
    std::vector<MediumSphere> spheres;
    for (const Primitive& primitive : scene.primitives) {
        const bool passes = std::any_of(primitive.bsdfs.begin(), primitive.bsdfs.end(),
                                        [](const BsdfPtr& bsdf) { return isIndexMatched(*bsdf) || refracts(*bsdf); });
        if (!passes || !scatters(primitive.inside.medium) || scatters(primitive.outside.medium)) continue;
        const Imath::Box3f box = boundsOf(primitive.shape);
        const auto* sphere = std::get_if<Sphere>(&primitive.shape);
        spheres.push_back({box.center(), sphere ? sphere->radius : 0.5f * box.size().length()});
    }
    return spheres;
}

bool isSealed(const Scene& scene) {
    const std::vector<BoundedMedium> bodies = boundedMediaOf(scene);
    const auto opens = [](const BoundedMedium& body) { return body.scatters() && !body.isSealed(); };
    const auto lights = [&](const Emitter& emitter) {
        return emitter.medium >= 0 && bodies[size_t(emitter.medium)].scatters();
    };
    return std::none_of(bodies.begin(), bodies.end(), opens) &&
           std::none_of(scene.emitters.begin(), scene.emitters.end(), lights);
}

} // namespace tungsten::transport
