#pragma once
// The scene: immutable while rendering, everything by index.

#include "tungsten/bsdf/Bsdf.h"
#include "tungsten/camera/Camera.h"
#include "tungsten/core/TimeProfile.h"
#include "tungsten/emitter/Emitter.h"
#include "tungsten/film/FilmContents.h"
#include "tungsten/geometry/SceneGeometry.h"
#include "tungsten/image/ToneMap.h"
#include "tungsten/medium/Medium.h"

#include <deque>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tungsten {

/// What a ray travels through: a medium (-1: vacuum) and the speed of light there.
struct Region {
    int medium = -1;
    float speed = 1.0f;
};

/// One surface of the scene.
struct Primitive {
    std::string name;
    Shape shape;
    std::vector<BsdfPtr> bsdfs; ///< by triangle material (clamped); at least one
    int emitter = -1;
    /// Whether crossing the surface changes the region; then `inside` holds behind the geometric normal, `outside`
    /// before it.
    bool boundsRegion = false;
    /// The surface names a medium on some side. If it names speeds only, a path inside a medium stays in it.
    bool boundsMedium = false;
    Region inside, outside;
    std::string path; ///< in the scene file, as problems have it
};

/// The time the sensor is open: one gate, a sequence of frames, a delta gate, or always (steady state).
struct TimeGate {
    bool steadyState = true;
    bool delta = false;      ///< Dirac gate at `start`
    double start = 0.0;      ///< of frame 0
    double frameWidth = 0.0; ///< time; 0 for delta gates
    int frames = 1;

    [[nodiscard]] double end() const { return start + frameWidth * frames; }
    [[nodiscard]] double frameStart(int frame) const { return start + frameWidth * frame; }
    /// Frame a time falls in, or -1. Frames are half open [start, end).
    [[nodiscard]] int frameOf(double time) const {
        if (!(time >= start)) return -1;
        const double position = (time - start) / frameWidth;
        return position < double(frames) ? int(position) : -1;
    }
    /// The frame a time falls in, or the nearest one.
    [[nodiscard]] int nearestFrame(double time) const {
        return int(std::clamp((time - start) / frameWidth, 0.0, double(frames) - 0.5));
    }
};

/// What an integrator's block means that gives no time gate.
enum class DefaultGate {
    None,  ///< steady state
    Gated, ///< a gate of width 0.1
    Never  ///< steady state, whatever it gives: the integrator knows no time
};

/// What every integrator's block has in common.
struct TransportSettings {
    int minBounces = 0; ///< rendered iff minBounces <= interactions < maxBounces
    int maxBounces = 64;
    bool twoSidedShading = true;
    bool consistencyChecks = false;
    TimeGate gate;                  ///< the response's support where there is one
    TimeProfile response;           ///< how the sensor weighs times of arrival; empty: evenly over the gate
    TimeProfile delay;              ///< of a sequence: between arrival and record; empty: none
    bool cameraUnwarped = false;    ///< time stops at the first interaction seen: camera segments do not count
    bool integrateOverGate = false; ///< output is the integral over a frame instead of its mean
    float vacuumSpeed = 1.0f;
};

struct Scene {
    std::filesystem::path file;
    std::vector<Medium> media;
    std::deque<Primitive> primitives; ///< surfaces only; addresses are stable
    std::vector<Emitter> emitters;
    std::vector<int> infiniteEmitters; ///< indices; an escaping ray sees the last one
    Camera camera;
    Region cameraRegion;
    ToneMap toneMap = ToneMap::Gamma;
    FilmContents film;
    TransportSettings transport;
    double lengthUnit = 0.0;                       ///< metres; 0: the scene does not say
    std::shared_ptr<const SceneGeometry> geometry; ///< of these primitives, or of those that this is a copy of

    [[nodiscard]] const Bsdf& bsdfOf(const SurfaceHit& hit) const {
        const Primitive& primitive = primitives[hit.shape];
        const int last = int(primitive.bsdfs.size()) - 1;
        return *primitive.bsdfs[size_t(std::clamp(hit.material, 0, last))];
    }
    [[nodiscard]] const Medium* medium(const Region& region) const {
        return region.medium < 0 ? nullptr : &media[size_t(region.medium)];
    }
    /// Region in which an emitter's light starts.
    [[nodiscard]] Region regionOf(const Emitter& emitter) const;
};

} // namespace tungsten
