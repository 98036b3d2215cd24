#pragma once
// The open set: integrators, loaded from plugins, registered by type name.

#include "tungsten/film/Film.h"
#include "tungsten/integrator/Features.h"
#include "tungsten/integrator/ProgressToken.h"
#include "tungsten/integrator/Statistics.h"
#include "tungsten/reader/ObjectReader.h"
#include "tungsten/scene/Scene.h"

#include <functional>
#include <map>
#include <memory>
#include <string>

namespace tungsten {

/// One progressive pass.
struct PassInfo {
    uint32_t index = 0;       ///< from 0
    uint64_t firstSample = 0; ///< samples per pixel already taken by earlier passes
    uint32_t samples = 1;     ///< samples per pixel of this pass
    uint64_t seed = 0;
    /// If any, an integrator that leavesBias adds to its pass, zeroed before, about by how much kernels make
    /// the pass's image wrong: what the pass would have, had it no noise, minus the truth.
    Film* bias = nullptr;
    /// Of the light paths that a pass traces, what this one is to trace: less than 1 only where cutsLightPaths().
    double share = 1.0;
    ProgressToken watch{}; ///< polled about every millisecond, so that a pass can be broken off

    /// The same for what is about the part from..to (0 to 1) of the pass's work.
    [[nodiscard]] PassInfo part(double from, double to) const {
        PassInfo part = *this;
        part.watch = watch.part(from, to);
        return part;
    }
};

/// Renders passes. A pass must depend only on (scene, settings, pass): no state is carried from pass to pass, so a
/// resumed render equals an uninterrupted one. Work is spread by oneTBB inside renderPass.
class Integrator {
  public:
    virtual ~Integrator() = default;
    /// Called once before the first pass, and for `--explain`: excludes what cannot arrive (excludeLate), and adds the
    /// features that the integrator decides on.
    virtual void plan(SceneFacts& facts, Features& features) const = 0;
    /// Called once after plan(): builds what the facts ask for (tables, distributions). Where that may take a second,
    /// `watch` is polled as in a pass; once it has thrown PassCancelled nothing is rendered.
    virtual void prepare(const SceneFacts& facts, const ProgressToken& watch, Statistics& statistics) = 0;
    /// Bytes that prepare() and a pass may take as settings and scene stand; asked after plan(), before prepare().
    [[nodiscard]] virtual double memoryBytes() const { return 0.0; }
    /// Whether kernels blur the image; after plan().
    [[nodiscard]] virtual bool leavesBias(const SceneFacts&) const { return false; }
    /// Width of a pass's kernels over that of the first pass's, whose square their bias follows; after prepare().
    [[nodiscard]] virtual double kernelWidth(uint32_t) const { return 1.0; }
    /// Whether a pass can trace fewer light paths than the scene's settings say (PassInfo::share), as one that has
    /// fewer samples can trace fewer camera paths.
    [[nodiscard]] virtual bool cutsLightPaths() const { return false; }
    /// Adds the pass's image to every frame of the film (Film::add): each pixel's mean over the pass's samples,
    /// averaged over the gate. Throws PassCancelled where the pass's watch does.
    virtual void renderPass(const PassInfo& pass, Film& film, Statistics& statistics) = 0;
};

/// Reads its settings (problems go to the reader's diagnostics) and keeps the scene.
using IntegratorFactory =
    std::function<std::unique_ptr<Integrator>(std::shared_ptr<const Scene> scene, const ObjectReader& settings)>;

/// Integrators that take the same settings, by which the host compares what they cost (`--plan-cost`).
enum class IntegratorFamily { Other, PhotonMaps, PathTracers };

/// What the host knows of an integrator before there is one.
struct IntegratorTraits {
    DefaultGate defaultGate = DefaultGate::None;
    IntegratorFamily family = IntegratorFamily::Other;
    bool represents = false; ///< the type that stands for its family where a scene has none of it
};

/// Integrator types and where each comes from.
class IntegratorRegistry {
  public:
    struct Entry {
        IntegratorFactory factory;
        std::string description; ///< one line, for `--list`
        std::string origin;      ///< the plugin's file
        IntegratorTraits traits{};
    };
    /// Registers a type; a second registration of a name is an InputError naming both origins.
    void add(const std::string& type, const std::string& description, IntegratorFactory factory,
             const IntegratorTraits& traits = {});
    [[nodiscard]] const std::map<std::string, Entry>& entries() const { return entries_; }
    /// Of a type that nobody registers: what scene files mean by it.
    [[nodiscard]] DefaultGate defaultGateOf(const std::string& type) const;
    /// The type that represents a family; empty if no plugin has one.
    [[nodiscard]] std::string typeOf(IntegratorFamily family) const;
    /// Origin recorded for the types that follow.
    void setOrigin(std::string origin) { origin_ = std::move(origin); }

  private:
    std::map<std::string, Entry> entries_;
    std::string origin_ = "built in";
};

} // namespace tungsten
