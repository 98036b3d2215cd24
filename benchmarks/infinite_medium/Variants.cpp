#include "Variants.h"

namespace infinite_medium {

namespace {

using darts::Direction;
using darts::Greens;
using darts::Lobe;
using darts::Mode;
using darts::Proposals;
using darts::Settings;

/// Changes of a base, as one variant.
using Change = void (*)(Settings&);

struct List {
    std::vector<Variant> variants;
    Settings base;
    Parts parts;

    void add(const char* name, const Settings& settings, std::vector<double> study = {}, bool reference = false) {
        variants.push_back({name, [settings](const Case&) { return settings; }, std::move(study), reference, parts});
    }
    void change(const char* name, Change apply, std::vector<double> study = {}, bool reference = false) {
        Settings settings = base;
        apply(settings);
        add(name, settings, std::move(study), reference);
    }
};

/// Free flights, the phase function's directions.
Settings unguided(Mode mode) {
    Settings s = darts::published(mode);
    s.direction = Direction::Phase;
    s.greens = Greens::None;
    s.candidates = 1;
    return s;
}

/// Bounded candidates, the event's probability a weight, roulette on expected contribution; nothing else beyond the
/// published.
Settings boundedOnly(Mode mode) {
    Settings s = darts::published(mode);
    s.bounded = true;
    s.lengthFirst = true;
    s.roulette = 0.1f;
    return s;
}

void addDistanceAblations(List& list) {
    list.change("  S after direction", [](Settings& s) { s.lengthFirst = false; });
    list.change("  unbounded", [](Settings& s) {
        s.bounded = false;
        s.proposals = Proposals::Exponential;
    });
    list.change("  no RIS", [](Settings& s) {
        s.candidates = 1;
        s.greens = Greens::None;
        s.proposals = Proposals::Exponential;
    });
    list.change("  no Green's function", [](Settings& s) { s.greens = Greens::None; });
    list.change("  4 candidates", [](Settings& s) { s.candidates = 4; });
    list.change("  16 candidates", [](Settings& s) { s.candidates = 16; });
    list.change("  exponential", [](Settings& s) { s.proposals = Proposals::Exponential; });
    list.change("  mixed uniform", [](Settings& s) { s.proposals = Proposals::MixedUniform; });
    list.change("  mixed quarter", [](Settings& s) { s.proposals = Proposals::MixedQuarter; });
    list.change("  equiangular", [](Settings& s) { s.proposals = Proposals::Equiangular; });
    list.change("  no roulette", [](Settings& s) { s.roulette = 0.0f; });
    list.change("  roulette .01", [](Settings& s) { s.roulette = 0.01f; });
    list.change("  roulette .03", [](Settings& s) { s.roulette = 0.03f; });
    list.change("  roulette .3", [](Settings& s) { s.roulette = 0.3f; });
    list.change("  roulette 1", [](Settings& s) { s.roulette = 1.0f; });
}

/// Path mode, direction RIS.
void addResampledDirections(List& list) {
    list.base.direction = Direction::Ris;
    list.base.directionCandidates = 4;
    list.change(
        "R2", [](Settings&) {}, {569, 48, 93, 42, 486, 112, 70, 1.9, 2.9, 177, 22, 57, 16, 8.6, 2.3}, true);
    list.change(
        "  R2 M=2", [](Settings& s) { s.directionCandidates = 2; }, {}, true);
    list.change(
        "  R2 M=8", [](Settings& s) { s.directionCandidates = 8; }, {}, true);
    list.change(
        "  R2 diffusion", [](Settings& s) { s.greens = Greens::Diffusion; }, {}, true);
    list.change(
        "  R2 mixed quarter", [](Settings& s) { s.proposals = Proposals::MixedQuarter; }, {}, true);
    list.change(
        "  R2 exponential", [](Settings& s) { s.proposals = Proposals::Exponential; }, {}, true);
}

/// The preset, whose settings depend on the medium, and single changes of it.
void addBest(List& list, Mode mode) {
    const auto add = [&](const char* name, Change apply) {
        list.variants.push_back({name,
                                 [mode, apply](const Case& c) {
                                     Settings settings = darts::best(mode, float(c.g));
                                     apply(settings);
                                     return settings;
                                 },
                                 {},
                                 true});
    };
    add("best", [](Settings&) {});
    add("  8 candidates", [](Settings& s) { s.candidates = 8; });
    add("  16 candidates", [](Settings& s) { s.candidates = 16; });
    add("  roulette .1", [](Settings& s) { s.roulette = 0.1f; });
}

/// The published sampler with a table that does not resolve the needle: one bin an octave, 1 - C / S not below 1 / 8.
Variant coarseTable(Mode mode) {
    darts::EdaResolution coarse;
    coarse.excessOctaves = 3;
    coarse.log2ExcessPerOctave = 0;
    coarse.log2DepthPerOctave = 0;
    const Settings settings = darts::published(mode);
    return {"published, coarse table", [settings](const Case&) { return settings; }, {}, false, {true, false}, coarse};
}

} // namespace

std::vector<Variant> pathVariants() {
    List list;
    list.parts = {.controlVertices = false, .guidedEmission = false};
    list.add("A plain", unguided(Mode::Path), {.13, .04, .13, .12, .2, .23, .05, .73, .25, 2.3, .47});
    list.parts.controlVertices = true;
    list.add("B elliptical only", unguided(Mode::Path), {.43, .69, .72, .76, .99, .78, 1, 1, .42, 1.1, .85, .56, .25});
    list.base = darts::published(Mode::Path);
    list.change("C phase directions", [](Settings& s) { s.direction = Direction::Phase; },
                {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1});
    list.add("published", darts::published(Mode::Path),
             {1.2, 2.0, 1.2, 2.5, .8, 2.2, 2.4, 1.5, .7, .65, .7, 6.0, 1.3, .5, 5.3});
    list.variants.push_back(coarseTable(Mode::Path));

    list.base = boundedOnly(Mode::Path);
    list.change("bounded phase", [](Settings& s) { s.direction = Direction::Phase; });
    list.change(
        "bounded table diffusion a.5", [](Settings&) {},
        {79, 13, 17, 13, 28, 25, 12, .7, 1.4, 2.8, 1.2, 9.9, 8.2, 1.1, 2.2}, true);
    list.base.greens = Greens::Causal;
    list.change(
        "bounded table causal a.5", [](Settings&) {}, {95, 22, 27, 16, 66, 34, 18, 1, 1.5, 4.7, 1.1, 13, 8.7, 1.3, 1.8},
        true);
    list.base.direction = Direction::Connection;
    list.change(
        "bounded lobe a.5", [](Settings&) {}, {249, 33, 52, 26, 350, 62, 34, .7, 1.5, 4.6, 1.9, 22, 14, 1.7, 4.2},
        true);
    list.change("bounded lobe a.1", [](Settings& s) { s.alpha = 0.1f; },
                {432, 94, 138, 82, 1430, 140, 155, .55, .43, 4.3, 2.7, 36, 40, 4.2, 13});

    list.base = darts::best(Mode::Path, 0.0f);
    list.base.direction = Direction::Connection;
    list.base.candidates = 8;
    list.base.roulette = 0.1f;
    list.base.lobe = Lobe::Path;
    list.base.alpha = 0.1f;
    list.base.greens = Greens::Causal;
    list.base.proposals = Proposals::MixedUniform;
    list.change("R1", [](Settings&) {}, {1880, 126, 374, 136, 1950, 401, 296, .9, .23, 354, 3.6, 164, 33, 15, 4});
    list.change("  a.02", [](Settings& s) { s.alpha = 0.02f; });
    list.change("  a.05", [](Settings& s) { s.alpha = 0.05f; });
    list.change("  a.25", [](Settings& s) { s.alpha = 0.25f; });
    list.change(
        "  a.5", [](Settings& s) { s.alpha = 0.5f; }, {}, true);
    list.change(
        "  a1", [](Settings& s) { s.alpha = 1.0f; }, {}, true);
    list.change("  photon lobe", [](Settings& s) { s.lobe = Lobe::Photon; });
    list.change("  diffusion", [](Settings& s) { s.greens = Greens::Diffusion; });
    addDistanceAblations(list);

    addResampledDirections(list);
    addBest(list, Mode::Path);
    return std::move(list.variants);
}

std::vector<Variant> photonVariants() {
    List list;
    list.parts = {.controlVertices = false, .guidedEmission = false};
    list.add("P0 plain", unguided(Mode::Photon), {.11, .02, .05, .08, .15, .05, .03, .02, .04});
    list.parts.controlVertices = true;
    list.add("P0 elliptical only", unguided(Mode::Photon));
    list.base = darts::published(Mode::Photon);
    list.change("P1 phase directions", [](Settings& s) { s.direction = Direction::Phase; },
                {1, 1, 1, 1, 1, 1, 1, 1, 1});
    list.add("published", darts::published(Mode::Photon));
    list.variants.push_back(coarseTable(Mode::Photon));

    list.base = boundedOnly(Mode::Photon);
    list.parts.guidedEmission = true;
    list.change("P2 bounded", [](Settings& s) { s.direction = Direction::Phase; },
                {.67, .88, .43, .13, .72, 1.2, .69, 1.1, .87});
    list.change(
        "P2 table a.5", [](Settings&) {}, {7.6, .93, 2.7, 4.3, 2.8, 5.6, 17, 0, 2.9}, true);
    list.base.direction = Direction::Connection;
    list.base.alpha = 0.25f;
    list.change("P4 a.05", [](Settings& s) { s.alpha = 0.05f; });
    list.change("P4 a.1", [](Settings& s) { s.alpha = 0.1f; }, {9.7, 1.1, 3.0, 5.4, 1.4, 6.6, 22, 0, 3.0});
    list.change("P4 a.25", [](Settings&) {}, {9.1, 1.1, 3.1, 6.4, 1.9, 6.0, 20, 0, 3.1});
    list.change(
        "P4 a.5", [](Settings& s) { s.alpha = 0.5f; }, {}, true);
    list.change(
        "P4 a1", [](Settings& s) { s.alpha = 1.0f; }, {6.8, 1.0, 3.0, 4.3, 1.3, 4.1, 9.7, 0, 2.5}, true);
    list.change("  path lobe", [](Settings& s) { s.lobe = Lobe::Path; }, {6.8, .88, 2.1, 3.7, 1.4, 5.1, 20, 0, 2.3});
    list.parts.guidedEmission = false;
    list.change("  unguided emission", [](Settings&) {});
    list.parts.guidedEmission = true;
    list.change("  causal", [](Settings& s) { s.greens = Greens::Causal; });
    addDistanceAblations(list);

    list.base.direction = Direction::Ris;
    list.base.directionCandidates = 4;
    list.base.greens = Greens::Causal;
    list.base.proposals = Proposals::MixedUniform;
    list.change(
        "RIS M=4", [](Settings&) {}, {5.3, .61, 1.8, 7.0, 4.9, 3.1, 26, 0, 1.6}, true);
    list.change(
        "  RIS M=8", [](Settings& s) { s.directionCandidates = 8; }, {}, true);
    list.change(
        "  RIS diffusion", [](Settings& s) { s.greens = Greens::Diffusion; }, {}, true);

    addBest(list, Mode::Photon);
    return std::move(list.variants);
}

} // namespace infinite_medium
