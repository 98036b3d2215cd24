// A film's state: for checkpoints, and for the ranks of a team.

#include "tungsten/core/Errors.h"
#include "tungsten/film/Film.h"

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

void Film::write(std::ostream& out) const {
    StateHeader header{{},
                       width_,
                       height_,
                       frames_,
                       contents_.channels,
                       contents_.moments,
                       passes_,
                       uint32_t(contents_.batches),
                       uint32_t(contents_.batchBlock),
                       weight_,
                       squaredWeights_,
                       moment2Sum_,
                       nonFinite_};
    std::memcpy(header.magic, Magic, sizeof Magic);
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    writeRows(out, 0, height_);
    scatter_.write(out);
}

void Film::read(std::istream& in, const std::string& fileName) {
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
    const std::string mine = text(width_, height_, frames_, contents_);
    if (saved != mine) throw InputError(fileName, "the saved state has " + saved + ", this render " + mine);
    Film loaded(width_, height_, frames_, contents_, meaning_);
    loaded.readRows(in, 0, height_);
    loaded.scatter_.read(in);
    if (!in) throw InputError(fileName, "the saved render state is truncated");
    loaded.moment2Sum_ = header.moment2Sum;
    loaded.nonFinite_ = header.nonFinite;
    *this = std::move(loaded);
}

void Film::writeRows(std::ostream& out, int from, int end) const {
    const size_t values = rowValues(), ofRow = blocks_.size() / size_t(height_);
    const auto rows = size_t(end - from);
    out.write(reinterpret_cast<const char*>(&passes_), sizeof passes_);
    for (const double* sum : {&weight_, &squaredWeights_}) out.write(reinterpret_cast<const char*>(sum), sizeof *sum);
    std::vector<float> rowOf(values);
    for (int frame = 0; frame < frames_; ++frame) {
        writeArray(out, lit_, row(frame, from), rows);
        for (size_t at = row(frame, from); at < row(frame, from) + rows; ++at)
            for (int part = Mean; lit_[at] != 0 && part < contents_.parts(); ++part) {
                readRow(at, Part(part), rowOf.data());
                writeArray(out, rowOf, 0, values);
            }
    }
    if (frames_ > 1)
        for (const auto* total : {&totalMean_, &totalMoment2_})
            writeArray(out, *total, size_t(from) * values, rows * values);
    for (const auto* blocks : {&lastBlocks_, &blocks_}) writeArray(out, *blocks, size_t(from) * ofRow, rows * ofRow);
    batches_.write(out, from, end);
}

void Film::readRows(std::istream& in, int from, int end) {
    const size_t values = rowValues(), ofRow = blocks_.size() / size_t(height_);
    const auto rows = size_t(end - from);
    in.read(reinterpret_cast<char*>(&passes_), sizeof passes_);
    for (double* sum : {&weight_, &squaredWeights_}) in.read(reinterpret_cast<char*>(sum), sizeof *sum);
    std::vector<float> rowOf(values);
    for (int frame = 0; frame < frames_; ++frame) {
        readArray(in, lit_, row(frame, from), rows);
        for (size_t at = row(frame, from); at < row(frame, from) + rows; ++at)
            for (int part = Mean; lit_[at] != 0 && part < contents_.parts(); ++part) {
                readArray(in, rowOf, 0, values);
                writeRow(at, Part(part), rowOf.data());
            }
    }
    if (frames_ > 1)
        for (auto* total : {&totalMean_, &totalMoment2_}) readArray(in, *total, size_t(from) * values, rows * values);
    for (auto* blocks : {&lastBlocks_, &blocks_}) readArray(in, *blocks, size_t(from) * ofRow, rows * ofRow);
    batches_.read(in, from, end);
}

} // namespace tungsten
