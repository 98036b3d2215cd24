#include "tungsten/geometry/Shape.h"

namespace tungsten {

Imath::Box3f boundsOf(const Shape& shape) {
    return std::visit([](const auto& m) { return m.bounds(); }, shape);
}

BoundingSphere boundingSphere(const Shape& shape) {
    return std::visit([](const auto& m) { return m.boundingSphere(); }, shape);
}

float surfaceArea(const Shape& shape) {
    return std::visit([](const auto& m) { return m.area(); }, shape);
}

FacePlane facePlane(const Shape& shape, uint32_t face, const Vec3f& position) {
    return std::visit([&](const auto& m) { return m.facePlane(face, position); }, shape);
}

AreaSampler::AreaSampler(const Shape& shape)
    : area_(surfaceArea(shape)),
      faces_(std::visit([](const auto& m) { return Distribution1D(m.faceAreas()); }, shape)) {}

SurfaceSample AreaSampler::sample(const Shape& shape, const Vec2f& u) const {
    return std::visit([&](const auto& m) { return m.samplePoint(faces_, u); }, shape);
}

} // namespace tungsten
