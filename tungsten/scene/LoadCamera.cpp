#include "tungsten/reader/FormatTypes.h"
#include "tungsten/scene/LoadContext.h"

#include <algorithm>

namespace tungsten {

namespace {

constexpr double LargestSide = 65536;
const Range LensRange{1e-9, 1e9};

FieldOfView fieldOfView(const ObjectReader& reader) {
    return {float(reader.number("fov", 60.0, {"degrees", "horizontal field of view"}, {1e-3, 179.0}))};
}

ThinLens readThinLens(const ObjectReader& reader) {
    ThinLens lens{fieldOfView(reader)};
    lens.focusDistance =
        float(reader.number("focus_distance", 1.0, {"length", "of the sharp plane, along the axis"}, LensRange));
    lens.apertureRadius =
        float(reader.number("aperture_size", 0.001, {"length", "radius of the lens"}, {0.0, LensRange.high}));
    if (reader.number("cateye", 0.0, {"none", "not simulated: the whole lens is open towards every pixel"},
                      Range::nonNegative()) > 0.0)
        reader.warn("cateye", "not simulated: the whole lens is open towards every pixel");
    reader.declare("aperture", "an object of type disk", "a disk", {"none", "shape of the lens"});
    const auto aperture =
        reader.isObject("aperture") ? reader.object("aperture", {"none", "shape of the lens"}) : std::nullopt;
    if (reader.has("aperture") && (!aperture || aperture->text("type", "", {"none", "which shape"}) != "disk"))
        reader.problem("aperture", "only the disk aperture is supported");
    return lens;
}

/// `focus_pivot` names a primitive; its origin's distance becomes the focus distance.
void readFocusPivot(const ObjectReader& root, const ObjectReader& reader, const Vec3f& cameraPosition, ThinLens& lens) {
    const std::string pivot =
        reader.text("focus_pivot", "", {"none", "name of a primitive whose origin's distance is the focus distance"});
    if (!reader.has("focus_pivot")) return;
    for (size_t i = 0; i < root.arraySize("primitives"); ++i) {
        const auto primitive = root.arrayObject("primitives", i);
        if (!primitive || !primitive->isText("name") || primitive->text("name", "", NameMeaning) != pivot) continue;
        lens.focusDistance = std::max(
            (primitive->transform("transform", PlacementMeaning).translation - cameraPosition).length(), 1e-6f);
        return;
    }
    reader.problem("focus_pivot", "there is no primitive called '" + pivot + "'");
}

Detector readDetector(const ObjectReader& block, const Transform& placement) {
    Detector detector;
    detector.name = block.text("name", "", {"none", "what results call it"});
    detector.position =
        placement.point(block.vec3("position", Vec3f(0.0f), {"length", "middle of its disc"}, Range::coordinate()));
    const Vec3f direction = placement.vector(block.vec3(
        "direction", Vec3f(0, 0, 1), {"none", "where it looks: the normal of its disc"}, Range::coordinate()));
    const bool looks = direction.length() > LeastPositive;
    if (!looks) block.problem("direction", "expected a direction, found the length 0");
    detector.frame = Frame(looks ? direction.normalized() : Vec3f(0, 0, 1));
    detector.radius = float(block.number("radius", 0.001, {"length", "of its disc"}, LensRange));
    detector.aperture = float(block.number("numerical_aperture", 1.0,
                                           {"none", "sine of the half angle within which it accepts light; 1: a bucket "
                                                    "that accepts a hemisphere"},
                                           {1e-6, 1.0}));
    block.refuseUnknown({{"aperture", "numerical_aperture is the sine of the cone's half angle"},
                         {"angle", "numerical_aperture is the sine of the cone's half angle"},
                         {"na", "numerical_aperture is meant"},
                         {"diameter", "radius is half of it"},
                         {"look_at", "direction is look_at - position"}});
    return detector;
}

/// As many columns as there are detectors.
void readDetectors(const ObjectReader& reader, Camera& camera) {
    const Transform placement = reader.has("transform") ? reader.transform("transform", PlacementMeaning) : Transform();
    Detectors detectors;
    const Meaning meaning{"none", "detectors: discs that accept light within a cone, each a pixel of one row"};
    for (const ObjectReader& block : reader.blocks("detectors", meaning))
        detectors.row.push_back(readDetector(block, placement));
    if (reader.describes()) return;
    if (detectors.row.empty() || detectors.row.size() > size_t(LargestSide))
        return reader.problem("detectors", "expected an array of 1 to " + brief(LargestSide) + " detectors");
    if (reader.has("resolution"))
        reader.problem("resolution", "the image has a pixel for each detector, in one row; leave it out");
    camera.resolution = {int(detectors.row.size()), 1};
    camera.toWorld = Transform();
    camera.toWorld.translation = detectors.row.front().position;
    camera.filter = ReconstructionFilter(FilterType::Box);
    camera.model = std::move(detectors);
}

void readModel(const ObjectReader& root, const ObjectReader& reader, Camera& camera) {
    const std::string type =
        reader.choice("type", "pinhole", cameraTypes(), {"none", "which camera"}, unsupportedCameras());
    if (type == "thinlens") {
        ThinLens lens = readThinLens(reader);
        readFocusPivot(root, reader, camera.position(), lens);
        camera.model = lens;
    } else if (type == "orthographic") {
        camera.model = Orthographic{
            float(reader.number("orthographic_size", 1.0, {"length", "half the image's height"}, LensRange))};
        reader.accept({"fov"});
    } else if (type == "detectors") {
        readDetectors(reader, camera);
        reader.accept({"fov", "orthographic_size"});
    } else {
        camera.model = Pinhole{fieldOfView(reader)};
        reader.accept({"orthographic_size"});
    }
}

Transform defaultCameraTransform() {
    Transform transform;
    transform.translation = Vec3f(0, 0, 2);
    return transform;
}

} // namespace

void describeCamera(const std::shared_ptr<Description>& description) {
    ScratchContext scratch;
    readCamera(scratch.context, ObjectReader::empty("", std::make_shared<Diagnostics>()),
               ObjectReader::describing(description, description->name));
}

std::vector<std::string> cameraTypes() {
    return {"pinhole", "thinlens", "orthographic", "detectors"};
}

void readCamera(LoadContext& context, const ObjectReader& root, const ObjectReader& reader) {
    Scene& scene = context.scene;
    Camera& camera = scene.camera;
    camera.resolution = reader.pair("resolution", {1000, 563}, {"pixels", "width and height"}, {1, LargestSide});
    const Transform placement =
        reader.transform("transform", {"none", "where it stands; it looks along +z with y up", "position [0, 0, 2]"});
    if (!(std::abs(placement.determinant()) >= LeastPositive))
        reader.problem("transform", "the camera has no extent in some direction: an axis is zero, or two are parallel");
    camera.toWorld = cameraTransform(reader.has("transform") ? placement : defaultCameraTransform());
    camera.filter = ReconstructionFilter(*filterByName(
        reader.choice("reconstruction_filter", "tent", filterNames(), {"none", "how samples weigh in their pixel"})));
    scene.toneMap =
        *toneMapByName(reader.choice("tonemap", "gamma", toneMapNames(), {"none", "curve of the 8-bit image"}));
    readModel(root, reader, camera);
    const int medium = readMediumReference(context, reader, "medium", {"none", "what surrounds the camera", "vacuum"});
    scene.cameraRegion = {medium, medium >= 0 ? scene.media[size_t(medium)].speedOfLight : scene.transport.vacuumSpeed};
    reader.accept({"name"});
    reader.warnAboutUnknown();
}

} // namespace tungsten
