#include "photon/primitives/beams/EmbreeBeams.h"

#include "photon/Tuning.h"

#include <new>

namespace tungsten::photon {

namespace {

/// Position and radius, as Embree lays curve vertices out.
struct CurveVertex {
    Vec3f position;
    float radius;
};

template <typename Element>
Element* newBuffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, size_t count) {
    auto* buffer = static_cast<Element*>(rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Element), count));
    if (!buffer) throw std::bad_alloc();
    return buffer;
}

} // namespace

EmbreeBeams::EmbreeBeams(const std::vector<PhotonBeam>& beams, const Radii& radii, bool fewRays)
    : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    cut(beams, radii, fewRays ? 1.0f : tuning::MostPieces);
    if (pieces_.empty()) { // Embree has no buffers of nothing
        rtcCommitScene(scene_);
        return;
    }
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_FLAT_LINEAR_CURVE);
    auto* vertices = newBuffer<CurveVertex>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 2 * pieces_.size());
    auto* firstVertices = newBuffer<uint32_t>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, pieces_.size());
    for (size_t i = 0; i < pieces_.size(); ++i) {
        const Piece& piece = pieces_[i];
        const PhotonBeam& beam = beams[piece.beam];
        vertices[2 * i] = {beam.base + beam.direction * piece.start, radii[piece.beam]};
        vertices[2 * i + 1] = {beam.base + beam.direction * piece.end, radii[piece.beam]};
        firstVertices[i] = uint32_t(2 * i);
    }
    rtcSetSceneFlags(scene_, embree::QueryFilterFlag);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
}

void EmbreeBeams::cut(const std::vector<PhotonBeam>& beams, const Radii& radii, float mostPieces) {
    pieces_.reserve(beams.size());
    for (uint32_t i = 0; i < beams.size(); ++i) {
        const PhotonBeam& beam = beams[i];
        const float length = beam.tEnd - beam.tStart, radius = radii[i];
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

EmbreeBeams::~EmbreeBeams() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

} // namespace tungsten::photon
