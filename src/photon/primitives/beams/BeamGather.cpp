#include "photon/primitives/beams/BeamGather.h"

#include "photon/Tuning.h"
#include "photon/primitives/CameraSegment.h"
#include "transport/BounceLimits.h"

namespace tungsten::photon {

namespace {

/// What gatherBeam() sees (queryAbout).
struct BeamQuery {
    embree::Context context;
    const Scene* scene;
    const transport::TimeSensor* sensor;
    const PhotonBeam* beams;
    const BeamGather::Piece* pieces;
    const CameraSegment* segment;
    FrameSums* sums;
    const Radii* radii;
    bool timed; ///< arrivals count, with the camera's time
    uint64_t gathered;
};

/// Whether light may leave the beam before `end`, its distance from the base, and arrive inside the gate: no more than
/// by the triangle inequality, but most beams near a segment behind refraction are of another time.
bool mayArrive(const TimeGate& gate, const CameraSegment& segment, const PhotonBeam& beam, float end) {
    const float toBase = (beam.base - segment.origin).length(), rounding = 1e-5f * (toBase + end);
    const double start = beam.time + segment.time;
    return start + double(toBase - rounding) * segment.inverseSpeed < gate.end() &&
           start + double(toBase + 2.0f * end + rounding) * segment.inverseSpeed >= gate.start;
}

void gatherBeam(BeamQuery& query, uint32_t index) {
    const BeamGather::Piece& piece = query.pieces[index];
    const PhotonBeam& beam = query.beams[piece.beam];
    const CameraSegment& segment = *query.segment;
    if (beam.medium != segment.medium) return;
    if (query.timed && !mayArrive(query.sensor->gate, segment, beam, piece.end)) return;
    const float radius = (*query.radii)[piece.beam];
    const auto approach = closestApproach(beam.base, beam.direction, segment.origin, segment.direction);
    if (!approach || !(approach->distance() < radius)) return;
    const float s = approach->alongBeam, t = approach->alongCamera;
    // Only the piece that holds the closest point counts, so that a beam counts once.
    if (!(s >= piece.start) || s >= piece.end || !(t > 0.0f) || t > segment.length) return;
    RibbonRange ribbon{-radius, radius};
    if (!query.radii->edges().empty()) {
        const Vec3f across = beam.direction.cross(segment.direction) / approach->sine;
        ribbon = RibbonRange::of(query.radii->edges(piece.beam), s, beam.direction, across, radius);
        if (!ribbon.holds(approach->offset)) return;
    }
    const TransportSettings& settings = query.scene->transport;
    const int interactions = segment.interactions + beam.bounce + 1;
    if (!transport::BounceLimits(settings).renders(interactions)) return;
    int frame = 0;
    float weight = 1.0f;
    if (!query.sensor->gate.steadyState) {
        // Through the beam's point, as for photon points: then ArrivalCulling's parts of beams are exact.
        const float toCamera = settings.cameraUnwarped ? 0.0f : std::sqrt(sqr(t) + sqr(approach->distance()));
        const double cameraTime = settings.cameraUnwarped ? 0.0 : segment.time;
        const double arrival = beam.time + cameraTime + (double(s) + double(toCamera)) * segment.inverseSpeed;
        frame = query.sensor->gate.frameOf(arrival);
        if (frame < 0) return;
        weight = query.sensor->weight(arrival);
    }
    const Medium& medium = query.scene->media[size_t(segment.medium)];
    weight *= medium.phase.eval(beam.direction, -segment.direction) / (ribbon.width() * approach->sine);
    const Rgb value = beam.power * medium.sigmaS() * medium.transmittance(s + t) * weight;
    (*query.sums)[size_t(frame)] += Vec3d(value);
    ++query.gathered;
}

} // namespace

BeamGather::BeamGather(const Scene& scene, const transport::TimeSensor& sensor, const std::vector<PhotonBeam>& beams,
                       const Radii& radius, bool fewRays)
    : scene_(scene), sensor_(sensor), beams_(beams), radii_(radius) {
    cut(fewRays ? 1.0f : tuning::MostPieces);
    if (pieces_.empty()) return;
    ribbons_.emplace(RTC_GEOMETRY_TYPE_FLAT_LINEAR_CURVE, embree::QueryFilterFlag, [&](RTCGeometry geometry) {
        auto* vertices = EmbreeScene::newBuffer<PointWithRadius>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4,
                                                                 2 * pieces_.size());
        auto* first =
            EmbreeScene::newBuffer<uint32_t>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, pieces_.size());
        for (size_t i = 0; i < pieces_.size(); ++i) {
            const Piece& piece = pieces_[i];
            const PhotonBeam& beam = beams_[piece.beam];
            vertices[2 * i] = {beam.base + beam.direction * piece.start, radii_[piece.beam]};
            vertices[2 * i + 1] = {beam.base + beam.direction * piece.end, radii_[piece.beam]};
            first[i] = uint32_t(2 * i);
        }
    });
}

void BeamGather::cut(float mostPieces) {
    pieces_.reserve(beams_.size());
    for (uint32_t i = 0; i < beams_.size(); ++i) {
        const PhotonBeam& beam = beams_[i];
        const float length = beam.tEnd - beam.tStart, radius = radii_[i];
        largestRadius_ = std::max(largestRadius_, radius);
        const float count = std::clamp(std::ceil(length / (tuning::PieceInRadii * radius)), 1.0f, mostPieces);
        float start = beam.tStart;
        for (float k = 1.0f; k <= count; ++k) {
            const float end = k == count ? beam.tEnd : beam.tStart + length * (k / count);
            pieces_.push_back({i, start, end});
            start = end;
        }
    }
}

uint64_t BeamGather::gather(const CameraSegment& segment, FrameSums& sums) const {
    if (!ribbons_) return 0;
    const bool timed = !sensor_.gate.steadyState && !scene_.transport.cameraUnwarped;
    BeamQuery query{{}, &scene_, &sensor_, beams_.data(), pieces_.data(), &segment, &sums, &radii_, timed, 0};
    queryAbout<gatherBeam>(ribbons_->get(), segment, largestRadius_, query);
    return query.gathered;
}

} // namespace tungsten::photon
