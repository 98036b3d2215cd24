#include "tungsten/scene/LoadTimeProfile.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

namespace tungsten {

namespace {

/// Points of a shape, as values over x from `from` to `to`.
TimeProfile pointsOf(double (*shape)(double), double from, double to, int points, double origin, double unit) {
    TimeProfile profile;
    for (int i = 0; i < points; ++i) {
        const double x = from + (to - from) * i / (points - 1);
        profile.times.push_back(origin + x * unit);
        profile.values.push_back(shape(x));
    }
    return profile;
}

/// Which field keeps (times, values) from being a density, and why; the message is empty if they are one.
struct ProfileProblem {
    std::string field, message;
};
ProfileProblem problemOf(const TimeProfile& profile) {
    const std::vector<double>&times = profile.times, &values = profile.values;
    if (times.size() < 2 || times.size() != values.size())
        return {"times", "expected as many values as times, at least two; found " + std::to_string(times.size()) +
                             " times and " + std::to_string(values.size()) + " values"};
    const auto earlier = std::adjacent_find(times.begin(), times.end(), std::greater_equal<>());
    if (earlier != times.end())
        return {"times", "expected increasing times, found " + brief(earlier[0]) + " before " + brief(earlier[1])};
    const auto negative = std::find_if(values.begin(), values.end(), [](double v) { return v < 0.0; });
    if (negative != values.end()) return {"values", "expected no negative value, found " + brief(*negative)};
    if (std::all_of(values.begin(), values.end(), [](double v) { return v == 0.0; }))
        return {"values", "zero at all times"};
    return {};
}

/// How long it lasts is the scene's to say: no unit of time suits all. `instead` where that is missing.
double width(const ObjectReader& block, const std::string& field, const Meaning& meaning, Range range,
             double instead = 1.0) {
    if (!block.has(field) && !block.describes()) block.problem(field, "missing, expected " + describe(range));
    return block.number(field, instead, meaning, range);
}

/// What fields of other names and types are here.
const std::map<std::string, std::string>& hints() {
    static const std::map<std::string, std::string> known{{"fwhm", "a gaussian's sigma is fwhm / 2.3548"},
                                                          {"width", "a gaussian's sigma is its full width at half "
                                                                    "maximum / 2.3548, a box's end is start + width"},
                                                          {"duration", "a box's end is start + duration"},
                                                          {"stddev", "a gaussian's sigma is meant"},
                                                          {"std", "a gaussian's sigma is meant"},
                                                          {"mean", "a gaussian's center is meant"},
                                                          {"mu", "a gaussian's center is meant"},
                                                          {"tau", "an exponential's decay is meant"},
                                                          {"lifetime", "an exponential's decay is meant"},
                                                          {"half_life", "an exponential's decay is half_life / 0.6931"},
                                                          {"center", "that takes the type gaussian"},
                                                          {"sigma", "that takes the type gaussian"},
                                                          {"start", "that takes the type box or exponential"},
                                                          {"end", "that takes the type box"},
                                                          {"decay", "that takes the type exponential"},
                                                          {"times", "that takes the type tabulated"},
                                                          {"values", "that takes the type tabulated"}};
    return known;
}

TimeProfile readShape(const ObjectReader& block, const std::string& type) {
    TimeProfile profile;
    if (type == "tabulated" || block.describes()) {
        profile.times = block.numbers("times", {"time", "tabulated: increasing; the density is linear between them"},
                                      Range::measure());
        profile.values = block.numbers("values", {"none", "tabulated: the density at each of the times, in any scale"});
    }
    if (type == "gaussian" || block.describes()) {
        const double centre = block.number("center", 0.0, {"time", "gaussian: where it is largest"}, Range::measure());
        const double sigma = width(block, "sigma", {"time", "gaussian: standard deviation, cut at four", "required"},
                                   Range::positiveMeasure());
        constexpr double Reach = 4.0; // standard deviations
        profile = pointsOf([](double x) { return std::exp(-0.5 * x * x); }, -Reach, Reach, 65, centre, sigma);
    }
    if (type == "box" || type == "exponential" || block.describes()) {
        const double start =
            block.number("start", 0.0, {"time", "box and exponential: when it begins"}, Range::measure());
        if (type == "exponential" || block.describes()) {
            const double decay = width(
                block, "decay", {"time", "exponential: until it has fallen to 1 / e; cut at 16 of these", "required"},
                Range::positiveMeasure());
            profile = pointsOf([](double x) { return std::exp(-x); }, 0.0, 16.0, 257, start, decay);
        }
        if (type == "box" || block.describes())
            profile = {
                {start, width(block, "end", {"time", "box: when it ends", "required"}, Range::measure(), start + 1.0)},
                {1.0, 1.0}};
    }
    return profile;
}

} // namespace

TimeProfile readTimeProfile(const ObjectReader& reader, const std::string& field, const Meaning& meaning) {
    const auto block = reader.block(field, meaning);
    if (!block) return {};
    const auto problems = [&] { return reader.diagnostics()->problems.size() + reader.diagnostics()->moreProblems; };
    const size_t before = problems();
    const std::string type = block->choice("type", "tabulated", {"box", "exponential", "gaussian", "tabulated"},
                                           {"none", "shape of the density over time, whose integral counts as 1"});
    TimeProfile profile = readShape(*block, type);
    const bool read = problems() == before; // else its numbers are not those of the scene
    const auto [where, problem] = read ? problemOf(profile) : ProfileProblem{};
    if (!problem.empty()) block->problem(type == "box" ? "end" : where, problem);
    block->refuseUnknown(hints());
    return read && problem.empty() ? profile : TimeProfile{};
}

} // namespace tungsten
