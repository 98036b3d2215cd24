#pragma once
// The way a render takes to its image: what it would have shown had it been stopped earlier (`--trace`).

#include "tungsten/film/FilmErrors.h"
#include "tungsten/scene/Scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace tungsten {

/// A render at one moment.
struct TraceEntry {
    uint32_t passes = 0;
    double samples = 0.0; ///< per pixel, resumed ones included; parts of them where passes were cut
    double wallSeconds = 0.0, cpuSeconds = 0.0; ///< of this run's passes, the trace's own left out
    double relativeError = 0.0;                 ///< relative standard error; NaN: unknown
    RelativeBias relativeBias{0.0, 0.0};        ///< where the film's bias is estimated
    std::string mean, standardError, bias;      ///< files; `bias` where it is estimated
};

/// Writes the film whenever the time that passes have taken has doubled, and at the end: `FOLDER/mean-PASSES.npy` and
/// `stderr-PASSES.npy`, where it is estimated also `bias-PASSES.npy`, (frames, height, width, 3) of 32-bit floats in
/// the units of all outputs, and after each of them `FOLDER/trace.json`, which lists what there is. Both files and list
/// appear whole or not at all.
class Trace {
  public:
    /// Writes to nothing without a folder.
    Trace(std::filesystem::path folder, const Scene& scene, uint64_t seed);

    /// Before the first pass.
    void start();
    /// Whether record() has something to write.
    [[nodiscard]] bool due() const;
    /// After a pass. Where a file cannot be written the trace ends, and requireWritten() tells.
    /// `bias`: of the film, without frames where none is estimated.
    /// `whole`: the film is; else nothing is written yet.
    void record(const Film& film, const Film& bias, bool whole = true);
    /// After the last pass, or one that was broken off: the film as it was at the last `record`, if that wrote nothing.
    void end(const Film& film, const Film& bias);
    [[nodiscard]] const std::vector<TraceEntry>& entries() const { return entries_; }
    /// Throws the InputError of the file that could not be.
    void requireWritten() const;
    /// What every trace has, none without a folder; of a folder's other files the names are those of passes.
    [[nodiscard]] static std::vector<std::filesystem::path> filesIn(const std::filesystem::path& folder);

  private:
    void attempt(const Film& film, const Film& bias);
    void write(const Film& film, const Film& bias);
    void writeList() const;

    std::filesystem::path folder_;
    const Scene& scene_;
    uint64_t seed_;
    double wallStart_ = 0.0, cpuStart_ = 0.0; ///< moved on by the time that writing takes
    double wall_ = 0.0, cpu_ = 0.0;           ///< when the last pass ended
    double next_ = 0.0;                       ///< seconds of passes
    bool written_ = true;                     ///< the last pass's film
    std::vector<TraceEntry> entries_;
    std::exception_ptr failure_;
};

} // namespace tungsten
