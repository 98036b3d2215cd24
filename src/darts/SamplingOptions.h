#pragma once
// Which of the library's switches a scene sets, and reading them from any block of named fields.

#include "darts/Settings.h"
#include "darts/Switches.h"

namespace darts {

/// A preset, the paper's two flags, and single switches that override the preset.
struct SamplingOptions {
    bool on = false;           ///< anything is guided
    bool published = false;    ///< the paper's preset instead of ours
    bool guideDistance = true; ///< `enable_guiding`
    bool elliptical = true;    ///< `enable_elliptical`
    bool everyMedium = false;  ///< media are guided whether or not they ask for it

    std::optional<Direction> direction;
    std::optional<Greens> greens;
    std::optional<Proposals> proposals;
    std::optional<int> candidates;
    std::optional<float> alpha, roulette;
    std::optional<bool> bounded, lengthFirst;

    /// Settings for a medium of mean cosine g; `asksDistance` and `asksDirection` are the medium's own wishes (type
    /// guided_homo; phase function ida).
    [[nodiscard]] Settings settings(Mode mode, float g, bool asksDistance, bool asksDirection) const {
        Settings s = published ? darts::published(mode) : best(mode, g);
        if (published && !asksDirection) s.direction = Direction::Phase;
        if (!guideDistance || !(asksDistance || everyMedium)) {
            s = plainFlights(s);
            s.bounded = false;
        }
        const auto set = [](auto& field, const auto& value) {
            if (value) field = *value;
        };
        set(s.direction, direction);
        set(s.greens, greens);
        set(s.proposals, proposals);
        set(s.candidates, candidates);
        set(s.alpha, alpha);
        set(s.roulette, roulette);
        set(s.rouletteOut, roulette);
        set(s.bounded, bounded);
        set(s.lengthFirst, lengthFirst);
        return s;
    }
};

namespace detail {

template <typename Block>
std::optional<int> candidateCount(const Block& block) {
    constexpr const char* Text = "published: distances among which one is resampled";
    block.declare("candidates", "1, 4, 8 or 16", "", {"none", Text, switches::ByPreset});
    if (!block.has("candidates")) return std::nullopt;
    const auto count = block.integer("candidates", 8, {"none", Text});
    if (count == 1 || count == 4 || count == 8 || count == 16) return int(count);
    block.problem("candidates", "expected 1, 4, 8 or 16, found " + std::to_string(count));
    return std::nullopt;
}

template <typename Block>
void readDistances(const Block& block, SamplingOptions& options) {
    options.guideDistance =
        block.choice("distance", "guided", {"guided", "plain"},
                     {"none", "distances by the light still to arrive from there, or plain free flights"}) ==
            "guided" &&
        options.guideDistance;
    options.greens = switches::named<Greens>(
        block, "greens_function", "the light still to arrive from there, which shapes distances",
        {{"none", Greens::None}, {"diffusion", Greens::Diffusion}, {"causal", Greens::Causal}});
    options.proposals = switches::named<Proposals>(block, "proposals", "published: where candidates come from",
                                                   {{"exponential", Proposals::Exponential},
                                                    {"mixed", Proposals::MixedUniform},
                                                    {"mixed_quarter", Proposals::MixedQuarter},
                                                    {"equiangular", Proposals::Equiangular}});
    options.candidates = candidateCount(block);
    options.bounded = switches::flag(block, "bounded", "distances end where no path can be in time any more");
}

template <typename Block>
void readDirections(const Block& block, SamplingOptions& options) {
    options.direction =
        switches::named<Direction>(block, "direction",
                                   "phase function alone; with the paper's table; with the connection's lobe in "
                                   "closed form; or (published) resampled from phase function and lobe",
                                   {{"phase", Direction::Phase},
                                    {"eda", Direction::Eda},
                                    {"connection", Direction::Connection},
                                    {"ris", Direction::Ris}});
    options.alpha = switches::fraction(block, "alpha", "weight of the phase function against the guide", 1e6);
    options.lengthFirst = switches::flag(block, "length_first",
                                         "published: a connection's length is drawn before the direction, shaping it");
}

/// What shapes resampling has no effect where densities are known.
template <typename Block>
void ignoreWithBest(const Block& block, SamplingOptions& options) {
    const auto ignore = [&](auto& value, const char* field, const std::string& what, const char* drawn) {
        if (!value) return;
        value.reset();
        block.warn(field, what + "has no effect with the preset best, whose " + drawn +
                              " have a density that is known: set \"preset\": \"published\"");
    };
    ignore(options.candidates, "candidates", "", "distances");
    ignore(options.proposals, "proposals", "", "distances");
    if (options.direction == Direction::Ris) ignore(options.direction, "direction", "ris ", "directions");
    if (options.lengthFirst == true) ignore(options.lengthFirst, "length_first", "true ", "directions");
}

template <typename Block>
void readSwitches(const Block& block, SamplingOptions& options) {
    options.published = block.choice("preset", "best", {"best", "published"},
                                     {"none", "what the switches below stand on"}) == "published";
    readDistances(block, options);
    readDirections(block, options);
    options.roulette = switches::fraction(
        block, "roulette", "part of their first expected contribution below which walks end at random; 0: never", 1.0);
    if (!options.published) ignoreWithBest(block, options);
}

} // namespace detail

/// Reads `darts` ("best", "published", "off", or an object of switches), `enable_guiding` and `enable_elliptical` from
/// an integrator's block (see Switches.h). Where `darts` is given, both flags default to true and every medium is
/// guided. `readMore(block)` reads switches of the renderer's own from the object.
template <typename Block, typename ReadMore>
SamplingOptions readSamplingOptions(const Block& block, const ReadMore& readMore) {
    constexpr const char* WithDarts = "true where `darts` is given";
    constexpr const char *Text = "a preset, or switches over one; the paper's is published",
                         *Without = "the two flags decide";
    SamplingOptions options;
    options.everyMedium = block.has("darts");
    options.guideDistance =
        block.flag("enable_guiding", options.everyMedium, {"none", "distances in media are guided (DARTS)", WithDarts});
    options.elliptical = block.flag("enable_elliptical", options.everyMedium,
                                    {"none", "control vertices make paths arrive in time (DARTS)", WithDarts});
    options.on = options.guideDistance || options.elliptical;
    if (!block.isObject("darts")) {
        const std::string preset = block.choice("darts", "", {"best", "published", "off"}, {"none", Text, Without});
        options.published = preset == "published";
        options.on = options.on && preset != "off";
    }
    if (block.isObject("darts") || block.describes()) {
        const auto object = block.block("darts", {"none", Text, Without});
        detail::readSwitches(*object, options);
        readMore(*object);
        object->refuseUnknown();
    }
    return options;
}
template <typename Block>
SamplingOptions readSamplingOptions(const Block& block) {
    return readSamplingOptions(block, [](const Block&) {});
}

} // namespace darts
