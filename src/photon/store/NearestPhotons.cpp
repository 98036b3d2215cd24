#include "photon/store/NearestPhotons.h"

namespace tungsten::photon {

namespace {

struct Query {
    const std::vector<Photon>& photons;
    Vec3f position;
    float squaredRadius;
    uint32_t count;
    std::vector<NearestPhotons::Neighbour>& found; ///< a max-heap once full
};

bool visit(RTCPointQueryFunctionArguments* arguments) {
    auto& query = *static_cast<Query*>(arguments->userPtr);
    const float squared = (query.photons[arguments->primID].position - query.position).length2();
    if (squared > query.squaredRadius) return false;
    const NearestPhotons::Neighbour neighbour{squared, arguments->primID};
    if (query.found.size() < query.count) {
        query.found.push_back(neighbour);
        if (query.found.size() == query.count) std::make_heap(query.found.begin(), query.found.end());
    } else if (neighbour < query.found.front()) {
        std::pop_heap(query.found.begin(), query.found.end());
        query.found.back() = neighbour;
        std::push_heap(query.found.begin(), query.found.end());
    }
    if (query.found.size() < query.count) return false;
    query.squaredRadius = query.found.front().squaredDistance;
    // A little more than the bound, so that ties at the bound are still seen.
    const float radius = std::sqrt(query.squaredRadius) * 1.00001f;
    if (radius >= arguments->query->radius) return false;
    arguments->query->radius = radius;
    return true;
}

void photonBounds(const RTCBoundsFunctionArguments* arguments) {
    const Vec3f& position = static_cast<const Photon*>(arguments->geometryUserPtr)[arguments->primID].position;
    RTCBounds& bounds = *arguments->bounds_o;
    bounds.lower_x = bounds.upper_x = position.x;
    bounds.lower_y = bounds.upper_y = position.y;
    bounds.lower_z = bounds.upper_z = position.z;
}

} // namespace

/// Embree answers point queries for user geometry, but not for discs.
NearestPhotons::NearestPhotons(const std::vector<Photon>& photons) : photons_(photons) {
    if (photons.empty()) return;
    points_.emplace(RTC_GEOMETRY_TYPE_USER, RTC_SCENE_FLAG_COMPACT, [&](RTCGeometry geometry) {
        rtcSetGeometryUserPrimitiveCount(geometry, unsigned(photons.size()));
        rtcSetGeometryUserData(geometry, const_cast<Photon*>(photons.data()));
        rtcSetGeometryBoundsFunction(geometry, photonBounds, nullptr);
    });
}

float NearestPhotons::find(const Vec3f& position, float radius, uint32_t count, std::vector<Neighbour>& found) const {
    found.clear();
    Query query{photons_, position, radius * radius, count, found};
    RTCPointQuery pointQuery{};
    pointQuery.x = position.x;
    pointQuery.y = position.y;
    pointQuery.z = position.z;
    pointQuery.radius = radius;
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    if (points_) rtcPointQuery(points_->get(), &pointQuery, &context, visit, &query);
    const bool all = found.size() == count;
    const float squared = all ? found.front().squaredDistance : radius * radius;
    std::sort(found.begin(), found.end(), [](const Neighbour& a, const Neighbour& b) { return a.index < b.index; });
    return squared;
}

} // namespace tungsten::photon
