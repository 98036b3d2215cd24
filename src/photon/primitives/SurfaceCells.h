#pragma once
// What cells of space know of the surfaces about them, so that most records need not search for any.

#include "tungsten/geometry/SceneGeometry.h"

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

namespace tungsten::photon {

/// Filled where they are asked for, by any number of threads, and kept from pass to pass. What a cell knows follows
/// from its place alone: not from who asked first, nor from whether there was room to keep it.
class SurfaceCells {
  public:
    /// Beyond so many faces those near a cell are searched for each record.
    static constexpr size_t MostFaces = 16;

    /// Faces of one plane, or one that is not flat.
    struct Group {
        std::optional<SceneGeometry::Plane> plane;
        std::vector<FaceIndex> faces;
    };
    /// All faces that may be within `reach` of a point of a cell.
    struct Faces {
        std::vector<Group> groups;
        bool tooMany = false; ///< there are more than are kept
    };

    /// Cells are cubes of edge `size`.
    SurfaceCells(const SceneGeometry& geometry, float size, float reach);
    ~SurfaceCells();
    SurfaceCells(const SurfaceCells&) = delete;
    SurfaceCells& operator=(const SurfaceCells&) = delete;

    /// Bounds on the distance of the nearest surface from a point.
    struct Distance {
        float least, most;
    };
    [[nodiscard]] Distance distance(const Vec3f& position) const;
    /// Calls use(faces) with those of the point's cell.
    template <typename Use>
    auto withFaces(const Vec3f& position, Use&& use) const {
        const Place place = placeOf(position);
        Slot* slot = place.key ? slotOf(place.key) : nullptr;
        if (!slot) return use(facesAbout(place.centre));
        const Faces* faces = slot->faces.load(std::memory_order_acquire);
        return use(faces ? *faces : keep(*slot, facesAbout(place.centre)));
    }
    [[nodiscard]] float reach() const { return reach_; }

  private:
    struct Place {
        uint64_t key; ///< 0: too far out to be numbered
        Vec3f centre;
    };
    struct Slot {
        std::atomic<uint64_t> key;
        std::atomic<const Faces*> faces;
        std::atomic<float> distance; ///< of the centre from the nearest surface; 0: not known yet
    };

    /// Fine or coarse cells, of edge size * `scale`.
    [[nodiscard]] Place placeOf(const Vec3f& position, float scale = 1.0f) const;
    [[nodiscard]] Distance distanceBy(const Place& place, const Vec3f& position) const;
    /// Nothing where there is no room.
    [[nodiscard]] Slot* slotOf(uint64_t key) const;
    [[nodiscard]] float distanceFrom(const Vec3f& centre) const;
    [[nodiscard]] Faces facesAbout(const Vec3f& centre) const;
    static const Faces& keep(Slot& slot, Faces&& faces);

    const SceneGeometry& geometry_;
    float size_, inverse_, reach_;
    std::unique_ptr<Slot[]> slots_;
};

} // namespace tungsten::photon
