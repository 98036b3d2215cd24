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

/// The default of switches that the preset sets.
inline constexpr const char* ByPreset = "the preset's";

/// A field whose value names an enumerator; none when absent.
template <typename Enum, typename Block>
std::optional<Enum> named(const Block& block, const char* field, const char* meaning,
                          const std::vector<std::pair<std::string, Enum>>& names, const char* otherwise = ByPreset) {
    std::vector<std::string> accepted;
    for (const auto& [name, value] : names) accepted.push_back(name);
    const std::string chosen = block.choice(field, accepted.front(), accepted, {"none", meaning, otherwise});
    if (!block.has(field)) return std::nullopt;
    for (const auto& [name, value] : names)
        if (name == chosen) return value;
    return std::nullopt;
}

template <typename Block>
std::optional<float> fraction(const Block& block, const char* field, const char* meaning, double most) {
    std::ostringstream accepted; // 0.05, 1000000: no zeros, no exponent
    accepted << "a number from 0 to " << std::setprecision(10) << most;
    block.declare(field, accepted.str(), "", {"none", meaning, ByPreset});
    if (!block.has(field)) return std::nullopt;
    const double value = block.number(field, 0.0, {"none", meaning});
    if (value >= 0.0 && value <= most) return float(value);
    block.problem(field, "expected " + accepted.str());
    return std::nullopt;
}

template <typename Block>
std::optional<bool> flag(const Block& block, const char* field, const char* meaning, const char* otherwise = ByPreset) {
    const bool value = block.flag(field, false, {"none", meaning, otherwise});
    return block.has(field) ? std::optional<bool>(value) : std::nullopt;
}

template <typename Block>
std::optional<int> candidateCount(const Block& block) {
    constexpr const char* Text = "distances among which one is resampled";
    block.declare("candidates", "1, 4, 8 or 16", "", {"none", Text, ByPreset});
    if (!block.has("candidates")) return std::nullopt;
    const auto count = block.integer("candidates", 8, {"none", Text});
    if (count == 1 || count == 4 || count == 8 || count == 16) return int(count);
    block.problem("candidates", "expected 1, 4, 8 or 16, found " + std::to_string(count));
    return std::nullopt;
}

template <typename Block>
void readDistances(const Block& block, Scheme& scheme) {
    scheme.guideDistance =
        block.choice("distance", "guided", {"guided", "plain"},
                     {"none", "distances are resampled from candidates, or plain free flights"}) == "guided" &&
        scheme.guideDistance;
    scheme.greens =
        named<Greens>(block, "greens_function", "what candidates are weighed by: the light still to arrive from there",
                      {{"none", Greens::None}, {"diffusion", Greens::Diffusion}, {"causal", Greens::Causal}});
    scheme.proposals = named<Proposals>(block, "proposals", "where candidates come from",
                                        {{"exponential", Proposals::Exponential},
                                         {"mixed", Proposals::MixedUniform},
                                         {"mixed_quarter", Proposals::MixedQuarter},
                                         {"equiangular", Proposals::Equiangular}});
    scheme.candidates = candidateCount(block);
    scheme.floor = fraction(block, "floor", "added to the weight of candidates, relative to their mean", 0.05);
    scheme.bounded = flag(block, "bounded", "candidates end where no path can be in time any more");
    scheme.overlap = flag(block, "overlap", "candidates are weighed by the part of the gate still in reach, too");
}

template <typename Block>
void readDirections(const Block& block, Scheme& scheme) {
    scheme.direction = named<Direction>(block, "direction",
                                        "phase function alone; with the paper's table; with the connection's lobe in "
                                        "closed form; or resampled from phase function and lobe",
                                        {{"phase", Direction::Phase},
                                         {"eda", Direction::Eda},
                                         {"connection", Direction::Connection},
                                         {"ris", Direction::Ris}});
    scheme.alpha = fraction(block, "alpha", "weight of the phase function against the guide", 1e6);
    scheme.focus = fraction(block, "focus", "least share of guided directions drawn from the camera's view", 1.0);
    scheme.lengthFirst = flag(block, "length_first", "a connection's length is drawn before the direction, shaping it");
    scheme.guideEmission = flag(block, "guide_emission", "directions of emission are guided too");
}

template <typename Block>
void readSwitches(const Block& block, Scheme& scheme) {
    scheme.published = block.choice("preset", "best", {"best", "published"},
                                    {"none", "what the switches below stand on"}) == "published";
    readDistances(block, scheme);
    readDirections(block, scheme);
    scheme.roulette =
        fraction(block, "roulette", "part of their first usefulness below which walks end at random; 0: never", 1.0);
    scheme.directView =
        named<DirectView>(
            block, "direct_view",
            "photon maps: control vertices alone (on), ordinary photons beside them (off), which is right "
            "in mirrors and behind refraction, or as the scene needs",
            {{"auto", DirectView::Auto}, {"on", DirectView::On}, {"off", DirectView::Off}}, "auto")
            .value_or(DirectView::Auto);
    constexpr const char *WithBest = "true with best", *WithPublished = "true with published";
    scheme.surfaceConnections = flag(block, "surface_connections",
                                     "light paths connect to visible surfaces, camera paths to lit ones", WithBest);
    scheme.glossySensorPaths = flag(block, "glossy_sensor_paths",
                                    "photon maps: sensor paths go on at glossy surfaces, as at mirrors", WithBest);
    scheme.singleFrames =
        flag(block, "single_frames",
             "photon maps: a light path aims at one frame of a sequence, not at all as one gate", WithPublished);
    scheme.bodies = flag(block, "bodies", "media end at their boundaries for sampling too", WithBest);
}

} // namespace detail

/// Reads `darts` ("best", "published", "off", or an object of switches), `enable_guiding` and `enable_elliptical` from
/// an integrator's block. A `Block` has has, flag, number, integer, choice, isObject, block (an object in it) and
/// problem, each by field name; the reading ones also take a field's {unit, meaning, default in words}. declare() and
/// describes() are for blocks that collect these, see ObjectReader. Where `darts` is given, both flags default to true
/// and every medium is guided.
template <typename Block>
Scheme readScheme(const Block& block) {
    constexpr const char* WithDarts = "true where `darts` is given";
    constexpr const char *Text = "a preset, or switches over one; the paper's is published",
                         *Without = "the two flags decide";
    Scheme scheme;
    scheme.everyMedium = block.has("darts");
    scheme.guideDistance =
        block.flag("enable_guiding", scheme.everyMedium, {"none", "distances in media are guided (DARTS)", WithDarts});
    scheme.elliptical = block.flag("enable_elliptical", scheme.everyMedium,
                                   {"none", "control vertices make paths arrive in time (DARTS)", WithDarts});
    scheme.on = scheme.guideDistance || scheme.elliptical;
    if (!block.isObject("darts")) {
        const std::string preset = block.choice("darts", "", {"best", "published", "off"}, {"none", Text, Without});
        scheme.published = preset == "published";
        scheme.on = scheme.on && preset != "off";
    }
    if (block.isObject("darts") || block.describes()) {
        const auto switches = block.block("darts", {"none", Text, Without});
        detail::readSwitches(*switches, scheme);
        switches->warnAboutUnknown();
    }
    return scheme;
}

} // namespace darts
