#pragma once
// The fixed part at the start of a partial state: what passes of one render agree in, and what images need of the
// scene.

#include "tungsten/render/PartialState.h"

namespace tungsten {

/// As it lies in the file; texts, detectors, passes, an end and the checksum follow.
struct PartialStateHeader {
    /// The last two characters are the version.
    static constexpr char Magic[8] = {'T', 'P', 'A', 'R', 'T', 'S', '0', '3'};
    static constexpr size_t VersionAt = 6;

    char magic[8];
    uint64_t content, seed;
    int64_t sppStep;
    int32_t width, height, frames;
    uint32_t firstPass;
    int32_t filmBatches, filmBatchBlock;
    double gateStart, frameWidth, lengthUnit, exposureStops;
    float vacuumSpeed, cameraSpeed;
    uint8_t steadyState, delta, hasResponse, cameraUnwarped, integrate, toneMap, filmChannels, filmMoments;
    uint8_t exposureGiven, exposureAutomatic, unused[6];

    static PartialStateHeader of(const PartialIdentity& identity, uint32_t firstPass);
    /// Whether there can be such a render: a checksum says that a file is as it was written, not who wrote it.
    [[nodiscard]] bool plausible() const;
    /// A scene of what images need.
    [[nodiscard]] std::shared_ptr<Scene> scene() const;
};

} // namespace tungsten
