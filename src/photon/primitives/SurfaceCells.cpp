#include "photon/primitives/SurfaceCells.h"

namespace tungsten::photon {

namespace {

constexpr size_t SlotBits = 17, Slots = size_t(1) << SlotBits;
/// Size of coarse cells, of that of fine ones.
constexpr float Coarse = 4.0f;
/// Slots that a key may be in.
constexpr size_t MostProbes = 8;

} // namespace

SurfaceCells::SurfaceCells(const SceneGeometry& geometry, float size, float reach)
    : geometry_(geometry), size_(size), inverse_(1.0f / size), reach_(reach), slots_(new Slot[Slots]()) {}

SurfaceCells::~SurfaceCells() {
    for (size_t i = 0; i < Slots; ++i) delete slots_[i].faces.load(std::memory_order_relaxed);
}

SurfaceCells::Distance SurfaceCells::distance(const Vec3f& position) const {
    // Far from surfaces coarse cells tell enough: fine ones would be too many to be kept.
    const Distance far = distanceBy(placeOf(position, Coarse), position);
    return far.least >= Coarse * size_ ? far : distanceBy(placeOf(position), position);
}

SurfaceCells::Distance SurfaceCells::distanceBy(const Place& place, const Vec3f& position) const {
    Slot* slot = place.key ? slotOf(place.key) : nullptr;
    float distance = slot ? slot->distance.load(std::memory_order_relaxed) : 0.0f;
    if (!(distance > 0.0f)) {
        distance = distanceFrom(place.centre);
        if (slot) slot->distance.store(distance, std::memory_order_relaxed);
    }
    constexpr float Rounding = 1e-5f;
    const float aside = (position - place.centre).length() * (1.0f + Rounding);
    return {distance * (1.0f - Rounding) - aside, distance * (1.0f + Rounding) + aside};
}

SurfaceCells::Place SurfaceCells::placeOf(const Vec3f& position, float scale) const {
    constexpr int AxisBits = 20;
    constexpr float Half = float(1 << (AxisBits - 1));
    uint64_t key = scale > 1.0f ? 3 : 2;
    Vec3f centre;
    bool numbered = true;
    for (int axis = 0; axis < 3; ++axis) {
        const float at = std::floor(position[axis] * (inverse_ / scale));
        numbered = numbered && std::abs(at) < Half;
        centre[axis] = (at + 0.5f) * (size_ * scale);
        key = key << AxisBits | (numbered ? uint64_t(int64_t(at) + int64_t(Half)) : 0);
    }
    return {numbered ? key : 0, centre};
}

SurfaceCells::Slot* SurfaceCells::slotOf(uint64_t key) const {
    size_t at = size_t((key * 0x9e3779b97f4a7c15u) >> (64 - SlotBits));
    for (size_t probe = 0; probe < MostProbes; ++probe, at = (at + 1) % Slots) {
        Slot& slot = slots_[at];
        uint64_t found = slot.key.load(std::memory_order_relaxed);
        if (found == key) return &slot;
        if (found == 0 && (slot.key.compare_exchange_strong(found, key, std::memory_order_relaxed) || found == key))
            return &slot;
    }
    return nullptr;
}

float SurfaceCells::distanceFrom(const Vec3f& centre) const {
    const auto toSurface = geometry_.toNearest(centre, Infinity);
    return toSurface ? std::max(float(toSurface->length()), std::numeric_limits<float>::min()) : Infinity;
}

SurfaceCells::Faces SurfaceCells::facesAbout(const Vec3f& centre) const {
    constexpr float HalfDiagonal = 0.8661f; // of a cube of edge 1, and rounding
    constexpr double Flat = 1e-6;           // of the size: faces as near to a plane as this lie in it
    constexpr double Parallel = 1e-12;
    const auto all = geometry_.facesWithin(centre, HalfDiagonal * size_ + reach_, MostFaces);
    if (!all) return {{}, true};
    Faces found;
    for (const FaceIndex& face : *all) {
        const auto plane = geometry_.planeOf(face);
        const auto holds = [&](const Group& group) {
            return plane && group.plane && plane->normal.cross(group.plane->normal).length2() < Parallel &&
                   std::abs((plane->point - group.plane->point).dot(group.plane->normal)) < Flat * double(size_);
        };
        const auto group = std::find_if(found.groups.begin(), found.groups.end(), holds);
        if (group != found.groups.end())
            group->faces.push_back(face);
        else
            found.groups.push_back({plane, {face}});
    }
    return found;
}

const SurfaceCells::Faces& SurfaceCells::keep(Slot& slot, Faces&& faces) {
    auto own = std::make_unique<const Faces>(std::move(faces));
    const Faces* kept = nullptr;
    // Another thread may have been first, with the same faces.
    if (!slot.faces.compare_exchange_strong(kept, own.get(), std::memory_order_acq_rel)) return *kept;
    return *own.release();
}

} // namespace tungsten::photon
