// Sensors, lights and surfaces that disagree about the medium between them. What a path is in goes by what it left or
// crossed last, so where two ends of a segment name different media, what it is depends on the direction.

#include "tungsten/core/Warp.h"
#include "tungsten/scene/LoadEmitters.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace tungsten {

namespace {

constexpr size_t MostChecked = 256; ///< surfaces, detectors: a warning is not worth more
constexpr int RaysOfEach = 64;      ///< rays from each side of a surface, or from a sensor
constexpr int EmitterRays = 32;     ///< rays from a light, besides those to the sensor

/// Of a low-discrepancy sequence in the unit square.
Vec2f spread(int i) {
    const double x = 0.5 + 0.7548776662466927 * i, y = 0.5 + 0.5698402909980532 * i;
    return {float(x - std::floor(x)), float(y - std::floor(y))};
}

/// The end of a segment: a side of a surface, or the sensor, with the medium that it names there.
struct SegmentEnd {
    int primitive = -1; ///< index; -1: the sensor
    bool inside = false;
    int medium = -1;
    auto operator<=>(const SegmentEnd&) const = default;
};

/// A point of a surface.
struct Place {
    Vec3f position, normal;
    int32_t material = 0;
};

struct Segment {
    bool blocked = false;          ///< by what light does not pass, or where surfaces touch
    std::optional<SegmentEnd> end; ///< none: nothing on the way says what it is in
    Place place = {};              ///< of the end
};

Place placeOn(const Sphere& sphere, int i) {
    const Vec3f normal = warp::squareToSphere(spread(i));
    return {sphere.centre + normal * sphere.radius, normal};
}
Place placeOn(const Disk& disk, int i) {
    const Vec2f at = warp::squareToDisk(spread(i)) * disk.radius;
    return {disk.centre + disk.frame.s * at.x + disk.frame.t * at.y, disk.frame.n};
}
/// On triangles that are evenly spaced in the mesh's list, several times on each of a few.
Place placeOn(const TriangleMesh& mesh, int i) {
    const size_t count = mesh.triangles.size();
    const auto triangle =
        uint32_t(count < size_t(RaysOfEach) ? size_t(i) % count : size_t(i) * count / size_t(RaysOfEach));
    const Vec2f b = warp::squareToTriangle(spread(i));
    return {mesh.pointOn(triangle, b.x, b.y), mesh.faceNormal(triangle),
            mesh.materials.empty() ? 0 : mesh.materials[triangle]};
}

/// What most ways from one place or side lead to.
class Votes {
  public:
    void add(const Segment& way) {
        if (!way.end) return;
        ++told_;
        ++ends_[*way.end];
    }
    /// The end most often met of those that name another medium, if that is at least the `part` of all that are met.
    [[nodiscard]] std::optional<SegmentEnd> against(int medium, double part) const {
        int others = 0, most = 0;
        std::optional<SegmentEnd> end;
        for (const auto& [met, count] : ends_) {
            if (met.medium == medium) continue;
            others += count;
            if (count > most) end = met;
            most = std::max(most, count);
        }
        return others >= 2 && others >= part * told_ ? end : std::nullopt;
    }

  private:
    int told_ = 0;
    std::map<SegmentEnd, int> ends_;
};

class MediaAgreement {
  public:
    MediaAgreement(const LoadContext& context, const ObjectReader& root) : context_(context), root_(root) {
        for (const Primitive& primitive : scene_.primitives) {
            boxes_.push_back(boundsOf(primitive.shape));
            extents_.push_back(boxes_.back().isEmpty() ? 0.0f : boxes_.back().size().length());
        }
    }

    void checkSensor(const ObjectReader& camera) {
        const auto* detectors = scene_.camera.detectors();
        const size_t count = detectors ? std::min(detectors->row.size(), MostChecked) : 1;
        for (size_t i = 0; i < count; ++i) {
            Votes votes;
            const int medium = scene_.cameraRegion.medium;
            for (int k = 0; k < RaysOfEach; ++k)
                cast(votes, segmentAlong(sensorRay(detectors ? int(i) : -1, k)), medium);
            const std::string name = detectors && !detectors->row[i].name.empty()
                                         ? "detector '" + detectors->row[i].name + "'"
                                     : detectors ? "detector " + std::to_string(i)
                                                 : "the camera";
            const auto end = votes.against(medium, SensorPart);
            if (end && blames(*end, medium))
                tellAbout(*end, "paths from " + name, medium);
            else if (end && told_.insert({-1, false, -1}).second)
                camera.warn("medium", aboutSensor(name, *end, medium));
        }
    }

