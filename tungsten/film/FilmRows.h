#pragma once
// A film by rows, and its state: for processes that own some rows each, for partial states and for checkpoints. Nothing
// else takes a film apart.

#include "tungsten/film/Film.h"

#include <iosfwd>
#include <string>

namespace tungsten {

/// A row is one of a frame: frame after frame, each from the top.
struct FilmRows {
    [[nodiscard]] static size_t count(const Film& film);
    [[nodiscard]] static size_t values(const Film& film); ///< of a row, by pixel
    /// Whether the pass in progress has light there, and its values.
    [[nodiscard]] static bool isLit(const Film& film, size_t row);
    static void readPass(const Film& film, size_t row, float* values);
    /// Instead of what the pass in progress has there; such a row counts as lit.
    static void setPass(Film& film, size_t row, const float* values);

    /// Film::endPass() in two steps, for a film whose image rows belong to several processes: the first accumulates
    /// image rows [from, end) and returns their spread, the second adds the spread of all rows to the error estimate.
    [[nodiscard]] static AccumulatedPass accumulate(Film& film, double weight, int from, int end);
    static void finish(Film& film, const AccumulatedPass& pass);

    /// Exact binary state of image rows [from, end), with the number and weight of passes, but without the estimate of
    /// the error. read() leaves a stream that failed to its caller.
    static void write(const Film& film, std::ostream& out, int from, int end);
    static void read(Film& film, std::istream& in, int from, int end);
    /// The same of the whole film. readState() throws InputError(file name, ...) on a mismatch or truncation.
    static void writeState(const Film& film, std::ostream& out);
    static void readState(Film& film, std::istream& in, const std::string& fileName);
};

} // namespace tungsten
