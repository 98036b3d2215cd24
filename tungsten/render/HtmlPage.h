#pragma once
// A page to look at a render with (`--html`): tungsten/page, and the film in it.

#include "tungsten/render/RenderSession.h"

namespace tungsten {

/// The film's payload may take so much, so that the page with all else stays below 30 MB (FilmCode.h: its precision
/// gives way).
inline constexpr double FilmBytesInPage = 20e6;

/// Writes the page as one file that needs nothing else. Throws InputError if it cannot be written.
void writeFilmPage(const std::filesystem::path& file, const LoadedScene& loaded, const SessionOptions& options,
                   const SessionResult& result);

} // namespace tungsten
