#include "tungsten/render/PassCode.h"

#include "tungsten/film/Film.h"

#include <zlib.h>

#include <algorithm>
#include <new>

namespace tungsten {

namespace {

constexpr size_t Step = size_t(1) << 16;

} // namespace

std::vector<unsigned char> deflatePass(const Film& film) {
    z_stream stream{};
    if (deflateInit(&stream, Z_BEST_SPEED) != Z_OK) throw std::bad_alloc();
    std::vector<unsigned char> bytes;
    std::vector<float> row(film.rowValues());
    unsigned char piece[Step];
    for (size_t at = 0; at < film.passRows(); ++at) {
        film.readPassRow(at, row.data());
        stream.next_in = reinterpret_cast<Bytef*>(row.data());
        stream.avail_in = uInt(row.size() * sizeof(float));
        const int flush = at + 1 == film.passRows() ? Z_FINISH : Z_NO_FLUSH;
        do {
            stream.next_out = piece;
            stream.avail_out = Step;
            deflate(&stream, flush);
            bytes.insert(bytes.end(), piece, piece + (Step - stream.avail_out));
        } while (stream.avail_out == 0);
    }
    deflateEnd(&stream);
    return bytes;
}

bool inflatePass(const std::vector<unsigned char>& bytes, Film& film) {
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
    std::vector<float> row(film.rowValues());
    size_t taken = 0;
    const auto step = [&] {
        if (stream.avail_in == 0) {
            stream.next_in = const_cast<Bytef*>(bytes.data() + taken);
            stream.avail_in = uInt(std::min(bytes.size() - taken, size_t(1) << 30));
            taken += stream.avail_in;
        }
        return inflate(&stream, Z_NO_FLUSH);
    };
    bool good = true;
    for (size_t at = 0; good && at < film.passRows(); ++at) {
        stream.next_out = reinterpret_cast<Bytef*>(row.data());
        stream.avail_out = uInt(row.size() * sizeof(float));
        while (good && stream.avail_out > 0) {
            const int code = step();
            good = code == Z_OK || (code == Z_STREAM_END && stream.avail_out == 0 && at + 1 == film.passRows());
        }
        if (good && !std::all_of(row.begin(), row.end(), [](float value) { return value == 0.0f; }))
            film.setPassRow(at, row.data());
    }
    unsigned char more = 0;
    stream.next_out = &more;
    stream.avail_out = 1;
    int code = good ? step() : Z_DATA_ERROR;
    while (code == Z_OK && stream.avail_out == 1) code = step(); // the checksum may lie in the next piece
    good = code == Z_STREAM_END && stream.avail_out == 1;
    inflateEnd(&stream);
    return good;
}

} // namespace tungsten
