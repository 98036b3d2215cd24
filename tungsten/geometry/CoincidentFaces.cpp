#include "tungsten/geometry/CoincidentFaces.h"

#include "tungsten/core/Overloaded.h"

#include <array>
#include <numeric>
#include <span>

namespace tungsten {

namespace {

/// Errors of a face's coordinates within which another is at the same place: two transforms round to both.
constexpr float Errors = 8.0f;

/// A flat face: a triangle, or the square about a disk.
struct Facet {
    std::array<Vec3f, 4> corners;
    int count = 0;
    Vec3f normal, centre;
    float radius = 0.0f; ///< of a sphere about it
    float reach = 0.0f;
    FaceIndex at;
    bool flipped = false; ///< `normal`, whose largest component is positive, is not the face's own

    [[nodiscard]] std::span<const Vec3f> outline() const { return {corners.data(), size_t(count)}; }
};

Vec3f largestOf(std::span<const Vec3f> points) {
    Vec3f largest(0.0f);
    for (const Vec3f& p : points)
        for (int axis = 0; axis < 3; ++axis) largest[axis] = std::max(largest[axis], std::abs(p[axis]));
    return largest;
}

void complete(Facet& facet, const Vec3f& normal) {
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
    facet.flipped = normal[axis] < 0.0f;
    facet.normal = facet.flipped ? -normal : normal;
    facet.centre = Vec3f(0.0f);
    for (const Vec3f& corner : facet.outline()) facet.centre += corner / float(facet.count);
    for (const Vec3f& corner : facet.outline()) facet.radius = std::max(facet.radius, (corner - facet.centre).length());
}

void addFacets(const TriangleMesh& mesh, uint32_t shape, std::vector<Facet>& facets) {
    for (uint32_t face = 0; face < mesh.triangles.size(); ++face) {
        const Vec3d normal = mesh.scaledNormal(face);
        if (!(normal.dot(normal) > 0.0)) continue;
        Facet facet;
        for (const uint32_t v : mesh.triangles[face].v) facet.corners[size_t(facet.count++)] = mesh.positions[v];
        complete(facet, unitOrUp(normal));
        facet.at = {shape, face};
        facet.reach = Errors * roundingError(largestOf(facet.outline()), facet.normal);
        facets.push_back(facet);
    }
}

void addFacets(const Disk& disk, uint32_t shape, std::vector<Facet>& facets) {
    if (!(disk.radius > 0.0f)) return;
    Facet facet;
    const Vec3f s = disk.frame.s * disk.radius, t = disk.frame.t * disk.radius;
    facet.corners = {disk.centre - s - t, disk.centre + s - t, disk.centre + s + t, disk.centre - s + t};
    facet.count = 4;
    complete(facet, disk.frame.n);
    facet.at = {shape, 0};
    facet.reach = Errors * roundingError(largestOf(facet.outline()), disk.frame.n);
    facets.push_back(facet);
}

/// Whether the outlines, seen along `normal`, share more than an edge (separating axes).
bool overlap(const Facet& a, const Facet& b, const Vec3f& normal, float edge) {
    const auto separated = [&](const Facet& by) {
        for (int i = 0; i < by.count; ++i) {
            const Vec3f side = by.corners[size_t(i)] - by.corners[size_t((i + 1) % by.count)];
            const Vec3f axis = side.cross(normal).normalized();
            float low[2] = {Infinity, Infinity}, high[2] = {-Infinity, -Infinity};
            for (int k = 0; k < 2; ++k) {
                for (const Vec3f& corner : (k == 0 ? a : b).outline()) {
                    const float x = (corner - by.corners[size_t(i)]).dot(axis);
                    low[k] = std::min(low[k], x);
                    high[k] = std::max(high[k], x);
                }
            }
            if (std::min(high[0], high[1]) - std::max(low[0], low[1]) <= edge) return true;
        }
        return false;
    };
    return !separated(a) && !separated(b);
}

bool coincide(const Facet& a, const Facet& b) {
    if (a.at.shape == b.at.shape && a.flipped == b.flipped) return false; // one surface
    if (a.normal.cross(b.normal).length2() > CoincidentFaces::Parallel) return false;
    const Facet &large = a.radius > b.radius ? a : b, &small = a.radius > b.radius ? b : a;
    const float reach = std::max(a.reach, b.reach);
    for (const Vec3f& corner : small.outline())
        if (std::abs((corner - large.centre).dot(large.normal)) > reach) return false;
    return overlap(a, b, large.normal, std::min(a.reach, b.reach));
}

/// Facets in the order of a number that is the same for two in one plane, which it is to `tolerance`.
struct ByPlane {
    std::vector<uint32_t> facet;
    std::vector<float> plane, tolerance, x, y, z, radius;

