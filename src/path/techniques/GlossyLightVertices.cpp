#include "path/techniques/GlossyLightVertices.h"

#include "path/GuidedPath.h"
#include "path/Tuning.h"
#include "path/techniques/LightCaches.h"
#include "path/techniques/LightVertices.h"

#include "transport/Balance.h"

namespace tungsten::path {

namespace {

constexpr uint32_t PilotPass = std::numeric_limits<uint32_t>::max();

/// Adds up to two ends of one light path: where it meets the next surface, and a point before.
void traceReflection(const Scene& scene, const Emitter& emitter, const EmitterChoice& choice, const Flights& flights,
                     Sampler sampler, std::vector<GlossyLightVertex>& vertices) {
    const auto glossy = traceLightVertex(scene, emitter, choice, sampler);
    if (!glossy || !reflectsSharply(glossy->vertex.lobes())) return;
    const SurfaceInteraction& from = *glossy->vertex.surface();
    const Vec2f uDirection = sampler.next2D();
    const auto sample = from.bsdf->sample(from.query(TransportMode::Photons), from.wi, {uDirection, sampler.next1D()});
    if (!sample || (sample->lobe & lobe::Smooth) == 0) return;
    const Vec3f direction = from.frame.toWorld(sample->wo).normalized();
    const float pdf = glossy->vertex.pdf(direction);
    const Rgb reflected = glossy->weighedIntensity(direction);
    if (!(pdf > 0.0f) || isBlack(reflected)) return;
    const auto end = [&](float flight, float density) {
        return GlossyLightVertex{*glossy,
                                 {direction, flight},
                                 std::nullopt,
                                 reflected / pdf,
                                 glossy->areaPdf * pdf * density / sqr(flight),
                                 glossy->vertex.areaDensity(1.0f, direction, flight)};
    };
    const Ray onward = glossy->vertex.spawnRay(direction);
    const auto hit = scene.geometry->intersect(onward);
    const float flight = flights.sample(sampler.next1D()), density = flights.pdf(flight);
    if (flight > onward.tMin && density > 0.0f && (!hit || flight < hit->t)) {
        vertices.push_back(end(flight, density));
        vertices.back().power = reflected / (pdf * density);
    }
    if (!hit || !endsGlossySubpath(scene.bsdfOf(*hit).lobes())) return;
    const float incidence = std::abs(direction.dot(hit->ng));
    if (!(incidence > 0.0f)) return;
    vertices.push_back(end(hit->t, incidence));
    vertices.back().surface.emplace(scene, makeInteraction(scene, *hit, direction), direction, TransportMode::Photons,
                                    glossy->vertex.region());
    vertices.back().incidence = incidence;
}

} // namespace

bool reflectsSharply(LobeMask lobes) {
    return (lobes & lobe::GlossyReflection) != 0 && (lobes & lobe::AnyTransmission) == 0;
}

void GlossyVertexCache::prepare(const Scene& scene, const Emitter& emitter, const Flights& flights,
                                const ProgressToken& watch) {
    trace(scene, emitter, {}, tuning::MostPaths, PassInfo{.index = PilotPass, .watch = watch}, flights);
    candidates_ =
        vertices().empty() ? 0.0f : float(tuning::Candidates) * float(tuning::MostPaths) / float(vertices().size());
}

void GlossyVertexCache::trace(const Scene& scene, const Emitter& emitter, const EmitterChoice& choice, size_t paths,
                              const PassInfo& pass, const Flights& flights) {
    const auto stream = uint64_t(&emitter - scene.emitters.data()) << 32;
    window_.fill(paths, "glossy light vertices", pass.watch, [&](size_t i, std::vector<GlossyLightVertex>& vertices) {
        const Sampler sampler(pass.seed, RandomStream::ReflectedLight, pass.index, stream | i);
        traceReflection(scene, emitter, choice, flights, sampler, vertices);
    });
}

auto GlossyVertexCache::choose(const Vec3f& position, float low, float high, const Vec2f& u) const -> CandidateSample {
    // Rough contributions, beside walks with even directions.
    const auto importance = [this](const GlossyLightVertex& vertex, const Vec3f& direction, float distance) {
        const float even = 0.25f * InvPi;
        const float walkPdf =
            vertex.surface ? vertex.surface->areaDensity(even, direction, distance) : even / sqr(distance);
        const float found = walkPdf * (even * vertex.perAreaAtGlossy + candidateDensity(vertex.glossy.areaPdf));
        const float candidates = candidates_ * vertex.density;
        return maxComponent(vertex.power) / vertex.incidence * walkPdf * candidates / (candidates + found);
    };
    return window_.choose(position, low, high, u, importance);
}

// ---- Connections

namespace {

/// A walk would go on like this: to the end and, reflected there, to the glossy surface.
bool walkGoesOn(const GuidedPath& path, const transport::Vertex& end, const Vec3f& direction) {
    return !end.surface() || (end.reflects(-direction) && path.guideFor(end, -direction));
}

/// From the end, which is seen along `direction`, to the light.
Rgb transmittanceOf(const GuidedPath& path, const GlossyLightVertex& light, const transport::Vertex& end,
                    const Vec3f& direction) {
    const Scene& scene = path.scene();
    const Region between = end.regionTowards(-direction, path.state.region);
    const Region beyond = light.glossy.vertex.regionTowards(light.flight.direction, between);
    Rgb transmittance(1.0f);
    if (const Medium* medium = scene.medium(between)) transmittance = medium->transmittance(light.flight.distance);
    if (const Medium* medium = scene.medium(beyond))
        transmittance = transmittance * medium->transmittance(light.glossy.distance);
    return transmittance;
}

} // namespace

void GlossyVertexConnections::connect(const GuidedPath& path, const transport::Vertex& here,
                                      const GlossyVertexCache& cache) {
    PathState& state = path.state;
    const auto [low, high] = path.lengthsInGate();
    state.random.at(state.interactions, Draw::ReflectedLight);
    const GlossyVertexCache::CandidateSample choice = cache.choose(here.position(), low, high, state.random.next2D());
    if (!choice.vertex) return;
    const GlossyLightVertex& light = *choice.vertex;
    const bool inMedium = !light.surface;
    if (!path.counts(2, inMedium ? 1 : 0)) return;
    const transport::SubpathEnd target = light.endIn(path.scene(), state.region);
    const transport::Vertex& end = target.vertex;
    const auto way = transport::connectionSegment(here.position(), end.position());
    if (!way || !walkGoesOn(path, end, way->direction)) return;
    ++path.counters.reflectedLight;
    const auto connection = path.connectInRegion(here, transport::connectionEndpoint(*way, target));
    if (!connection) return;
    // Of the walk and of light vertices one vertex on, together.
    const float arrives = end.areaDensity(here.pdf(way->direction), way->direction, way->distance) *
                          (inMedium ? path.context.lightCaches.flights().pdf(way->distance) : 1.0f);
    const float goesOn = end.pdfReverse(-way->direction) * light.perAreaAtGlossy;
    const float connects = LightVertexConnections::density(light.glossy.areaPdf),
                found = cache.candidates() * light.density;
    const float share = transport::balance(found, arrives * (goesOn + connects));
    const float flies = inMedium ? pdfFlight(*path.scene().medium(state.region), way->distance, state.channels)
                                 : path.plainlyPasses(state.region, way->distance);
    const float plain = end.areaDensity(here.pdf(way->direction), way->direction, way->distance) * flies * goesOn *
                        path.plainlyPasses(end.regionTowards(-way->direction, state.region), light.flight.distance);
    // As the walk has it at the glossy surface, two vertices on: GuidedPath::logRatioByLightCaches.
    const float ofWalk = transport::balance(arrives * goesOn, arrives * connects, found);
    const float there = path.behind.ratios.there;
    const LogRatio logRatio{there - std::log(std::max(ofWalk, 1e-30f)),
                            there + std::log(light.density / (plain * choice.weight * share))};
    Rgb transmittance = transmittanceOf(path, light, end, way->direction);
    if (inMedium) transmittance = transmittance * path.scene().medium(state.region)->sigmaS();
    const double time = connection->time + double(light.length()) / double(state.region.speed);
    path.sink.add(connection->throughput * transmittance * (choice.weight * share),
                  state.time + time + path.target().start, *path.target().emitter, logRatio);
}

float GlossyVertexConnections::density(const GuidedPath& path, float pdf, const transport::Segment& way,
                                       float areaPdf) {
    const bool inMedium = isBlack(path.behind.approach->normal);
    const float cosine = way.direction.dot(path.behind.approach->normal);
    if (!inMedium && !(cosine > 0.0f)) return 0.0f;
    const LightCaches& lightCaches = path.context.lightCaches;
    const float end = inMedium ? lightCaches.flights().pdf(way.distance) : cosine;
    return lightCaches.reflected(path.target().index)->candidates() * areaPdf * pdf * end / sqr(way.distance) /
           path.behind.approach->pdf;
}

} // namespace tungsten::path
