#include "tungsten/camera/CameraReader.h"
#include "tungsten/reader/FormatTypes.h"
#include "tungsten/scene/LoadContext.h"

namespace tungsten {

namespace {

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

void readCamera(LoadContext& context, const ObjectReader& root, const ObjectReader& reader) {
    Scene& scene = context.scene;
    Camera& camera = scene.camera;
    camera.resolution =
        reader.pair("resolution", {1000, 563}, {"pixels", "width and height"}, {1, CameraReader::LargestSide});
    const Transform placement =
        reader.transform("transform", {"none", "where it stands; it looks along +z with y up", "position [0, 0, 2]"});
    if (!(std::abs(placement.determinant()) >= LeastPositive))
        reader.problem("transform", "the camera has no extent in some direction: an axis is zero, or two are parallel");
    camera.toWorld = cameraTransform(reader.has("transform") ? placement : defaultCameraTransform());
    camera.filter = ReconstructionFilter(*filterByName(
        reader.choice("reconstruction_filter", "tent", filterNames(), {"none", "how samples weigh in their pixel"})));
    scene.toneMap =
        *toneMapByName(reader.choice("tonemap", "gamma", toneMapNames(), {"none", "curve of the 8-bit image"}));
    const std::string type =
        reader.choice("type", Pinhole::Type, Cameras::names(), {"none", "which camera"}, unsupportedCameras());
    const CameraReader fields(reader, root);
    Cameras::with(type, [&]<typename Model> { Model::read(fields, camera); });
    const int medium = readMediumReference(context, reader, "medium", {"none", "what surrounds the camera", "vacuum"});
    scene.cameraRegion = {medium, medium >= 0 ? scene.media[size_t(medium)].speedOfLight : scene.transport.vacuumSpeed};
    reader.accept({"name"});
    reader.warnAboutUnknown();
}

} // namespace tungsten
