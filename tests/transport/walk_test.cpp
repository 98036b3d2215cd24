// The loop of all walks: the order of its hooks, what the path holds at each, copies; and the steps that draw from the
// scene's own distributions, number by number.

#include "transport/PlainSteps.h"

#include "support/SceneFile.h"

#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

namespace tungsten::transport {
namespace {

using Event = Flight::Event;

/// A floor at y = 0, a sheet that light passes straight at y = 1, on a slab of slow fog up to y = 2.
std::shared_ptr<const Scene> floorUnderFog() {
    const test::SceneFile file(R"({
      "media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0.2, "sigma_s": 0.6, "speed_of_light": 0.5,
                 "max_bounces": 3, "phase_function": {"type": "henyey_greenstein", "g": 0.6}}],
      "primitives": [{"type": "quad", "bsdf": {"type": "lambert", "albedo": 0.5}, "transform": {"scale": 8}},
                     {"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"},
                      "transform": {"position": [0, 1.5, 0], "scale": [4, 1, 4]}}],
      "camera": {"resolution": 1}, "integrator": {"type": "path_tracer"}, "renderer": {}})");
    return loadScene(file.path()).scene;
}

const Region InVacuum{}, InFog{0, 0.5f};
const Vec3f Downwards(0.0f, -1.0f, 0.0f), Onwards(0.6f, 0.8f, 0.0f);

/// What a walk is to do between one vertex and the next.
struct Script {
    Event event = Event::Surface;
    float distance = 2.0f;
    double length = 3.0; ///< not quite the distance, to tell them apart
    Rgb flightWeight{0.5f};
    bool flies = true, looks = true, visits = true, survives = true;
    int copies = 1;
    LobeMask lobe = lobe::DiffuseReflection; ///< None: no way on, but in media
    bool hasWay = true;
    Region beyond = InVacuum;
    Rgb weight{0.25f};
    float pdf = 0.7f;
};

/// What the walk and its copies tell, in order.
struct Log {
    struct Entry {
        std::string hook;
        PathState path;
    };
    std::vector<Entry> entries;

    void add(const char* hook, const PathState& path) { entries.push_back({hook, path}); }
    /// The state at the n-th time that this hook is called.
    [[nodiscard]] const PathState& at(const std::string& hook, int n = 0) const {
        for (const Entry& entry : entries)
            if (entry.hook == hook && n-- == 0) return entry.path;
        ADD_FAILURE() << hook << " was not called";
        return entries.front().path;
    }
    [[nodiscard]] int count(const std::string& hook) const {
        return int(std::count_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.hook == hook; }));
    }
};

/// Tells copies apart: a copy gets the next number.
struct Identity {
    explicit Identity(int& number) : last(&number) {}
    Identity(const Identity& other) : own(++*other.last), last(other.last) {}
    Identity& operator=(const Identity&) = delete;
    int own = 0;
    int* last;
};

/// Does what the script says for its next vertex, and stops when that is over. `Timed` as in Steps.
template <bool HasClock>
struct ScriptedSteps {
    static constexpr bool Timed = HasClock;

    [[nodiscard]] const WalkContext& context() const { return walkContext; }
    Ahead ahead(PathState& path) {
        log->add("steps.ahead", path);
        if (size_t(path.interactions) >= script->size()) return {};
        Ahead result{now(path.interactions).flies, walkContext.scene.medium(path.region), floor};
        if (now(path.interactions).event == Event::Escape) result.hit.reset();
        return result;
    }
    Flight flight(PathState& path, const Ahead&) {
        log->add("flight", path);
        const Script& s = now(path.interactions);
        return {s.event, s.distance, s.flightWeight, 1.0f, s.length};
    }
    bool canArrive(PathState& path, const WalkVertex&) {
        log->add("canArrive", path);
        return now(path.interactions - 1).looks;
    }
    int copies(PathState& path, const WalkVertex&) {
        log->add("copies", path);
        return now(path.interactions - 1).copies;
    }
    std::optional<Way> way(PathState& path, const WalkVertex& vertex) {
        log->add("way", path);
        const Script& s = now(path.interactions - 1);
        if (!s.hasWay) return std::nullopt;
        return Way{{vertex.position, Onwards}, s.beyond, s.weight, s.pdf, vertex.medium ? lobe::None : s.lobe};
    }
    bool survives(PathState& path) {
        log->add("survives", path);
        return now(path.interactions - 1).survives;
    }
    [[nodiscard]] const Script& now(int vertex) const { return (*script)[size_t(vertex)]; }

