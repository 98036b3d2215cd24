#pragma once
// Which of the library's switches a scene sets, and reading them from any block of named fields.

#include "darts/Settings.h"

#include <iomanip>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace darts {

/// Whether the target is always seen along one straight line: then control vertices alone are complete.
enum class DirectView { Auto, On, Off };

/// A preset, the paper's two flags, and single switches that override the preset.
struct Scheme {
    bool on = false;           ///< anything is guided
    bool published = false;    ///< the paper's preset instead of ours
    bool guideDistance = true; ///< `enable_guiding`
    bool elliptical = true;    ///< `enable_elliptical`
    bool everyMedium = false;  ///< media are guided whether or not they ask for it
    DirectView directView = DirectView::Auto;
    /// Light paths also connect their vertices to visible surfaces, camera paths theirs to surfaces that light reaches
    /// first; by default not in the paper's preset.
    std::optional<bool> surfaceConnections;
    [[nodiscard]] bool connectsSurfaces() const { return surfaceConnections.value_or(!published); }
    /// Sensor paths of a photon map go on along the lobes of glossy surfaces, as they do along mirrors; by default not
    /// in the paper's preset.
    std::optional<bool> glossySensorPaths;
    [[nodiscard]] bool followsGlossy() const { return on && glossySensorPaths.value_or(!published); }

    /// Every light path of a photon map aims at one frame of a sequence, by default in the paper's preset alone:
    /// otherwise at all of them as one gate, since a path that aims at one of n leaves nothing in the others.
    std::optional<bool> singleFrames;
    [[nodiscard]] bool aimsAtSingleFrames() const { return singleFrames.value_or(published); }

    /// Bodies of media end where their boundaries are, for sampling too; otherwise every medium is taken for infinite,
    /// as by default in the paper's preset.
    std::optional<bool> bodies;
    [[nodiscard]] bool followsBodies() const { return on && bodies.value_or(!published); }

    std::optional<Direction> direction;
    std::optional<Greens> greens;
    std::optional<Proposals> proposals;
    std::optional<int> candidates;
    std::optional<float> alpha, focus, roulette, floor;
    std::optional<bool> bounded, lengthFirst, overlap, guideEmission;

    /// Settings for a medium of mean cosine g; `asksDistance` and `asksDirection` are the medium's own wishes (type
    /// guided_homo; phase function ida).
    [[nodiscard]] Settings settings(Mode mode, float g, bool asksDistance, bool asksDirection) const {
        Settings s = published ? darts::published(mode) : best(mode, g);
        if (published && !asksDirection) s.direction = Direction::Phase;
        if (!guideDistance || !(asksDistance || everyMedium)) {
            s = plainFlights(s);
            s.bounded = false;
        }
        s.elliptical = elliptical;
        const auto set = [](auto& field, const auto& value) {
            if (value) field = *value;
        };
        set(s.direction, direction);
        set(s.greens, greens);
        set(s.proposals, proposals);
        if (proposals) s.mixDenseOnly = false;
        set(s.candidates, candidates);
        set(s.alpha, alpha);
        set(s.focus, focus);
        set(s.thinFocus, focus);
        set(s.roulette, roulette);
        set(s.floor, floor);
        set(s.bounded, bounded);
        set(s.lengthFirst, lengthFirst);
        set(s.overlap, overlap);
        set(s.guideEmission, guideEmission);
        return s;
    }
};

