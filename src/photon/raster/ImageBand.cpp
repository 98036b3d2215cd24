#include "photon/raster/ImageBand.h"

namespace tungsten::photon {

ImageBand::ImageBand(const SensorRecord& record, size_t number, int frames)
    : firstRow(int(number) * Rows), lastRow(std::min(firstRow + Rows, record.height) - 1),
      stride(size_t(record.width + Lanes)), x(), y(), z(), record_(record), frames_(frames), drawn_(size_t(frames), 0) {
    // Beyond the image no piece is seen, but lanes are computed there: with a direction, and one along no axis.
    x = rowsOf(record.x, 0.48f);
    y = rowsOf(record.y, 0.6f);
    z = rowsOf(record.z, 0.64f);
    for (size_t k = 0; k < record.pieces.size(); ++k) addPiece(k);
}

template <typename T>
std::vector<float> ImageBand::rowsOf(const std::vector<T>& image, float beyond) const {
    std::vector<float> rows(size_t(lastRow - firstRow + 1) * stride, beyond);
    const auto width = size_t(record_.width);
    for (int row = firstRow; row <= lastRow; ++row)
        for (size_t column = 0; column < width; ++column)
            rows[at(int(column), row)] = float(image[size_t(row) * width + column]);
    return rows;
}

void ImageBand::addPiece(size_t number) {
    const StraightPiece& recorded = record_.pieces[number];
    BandPiece piece;
    piece.number = number;
    const auto width = size_t(record_.width), begin = size_t(firstRow) * width, end = size_t(lastRow + 1) * width;
    bool empty = true;
    for (size_t i = begin; i < end; ++i) {
        if (!(recorded.end[i] > recorded.start[i])) continue;
        if (empty) {
            piece.medium = recorded.medium[i];
            piece.interactions = recorded.interactions[i];
            piece.leastStart = piece.mostStart = recorded.start[i];
            empty = false;
        }
        piece.leastStart = std::min(piece.leastStart, recorded.start[i]);
        piece.mostStart = std::max(piece.mostStart, recorded.start[i]);
        piece.mixed =
            piece.mixed || recorded.medium[i] != piece.medium || int(recorded.interactions[i]) != piece.interactions;
    }
    if (empty) return;
    piece.start = rowsOf(recorded.start);
    piece.end = rowsOf(recorded.end);
    if (piece.mixed) {
        piece.media = rowsOf(recorded.medium);
        piece.interactionCounts = rowsOf(recorded.interactions);
    }
    for (auto& channel : piece.sums) channel.resize(piece.start.size() * size_t(frames_));
    piece.settled.resize(size_t(frames_));
    pieces.push_back(std::move(piece));
}

void ImageBand::settle(int frame) {
    const size_t begin = sumsOf(frame);
    drawn_[placeOf(frame)] = 0;
    for (BandPiece& piece : pieces) {
        std::vector<Vec3d>& settled = piece.settled[placeOf(frame)];
        settled.resize(x.size(), Vec3d(0.0));
        for (size_t k = 0; k < piece.sums.size(); ++k)
            for (size_t i = 0; i < settled.size(); ++i) {
                settled[i][int(k)] += double(piece.sums[k][begin + i]);
                piece.sums[k][begin + i] = 0.0f;
            }
    }
}

void ImageBand::addToFilm(int frame, Film& film) {
    const auto width = size_t(record_.width);
    const size_t begin = sumsOf(frame);
    const bool settles = std::any_of(pieces.begin(), pieces.end(),
                                     [&](const BandPiece& piece) { return !piece.settled[placeOf(frame)].empty(); });
    if (settles) settle(frame);
    for (BandPiece& piece : pieces) {
        const std::vector<Rgb>& throughput = record_.pieces[piece.number].throughput;
        std::vector<Vec3d>& settled = piece.settled[placeOf(frame)];
        for (int row = firstRow; row <= lastRow; ++row)
            for (size_t column = 0; column < width; ++column) {
                const size_t at = this->at(int(column), row), i = begin + at;
                const Rgb sum = settles ? Rgb(float(settled[at].x), float(settled[at].y), float(settled[at].z))
                                        : Rgb(piece.sums[0][i], piece.sums[1][i], piece.sums[2][i]);
                film.add(frame, int(column), row, sum * throughput[size_t(row) * width + column]);
            }
        settled.clear();
        for (auto& channel : piece.sums) std::fill_n(channel.begin() + ptrdiff_t(begin), x.size(), 0.0f);
    }
    drawn_[placeOf(frame)] = 0;
}

} // namespace tungsten::photon