    WalkContext walkContext;
    const std::vector<Script>* script;
    Log* log;
    SurfaceHit floor;
};

struct LoggingVisitor {
    [[nodiscard]] bool mayGoOn(const PathState& path) const {
        log->add("mayGoOn", path);
        return path.interactions < most;
    }
    bool ahead(PathState& path, auto&, const Ahead& ahead) {
        log->add("ahead", path);
        fliesThrough.push_back(ahead.medium);
        return true;
    }
    void escape(PathState& path) { log->add("escape", path); }
    bool arrive(PathState& path, auto&, const Ahead&, const Flight&) {
        log->add("arrive", path);
        return path.interactions != endsAt;
    }
    bool vertex(PathState& path, auto& steps, const WalkVertex& at) {
        log->add("vertex", path);
        met.push_back({at.medium, nullptr, at.position, at.before, at.region});
        EXPECT_NE(at.medium == nullptr, at.surface == nullptr);
        return steps.now(path.interactions - 1).visits;
    }
    void leave(PathState& path, auto&, const WalkVertex&, const Way&) { log->add("leave", path); }
    void end(PathState& path) {
        log->add("end", path);
        ended->push_back(identity.own);
    }

    Log* log;
    std::vector<int>* ended;
    Identity identity;
    int most = 1000, endsAt = -1;
    std::vector<const Medium*> fliesThrough{};
    std::vector<WalkVertex> met{};
};

class Scripted : public testing::Test {
  protected:
    template <bool HasClock = true>
    LoggingVisitor walk(const std::vector<Script>& script, const PathState& start) {
        const auto floor = scene_->geometry->intersect({Vec3f(0.25f, 0.5f, 0.0f), Downwards});
        const ScriptedSteps<HasClock> steps{{*scene_, counters_, watch_}, &script, &log_, *floor};
        const LoggingVisitor visitor{&log_, &ended_, Identity(last_), most_, endsAt_};
        Walk walk{start, steps, visitor};
        walk.run();
        return walk.visitor;
    }
    static PathState startIn(const Region& region) {
        return {.random = Sampler(1, RandomStream::Test, 0, 0),
                .ray = {Vec3f(0.0f, 4.0f, 0.0f), Downwards},
                .region = region,
                .time = 10.0};
    }
    void expectHooks(const std::vector<std::string>& hooks) {
        std::vector<std::string> called;
        for (const Log::Entry& entry : log_.entries) called.push_back(entry.hook);
        EXPECT_EQ(called, hooks);
    }

    std::shared_ptr<const Scene> scene_ = floorUnderFog();
    StepCounters counters_;
    ProgressToken watch_;
    Log log_;
    std::vector<int> ended_;
    int last_ = 0, most_ = 1000, endsAt_ = -1;
};

TEST_F(Scripted, HooksComeInOrder) {
    walk({{.event = Event::Collision, .beyond = InFog}, {.event = Event::Surface}, {.event = Event::Escape}},
         startIn(InFog));
    expectHooks({"mayGoOn",  "steps.ahead", "ahead",       "flight",   "arrive",  "canArrive",   "vertex",
                 "copies",   "way",         "leave",       "survives", "mayGoOn", "steps.ahead", "ahead",
                 "flight",   "arrive",      "canArrive",   "vertex",   "copies",  "way",         "leave",
                 "survives", "mayGoOn",     "steps.ahead", "ahead",    "flight",  "escape",      "end"});
    EXPECT_EQ(counters_.steps, 3u);
    EXPECT_EQ(counters_.mediumEvents, 1u);
    EXPECT_EQ(counters_.anisotropicEvents, 1u);
    EXPECT_EQ(counters_.surfaceEvents, 1u);
    EXPECT_EQ(counters_.scattered, 1u);
}

