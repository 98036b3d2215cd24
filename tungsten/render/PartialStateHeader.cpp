#include "tungsten/render/PartialStateHeader.h"

#include <cmath>
#include <cstring>

namespace tungsten {

PartialStateHeader PartialStateHeader::of(const PartialIdentity& identity, uint32_t firstPass) {
    const Scene& scene = *identity.scene;
    const TransportSettings& transport = scene.transport;
    PartialStateHeader header{};
    std::memcpy(header.magic, Magic, sizeof Magic);
    header.content = identity.content;
    header.seed = identity.seed;
    header.sppStep = identity.sppStep;
    header.width = scene.camera.resolution.x;
    header.height = scene.camera.resolution.y;
    header.frames = transport.gate.frames;
    header.firstPass = firstPass;
    header.gateStart = transport.gate.start;
    header.frameWidth = transport.gate.frameWidth;
    header.lengthUnit = scene.lengthUnit;
    header.vacuumSpeed = transport.vacuumSpeed;
    header.cameraSpeed = scene.cameraRegion.speed;
    header.steadyState = transport.gate.steadyState;
    header.delta = transport.gate.delta;
    header.hasResponse = !transport.response.empty();
    header.cameraUnwarped = transport.cameraUnwarped;
    header.integrate = transport.integrateOverGate;
    header.toneMap = uint8_t(scene.toneMap);
    header.filmChannels = uint8_t(scene.film.channels);
    header.filmMoments = scene.film.moments;
    header.filmBatches = scene.film.batches;
    header.filmBatchBlock = scene.film.batchBlock;
    header.exposureGiven = identity.exposure.has_value();
    header.exposureAutomatic = identity.exposure && identity.exposure->automatic;
    header.exposureStops = identity.exposure ? identity.exposure->stops : 0.0;
    return header;
}

bool PartialStateHeader::plausible() const {
    const bool sizes = width > 0 && height > 0 && frames > 0;
    const bool contents = filmChannels == 1 || filmChannels == 3;
    const bool numbers = std::isfinite(gateStart) && frameWidth >= 0.0 && lengthUnit >= 0.0;
    const bool batches = filmBatches >= 0 && filmBatches <= 256 && filmBatchBlock > 0;
    return sizes && contents && numbers && batches && sppStep > 0 && toneMap <= uint8_t(ToneMap::Pbrt);
}

std::shared_ptr<Scene> PartialStateHeader::scene() const {
    auto made = std::make_shared<Scene>();
    made->camera.resolution = Vec2i(width, height);
    TransportSettings& transport = made->transport;
    transport.gate = {steadyState != 0, delta != 0, gateStart, frameWidth, frames};
    transport.vacuumSpeed = vacuumSpeed;
    transport.cameraUnwarped = cameraUnwarped != 0;
    transport.integrateOverGate = integrate != 0;
    if (hasResponse) transport.response = {{gateStart, transport.gate.end()}, {1.0, 1.0}};
    made->lengthUnit = lengthUnit;
    made->cameraRegion.speed = cameraSpeed;
    made->toneMap = ToneMap(toneMap);
    made->film = {filmChannels, filmMoments != 0, filmBatches, filmBatchBlock};
    return made;
}

} // namespace tungsten
