#include "tungsten/scene/LoadContext.h"

namespace tungsten {

namespace {

constexpr double LargestSide = 65536;

FieldOfView fieldOfView(const ObjectReader& reader) {
    return {float(reader.number("fov", 60.0, {1e-3, 179.0}))};
}

ThinLens readThinLens(const ObjectReader& reader) {
    ThinLens lens{fieldOfView(reader)};
    lens.focusDistance = float(reader.number("focus_distance", 1.0, Range::positive()));
    lens.apertureRadius = float(reader.number("aperture_size", 0.001, Range::nonNegative()));
    if (reader.number("cateye", 0.0, Range::nonNegative()) > 0.0)
        reader.warn("cateye", "not simulated: the whole lens is open towards every pixel");
    if (const auto aperture = reader.isObject("aperture") ? reader.object("aperture") : std::nullopt) {
        if (aperture->text("type", "") != "disk") reader.problem("aperture", "only the disk aperture is supported");
    } else if (reader.has("aperture")) {
        reader.problem("aperture", "only the disk aperture is supported");
    }
    return lens;
}

/// `focus_pivot` names a primitive; its origin's distance becomes the focus distance.
void readFocusPivot(const ObjectReader& root, const ObjectReader& reader, const Vec3f& cameraPosition, ThinLens& lens) {
    if (!reader.has("focus_pivot")) return;
    const std::string pivot = reader.text("focus_pivot", "");
    for (size_t i = 0; i < root.arraySize("primitives"); ++i) {
        const auto primitive = root.arrayObject("primitives", i);
        if (!primitive || !primitive->isText("name") || primitive->text("name", "") != pivot) continue;
        lens.focusDistance = std::max((primitive->transform("transform").translation - cameraPosition).length(), 1e-6f);
        return;
    }
    reader.problem("focus_pivot", "there is no primitive called '" + pivot + "'");
}

void readModel(const ObjectReader& root, const ObjectReader& reader, Camera& camera) {
    const std::string type = reader.choice("type", "pinhole", cameraTypes());
    if (type == "thinlens") {
        ThinLens lens = readThinLens(reader);
        readFocusPivot(root, reader, camera.position(), lens);
        camera.model = lens;
    } else if (type == "orthographic") {
        camera.model = Orthographic{float(reader.number("orthographic_size", 1.0, Range::positive()))};
        reader.accept({"fov"});
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

std::vector<std::string> cameraTypes() {
    return {"pinhole", "thinlens", "orthographic"};
}

void readCamera(LoadContext& context, const ObjectReader& root) {
    Scene& scene = context.scene;
    const ObjectReader reader = root.has("camera") && root.isObject("camera")
                                    ? *root.object("camera")
                                    : ObjectReader::empty("camera", root.diagnostics());
    Camera& camera = scene.camera;
    camera.resolution = reader.pair("resolution", {1000, 563}, {1, LargestSide});
    camera.toWorld =
        cameraTransform(reader.has("transform") ? reader.transform("transform") : defaultCameraTransform());
    camera.filter = ReconstructionFilter(*filterByName(reader.choice("reconstruction_filter", "tent", filterNames())));
    scene.toneMap = *toneMapByName(reader.choice("tonemap", "gamma", toneMapNames()));
    readModel(root, reader, camera);
    const int medium = reader.has("medium") ? readMediumReference(context, reader, "medium") : -1;
    scene.cameraRegion = {medium, medium >= 0 ? scene.media[size_t(medium)].speedOfLight : scene.transport.vacuumSpeed};
    reader.accept({"name"});
    reader.warnAboutUnknown();
}

} // namespace tungsten