/// Every hook that says so ends the walk, and none is called after it but the end.
TEST_F(Scripted, EndsWhereAHookSaysSo) {
    const std::vector<std::string> all{"mayGoOn", "steps.ahead", "ahead", "flight", "arrive",  "canArrive",
                                       "vertex",  "copies",      "way",   "leave",  "survives"};
    const auto expectEndAfter = [&](const std::string& last, const Script& script) {
        SCOPED_TRACE(last);
        log_ = {};
        walk({script, {}}, startIn(InVacuum));
        std::vector<std::string> hooks(all.begin(), std::find(all.begin(), all.end(), last) + 1);
        hooks.emplace_back("end");
        expectHooks(hooks);
    };
    expectEndAfter("steps.ahead", {.flies = false});
    expectEndAfter("flight", {.event = Event::Nothing});
    expectEndAfter("flight", {.flightWeight = Rgb(0.0f)});
    expectEndAfter("canArrive", {.looks = false});
    expectEndAfter("vertex", {.visits = false});
    expectEndAfter("copies", {.copies = 0});
    expectEndAfter("way", {.hasWay = false});
    expectEndAfter("leave", {.weight = Rgb(0.0f)});
    expectEndAfter("survives", {.survives = false});
    endsAt_ = 1;
    expectEndAfter("arrive", {});
    most_ = 0;
    expectEndAfter("mayGoOn", {});
    EXPECT_EQ(counters_.steps, 10u) << "none where the walk may not go on";
}

TEST_F(Scripted, ArrivesWithTheFlightsWeightAndTimeAndLeavesWithTheWaysWeight) {
    const LoggingVisitor visitor =
        walk({{.event = Event::Collision, .beyond = InFog, .pdf = 0.3f}, {.lobe = lobe::GlossyReflection, .pdf = 0.6f}},
             startIn(InFog));
    const PathState &flown = log_.at("flight"), &arrived = log_.at("arrive"), &left = log_.at("survives");
    EXPECT_EQ(flown.interactions, 0);
    EXPECT_EQ(flown.throughput.x, 1.0f);
    EXPECT_EQ(flown.time, 10.0);
    EXPECT_EQ(arrived.throughput.x, 0.5f);
    EXPECT_EQ(arrived.time, 10.0 + 3.0 / 0.5) << "by the length as it is stored, at the speed of the region";
    EXPECT_EQ(arrived.interactions, 1);
    EXPECT_EQ(arrived.mediumScatters, 1);
    EXPECT_EQ(arrived.inARow, 1);
    EXPECT_EQ(arrived.ray.origin, Vec3f(0.0f, 2.0f, 0.0f));
    EXPECT_EQ(arrived.ray.direction, Downwards);
    EXPECT_TRUE(arrived.scattered);
    EXPECT_EQ(arrived.last.kind, LastVertex::Kind::Start);
    EXPECT_EQ(log_.at("leave").throughput.x, 0.5f) << "before it takes the way";
    EXPECT_EQ(log_.at("leave").ray.direction, Downwards);
    EXPECT_EQ(left.throughput.x, 0.125f);
    EXPECT_EQ(left.ray.direction, Onwards);
    EXPECT_EQ(left.last.kind, LastVertex::Kind::Medium);
    EXPECT_EQ(left.last.pdf, 0.3f);
    EXPECT_EQ(left.last.position, arrived.ray.origin);
    // Then the floor, through fog.
    const PathState &onFloor = log_.at("arrive", 1), &offFloor = log_.at("survives", 1);
    EXPECT_EQ(onFloor.ray.origin, Vec3f(0.25f, 0.0f, 0.0f)) << "the surface's own position, not one along the ray";
    EXPECT_EQ(onFloor.interactions, 2);
    EXPECT_EQ(onFloor.mediumScatters, 1);
    EXPECT_EQ(onFloor.inARow, 0);
    EXPECT_EQ(offFloor.last.kind, LastVertex::Kind::Surface);
    EXPECT_EQ(offFloor.last.pdf, 0.6f);
    EXPECT_EQ(offFloor.last.position, onFloor.ray.origin);
    EXPECT_EQ(offFloor.region.medium, -1);
    EXPECT_EQ(log_.at("leave", 1).region.medium, 0) << "the walk is in the region that it came through";
    ASSERT_EQ(visitor.met.size(), 2u);
    EXPECT_EQ(visitor.met[0].medium, &scene_->media[0]);
    EXPECT_EQ(visitor.met[1].medium, nullptr);
    EXPECT_EQ(visitor.met[1].before, Onwards);
    EXPECT_EQ(visitor.met[1].region.medium, 0);
}

