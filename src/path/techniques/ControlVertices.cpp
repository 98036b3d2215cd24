#include "path/techniques/ControlVertices.h"

#include "path/techniques/EmitterConnections.h"
#include "path/techniques/ShellChord.h"

namespace tungsten::path {

namespace {

/// The last vertex before the target, in the medium of the present flight; `arrival` is the total time of flight.
void add(const GuidedPath& path, const Medium& medium, const darts::ControlVertex& vertex, double arrival) {
    PathState& state = path.state;
    if (!path.context.forwardBoundaries && !path.counts(1, 1)) return;
    const Vec3f position = state.ray.at(vertex.distance);
    const auto way = transport::connectionSegment(position, path.target().vertex.position());
    if (!(vertex.toTarget > 0.0f) || !way) return;
    ++path.counters.controlVertices;
    const Rgb light = path.target().intensity(-way->direction);
    if (isBlack(light)) return;
    const float phase = medium.phase.eval(state.ray.direction, way->direction);
    const float traced = path.steps.shadowRayProbability(vertex, way->direction);
    state.random.at(state.interactions + 1, Draw::ControlVertex);
    if (traced < 1.0f && !(path.next() < traced)) return;
    const float clear = path.target().vertex.margin().before(way->direction, way->distance);
    const Visibility visibility = path.connector().visibility({position, way->direction, 0.0f, clear}, way->distance,
                                                              state.region, path.counters.shadowRays);
    if (isBlack(visibility.transmittance) || !visibility.oneSpeed || !path.counts(1 + visibility.crossings, 1)) return;
    const auto ending = ControlVertices::endingAt(path, medium, vertex, traced);
    const auto share = ConnectionsFromMedia::share(path, position, phase, ending);
    const float weight =
        phase / sqr(vertex.toTarget) * vertex.inversePdf * ending.shareOfControl() / traced * share.beside;
    const Rgb radiance = state.throughput * medium.sigmaS() * medium.transmittance(vertex.distance) * light *
                         visibility.transmittance * weight;
    // A delta gate is one of time, the connection's weight dt/dS one of length.
    path.sink.addInside(path.context.sensor.gate.delta ? radiance * state.region.speed : radiance, arrival,
                        *path.target().emitter, LogRatio(ending.logRatio).with(share));
}

} // namespace

void ControlVertices::sample(const GuidedPath& path, const transport::Ahead& ahead) {
    if (!path.steps.drawsControlVertices()) return;
    const darts::Guide& guide = path.steps.guideOf(path.state.region);
    const float h = path.steps.heading().h;
    const auto draw = [&](const darts::TimeBudget& budget) {
        path.state.random.at(path.state.interactions + 1, Draw::FlightConnection);
        return path.steps.drawConnection(path.state, guide, budget, &h);
    };
    const auto met =
        path.steps.meetControlVertex({guide, h, path.state.time, path.steps.sharesConnections()}, ahead.reach(), draw);
    if (!met) return;
    const double arrival = met->departure + met->length / double(path.state.region.speed) + path.target().start;
    add(path, *ahead.medium, met->vertex, arrival);
}

void ControlVertices::sampleUntimed(const GuidedPath& path, const transport::Ahead& ahead) {
    const PathState& state = path.state;
    if (!path.steps.drawsControlVertices()) return;
    const PathTarget& target = path.target();
    const double speed = double(state.region.speed), low = speed * (path.steps.window().begin - target.start);
    const ShellChord chord = path.steps.controlChord(state.ray, state.region, ahead.reach());
    const auto addAt = [&](double t, double inversePdf) {
        const double toTarget = double((target.vertex.position() - state.ray.at(float(t))).length());
        add(path, *ahead.medium, {float(t), float(toTarget), float(inversePdf)}, toTarget / speed + target.start);
    };
    if (path.context.sensor.gate.delta) {
        std::array<double, 2> t{}, perRadius{};
        const int count = chord.intersect(low, t, perRadius);
        for (size_t i = 0; i < size_t(count); ++i) addAt(t[i], perRadius[i]);
    } else if (!chord.empty()) {
        path.state.random.at(path.state.interactions + 1, Draw::Untimed);
        const double t = chord.sample(path.state.random.nextDouble()), pdf = chord.pdf(t);
        if (pdf > 0.0) addAt(t, 1.0 / pdf);
    }
}

StepsToEmitter::InMedium ControlVertices::ending(const GuidedPath& path, const Medium& medium, float distance) {
    if (path.steps.hasDensities()) return path.steps.inMedium(distance);
    if (!path.steps.drawsControlVertices()) return {1.0f, 0.0f};
    const auto control = path.steps.controlVertexPdf(distance);
    return control ? StepsToEmitter::InMedium{ConnectionsFromMedia::density(medium, distance), *control}
                   : StepsToEmitter::InMedium{0.0f, 1.0f};
}

StepsToEmitter::InMedium ControlVertices::endingAt(const GuidedPath& path, const Medium& medium,
                                                   const darts::ControlVertex& vertex, float shadowRayProbability) {
    // A delta gate leaves no density per length.
    if (!path.steps.hasDensities() || path.context.sensor.gate.delta) return ending(path, medium, vertex.distance);
    return path.steps.inMedium(vertex.distance, shadowRayProbability / vertex.inversePdf);
}

} // namespace tungsten::path