    void checkEmitter(size_t index) {
        const Emitter& emitter = scene_.emitters[index];
        if (emitter.isInfinite()) return;
        Votes votes;
        for (int k = 0; k < EmitterRays; ++k)
            cast(votes,
                 segmentAlong(sampleEmission(emitter, spread(k), spread(k + EmitterRays)).ray, emitter.primitive()),
                 emitter.medium);
        for (int k = 0; k < 4; ++k) cast(votes, segmentToSensor(emitter, k), emitter.medium);
        const auto end = votes.against(emitter.medium, EmitterPart);
        if (!end) return;
        if (end->primitive >= 0 && blames(*end, emitter.medium))
            return tellAbout(*end, "light of '" + emitter.name + "'", emitter.medium);
        if (const auto primitive = emitter.primitive()) told_.insert({int(*primitive), false, -1});
        context_.emitters[index].warn("ext_medium", aboutEmitter(emitter, *end));
    }

    void checkSurface(size_t index) {
        const Primitive& primitive = scene_.primitives[index];
        for (const bool inside : {false, true}) {
            const int medium = (inside ? primitive.inside : primitive.outside).medium;
            Votes votes;
            for (int k = 0; k < RaysOfEach; ++k) {
                const Place place = std::visit([&](const auto& shape) { return placeOn(shape, k); }, primitive.shape);
                if (!says(primitive, inside, place.material)) continue;
                const Vec3f side = inside ? -place.normal : place.normal;
                const Vec3f direction = Frame(side).toWorld(warp::squareToCosineHemisphere(spread(k + RaysOfEach)));
                Segment way = segmentAlong({place.position + side * (StartPart * extents_[index]), direction});
                if (way.end && way.end->primitive == int(index)) way.end->medium = medium; // its own holes
                if (way.end && way.end->medium != medium && touches(place, index)) continue;
                cast(votes, way, medium);
            }
            const auto end = votes.against(medium, SurfacePart);
            if (!end) continue;
            const SegmentEnd own{int(index), inside, medium};
            if (blames(*end, medium)) {
                tellAbout(*end, "paths from " + textOf(own), medium);
                continue;
            }
            tellAbout(own, "paths from " + textOf(*end), end->medium);
            if (medium >= 0) told_.insert({end->primitive, end->inside, -1}); // it would say the same
        }
    }

    [[nodiscard]] bool isWorthChecking(size_t index) const {
        return scene_.primitives[index].boundsMedium && extents_[index] > 0.0f;
    }

  private:
    // Parts of the ways that something names as another medium than that in which they start: a single one may be a
    // hole of a mesh.
    static constexpr double SensorPart = 0.125, SurfacePart = 0.125, EmitterPart = 0.5;
    static constexpr float TouchPart = 1e-3f; ///< of a surface's extent: what is nearer to it touches it
    static constexpr float StartPart = 1e-5f; ///< how far off the surface rays start

    /// The side says what is before it: who names none on the side of what light does not pass says nothing.
    [[nodiscard]] bool says(const Primitive& primitive, bool inside, int32_t material) const {
        if (!primitive.boundsMedium) return false;
        if ((inside ? primitive.inside : primitive.outside).medium >= 0) return true;
        return (bsdfOf(primitive, material).lobes() & lobe::AnyTransmission) != 0;
    }
    static const Bsdf& bsdfOf(const Primitive& primitive, int32_t material) {
        return *primitive.bsdfs[size_t(std::clamp(material, 0, int(primitive.bsdfs.size()) - 1))];
    }

    /// Another surface lies in the same place: which of the two is crossed first is nothing that their names tell. Rays
    /// meet one of them and skip the other, so each is looked at alone.
    [[nodiscard]] bool touches(const Place& place, size_t index) {
        const float reach = TouchPart * extents_[index];
        Ray across{place.position - place.normal * reach, place.normal};
        across.tMax = 2.0f * reach;
        const Vec3f margin(reach);
        for (size_t i = 0; i < boxes_.size(); ++i) {
            if (i == index || !Imath::Box3f(boxes_[i].min - margin, boxes_[i].max + margin).intersects(place.position))
                continue;
            std::unique_ptr<SceneGeometry>& alone = alone_[i];
            if (!alone) alone = std::make_unique<SceneGeometry>(std::vector<const Shape*>{&scene_.primitives[i].shape});
            if (alone->occluded(across)) return true;
        }
        return false;
    }

    /// What contradicts `medium` counts only where the names tell what is crossed.
    void cast(Votes& votes, const Segment& way, int medium) {
        const bool contradicts = way.end && way.end->medium != medium && way.end->primitive >= 0;
        if (!contradicts || !touches(way.place, size_t(way.end->primitive))) votes.add(way);
    }

    /// To the first side that says what the ray is in there, through what light passes; as if `own` were not there.
    [[nodiscard]] Segment segmentAlong(Ray ray, std::optional<uint32_t> own = {}) const {
        constexpr int MostCrossed = 64;
        for (int k = 0; k < MostCrossed; ++k) {
            const auto hit = scene_.geometry->intersect(ray);
            if (!hit) return {};
            const Primitive& primitive = scene_.primitives[hit->shape];
            const bool inside = ray.direction.dot(hit->ng) > 0.0f;
            if (hit->shape != own && says(primitive, inside, hit->material)) {
                const int medium = (inside ? primitive.inside : primitive.outside).medium;
                return {true, SegmentEnd{int(hit->shape), inside, medium}, {hit->position, hit->ng, hit->material}};
            }
            if (hit->shape != own && (scene_.bsdfOf(*hit).lobes() & lobe::AnyTransmission) == 0) return {true, {}};
            ray.tMin = hit->margin().beyond(ray.direction, hit->t);
        }
        return {true, {}};
    }