TEST_F(Scripted, WhatEscapesHasTheWeightOfItsFlight) {
    walk({{.event = Event::Escape, .flightWeight = Rgb(0.25f)}}, startIn(InVacuum));
    EXPECT_EQ(log_.at("escape").throughput.x, 0.25f);
    EXPECT_EQ(log_.at("end").interactions, 0) << "no vertex";
    log_ = {};
    walk({{.event = Event::Escape, .flightWeight = Rgb(0.0f)}}, startIn(InVacuum));
    EXPECT_EQ(log_.count("escape"), 1) << "nothing comes, but the visitor is told";
}

TEST_F(Scripted, StraightPassagesAndMirrorsLeaveWhatTheyMust) {
    const Script straight{.lobe = lobe::Forward, .pdf = 1.0f}, mirror{.lobe = lobe::SpecularReflection, .pdf = 0.0f},
        glossy{.lobe = lobe::GlossyReflection, .pdf = 0.6f};
    PathState start = startIn(InVacuum);
    start.timed = false;
    walk({straight, mirror, glossy, straight, mirror}, start);
    using Kind = LastVertex::Kind;
    const auto expectLeft = [&](int vertex, Kind kind, float pdf, bool scattered) {
        const PathState& left = log_.at("survives", vertex);
        EXPECT_EQ(left.last.kind, kind) << vertex;
        EXPECT_EQ(left.last.pdf, pdf) << vertex;
        EXPECT_EQ(left.scattered, scattered) << vertex;
        EXPECT_EQ(left.timed, scattered) << "time starts where the camera's specular chain ends " << vertex;
    };
    expectLeft(0, Kind::Start, 0.0f, false);
    expectLeft(1, Kind::Specular, 0.0f, false);
    expectLeft(2, Kind::Surface, 0.6f, true);
    expectLeft(3, Kind::Surface, 0.6f, true);
    expectLeft(4, Kind::Specular, 0.0f, true);
    EXPECT_EQ(log_.at("arrive", 2).time, 10.0);
    EXPECT_EQ(log_.at("arrive", 4).time, 10.0 + 2 * 3.0);
    EXPECT_EQ(counters_.straight, 2u);
    EXPECT_EQ(counters_.mirrored, 2u);
}

TEST_F(Scripted, ScatteringInAMediumStartsTheClock) {
    PathState start = startIn(InFog);
    start.timed = false;
    walk({{.event = Event::Collision, .beyond = InFog}, {.event = Event::Collision, .beyond = InFog}}, start);
    EXPECT_TRUE(log_.at("arrive").timed && log_.at("arrive").scattered);
    EXPECT_EQ(log_.at("arrive").time, 10.0);
    EXPECT_EQ(log_.at("arrive", 1).time, 10.0 + 3.0 / 0.5);
    log_ = {};
    walk<false>({{}, {}}, startIn(InVacuum));
    EXPECT_EQ(log_.at("end").time, 10.0) << "steps without a clock";
}

