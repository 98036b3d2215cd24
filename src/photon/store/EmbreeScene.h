#pragma once
// An Embree structure over primitives of one kind, owned.

#include "tungsten/core/Types.h"
#include "tungsten/geometry/Embree.h"

#include <cstddef>
#include <new>

namespace tungsten::photon {

class EmbreeScene {
  public:
    /// `fill(geometry)` gives a geometry of this type its primitives, of which there is at least one: Embree has no
    /// buffers of nothing.
    template <typename Fill>
    EmbreeScene(RTCGeometryType type, RTCSceneFlags flags, const Fill& fill)
        : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        RTCGeometry geometry = rtcNewGeometry(device_, type);
        fill(geometry);
        rtcSetSceneFlags(scene_, flags);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    ~EmbreeScene() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    [[nodiscard]] RTCScene get() const { return scene_; }
    /// A buffer of the geometry that is being filled.
    template <typename Element>
    [[nodiscard]] static Element* newBuffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, size_t count) {
        auto* buffer =
            static_cast<Element*>(rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Element), count));
        if (!buffer) throw std::bad_alloc();
        return buffer;
    }

  private:
    RTCDevice device_;
    RTCScene scene_;
};

/// Position and radius, as Embree lays out points and the vertices of curves.
struct PointWithRadius {
    Vec3f position;
    float radius;
};
static_assert(sizeof(PointWithRadius) == 16);

} // namespace tungsten::photon
