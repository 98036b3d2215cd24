#pragma once
// Some of a render's passes, in a file (`--passes`), and putting such together (`tungsten merge`). A pass depends on
// the scene, the settings and its number alone, and a film on its passes in their order: what is merged is bit for bit
// what one run gives, wherever two runs give the same.

#include "tungsten/film/Film.h"
#include "tungsten/image/Exposure.h"
#include "tungsten/scene/SceneLoader.h"

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

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

/// The fixed part at the start of a partial state: what passes of one render agree in, and what images need of the
/// scene. As it lies in the file; texts, detectors, passes, an end and the checksum follow.
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

/// A partial state whose checksum has been looked at: it is as it was written.
class PartialStateReader {
  public:
    /// Throws InputError if the file is no partial state, damaged or of another version.
    explicit PartialStateReader(const std::filesystem::path& file);

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    [[nodiscard]] const PartialIdentity& identity() const { return identity_; }
    /// Passes [first, end) of the render.
    [[nodiscard]] uint32_t first() const { return first_; }
    [[nodiscard]] uint32_t end() const { return first_ + uint32_t(samples_.size()); }
    /// Per pixel, by pass.
    [[nodiscard]] const std::vector<uint32_t>& samples() const { return samples_; }
    /// JSON, and CPU seconds of the process that wrote it.
    [[nodiscard]] const std::string& statistics() const { return statistics_; }
    [[nodiscard]] double cpuSeconds() const { return cpuSeconds_; }
    /// In what it is of another render; empty: in nothing.
    [[nodiscard]] std::string differenceTo(const PartialStateReader& other) const;
    /// Folds its passes into the film, in their order. Throws InputError if the file has changed.
    void fold(Film& film) const;

  private:
    std::filesystem::path file_;
    PartialIdentity identity_;
    std::string build_, statistics_;
    std::streampos passesAt_;
    uint32_t first_ = 0;
    std::vector<uint32_t> samples_;
    double cpuSeconds_ = 0.0;
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