TEST_F(Scripted, SurfacesStartTheCountsOfTheirMediumAnew) {
    PathState start = startIn(InFog);
    start.flights = 7;
    const Script collision{.event = Event::Collision, .beyond = InFog}, sheet{.lobe = lobe::Forward, .beyond = InFog};
    walk({collision, collision, sheet, collision}, start);
    EXPECT_EQ(log_.at("arrive", 1).inARow, 2);
    EXPECT_EQ(log_.at("arrive", 1).flights, 7) << "steps count flights";
    EXPECT_EQ(log_.at("arrive", 2).inARow, 0);
    EXPECT_EQ(log_.at("arrive", 2).flights, 0);
    EXPECT_EQ(log_.at("arrive", 3).inARow, 1);
    EXPECT_EQ(log_.at("arrive", 3).mediumScatters, 3);
}

TEST_F(Scripted, CopiesShareTheThroughputAndHaveNumbersOfTheirOwn) {
    const Script splits{.event = Event::Collision, .copies = 3, .beyond = InFog};
    walk({splits, splits}, startIn(InFog));
    EXPECT_EQ(log_.count("way"), 3 + 9);
    EXPECT_EQ(log_.count("end"), 9) << "each copy's own";
    std::sort(ended_.begin(), ended_.end());
    EXPECT_EQ(std::unique(ended_.begin(), ended_.end()) - ended_.begin(), 9);
    std::set<uint32_t> numbers;
    double sum = 0.0;
    for (const Log::Entry& entry : log_.entries) {
        if (entry.hook != "end") continue;
        sum += double(entry.path.throughput.x);
        EXPECT_EQ(entry.path.interactions, 2);
        Sampler random = entry.path.random;
        random.at(5, Draw::Direction);
        numbers.insert(random.nextBits());
    }
    EXPECT_NEAR(sum, std::pow(0.5 * 0.25, 2), 1e-7);
    EXPECT_EQ(numbers.size(), 9u) << "copies of copies, too";
    EXPECT_EQ(counters_.mediumEvents, 1u + 3u) << "the vertex where they part is one";
    // The first copy is the walk itself.
    Sampler own = startIn(InFog).random, last = log_.entries.back().path.random;
    own.at(5, Draw::Direction);
    last.at(5, Draw::Direction);
    EXPECT_EQ(own.nextBits(), last.nextBits());
}

TEST_F(Scripted, CopiesOfCopiesDifferByWhereTheyPart) {
    const Script splits{.event = Event::Collision, .copies = 2, .beyond = InFog};
    const auto first = [&](size_t vertex) { // number of a copy made there alone
        log_ = {};
        std::vector<Script> script(3, {.event = Event::Collision, .beyond = InFog});
        script[vertex] = splits;
        walk(script, startIn(InFog));
        Sampler random = log_.at("end").random;
        random.at(9, Draw::Direction);
        return random.nextBits();
    };
    EXPECT_NE(first(0), first(1));
    EXPECT_NE(first(1), first(2));
}

TEST_F(Scripted, ACopyThatEndsWhereItPartsIsOver) {
    walk({{.event = Event::Collision, .copies = 3, .hasWay = false}}, startIn(InFog));
    EXPECT_EQ(log_.count("way"), 3);
    EXPECT_EQ(log_.count("end"), 3);
}

// ---- Steps that draw by the scene's own distributions

class OwnSteps : public testing::Test {
  protected:
    [[nodiscard]] PathState startAt(float y, const Vec3f& direction, const Region& region) const {
        return {.random = random_, .ray = {Vec3f(0.1f, y, 0.2f), direction}, .region = region};
    }
    [[nodiscard]] Sampler numbers(int vertex, Draw draw) const {
        Sampler random = random_;
        random.at(vertex, draw);
        return random;
    }
    [[nodiscard]] WalkContext context() { return {*scene_, counters_, {}}; }
    [[nodiscard]] const Medium& fog() const { return scene_->media[0]; }

    std::shared_ptr<const Scene> scene_ = floorUnderFog();
    StepCounters counters_;
    Sampler random_{1, RandomStream::Test, 0, 0};
};

