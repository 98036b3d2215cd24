#include "transport/SharePilot.h"

#include "transport/Tuning.h"

#include <unordered_map>

namespace tungsten::transport {

StrategyBalance PathCosts::ofTime(double plainTime) const {
    if (plainTime >= 1.0) return {1.0f, 0.0f};
    const double ofPlain = plainTime / (plain + densities), ofGuided = (1.0 - plainTime) / guided;
    const auto share = float(ofPlain / (ofPlain + ofGuided));
    return {share, 1.0f - share};
}

double PathCosts::mean(const StrategyBalance& balance) const {
    if (balance.guided == 0.0f) return shared + plain;
    return shared + double(balance.plain) * (plain + densities) + double(balance.guided) * guided;
}

double SharePilot::weighed(const Contribution& contribution, Strategy strategy, const StrategyBalance& balance) const {
    const auto value = double(contribution.value);
    if (balance.guided == 0.0f) {
        const double ofPlain = value * double(contribution.logRatio.aloneOverBeside);
        if (strategy == Strategy::Plain) return ofPlain;
        return ofPlain * std::exp(std::min(double(contribution.logRatio.plainToEstimate), 80.0));
    }
    return value * double(balance.weight(strategy, contribution.logRatio.weighed));
}

double SharePilot::pairsOfLast() const {
    if (paths_.empty()) return 0.0;
    std::unordered_map<int, double> frames;
    double pairs = 0.0;
    for (size_t k = paths_.back().first; k < found_.size(); ++k) {
        const double value = double(found_[k].value);
        double& before = frames[found_[k].frame];
        pairs += 2.0 * before * value;
        before += value;
    }
    return pairs;
}

void SharePilot::tellPairsOfAlone(double pairs) {
    if (paths_.empty()) return;
    alone_.resize((paths_.size() - 1) / PathsOfPixel + 1);
    alone_.back().sum += pairs;
    ++alone_.back().paths;
}

double SharePilot::effective(Strategy strategy) const {
    double sum = 0.0, squares = 0.0;
    for (size_t i = 0; i < paths_.size(); ++i) {
        if (strategy != Strategy::Alone && paths_[i].strategy != strategy) continue;
        for (size_t k = paths_[i].first; k < end(i); ++k) {
            const double value = weighed(found_[k], paths_[i].strategy, Halves);
            sum += value;
            squares += value * value;
        }
    }
    return squares > 0.0 ? sum * sum / squares : 0.0;
}

/// Second moments at other shares, from contributions c at the pilot's own: E[sum c_k c'_k + 2 sum_(j<k) c_k c'_j],
/// where c' are those at the shares in question, since pairs on one way are found as densely as the longer path, by
/// plain paths alone as well where they find alike. What guided paths find beside their way they find in pairs alone.
/// Less the squares of means, by independent halves.
auto SharePilot::momentsByPixel(const StrategyBalance& balance) const -> std::vector<Moments> {
    struct Before {
        double onWay = 0.0, aside = 0.0; ///< of what the path has found in this frame
    };
    std::unordered_map<int, Before> before;
    std::unordered_map<int, std::array<double, 2>> halves;
    std::vector<Moments> moments(paths_.size() / PathsOfPixel);
    const double guidedFactor = double(balance.guided) / double(Halves.guided);
    for (size_t i = 0; i < moments.size() * PathsOfPixel; ++i) {
        const Strategy strategy = paths_[i].strategy;
        const size_t place = i / PathsOfPixel;
        Moments& pixel = moments[place];
        const Pairs* const alone = place < alone_.size() && alone_[place].paths > 0 ? &alone_[place] : nullptr;
        before.clear();
        if (i % PathsOfPixel == 0) halves.clear();
        for (size_t k = paths_[i].first; k < end(i); ++k) {
            const double share = balance.guided == 0.0f ? double(found_[k].logRatio.aloneOverBeside) : 1.0;
            const double here = weighed(found_[k], strategy, Halves), there = weighed(found_[k], strategy, balance);
            Before& frame = before[found_[k].frame];
            double inPairs = share * here;
            if (balance.guided == 0.0f && (alone || plainInPairs_))
                inPairs = !alone && strategy == Strategy::Plain ? there / double(Halves.plain) : 0.0;
            pixel.second += share * here * there + 2.0 * inPairs * frame.onWay + 2.0 * there * frame.aside;
            if (found_[k].found == Found::OnWay)
                frame.onWay += there;
            else
                frame.aside += there * guidedFactor;
            halves[found_[k].frame][(i % PathsOfPixel) / 2] += 0.5 * here;
        }
        if (i % PathsOfPixel < PathsOfPixel - 1) continue;
        if (balance.guided == 0.0f && alone) pixel.second += double(PathsOfPixel) * alone->sum / double(alone->paths);
        for (const auto& [frame, half] : halves) pixel.squaredMean += half[0] * half[1] * double(PathsOfPixel);
    }
    return moments;
}

auto SharePilot::moments(const StrategyBalance& balance) const -> Moments {
    Moments mean{};
    const std::vector<Moments> pixels = momentsByPixel(balance);
    const double paths = std::max(double(pixels.size() * PathsOfPixel), 1.0);
    for (const Moments& pixel : pixels) {
        mean.second += pixel.second / paths;
        mean.squaredMean += pixel.squaredMean / paths;
    }
    return mean;
}

double SharePilot::variance(const StrategyBalance& balance) const {
    const auto [second, squaredMean] = moments(balance);
    return std::max(second - squaredMean, 0.01 * second);
}

double SharePilot::ownSecondMoment(Strategy strategy) const {
    std::unordered_map<int, double> frames;
    double squares = 0.0, paths = 0.0;
    for (size_t i = 0; i < paths_.size(); ++i) {
        if (paths_[i].strategy != strategy) continue;
        paths += 1.0;
        frames.clear();
        for (size_t k = paths_[i].first; k < end(i); ++k) frames[found_[k].frame] += double(found_[k].value);
        for (const auto& [frame, sum] : frames) squares += sum * sum;
    }
    return paths > 0.0 ? squares / paths : 0.0;
}

bool SharePilot::isSure(const PathCosts& costs) const {
    constexpr double Errors = 2.0;
    const auto times = [&](double time) { return costs.ofTime(time); };
    const StrategyBalance most = times(Times.front()), least = times(Times.back());
    const std::vector<Moments> ofMost = momentsByPixel(most), ofLeast = momentsByPixel(least);
    double sum = 0.0, squares = 0.0;
    for (size_t i = 0; i < ofMost.size(); ++i) {
        const double difference = (ofMost[i].second - ofMost[i].squaredMean) * costs.mean(most) -
                                  (ofLeast[i].second - ofLeast[i].squaredMean) * costs.mean(least);
        sum += difference;
        squares += difference * difference;
    }
    return sum * sum > Errors * Errors * (squares - sum * sum / double(ofMost.size()));
}

double SharePilot::choose(const std::function<double(double)>& score) const {
    constexpr double Half = 0.5;
    if (effective(Strategy::Alone) < tuning::LeastEffective) return Half;
    double best = Half, least = score(Half);
    for (const double time : Times) {
        if (time == Half) continue;
        if (const double other = score(time); other < least) {
            least = other;
            best = time;
        }
    }
    return best;
}

} // namespace tungsten::transport
