#include "tungsten/io/FilmCode.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>

#include <zlib.h>

namespace tungsten {

namespace {

using Bytes = std::vector<uint8_t>;

constexpr double FinestStep = 1.0 / 1024, CoarsestStep = 1.0 / 2; // octaves
constexpr int LargestBlock = 8;
constexpr double ShareOfBlocks = 1.0 / 3; ///< of the budget, for colours and errors
constexpr int LastCode = 65535, LastErrorCode = 255;

double meanOfChannels(const Rgb& c) {
    const double mean = (double(c.x) + double(c.y) + double(c.z)) / 3.0;
    return std::isfinite(mean) ? std::max(mean, 0.0) : 0.0;
}

/// log2 of the channels' means of all frames, -infinity for black.
std::vector<float> logarithms(const std::vector<Image>& frames) {
    std::vector<float> logs;
    logs.reserve(frames.size() * frames[0].pixels.size());
    for (const Image& frame : frames)
        for (const Rgb& pixel : frame.pixels) logs.push_back(float(std::log2(meanOfChannels(pixel))));
    return logs;
}

double highest(const std::vector<float>& logs) {
    const double top = double(*std::max_element(logs.begin(), logs.end()));
    return std::isfinite(top) ? top : 0.0;
}

int codeOf(double log, double top, double step, int last) {
    return std::isfinite(log) ? std::max(0, last - int(std::lround((top - log) / step))) : 0;
}

/// Low bytes, then high bytes of the codes' zigzag differences.
Bytes valuePlanes(const std::vector<float>& logs, double top, double step) {
    Bytes planes(2 * logs.size());
    int before = 0;
    for (size_t i = 0; i < logs.size(); ++i) {
        const int code = codeOf(double(logs[i]), top, step, LastCode);
        const auto difference = int16_t(uint16_t(code - before));
        const auto zigzag = uint16_t((difference << 1) ^ (difference >> 15));
        planes[i] = uint8_t(zigzag & 255);
        planes[logs.size() + i] = uint8_t(zigzag >> 8);
        before = code;
    }
    return planes;
}

/// Bytes that an ideal code of single bytes takes.
double entropyBytes(std::span<const uint8_t> bytes) {
    std::array<size_t, 256> counts{};
    for (const uint8_t byte : bytes) ++counts[byte];
    double bits = 0.0;
    for (const size_t n : counts)
        if (n > 0) bits -= double(n) * std::log2(double(n) / double(bytes.size()));
    return bits / 8.0;
}

/// Calls `use(sum, pixels)` for every block of every frame with the sums of its pixels' `of`.
template <typename Of, typename Use>
void forBlocks(const std::vector<Image>& frames, int block, Of of, Use use) {
    for (const Image& frame : frames)
        for (int top = 0; top < frame.height; top += block)
            for (int left = 0; left < frame.width; left += block) {
                Rgb sum(0.0f);
                const int bottom = std::min(top + block, frame.height), right = std::min(left + block, frame.width);
                for (int y = top; y < bottom; ++y)
                    for (int x = left; x < right; ++x) sum += of(frame.at(x, y));
                use(sum, (bottom - top) * (right - left));
            }
}

void appendDifferences(Bytes& bytes, const Bytes& plane) {
    uint8_t before = 0;
    for (const uint8_t value : plane) {
        bytes.push_back(uint8_t(value - before));
        before = value;
    }
}

/// Shares of red and of green in 255ths; black is grey.
void appendColours(Bytes& bytes, const std::vector<Image>& means, int block) {
    Bytes red, green;
    const auto finite = [](const Rgb& c) { return isFinite(c) ? c : Rgb(0.0f); };
    forBlocks(means, block, finite, [&](const Rgb& sum, int) {
        const Rgb c(std::max(sum.x, 0.0f), std::max(sum.y, 0.0f), std::max(sum.z, 0.0f));
        const float all = c.x + c.y + c.z;
        red.push_back(uint8_t(std::lround(all > 0.0f ? 255.0f * c.x / all : 85.0f)));
        green.push_back(uint8_t(std::lround(all > 0.0f ? 255.0f * c.y / all : 85.0f)));
    });
    appendDifferences(bytes, red);
    appendDifferences(bytes, green);
}

/// rms standard errors of blocks; returns the scale's top.
double appendErrors(Bytes& bytes, const std::vector<Image>& errors, int block) {
    std::vector<float> logs;
    const auto square = [](const Rgb& c) {
        const auto error = float(meanOfChannels(c));
        return Rgb(error * error);
    };
    forBlocks(errors, block, square,
              [&](const Rgb& sum, int pixels) { logs.push_back(float(0.5 * std::log2(double(sum.x) / pixels))); });
    const double top = highest(logs);
    Bytes codes;
    for (const float log : logs) codes.push_back(uint8_t(codeOf(double(log), top, FilmCode::ErrorStep, LastErrorCode)));
    appendDifferences(bytes, codes);
    return top;
}

Bytes deflate(const Bytes& bytes) {
    uLongf size = compressBound(uLong(bytes.size()));
    Bytes packed(size);
    if (compress2(packed.data(), &size, bytes.data(), uLong(bytes.size()), Z_DEFAULT_COMPRESSION) != Z_OK)
        throw std::runtime_error("the film cannot be compressed");
    packed.resize(size);
    return packed;
}

} // namespace

FilmCode encodeFilm(const FilmImages& film, double budgetBytes) {
    FilmCode code;
    code.width = film.means[0].width;
    code.height = film.means[0].height;
    code.frames = int(film.means.size());
    code.hasError = !film.standardErrors.empty();
    Bytes blocks;
    for (;; code.block *= 2) {
        blocks.clear();
        appendColours(blocks, film.means, code.block);
        if (code.hasError) code.errorTop = appendErrors(blocks, film.standardErrors, code.block);
        if (entropyBytes(blocks) <= ShareOfBlocks * budgetBytes || code.block >= LargestBlock) break;
    }
    const double left = budgetBytes - entropyBytes(blocks);
    const std::vector<float> logs = logarithms(film.means);
    code.top = highest(logs);
    Bytes planes;
    for (code.step = FinestStep;; code.step *= 2.0) {
        planes = valuePlanes(logs, code.top, code.step);
        const std::span<const uint8_t> bytes(planes), low = bytes.first(logs.size()), high = bytes.last(logs.size());
        if (entropyBytes(low) + entropyBytes(high) <= left || code.step >= CoarsestStep) break;
    }
    planes.insert(planes.end(), blocks.begin(), blocks.end());
    code.deflated = deflate(planes);
    return code;
}

std::string base64(const std::vector<uint8_t>& bytes) {
    static constexpr char Digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t count = std::min<size_t>(3, bytes.size() - i);
        uint32_t word = 0;
        for (size_t k = 0; k < 3; ++k) word = (word << 8) | (k < count ? bytes[i + k] : 0u);
        for (size_t k = 0; k < 4; ++k) text += k <= count ? Digits[(word >> (18 - 6 * k)) & 63u] : '=';
    }
    return text;
}

} // namespace tungsten