/// Vertex 1's own numbers, with the density of what they choose; walks through the slab either meet its lower face,
/// with the weight over the chance of that, or scatter before.
TEST_F(OwnSteps, FlightsAreDrawnWithTheNumbersOfTheVertexTheyLeadTo) {
    const auto expectFlights = [&](auto steps, bool whole) {
        int collisions = 0;
        for (uint64_t i = 0; i < 50; ++i) {
            random_ = Sampler(1, RandomStream::Test, 0, i);
            PathState path = startAt(1.9f, Downwards, InFog);
            const auto ahead = steps.ahead(path);
            ASSERT_TRUE(ahead.flies);
            EXPECT_EQ(path.flights, 1);
            const Flight flight = steps.flight(path, ahead);
            Sampler own = numbers(1, Draw::Flight);
            const FlightSample drawn = sampleFlight(fog(), Infinity, path.channels, own);
            if (drawn.distance < 0.9f) {
                ++collisions;
                EXPECT_EQ(flight.event, Event::Collision);
                EXPECT_EQ(flight.distance, drawn.distance);
                EXPECT_FLOAT_EQ(flight.weight.x, 0.6f / 0.8f);
                EXPECT_FLOAT_EQ(flight.pdf, 0.8f * std::exp(-0.8f * drawn.distance));
            } else {
                EXPECT_EQ(flight.event, Event::Surface);
                EXPECT_NEAR(flight.distance, 0.9f, 1e-6f);
                EXPECT_NEAR(flight.weight.x, 1.0f, 1e-6f) << "transmittance over the chance of passing";
                EXPECT_NEAR(flight.pdf, std::exp(-0.8f * 0.9f), 1e-6f);
            }
            EXPECT_TRUE(ahead.hit || !whole) << "what is drawn along the whole ray knows its end";
        }
        EXPECT_GT(collisions, 10);
        EXPECT_LT(collisions, 40);
    };
    expectFlights(PlainLightSteps(context()), false);
    expectFlights(PlainSteps<PlainOptions{.mode = TransportMode::Photons, .wholeRays = true}>(context()), true);
}

TEST_F(OwnSteps, DirectionsAreDrawnWithTheNumbersOfTheirVertex) {
    PlainLightSteps steps(context());
    for (uint64_t i = 0; i < 10; ++i) {
        random_ = Sampler(1, RandomStream::Test, 0, i);
        PathState path = startAt(1.5f, Downwards, InFog);
        path.interactions = 3;
        const auto way = steps.way(path, {&fog(), nullptr, path.ray.origin, Downwards, InFog});
        ASSERT_TRUE(way);
        const Vec3f expected = fog().phase.sample(Downwards, numbers(3, Draw::Direction).next2D());
        EXPECT_EQ(way->ray.direction, expected);
        EXPECT_EQ(way->ray.origin, path.ray.origin);
        EXPECT_EQ(way->pdf, fog().phase.pdf(Downwards, expected));
        EXPECT_EQ(way->weight.x, 1.0f);
        EXPECT_EQ(way->lobe, lobe::None);
    }
    // On the floor, whose density is that of the cosine.
    PathState path = startAt(0.5f, Downwards, InVacuum);
    path.interactions = 3;
    const SurfaceInteraction floor = makeInteraction(*scene_, *scene_->geometry->intersect(path.ray), Downwards);
    const auto way = steps.way(path, {nullptr, &floor, floor.hit.position, Downwards, InVacuum});
    Sampler own = numbers(3, Draw::Direction);
    const auto exit = sampleBsdf(floor, floor.query(TransportMode::Photons), false, own);
    ASSERT_TRUE(way && exit);
    EXPECT_EQ(way->ray.direction, exit->direction);
    EXPECT_NEAR(way->pdf, way->ray.direction.y * InvPi, 1e-6f);
    EXPECT_FLOAT_EQ(way->weight.x, 0.5f);
    EXPECT_TRUE(way->smooth() && !way->straight());
}

