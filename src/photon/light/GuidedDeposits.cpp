// What a guided light path leaves on a flight, at its end and at a light, for each kind of record.

#include "photon/Tuning.h"
#include "photon/light/GuidedPhotonWalk.h"

#include "transport/Balance.h"

namespace tungsten::photon {

namespace {

/// Density per length, for weights, of an ordinary photon at this distance along a flight.
float pdfPhoton(const Medium& medium, float distance) {
    return transport::pdfFreeFlight(meanComponent(medium.sigmaT()), distance);
}

/// The part of a record that is left to control vertices, by densities per length along the flight: the balance
/// heuristic, and all of it where hardly any ordinary photon would get.
float shareOfVertices(float pdfVertex, float pdfPhoton) {
    return pdfPhoton < tuning::LeastPhotons * pdfVertex ? 1.0f : transport::balance(pdfVertex, pdfPhoton);
}

} // namespace

// --- Points ---------------------------------------------------------------------------------------------------------

void GuidedPhotonWalk::leaveOn(const Flight& flight, DepositList<Photon>& points) {
    const auto& [medium, guide, h, surface] = flight;
    if (!guide.settings().elliptical || !path_.orderCounts(1)) return;
    const auto draw = [&](const darts::Residual& residual) {
        path_.sampler.at(path_.bounce + 1, Draw::FlightConnection);
        return drawConnection(flight.guide, residual);
    };
    const bool shares = guidance_.storesPhotons();
    const auto met = step_.meetControlVertex({guide, h, path_.time, shares}, surface, draw);
    if (!met) return;
    const darts::ControlVertex& vertex = met->vertex;
    ++path_.counters.controlVertices;
    Rgb power = path_.power * medium.sigmaS() * medium.transmittance(vertex.distance) * vertex.inversePdf;
    if (shares) power = power * shareOfVertices(1.0f / vertex.inversePdf, pdfPhoton(medium, vertex.distance));
    // In its frame but for rounding, which goes both ways: a test of the frame would only lose what it moves.
    store(points, path_.context.culling, path_.ray.at(vertex.distance), power);
}

void GuidedPhotonWalk::leaveAt(float distance, const Flight& flight, DepositList<Photon>& points) {
    const bool elliptical = flight.guide.settings().elliptical;
    if ((!guidance_.storesPhotons() && elliptical) || !path_.orderCounts(1)) return;
    float share = 0.0f;
    if (elliptical)
        share = shareOfVertices(step_.controlVertexPdf(distance).value_or(0.0f), pdfPhoton(flight.medium, distance));
    store(points, *path_.culling, path_.ray.at(distance), path_.power * (1.0f - share));
}

void GuidedPhotonWalk::store(DepositList<Photon>& points, const ArrivalCulling& culling, const Vec3f& position,
                             const Rgb& power) {
    const int bounce = path_.bounce + 1;
    if (!path_.bears(power) || bounce > MostPhotonBounces) return;
    if (guidance_.directView() && !guidance_.view().sees(position, path_.context.settings.volumeReach())) return;
    ++path_.counters.volumeDeposits;
    const double time = path_.timeAt(position);
    if (!culling.mayCount(position, time)) return;
    ++path_.counters.countingDeposits;
    points.records.push_back(
        {time, position, path_.ray.direction, power, uint16_t(bounce), int16_t(path_.region.medium)});
}

// --- Beams ----------------------------------------------------------------------------------------------------------

void GuidedPhotonWalk::leaveOn(const Flight& flight, DepositList<PhotonBeam>& beams) {
    const Medium& medium = flight.medium;
    if (!guidance_.directView()) return path_.depositBeam(beams, medium, flight.surface);
    if (!path_.bears(path_.power) || !path_.orderCounts(1)) return;
    const Ray& ray = path_.ray;
    const FlightPart seen = guidance_.view().seenPart(ray.origin, ray.direction, path_.context.settings.volumeReach());
    const float end = std::min(flight.surface, float(seen.end));
    if (!(float(seen.start) < end)) return;
    storeBeam(beams, *path_.culling, medium,
              {path_.time, ray.origin, ray.direction, path_.power, float(seen.start), end, uint16_t(path_.bounce),
               int16_t(path_.region.medium)});
}

void GuidedPhotonWalk::leaveAt(float, const Flight&, DepositList<PhotonBeam>&) {}

// --- Slices ---------------------------------------------------------------------------------------------------------

void GuidedPhotonWalk::leaveLight(DepositList<CollapsedFlights>& flights, const Emitter& emitter, float probability,
                                  const SurfaceSample& start) {
    Sampler own = path_.records(LightPath::RecordsOf::Light);
    chain_.leaveLight(path_.chainRules(), emitter, probability, start,
                      {start.position, Vec3f(0.0f), path_.power, path_.time, Infinity, path_.bounce},
                      path_.region.medium, own, flights);
}

void GuidedPhotonWalk::leaveOn(const Flight& flight, DepositList<CollapsedFlights>& flights) {
    const Ray& ray = path_.ray;
    Sampler own = path_.records(LightPath::RecordsOf::Flight);
    chain_.fly(path_.chainRules(), {ray.origin, ray.direction, path_.power, path_.time, flight.surface, path_.bounce},
               path_.region.medium, own, flights);
}

void GuidedPhotonWalk::leaveAt(float distance, const Flight&, DepositList<CollapsedFlights>& flights) {
    const Vec3f position = path_.ray.at(distance);
    const double time = path_.timeAt(position);
    Sampler own = path_.records(LightPath::RecordsOf::Vertex, 1);
    chain_.scatter(path_.chainRules(), {position, path_.ray.direction, path_.power, time, Infinity, path_.bounce + 1},
                   own, flights);
}

} // namespace tungsten::photon
