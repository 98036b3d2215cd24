#pragma once
// A page to look at a render with (`--html`): tungsten/page, and the film in it.

#include "tungsten/film/Film.h"
#include "tungsten/scene/Scene.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tungsten {

/// The film's payload may take so much, so that the page with all else stays below 30 MB (FilmCode.h: its precision
/// gives way).
inline constexpr double FilmBytesInPage = 20e6;

/// What a page shows. Film and scene must outlive it.
struct PageContent {
    /// The relative standard error at one moment of the render.
    struct CurvePoint {
        double cpuSeconds = 0.0, wallSeconds = 0.0, error = 0.0;
    };

    const Film& film;
    const Scene& scene;
    std::string method;                                     ///< the integrator's type
    std::string subtitle;                                   ///< how the film was rendered, in a line
    std::vector<std::pair<std::string, std::string>> facts; ///< by name; empty ones are left out
    std::vector<CurvePoint> curve;                          ///< none is shown with fewer than two points
    std::string statistics;                                 ///< JSON, as of --stats
};

/// Writes the page as one file that needs nothing else. Throws InputError if it cannot be written.
void writePage(const std::filesystem::path& file, const PageContent& content);

} // namespace tungsten
