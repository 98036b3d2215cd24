#include "photon/raster/ImageBand.h"

namespace tungsten::photon {

ImageBand::ImageBand(const CameraRecord& record, size_t number, int frames)
    : firstRow(int(number) * Rows), lastRow(std::min(firstRow + Rows, record.height) - 1),
      stride(size_t(record.width + Lanes)), x(), y(), z(), record_(record), frames_(frames), drawn_(size_t(frames), 0) {
    // Beyond the image no segment is seen, but lanes are computed there: with a direction, and one along no axis.
    x = rowsOf(record.x, 0.48f);
    y = rowsOf(record.y, 0.6f);
    z = rowsOf(record.z, 0.64f);
    for (size_t k = 0; k < record.mediumSegments.size(); ++k) addSegment(k);
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

void ImageBand::addSegment(size_t number) {
    const MediumSegment& recorded = record_.mediumSegments[number];
    BandSegment segment;
    segment.number = number;
    const auto width = size_t(record_.width), begin = size_t(firstRow) * width, end = size_t(lastRow + 1) * width;
    bool empty = true;
    for (size_t i = begin; i < end; ++i) {
        if (!(recorded.end[i] > recorded.start[i])) continue;
        if (empty) {
            segment.medium = recorded.medium[i];
            segment.interactions = recorded.interactions[i];
            segment.leastStart = segment.mostStart = recorded.start[i];
            empty = false;
        }
        segment.leastStart = std::min(segment.leastStart, recorded.start[i]);
        segment.mostStart = std::max(segment.mostStart, recorded.start[i]);
        segment.mixed = segment.mixed || recorded.medium[i] != segment.medium ||
                        int(recorded.interactions[i]) != segment.interactions;
    }
    if (empty) return;
    segment.start = rowsOf(recorded.start);
    segment.end = rowsOf(recorded.end);
    if (segment.mixed) {
        segment.media = rowsOf(recorded.medium);
        segment.interactionCounts = rowsOf(recorded.interactions);
    }
    for (auto& channel : segment.sums) channel.resize(segment.start.size() * size_t(frames_));
    segment.settled.resize(size_t(frames_));
    segments.push_back(std::move(segment));
}

void ImageBand::settle(int frame) {
    const size_t begin = sumsOf(frame);
    drawn_[placeOf(frame)] = 0;
    for (BandSegment& segment : segments) {
        std::vector<Vec3d>& settled = segment.settled[placeOf(frame)];
        settled.resize(x.size(), Vec3d(0.0));
        for (size_t k = 0; k < segment.sums.size(); ++k)
            for (size_t i = 0; i < settled.size(); ++i) {
                settled[i][int(k)] += double(segment.sums[k][begin + i]);
                segment.sums[k][begin + i] = 0.0f;
            }
    }
}

void ImageBand::addToFilm(int frame, Film& film) {
    const auto width = size_t(record_.width);
    const size_t begin = sumsOf(frame);
    const bool settles = std::any_of(segments.begin(), segments.end(), [&](const BandSegment& segment) {
        return !segment.settled[placeOf(frame)].empty();
    });
    if (settles) settle(frame);
    for (BandSegment& segment : segments) {
        const std::vector<Rgb>& throughput = record_.mediumSegments[segment.number].throughput;
        std::vector<Vec3d>& settled = segment.settled[placeOf(frame)];
        for (int row = firstRow; row <= lastRow; ++row)
            for (size_t column = 0; column < width; ++column) {
                const size_t at = this->at(int(column), row), i = begin + at;
                const Rgb sum =
                    settles ? Rgb(settled[at]) : Rgb(segment.sums[0][i], segment.sums[1][i], segment.sums[2][i]);
                film.add(frame, int(column), row, sum * throughput[size_t(row) * width + column]);
            }
        settled.clear();
        for (auto& channel : segment.sums) std::fill_n(channel.begin() + ptrdiff_t(begin), x.size(), 0.0f);
    }
    drawn_[placeOf(frame)] = 0;
}

} // namespace tungsten::photon