namespace detail {

/// A field whose value names an enumerator; none when absent.
template <typename Enum, typename Block>
std::optional<Enum> named(const Block& block, const char* field,
                          const std::vector<std::pair<std::string, Enum>>& names) {
    if (!block.has(field)) return std::nullopt;
    std::vector<std::string> accepted;
    for (const auto& [name, value] : names) accepted.push_back(name);
    const std::string chosen = block.choice(field, accepted.front(), accepted);
    for (const auto& [name, value] : names)
        if (name == chosen) return value;
    return std::nullopt;
}

template <typename Block>
std::optional<float> fraction(const Block& block, const char* field, double most) {
    if (!block.has(field)) return std::nullopt;
    const double value = block.number(field, 0.0);
    if (value >= 0.0 && value <= most) return float(value);
    std::ostringstream accepted; // 0.05, 1000000: no zeros, no exponent
    accepted << std::setprecision(10) << most;
    block.problem(field, "expected a number from 0 to " + accepted.str());
    return std::nullopt;
}

template <typename Block>
std::optional<bool> flag(const Block& block, const char* field) {
    if (!block.has(field)) return std::nullopt;
    return block.flag(field, false);
}

template <typename Block>
void readSwitches(const Block& block, Scheme& scheme) {
    scheme.published = block.choice("preset", "best", {"best", "published"}) == "published";
    scheme.directView =
        named<DirectView>(block, "direct_view",
                          {{"auto", DirectView::Auto}, {"on", DirectView::On}, {"off", DirectView::Off}})
            .value_or(DirectView::Auto);
    scheme.guideDistance = block.choice("distance", "guided", {"guided", "plain"}) == "guided" && scheme.guideDistance;
    scheme.direction = named<Direction>(block, "direction",
                                        {{"phase", Direction::Phase},
                                         {"eda", Direction::Eda},
                                         {"connection", Direction::Connection},
                                         {"ris", Direction::Ris}});
    scheme.greens =
        named<Greens>(block, "greens_function",
                      {{"none", Greens::None}, {"diffusion", Greens::Diffusion}, {"causal", Greens::Causal}});
    scheme.proposals = named<Proposals>(block, "proposals",
                                        {{"exponential", Proposals::Exponential},
                                         {"mixed", Proposals::MixedUniform},
                                         {"mixed_quarter", Proposals::MixedQuarter},
                                         {"equiangular", Proposals::Equiangular}});
    if (block.has("candidates")) {
        const auto count = block.integer("candidates", 8);
        if (count == 1 || count == 4 || count == 8 || count == 16)
            scheme.candidates = int(count);
        else
            block.problem("candidates", "expected 1, 4, 8 or 16, found " + std::to_string(count));
    }
    scheme.alpha = fraction(block, "alpha", 1e6);
    scheme.focus = fraction(block, "focus", 1.0);
    scheme.roulette = fraction(block, "roulette", 1.0);
    scheme.floor = fraction(block, "floor", 0.05);
    scheme.bounded = flag(block, "bounded");
    scheme.lengthFirst = flag(block, "length_first");
    scheme.overlap = flag(block, "overlap");
    scheme.guideEmission = flag(block, "guide_emission");
    scheme.surfaceConnections = flag(block, "surface_connections");
    scheme.glossySensorPaths = flag(block, "glossy_sensor_paths");
    scheme.singleFrames = flag(block, "single_frames");
    scheme.bodies = flag(block, "bodies");
}

} // namespace detail

/// Reads `darts` ("best", "published", "off", or an object of switches), `enable_guiding` and `enable_elliptical` from
/// an integrator's block. A `Block` has has, flag, number, integer, choice, isObject, object and problem, each by field
/// name. Where `darts` is given, both flags default to true and every medium is guided.
template <typename Block>
Scheme readScheme(const Block& block) {
    Scheme scheme;
    scheme.everyMedium = block.has("darts");
    scheme.guideDistance = block.flag("enable_guiding", scheme.everyMedium);
    scheme.elliptical = block.flag("enable_elliptical", scheme.everyMedium);
    scheme.on = scheme.guideDistance || scheme.elliptical;
    if (!scheme.everyMedium) return scheme;
    if (block.isObject("darts")) {
        const auto switches = block.object("darts");
        detail::readSwitches(*switches, scheme);
        switches->warnAboutUnknown();
    } else {
        const std::string preset = block.choice("darts", "best", {"best", "published", "off"});
        scheme.published = preset == "published";
        scheme.on = scheme.on && preset != "off";
    }
    return scheme;
}

} // namespace darts