TEST_F(OwnSteps, StraightPassagesHaveNoDensityAndEnterTheRegionBeyond) {
    PlainLightSteps steps(context());
    PathState path = startAt(3.0f, Downwards, InVacuum);
    const SurfaceInteraction top = makeInteraction(*scene_, *scene_->geometry->intersect(path.ray), Downwards);
    const auto way = steps.way(path, {nullptr, &top, top.hit.position, Downwards, InVacuum});
    ASSERT_TRUE(way);
    EXPECT_TRUE(way->straight());
    EXPECT_EQ(way->pdf, 0.0f);
    EXPECT_EQ(way->region.medium, 0);
    EXPECT_EQ(way->region.speed, 0.5f);
    EXPECT_EQ(way->weight.x, 1.0f);
}

TEST_F(OwnSteps, RouletteHasANumberOfItsOwn) {
    PlainLightSteps steps(context());
    steps.roulette = true;
    int survived = 0;
    for (uint64_t i = 0; i < 100; ++i) {
        random_ = Sampler(1, RandomStream::Test, 0, i);
        PathState path = startAt(1.5f, Downwards, InFog);
        path.interactions = 50;
        path.throughput = Rgb(0.04f);
        const bool survives = numbers(50, Draw::Roulette).next1D() < 0.04f;
        EXPECT_EQ(steps.survives(path), survives);
        EXPECT_EQ(path.throughput.x, survives ? 1.0f : 0.04f);
        survived += survives ? 1 : 0;
    }
    EXPECT_GT(survived, 0);
    steps.roulette = false;
    PathState path = startAt(1.5f, Downwards, InFog);
    path.throughput = Rgb(1e-6f);
    EXPECT_TRUE(steps.survives(path));
}

TEST_F(OwnSteps, OfAMediumAreAsManyAsItAllows) {
    PlainLightSteps steps(context());
    PathState path = startAt(1.9f, Downwards, InFog);
    for (int flight = 1; flight <= 3; ++flight) {
        EXPECT_TRUE(steps.ahead(path).flies) << flight;
        EXPECT_EQ(path.flights, flight);
    }
    EXPECT_FALSE(steps.ahead(path).flies) << "max_bounces of the medium";
}

TEST_F(OwnSteps, StraightOnesAreWeakenedByWhatTheyCross) {
    StraightSteps<TransportMode::Photons> steps(context());
    PathState path = startAt(1.9f, Downwards, InFog);
    auto ahead = steps.ahead(path);
    ASSERT_TRUE(ahead.flies);
    Flight flight = steps.flight(path, ahead);
    EXPECT_EQ(flight.event, Event::Surface);
    EXPECT_NEAR(flight.distance, 0.9f, 1e-6f);
    EXPECT_NEAR(flight.weight.x, std::exp(-0.8f * 0.9f), 1e-6f);
    steps.attenuated = false;
    EXPECT_EQ(steps.flight(path, ahead).weight.x, 1.0f);
    path = startAt(3.0f, -Downwards, InVacuum);
    ahead = steps.ahead(path);
    flight = steps.flight(path, ahead);
    EXPECT_EQ(flight.event, Event::Escape);
    EXPECT_EQ(flight.weight.x, 1.0f);
}

TEST_F(OwnSteps, OthersConnectToAVertexThroughTheRegionItWasReachedThrough) {
    // The slab's upper face, met from above.
    const PathState path = startAt(3.0f, Downwards, InVacuum);
    const SurfaceInteraction top = makeInteraction(*scene_, *scene_->geometry->intersect(path.ray), Downwards);
    const Vertex vertex =
        WalkVertex{nullptr, &top, top.hit.position, Downwards, InVacuum}.connectible(*scene_, TransportMode::Photons);
    EXPECT_EQ(vertex.region().medium, -1);
    EXPECT_EQ(vertex.regionTowards(Downwards).medium, 0);
    EXPECT_EQ(vertex.position(), top.hit.position);
    const Vertex there =
        WalkVertex{&fog(), nullptr, Vec3f(0, 1.5f, 0), Downwards, InFog}.connectible(*scene_, TransportMode::Photons);
    EXPECT_EQ(there.region().medium, 0);
    EXPECT_EQ(there.pdf(Onwards), fog().phase.pdf(Downwards, Onwards)) << "the direction up to there is kept";
}

} // namespace
} // namespace tungsten::transport
