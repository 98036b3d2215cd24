#include "photon/store/FoldedSelection.h"

#include <algorithm>

namespace tungsten::photon {

namespace {

/// A box about everything that lines can meet.
struct Box {
    Vec3f low{Infinity}, high{-Infinity};

    void include(const Vec3f& point, float radius) {
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], point[axis] - radius);
            high[axis] = std::max(high[axis], point[axis] + radius);
        }
    }
    /// Area of the box seen from far away, averaged over directions: a quarter of its surface (Cauchy).
    [[nodiscard]] double meanShadow() const {
        const Vec3f size = high - low;
        return 0.5 *
               (double(size.x) * double(size.y) + double(size.y) * double(size.z) + double(size.z) * double(size.x));
    }
};

/// `area`: of all discs or ribbons, as lines see them.
double share(double area, const Box& box) {
    const double met = area / box.meanShadow();
    return met > FoldedMeetings && std::isfinite(met) ? FoldedMeetings / met : 1.0;
}

} // namespace

double foldedShare(const std::vector<Photon>& photons, const std::vector<float>& radii) {
    Box box;
    double area = 0.0;
    for (size_t i = 0; i < photons.size(); ++i) {
        const float radius = radii[radii.size() == 1 ? 0 : i];
        box.include(photons[i].position, radius);
        area += double(Pi * radius * radius);
    }
    return share(area, box);
}

double foldedShare(const std::vector<PhotonBeam>& beams, float radius) {
    constexpr double MeanSine = 0.25 * double(Pi);
    Box box;
    double area = 0.0;
    for (const PhotonBeam& beam : beams) {
        box.include(beam.base + beam.direction * beam.tStart, radius);
        box.include(beam.base + beam.direction * beam.tEnd, radius);
        area += MeanSine * 2.0 * double(radius) * double(beam.tEnd - beam.tStart);
    }
    return share(area, box);
}

} // namespace tungsten::photon
