#pragma once
// A film as its outputs show it: in their units, and as bright as 8-bit images are to be.

#include "tungsten/film/Film.h"
#include "tungsten/image/Exposure.h"
#include "tungsten/scene/Scene.h"

#include <optional>
#include <string>

namespace tungsten {

/// What all formats write from. Films, scene and metadata must outlive it.
class OutputFilm {
  public:
    /// `bias`: of the film, without frames where none is estimated. `metadata`: Result.h. Exposure of 8-bit images;
    /// none: automatic where there is a gate.
    OutputFilm(const Film& film, const Film& bias, const Scene& scene, const std::string& metadata,
               const std::optional<ExposureChoice>& exposure);

    [[nodiscard]] const Film& film() const { return film_; }
    [[nodiscard]] const Film& bias() const { return bias_; }
    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] const std::string& metadata() const { return metadata_; }
    [[nodiscard]] int frames() const { return film_.frames(); }

    /// The mean of a frame, of the whole gate, and of either in output units.
    [[nodiscard]] Image frame(int frame) const { return overFrame(film_.mean(frame)); }
    [[nodiscard]] Image whole() const;
    [[nodiscard]] Image overFrame(Image average) const;
    /// The same as 8-bit images show them, before the tone curve. Frames have one exposure, so that they can be
    /// compared; the whole gate has its own.
    [[nodiscard]] Image shownFrame(int frame) const;
    [[nodiscard]] Image shownWhole() const;

  private:
    [[nodiscard]] float framesFactor() const;

    const Film &film_, &bias_;
    const Scene& scene_;
    const std::string& metadata_;
    ExposureChoice exposure_;
    mutable std::optional<float> framesFactor_; ///< once it is known
};

} // namespace tungsten
