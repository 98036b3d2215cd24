#include "path/SampleAllocation.h"

#include <algorithm>
#include <cmath>

namespace tungsten::path {

namespace {

/// Blocks along a side of an image, at most.
constexpr int MostBlocks = 32;
/// Bit of sample numbers that no other pass uses, for passes of too few samples to be shared out.
constexpr uint32_t EvenSamples = 1u << 31;

} // namespace

SampleAllocation::SampleAllocation(Vec2i resolution)
    : resolution_(resolution),
      grid_(std::min(resolution.x, MostBlocks), std::min(resolution.y, MostBlocks)), halves_{Blocks(blocks()),
                                                                                             Blocks(blocks())} {}

Vec2i SampleAllocation::pixelOf(size_t block, float u, float v) const {
    const auto along = [](int cell, int cells, int pixels, float at) {
        return std::min(int((float(cell) + at) * float(pixels) / float(cells)), pixels - 1);
    };
    const auto width = size_t(grid_.x);
    return {along(int(block % width), grid_.x, resolution_.x, u), along(int(block / width), grid_.y, resolution_.y, v)};
}

void SampleAllocation::tell(size_t block, double variance, double cost) {
    if (!std::isfinite(variance)) return;
    // By turns, and a block's neighbours the other way round: both halves see all of the image from the first pair on.
    const auto width = size_t(grid_.x);
    const bool odd = (block % width + block / width) % 2 == 1;
    const double first = halves_[0][block].pairs, second = halves_[1][block].pairs;
    Block& told = halves_[first == second ? odd : first > second][block];
    told.variance += variance;
    squares_ += variance * variance;
    told.cost += cost;
    told.pairs += 1.0;
}

auto SampleAllocation::smoothed(const Blocks& told, double pairs) const -> Blocks {
    Blocks smooth(told.size());
    const auto isInside = [](int at, int cells) { return at >= 0 && at < cells; };
    for (int y = 0; y < grid_.y; ++y)
        for (int x = 0; x < grid_.x; ++x) {
            Block sum;
            const auto add = [&](int i, int j) {
                if (!isInside(i, grid_.x) || !isInside(j, grid_.y)) return;
                const Block& near = told[size_t(j) * size_t(grid_.x) + size_t(i)];
                sum = {sum.variance + near.variance, sum.cost + near.cost, sum.pairs + near.pairs};
            };
            // Squares about the block, one ring after the other.
            for (int reach = 0; reach < 2 || (sum.pairs < pairs && reach < std::max(grid_.x, grid_.y)); ++reach)
                for (int j = -reach; j <= reach; ++j)
                    for (int i = -reach; i <= reach; i += std::abs(j) < reach ? 2 * reach : 1) add(x + i, y + j);
            const double of = std::max(sum.pairs, 1.0);
            smooth[size_t(y) * size_t(grid_.x) + size_t(x)] = {sum.variance / of, sum.cost / of, sum.pairs};
        }
    return smooth;
}

auto SampleAllocation::densitiesBy(const Blocks& told, double pairs) const -> Densities {
    const Blocks blocks = smoothed(told, pairs);
    std::vector<double> wanted;
    double cost = 0.0;
    for (const Block& block : blocks) {
        wanted.push_back(block.cost > 0.0 ? std::sqrt(block.variance / block.cost) : 0.0);
        cost += block.cost;
    }
    // 2^k and 3/2 2^k make whole numbers of samples of passes of 8, 16, ..., however samples are cut into them.
    const auto rounded = [](double density) {
        const double octaves = std::log2(std::max(density, 1e-6)), whole = std::floor(octaves), rest = octaves - whole;
        constexpr double Half = 0.5849625007211562; // log2(3/2)
        const double step = rest < 0.5 * Half ? 1.0 : rest < 0.5 * (1.0 + Half) ? 1.5 : 2.0;
        return std::clamp(std::exp2(whole) * step, double(Least), double(Most));
    };
    const auto taken = [&](double scale) {
        double sum = 0.0;
        for (size_t i = 0; i < blocks.size(); ++i) sum += rounded(scale * wanted[i]) * blocks[i].cost;
        return sum;
    };
    const double largest = *std::max_element(wanted.begin(), wanted.end());
    if (!(largest > 0.0)) return {};
    // The scale at which a pass costs what an even one does: `taken` grows with it, in steps.
    double low = 0.0, high = 1.0 / largest;
    while (taken(high) < cost && high < 1e12 / largest) high *= 2.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (taken(middle) < cost ? low : high) = middle;
    }
    const double scale = cost - taken(low) < taken(high) - cost ? low : high;
    Densities densities;
    for (const double density : wanted) densities.push_back(float(rounded(scale * density)));
    return densities;
}

void SampleAllocation::choose() {
    Blocks all = halves_[0];
    for (size_t i = 0; i < all.size(); ++i) {
        const Block& other = halves_[1][i];
        all[i] = {all[i].variance + other.variance, all[i].cost + other.cost, all[i].pairs + other.pairs};
    }
    // Variance x cost, relative to even samples, as the other half of the pairs has it.
    const auto predicted = [](const Densities& densities, const Blocks& judge) {
        double variance = 0.0, cost = 0.0, evenVariance = 0.0, evenCost = 0.0;
        for (size_t i = 0; i < judge.size(); ++i) {
            const double density = densities.empty() ? 1.0 : double(densities[i]);
            variance += judge[i].variance / density;
            cost += judge[i].cost * density;
            evenVariance += judge[i].variance;
            evenCost += judge[i].cost;
        }
        return evenVariance > 0.0 ? variance * cost / (evenVariance * evenCost) : 1.0;
    };
    // Few pairs follow what an image has, many what noise leaves.
    double least = 1.0;
    for (const double pairs : {64.0, 256.0, 1024.0}) {
        const double one = predicted(densitiesBy(halves_[0], 0.5 * pairs), halves_[1]),
                     other = predicted(densitiesBy(halves_[1], 0.5 * pairs), halves_[0]);
        // A single bright path makes one half promise much: what they differ by is how little they know.
        const double doubted = std::max(one, other) + std::abs(one - other);
        if (doubted >= least) continue;
        least = doubted;
        part_ = std::max(one, other);
        densities_ = densitiesBy(all, pairs);
    }
}

SampleAllocation::Block SampleAllocation::total() const {
    Block all;
    for (const Blocks& half : halves_)
        for (const Block& block : half)
            all = {all.variance + block.variance, all.cost + block.cost, all.pairs + block.pairs};
    return all;
}

double SampleAllocation::varianceTimesCostOfEven() const {
    const Block all = total();
    return all.pairs > 0.0 ? all.variance / all.pairs * (all.cost / all.pairs) : 0.0;
}

double SampleAllocation::relativeError() const {
    const double variance = total().variance;
    return variance > 0.0 ? std::sqrt(squares_) / variance : Infinity;
}

auto SampleAllocation::of(int x, int y, uint64_t first, uint32_t count) const -> Samples {
    if (densities_.empty()) return {uint32_t(first), count};
    if (count < FewestSamples) return {uint32_t(first) | EvenSamples, count};
    const auto cell = [](int at, int cells, int pixels) { return int(int64_t(at) * cells / pixels); };
    const size_t block =
        size_t(cell(y, grid_.y, resolution_.y)) * size_t(grid_.x) + size_t(cell(x, grid_.x, resolution_.x));
    const auto density = double(densities_[block]);
    const auto begin = uint64_t(double(first) * density), end = uint64_t(double(first + count) * density);
    return {uint32_t(begin), uint32_t(end - begin)};
}

} // namespace tungsten::path
