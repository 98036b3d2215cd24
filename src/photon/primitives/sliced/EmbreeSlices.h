#pragma once
// An Embree structure over records of collapsed flights, owned: boxes about what they can reach.

#include "photon/primitives/sliced/SliceRecord.h"
#include "photon/view/CameraSegment.h"

#include "tungsten/geometry/Embree.h"

namespace tungsten::photon {

class EmbreeSlices {
  public:
    struct Box {
        Vec3f low, high;
    };
    explicit EmbreeSlices(std::vector<Box> boxes);
    ~EmbreeSlices();
    EmbreeSlices(const EmbreeSlices&) = delete;
    EmbreeSlices& operator=(const EmbreeSlices&) = delete;

    /// Calls meet(user, index) for every box that the segment meets.
    using Meet = void (*)(void* user, uint32_t index);
    void query(const CameraSegment& segment, Meet meet, void* user) const;

  private:
    std::vector<Box> boxes_;
    RTCDevice device_;
    RTCScene scene_;
};

} // namespace tungsten::photon
