#include "tungsten/film/FilmRows.h"

#include "tungsten/core/Errors.h"

#include <cstring>
#include <istream>
#include <ostream>

namespace tungsten {

namespace {

constexpr char Magic[8] = {'T', 'F', 'I', 'L', 'M', '0', '0', '6'};

struct StateHeader {
    char magic[8];
    int32_t width, height, frames, channels;
    uint32_t moments, passes, batches, batchBlock;
    double weight, squaredWeights, moment2Sum;
    uint64_t nonFinite;
};

template <typename Values>
void writeArray(std::ostream& out, const Values& values, size_t first, size_t count) {
    out.write(reinterpret_cast<const char*>(values.data() + first), std::streamsize(count * sizeof(values[0])));
}

template <typename Values>
void readArray(std::istream& in, Values& values, size_t first, size_t count) {
    in.read(reinterpret_cast<char*>(values.data() + first), std::streamsize(count * sizeof(values[0])));
}

} // namespace

size_t FilmRows::count(const Film& film) {
    return film.touched_.size();
}

size_t FilmRows::values(const Film& film) {
    return film.rowValues();
}

bool FilmRows::isLit(const Film& film, size_t row) {
    return film.touched_[row] != 0;
}

void FilmRows::readPass(const Film& film, size_t row, float* values) {
    film.readRow(row, Film::Pass, values);
}

void FilmRows::setPass(Film& film, size_t row, const float* values) {
    film.writeRow(row, Film::Pass, values);
    film.touched_[row] = 1;
}

AccumulatedPass FilmRows::accumulate(Film& film, double weight, int from, int end) {
    return film.accumulateRows(weight, from, end);
}

void FilmRows::finish(Film& film, const AccumulatedPass& pass) {
    film.finishPass(pass);
}

void FilmRows::write(const Film& film, std::ostream& out, int from, int end) {
    const size_t values = film.rowValues(), ofRow = film.blocks_.size() / size_t(film.height_);
    const auto rows = size_t(end - from);
    out.write(reinterpret_cast<const char*>(&film.passes_), sizeof film.passes_);
    for (const double* sum : {&film.weight_, &film.squaredWeights_})
        out.write(reinterpret_cast<const char*>(sum), sizeof *sum);
    std::vector<float> rowOf(values);
    for (int frame = 0; frame < film.frames_; ++frame) {
        writeArray(out, film.lit_, film.row(frame, from), rows);
        for (size_t at = film.row(frame, from); at < film.row(frame, from) + rows; ++at)
            for (int part = Film::Mean; film.lit_[at] != 0 && part < film.contents_.parts(); ++part) {
                film.readRow(at, Film::Part(part), rowOf.data());
                writeArray(out, rowOf, 0, values);
            }
    }
    if (film.frames_ > 1)
        for (const auto* total : {&film.totalMean_, &film.totalMoment2_})
            writeArray(out, *total, size_t(from) * values, rows * values);
    for (const auto* blocks : {&film.lastBlocks_, &film.blocks_})
        writeArray(out, *blocks, size_t(from) * ofRow, rows * ofRow);
    film.batches_.write(out, from, end);
}

void FilmRows::read(Film& film, std::istream& in, int from, int end) {
    const size_t values = film.rowValues(), ofRow = film.blocks_.size() / size_t(film.height_);
    const auto rows = size_t(end - from);
    in.read(reinterpret_cast<char*>(&film.passes_), sizeof film.passes_);
    for (double* sum : {&film.weight_, &film.squaredWeights_}) in.read(reinterpret_cast<char*>(sum), sizeof *sum);
    std::vector<float> rowOf(values);
    for (int frame = 0; frame < film.frames_; ++frame) {
        readArray(in, film.lit_, film.row(frame, from), rows);
        for (size_t at = film.row(frame, from); at < film.row(frame, from) + rows; ++at)
            for (int part = Film::Mean; film.lit_[at] != 0 && part < film.contents_.parts(); ++part) {
                readArray(in, rowOf, 0, values);
                film.writeRow(at, Film::Part(part), rowOf.data());
            }
    }
    if (film.frames_ > 1)
        for (auto* total : {&film.totalMean_, &film.totalMoment2_})
            readArray(in, *total, size_t(from) * values, rows * values);
    for (auto* blocks : {&film.lastBlocks_, &film.blocks_}) readArray(in, *blocks, size_t(from) * ofRow, rows * ofRow);
    film.batches_.read(in, from, end);
}

void FilmRows::writeState(const Film& film, std::ostream& out) {
    StateHeader header{{},
                       film.width_,
                       film.height_,
                       film.frames_,
                       film.contents_.channels,
                       film.contents_.moments,
                       film.passes_,
                       uint32_t(film.contents_.batches),
                       uint32_t(film.contents_.batchBlock),
                       film.weight_,
                       film.squaredWeights_,
                       film.moment2Sum_,
                       film.nonFinite_};
    std::memcpy(header.magic, Magic, sizeof Magic);
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    write(film, out, 0, film.height_);
    film.confidence_.write(out);
}

void FilmRows::readState(Film& film, std::istream& in, const std::string& fileName) {
    StateHeader header{};
    in.read(reinterpret_cast<char*>(&header), sizeof header);
    if (!in || std::memcmp(header.magic, Magic, sizeof Magic) != 0)
        throw InputError(fileName, "not a saved render state (or truncated)");
    const auto text = [](int width, int height, int frames, const FilmContents& contents) {
        return std::to_string(width) + "x" + std::to_string(height) + " pixels in " + std::to_string(frames) +
               " frames of " + std::to_string(contents.channels) + (contents.channels == 1 ? " channel" : " channels") +
               (contents.moments ? "" : " without moments") +
               (contents.batches == 0 ? ""
                                      : " with " + std::to_string(contents.batches) + " batches of blocks of " +
                                            std::to_string(contents.batchBlock) + " pixels");
    };
    const FilmContents contents{header.channels, header.moments != 0, int(header.batches), int(header.batchBlock)};
    const std::string saved = text(header.width, header.height, header.frames, contents);
    const std::string mine = text(film.width_, film.height_, film.frames_, film.contents_);
    if (saved != mine) throw InputError(fileName, "the saved state has " + saved + ", this render " + mine);
    Film loaded(film.width_, film.height_, film.frames_, film.contents_, film.meaning_);
    read(loaded, in, 0, film.height_);
    loaded.confidence_.read(in);
    if (!in) throw InputError(fileName, "the saved render state is truncated");
    loaded.moment2Sum_ = header.moment2Sum;
    loaded.nonFinite_ = header.nonFinite;
    film = std::move(loaded);
}

} // namespace tungsten