    [[nodiscard]] Segment segmentToSensor(const Emitter& emitter, int k) const {
        const SurfaceSample point = sampleEmissionPoint(emitter, spread(k));
        const Vec3f way = sensorRay(-1, k).origin - point.position;
        const SegmentEnd sensor{-1, false, scene_.cameraRegion.medium};
        if (!(way.length() > 0.0f)) return {false, sensor};
        Ray ray = point.spawnRay(way.normalized());
        ray.tMax = way.length();
        Segment found = segmentAlong(ray, emitter.primitive());
        if (!found.blocked) found.end = sensor;
        return found;
    }

    /// Of that detector, or of any pixel.
    [[nodiscard]] Ray sensorRay(int detector, int k) const {
        const Vec2f u = spread(k);
        const Vec2i& size = scene_.camera.resolution;
        const Vec2i pixel(std::min(int(u.x * float(size.x)), size.x - 1),
                          std::min(int(u.y * float(size.y)), size.y - 1));
        return scene_.camera.generateRay(detector < 0 ? pixel : Vec2i(detector, 0), spread(k + RaysOfEach), {u.y, u.x});
    }

    /// Of two ends of a way, of which one names none: that one.
    static bool blames(const SegmentEnd& end, int medium) {
        return end.primitive >= 0 && end.medium < 0 && medium >= 0;
    }

    [[nodiscard]] std::string nameOf(int medium) const { return "'" + scene_.media[size_t(medium)].name + "'"; }
    [[nodiscard]] std::string textOf(const SegmentEnd& end) const {
        if (end.primitive < 0) return "the camera";
        const Primitive& primitive = scene_.primitives[size_t(end.primitive)];
        return primitive.name.empty() ? primitive.path : "'" + primitive.name + "'";
    }
    /// "'ball' has 'fog' on its inner side".
    [[nodiscard]] std::string nameAt(const SegmentEnd& end) const {
        const std::string named = end.medium < 0 ? "vacuum" : nameOf(end.medium);
        if (end.primitive < 0) return "the camera is in " + named;
        return textOf(end) + " has " + named + (end.inside ? " on its inner side" : " on its outer side");
    }

    /// Once for every side: what comes there is in another medium.
    void tellAbout(const SegmentEnd& end, const std::string& what, int medium) {
        if (!told_.insert({end.primitive, end.inside, -1}).second) return;
        const std::string field = end.inside ? "int_medium" : "ext_medium";
        root_.warn(
            scene_.primitives[size_t(end.primitive)].path + "." + field,
            end.medium < 0
                ? textOf(end) + " names no " + field + ", so light that leaves it there goes on in vacuum, while " +
                      what + " arrive there in " + nameOf(medium)
                : nameAt(end) + ", while " + what + " arrive there in " + (medium < 0 ? "vacuum" : nameOf(medium)));
    }

    [[nodiscard]] std::string aboutSensor(const std::string& name, const SegmentEnd& end, int medium) const {
        if (medium < 0)
            return name + " is in medium " + nameOf(end.medium) +
                   " but names no medium: paths from it start in vacuum, while " + nameAt(end);
        return name + " is in medium " + nameOf(medium) + ", while what it sees is not: " + nameAt(end);
    }
    [[nodiscard]] std::string aboutEmitter(const Emitter& emitter, const SegmentEnd& end) const {
        if (emitter.medium >= 0)
            return "light '" + emitter.name + "' names medium " + nameOf(emitter.medium) + ", while " + nameAt(end);
        return "light '" + emitter.name + "' is in medium " + nameOf(end.medium) +
               " but names no ext_medium: its photons start in vacuum, while camera paths find it in " +
               nameOf(end.medium);
    }

    const LoadContext& context_;
    const ObjectReader& root_;
    const Scene& scene_ = context_.scene;
    std::vector<Imath::Box3f> boxes_;                        ///< of the surfaces
    std::vector<float> extents_;                             ///< diagonals of the boxes
    std::map<size_t, std::unique_ptr<SceneGeometry>> alone_; ///< single surfaces, as far as they were needed
    std::set<SegmentEnd> told_;                              ///< sides, without their media
};

} // namespace

void warnAboutMedia(const LoadContext& context, const ObjectReader& root, const ObjectReader& camera) {
    if (context.scene.media.empty()) return;
    MediaAgreement agreement(context, root);
    agreement.checkSensor(camera);
    for (size_t i = 0; i < std::min(context.emitters.size(), MostChecked); ++i) agreement.checkEmitter(i);
    size_t looked = 0;
    for (size_t i = 0; i < context.scene.primitives.size() && looked < MostChecked; ++i) {
        if (!agreement.isWorthChecking(i)) continue;
        ++looked;
        context.files.watch.poll();
        agreement.checkSurface(i);
    }
}

} // namespace tungsten
