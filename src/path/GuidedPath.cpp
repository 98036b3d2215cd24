#include "path/GuidedPath.h"

namespace tungsten::path {

bool endsReflectedLight(LobeMask lobes) {
    return (lobes & lobe::Smooth) != 0 && (lobes & (lobe::Specular | lobe::Through)) == 0;
}

std::optional<transport::Connection> GuidedPath::connectInRegion(const transport::Vertex& here,
                                                                 const transport::ConnectionEnd& end) {
    if (!(here.margin().beyond(end.direction) < end.margin.before(end.direction, end.distance))) return std::nullopt;
    return transport::Connector(scene(), false).connect(here, state.throughput, end, state.counters.shadowRays);
}

LengthsInGate GuidedPath::lengthsInGate() const {
    const TimeGate& gate = context.sensor.arrivals;
    const double speed = double(state.region.speed), elapsed = state.time + target->start;
    return {float(speed * (gate.start - elapsed)), float(speed * (gate.end() - elapsed))};
}

const darts::Guide* GuidedPath::guideFor(const transport::Vertex& vertex, const Vec3f& back) const {
    if (!endsReflectedLight(vertex.lobes())) return nullptr;
    const Region region = vertex.regionTowards(back, state.region);
    const Medium* medium = scene().medium(region);
    if (!medium || !medium->scatters()) return nullptr;
    const bool diffuse = (vertex.lobes() & lobe::DiffuseReflection) != 0;
    const auto& guides = diffuse ? context.guides.surfaces : context.guides.glossy;
    const darts::Guide& guide = guides[size_t(region.medium)];
    return guide.settings().direction == darts::Direction::Phase ? nullptr : &guide;
}

darts::ConnectionSample GuidedPath::drawConnection(const darts::Guide& guide, const darts::Residual& residual) {
    return guide.sampleConnection(
        residual, next(), {context.sensor.response.get(), state.time + target->start, double(state.region.speed)});
}

} // namespace tungsten::path
