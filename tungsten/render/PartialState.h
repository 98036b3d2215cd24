#pragma once
// Some of a render's passes, in a file (`--passes`), and putting such together (`tungsten merge`). A pass depends on
// the scene, the settings and its number alone, and a film on its passes in their order: what is merged is bit for bit
// what one run gives, wherever two runs give the same.

#include "tungsten/film/Exposure.h"
#include "tungsten/film/Film.h"
#include "tungsten/scene/SceneLoader.h"

#include <filesystem>
#include <memory>
#include <optional>

namespace tungsten {

/// Passes [first, end), from 0.
struct PassRange {
    uint32_t first = 0, end = 0;
};

/// What partial states of one render agree in, and what their images need of the scene.
struct PartialIdentity {
    uint64_t content = 0; ///< LoadedScene::hash
    uint64_t seed = 0;
    int64_t sppStep = 0;
    std::shared_ptr<const Scene> scene; ///< its file, resolution, detectors, film, transport, units, tone map are kept
    std::string integrator, sceneText;
    std::optional<ExposureChoice> exposure{}; ///< of 8-bit images; need not agree

    static PartialIdentity of(const LoadedScene& loaded, uint64_t seed, int64_t sppStep,
                              const std::optional<ExposureChoice>& exposure);
};

/// Writes a partial state pass by pass, to a stream of writeAtomically().
class PartialStateWriter {
  public:
    PartialStateWriter(std::ostream& out, std::string file, const PartialIdentity& identity, uint32_t firstPass);
    ~PartialStateWriter();
    PartialStateWriter(const PartialStateWriter&) = delete;
    PartialStateWriter& operator=(const PartialStateWriter&) = delete;

    /// The film's pass image, before endPass(). Throws InputError if it cannot be written.
    void add(Film& film, uint32_t samples);
    /// `statistics`: JSON.
    void finish(const std::string& statistics, double cpuSeconds);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// What was merged; its identity is that of the state with the first passes.
struct MergedRender {
    PartialIdentity identity;
    Film film;
    uint64_t samples = 0;
    std::string statistics; ///< JSON, with those of every state
};

/// All passes of the states, which must be those of one render from its first on, each once. Throws InputError, with
/// every file that is no partial state, damaged or of another render, and all passes that overlap or are missing.
MergedRender mergePartialStates(const std::vector<std::filesystem::path>& files);

} // namespace tungsten