    explicit ByPlane(const std::vector<Facet>& facets) {
        Imath::Box3f box;
        for (const Facet& f : facets) box.extendBy(f.centre);
        const float size = box.size().length();
        const Vec3f generic = Vec3f(0.36f, 0.48f, 0.80f) * size;
        std::vector<float> planes;
        for (const Facet& f : facets) planes.push_back(f.normal.dot(f.centre - box.center() + generic));
        facet.resize(facets.size());
        std::iota(facet.begin(), facet.end(), 0u);
        std::sort(facet.begin(), facet.end(), [&](uint32_t a, uint32_t b) { return planes[a] < planes[b]; });
        for (const uint32_t i : facet) {
            const Facet& f = facets[i];
            // The normal of a small face is known the worse, until faces no longer count as parallel.
            const float tilt = std::min(f.reach / std::max(f.radius, 1e-30f), 1.5e-3f);
            plane.push_back(planes[i]);
            tolerance.push_back(f.reach + 2.0f * tilt * size);
            x.push_back(f.centre.x);
            y.push_back(f.centre.y);
            z.push_back(f.centre.z);
            radius.push_back(f.radius);
        }
    }

    /// Whether any of [first, last) is near enough to the k-th to touch it.
    [[nodiscard]] bool anyNear(size_t k, size_t first, size_t last) const {
        const float *xs = x.data(), *ys = y.data(), *zs = z.data(), *rs = radius.data();
        const float cx = xs[k], cy = ys[k], cz = zs[k], reach = rs[k];
        int near = 0; // not bool: so that registers hold eight facets
        for (size_t j = first; j < last; ++j) {
            const float dx = xs[j] - cx, dy = ys[j] - cy, dz = zs[j] - cz, r = rs[j] + reach;
            near |= int(dx * dx + dy * dy + dz * dz <= r * r);
        }
        return near != 0;
    }
};

/// Calls `meet` for pairs that may coincide until it has looked at `most`; returns the first facet, by plane, that it
/// did not come to.
size_t eachPair(const ByPlane& sorted, double most, const LoadWatch& watch, const auto& meet) {
    constexpr size_t Block = 64;
    double looked = 0.0;
    for (size_t k = 0; k < sorted.facet.size(); ++k) {
        if (k % 4096 == 0) watch.poll();
        // From the one that is known worse: twice its tolerance is that of the pair.
        const float low = sorted.plane[k] - 2.0f * sorted.tolerance[k],
                    high = sorted.plane[k] + 2.0f * sorted.tolerance[k];
        const auto begin = std::lower_bound(sorted.plane.begin(), sorted.plane.end(), low) - sorted.plane.begin();
        const auto end = std::upper_bound(sorted.plane.begin(), sorted.plane.end(), high) - sorted.plane.begin();
        looked += double(end - begin);
        if (looked > most) return k;
        for (size_t first = size_t(begin); first < size_t(end); first += Block) {
            const size_t last = std::min(first + Block, size_t(end));
            if (!sorted.anyNear(k, first, last)) continue;
            for (size_t j = first; j < last; ++j)
                if (j != k && sorted.anyNear(k, j, j + 1)) meet(sorted.facet[k], sorted.facet[j]);
        }
    }
    return sorted.facet.size();
}

/// Whether two spheres are one, to rounding. A disk or a triangle lies on none.
bool coincide(const Sphere& a, const Sphere& b, float reach) {
    return (a.centre - b.centre).length() + std::abs(a.radius - b.radius) <= reach;
}

float reachOf(const Sphere& sphere) {
    const Vec3f c = sphere.centre;
    return Errors *
           roundingError(Vec3f(std::abs(c.x), std::abs(c.y), std::abs(c.z)) + Vec3f(sphere.radius), Vec3f(1.0f));
}

} // namespace

CoincidentFaces::CoincidentFaces(const std::vector<const Shape*>& shapes, const std::vector<bool>& opaque,
                                 const LoadWatch& watch)
    : reaches_(shapes.size()) {
    std::vector<Facet> facets;
    std::vector<std::pair<uint32_t, const Sphere*>> spheres;
    for (uint32_t i = 0; i < shapes.size(); ++i) {
        faces_.push_back(std::visit([](const auto& m) { return m.faceCount(); }, *shapes[i]));
        std::visit(Overloaded{[&](const Sphere& sphere) { spheres.emplace_back(i, &sphere); },
                              [&](const auto& flat) { addFacets(flat, i, facets); }},
                   *shapes[i]);
    }
    const auto meet = [&](uint32_t i, uint32_t j) {
        const Facet &a = facets[i], &b = facets[j];
        const bool hidden = !opaque.empty() && opaque[a.at.shape] && opaque[b.at.shape] && a.flipped != b.flipped;
        if (hidden || !coincide(a, b)) return;
        mark(a.at, std::max(a.reach, b.reach));
        mark(b.at, std::max(a.reach, b.reach));
    };
    // Where that is long, those left over are taken for coincident: slower to render, and right.
    constexpr double MostPairs = 5e8;
    const ByPlane sorted(facets);
    for (size_t k = eachPair(sorted, MostPairs, watch, meet); k < facets.size(); ++k)
        mark(facets[sorted.facet[k]].at, facets[sorted.facet[k]].reach);
    for (size_t i = 0; i < spheres.size(); ++i) {
        for (size_t j = i + 1; j < spheres.size(); ++j) {
            const float reach = std::max(reachOf(*spheres[i].second), reachOf(*spheres[j].second));
            if (!coincide(*spheres[i].second, *spheres[j].second, reach)) continue;
            mark({spheres[i].first, 0}, reach);
            mark({spheres[j].first, 0}, reach);
        }
    }
    if (any_) rankShapes(shapes);
}

void CoincidentFaces::mark(const FaceIndex& at, float reach) {
    any_ = true;
    std::vector<float>& reaches = reaches_[at.shape];
    if (reaches.empty()) reaches.resize(faces_[at.shape], 0.0f);
    reaches[at.face] = std::max(reaches[at.face], reach);
}

void CoincidentFaces::rankShapes(const std::vector<const Shape*>& shapes) {
    std::vector<uint32_t> bySize(shapes.size());
    std::vector<float> sizes;
    for (const Shape* shape : shapes) sizes.push_back(boundsOf(*shape).size().length());
    std::iota(bySize.begin(), bySize.end(), 0u);
    std::stable_sort(bySize.begin(), bySize.end(), [&](uint32_t a, uint32_t b) { return sizes[a] < sizes[b]; });
    ranks_.resize(shapes.size());
    for (size_t i = 0; i < bySize.size(); ++i)
        ranks_[bySize[i]] = {int64_t(i) + 1, std::visit([](const auto& m) { return m.isSheet(); }, *shapes[bySize[i]])};
}

int64_t CoincidentFaces::order(uint32_t shape, bool along) const {
    // Symmetric about 0: a ray the other way sees the same values with the other sign. From outside in: bodies left,
    // sheets with their backs to the ray's origin... each by size.
    const Rank& rank = ranks_[shape];
    const auto count = int64_t(ranks_.size());
    const int64_t value = rank.sheet ? count + 1 - rank.size : rank.size - 2 * count - 1;
    return along ? value : -value;
}

} // namespace tungsten
