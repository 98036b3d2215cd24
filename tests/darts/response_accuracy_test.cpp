// The sensor's response against 50 digits: integrals of linear pieces whose widths and heights span ten orders of
// magnitude, and what connections draw of them.

#include "darts/Guide.h"

#include "support/Exact.h"
#include "support/LogUniform.h"

#include "tungsten/core/Random.h"

namespace darts {
namespace {

using tungsten::RandomStream;
using tungsten::Sampler;
using tungsten::test::Exact;
using tungsten::test::LargestError;
using tungsten::test::logUniform;

/// Linear between values at times.
struct Pieces {
    std::vector<double> times, values;

    /// `grid`: of which the times are multiples, or 0.
    explicit Pieces(uint64_t i, int ends = 8, double grid = 0.0) {
        Sampler s(31, RandomStream::Test, 0, i);
        double time = 10.0 * (s.nextDouble() - 0.5);
        for (int k = 0; k < ends; ++k) {
            times.push_back(grid > 0.0 ? grid * std::round(time / grid) : time);
            values.push_back(s.next1D() < 0.3f ? 0.0 : logUniform(s, 1e-5, 1e5));
            time += grid + logUniform(s, 1e-4, 1.0);
        }
        values[size_t(ends / 2)] = 1.0;
    }
    [[nodiscard]] TemporalResponse response() const { return TemporalResponse::tabulated(times, values); }
    [[nodiscard]] Exact at(const Exact& time) const {
        for (size_t k = 0; k + 1 < times.size(); ++k)
            if (time >= times[k] && time < times[k + 1])
                return values[k] +
                       (Exact(values[k + 1]) - values[k]) * (time - times[k]) / (Exact(times[k + 1]) - times[k]);
        return 0;
    }
    /// From the first time on.
    [[nodiscard]] Exact integral(const Exact& until) const {
        Exact sum = 0;
        for (size_t k = 0; k + 1 < times.size() && until > times[k]; ++k) {
            const Exact end = until < times[k + 1] ? until : Exact(times[k + 1]);
            const Exact last = until < times[k + 1] ? at(until) : Exact(values[k + 1]);
            sum += (values[k] + last) / 2 * (end - times[k]);
        }
        return sum;
    }
    [[nodiscard]] Exact total() const { return integral(times.back()); }
    [[nodiscard]] Exact peak() const { return *std::max_element(values.begin(), values.end()); }
};

TEST(ResponseAccuracy, DensitiesIntegralsAndTheirInverse) {
    LargestError pdf("pdf"), distribution("distribution"), quantile("quantile");
    for (uint64_t i = 0; i < 200; ++i) {
        const Pieces pieces(i);
        const TemporalResponse response = pieces.response();
        const Exact total = pieces.total();
        Sampler s(32, RandomStream::Test, 0, i);
        for (int k = 0; k < 20; ++k) {
            const double u = k < 2 ? double(k) : s.nextDouble(), time = response.quantile(u);
            // Times are doubles, beside which density may be high.
            quantile.add(double(pieces.integral(time) / total), u, 1 + pieces.peak() / total * std::abs(time));
            pdf.add(response.pdf(time), pieces.at(time) / total, pieces.peak() / total);
            const double any = response.begin() + s.nextDouble() * (response.end() - response.begin());
            pdf.add(response.pdf(any), pieces.at(any) / total, pieces.peak() / total);
            distribution.add(response.distribution(any), pieces.integral(any) / total, Exact(1));
        }
    }
    EXPECT_TRUE(pdf.within(1e-15));
    EXPECT_TRUE(distribution.within(1e-15));
    EXPECT_TRUE(quantile.within(4e-16));
}

/// The sum over pieces of one and shifted pieces of the other, each a parabola, by Simpson's rule.
Exact convolution(const Pieces& a, const Pieces& b, const Exact& time) {
    std::vector<Exact> ends;
    for (const double t : a.times) ends.push_back(t);
    for (const double t : b.times) ends.push_back(time - t);
    std::sort(ends.begin(), ends.end());
    Exact sum = 0;
    for (size_t k = 0; k + 1 < ends.size(); ++k) {
        const Exact width = ends[k + 1] - ends[k];
        if (!(width > 0)) continue;
        // Just inside the ends, where steps have not happened yet.
        const auto f = [&](const Exact& share) {
            const Exact s = ends[k] + share * width;
            return a.at(s) * b.at(time - s);
        };
        const Exact edge = Exact(1e-30), middle = Exact(1) / 2;
        sum += width * (f(edge) + 4 * f(middle) + f(1 - edge)) / 6;
    }
    return sum / (a.total() * b.total());
}

TEST(ResponseAccuracy, Convolutions) {
    LargestError pdf("convolved");
    constexpr double Grid = 1.0 / 16.0; // bends that are closer to each other may be left out
    for (uint64_t i = 0; i < 60; ++i) {
        const Pieces a(2 * i + 1000, 4, Grid), b(2 * i + 1001, 4, Grid);
        const TemporalResponse both = TemporalResponse::convolved(a.response(), b.response());
        // Where pieces meet it is exact but for the normalisation, of what is linear between.
        std::vector<Exact> found, exact;
        Exact peak = 0, sums[2] = {0, 0};
        for (const double s : a.times)
            for (const double t : b.times) {
                const Exact value = convolution(a, b, s + t);
                if (s + t >= both.end()) continue;
                found.push_back(both.pdf(s + t));
                exact.push_back(value);
                peak = std::max(peak, value);
                sums[0] += found.back();
                sums[1] += value;
            }
        for (size_t k = 0; k < found.size(); ++k)
            pdf.add(double(found[k] / sums[0]), exact[k] / sums[1], peak / sums[1]);
    }
    EXPECT_TRUE(pdf.within(7e-15));
}

TEST(ResponseAccuracy, GaussiansAtTheirPieces) {
    LargestError pdf("gaussian");
    for (const double sigma : {1e-6, 0.3, 1e4}) {
        const TemporalResponse response = TemporalResponse::gaussian(3.0, sigma);
        Exact total = 0;
        const auto x = [](int i) { return Exact(i) / 8 - 4; };
        const auto value = [&](int i) { return Exact(exp(-x(i) * x(i) / 2)); };
        for (int i = 0; i < 64; ++i) total += (value(i) + value(i + 1)) / 16;
        for (int i = 0; i < 64; ++i)
            for (const Exact& part : {Exact(0.25), Exact(0.75)}) {
                const double time = 3.0 + sigma * double(x(i) + part / 8);
                const Exact exact = (value(i) * (1 - part) + value(i + 1) * part) / total / sigma;
                // Times have the rounding of the centre.
                pdf.add(response.pdf(time), exact, (1 + Exact(3.0) / sigma) / total / sigma);
            }
    }
    EXPECT_TRUE(pdf.within(1e-15));
}

/// Connections of a length by the response: at the time that the length stands for.
TEST(ResponseAccuracy, ConnectionsThatFollowIt) {
    LargestError inverse("inverse_pdf"), inverted("inverted");
    const Guide guide(best(Mode::Path, 0.0f), Medium{{0, 0, 0}, {1, 1, 1}, 0.0f});
    for (uint64_t i = 0; i < 1500; ++i) {
        const Pieces pieces(i, 8, 1.0 / 16.0); // excess lengths are floats, which know narrower ones badly
        const TemporalResponse response = pieces.response();
        Sampler s(33, RandomStream::Test, 0, i);
        const double speed = logUniform(s, 0.1, 10.0), elapsed = response.begin() - s.nextDouble();
        const LengthInterval range = LengthInterval::of({response.begin(), response.end()}, elapsed, speed);
        const TimeBudget budget = TimeBudget::of({0, 0, float(range.high * s.nextDouble())}, range);
        if (!budget.alive()) continue;
        const float u = s.next1D();
        const ConnectionSample connection = guide.sampleConnection(budget, u, {&response, elapsed, speed});
        if (!(connection.inversePdf > 0.0f)) continue;
        const Exact begin = elapsed + Exact(budget.shortest) / speed;
        const Exact time = begin + (Exact(connection.excess) - budget.low) / speed;
        const Exact low = pieces.integral(begin), high = pieces.integral(begin + Exact(budget.width) / speed);
        inverted.add(double((pieces.integral(time) - low) / pieces.total()), u * (high - low) / pieces.total(),
                     Exact(1));
        inverse.add(double(pieces.at(time) / (speed * (high - low))), 1 / Exact(connection.inversePdf),
                    pieces.peak() / (speed * (high - low)));
    }
    EXPECT_TRUE(inverse.within(5e-6));
    EXPECT_TRUE(inverted.within(3e-6));
}

} // namespace
} // namespace darts
