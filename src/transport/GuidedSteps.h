#pragma once
// What steps towards a target have in common, an emitter's point or the camera (docs/method.md, sections 3 to 6), from
// vertex to vertex:
//   budget       what may still come from the vertex, in lengths;
//   roulette     whether the walk goes on, and in how many copies;
//   connection   the length of the rest of the path, should the next vertex be the last one: the control vertex;
//   direction    of the straight way ahead, to suit the connection if its length is drawn first;
//   flight       the control vertex on the way, then the distance to the next vertex.
// A straight way may cross several regions: the stages up to the direction are then passed once, the flight in each.
// Random numbers are the walk's own, which says how they are drawn.

#include "transport/Balance.h"
#include "transport/EscapeModels.h"
#include "transport/Walk.h"

#include "darts/Guide.h"

#include <optional>
#include <variant>

namespace tungsten::transport {

/// Flights of plain walks, asked of those that guided steps take (docs/method.md, section 11).
/// Through `medium`, null in vacuum, up to a surface at `reach`.
struct PlainFlight {
    const Medium* medium = nullptr;
    float reach = Infinity;
    ChannelDensities channels{1.0f}; ///< where it starts

    /// Probability of getting to the surface.
    [[nodiscard]] float surface() const { return medium ? probabilityFlightExits(*medium, reach, channels) : 1.0f; }
    /// Per length, of a collision.
    [[nodiscard]] float pdf(float distance) const { return pdfFlight(*medium, distance, channels); }
    /// That ends as this one does.
    [[nodiscard]] FlightSample like(const Flight& flight) const {
        if (!medium) return {flight.distance, true, Rgb(1.0f), 1.0f, channels};
        return flight.event == Flight::Event::Collision ? flightThatCollides(*medium, flight.distance, channels)
                                                        : flightThatExits(*medium, flight.distance, channels);
    }
};

class GuidedSteps {
  public:
    /// The control vertex of a connection, on the straight way ahead.
    struct OnWay {
        darts::ControlVertex vertex; ///< at a distance from the ray's origin
        double length = 0.0;         ///< of the whole connection
        double departure = 0.0;      ///< the walk's time where the connection starts
    };
    /// Densities of paths whose last vertex is in the medium, at one distance: per length, of own vertices and of
    /// control vertices; and the logarithm of both over the density of plain paths.
    struct InMedium {
        float own = 0.0f, control = 0.0f, logRatio = 0.0f;
        [[nodiscard]] float shareOfControl() const { return transport::balance(control, own); }
    };

    // Time budget. Whatever the walk may find besides its target may arrive later by `extraLength`, a length.
    void setTimeBudget(const darts::TimeBudget& budget, float extraLength) {
        setTimeBudgetAndModel(budget);
        known_ = Known::TimeBudget;
        reachable_.excess += extraLength;
        reachable_.width += extraLength;
        extraLength_ = extraLength;
    }
    /// Chooses how light gets to the target, too. Adds the rays traced to `rays`.
    void setEscapeModel(const EscapeModels& escapeModels, const FlightStart& start, const Region& region,
                        const EscapeTarget& aim, uint64_t& rays);
    /// Both at once, when the walk knows.
    void setTimeBudgetAndModel(const darts::TimeBudget& budget) {
        known_ = Known::EscapeModel;
        budget_ = budget;
        reachable_ = budget;
        extraLength_ = 0.0f;
    }
    /// At another vertex: what the walk knew of the last one is over.
    void forget() {
        known_ = Known::Nothing;
        startWay();
    }
    [[nodiscard]] bool hasTimeBudget() const { return known_ != Known::Nothing; }
    [[nodiscard]] bool hasEscapeModel() const { return known_ == Known::EscapeModel; }
    /// Towards the target.
    [[nodiscard]] const darts::TimeBudget& budget() const { return budget_; }
    /// Time budget of everything that the walk may find.
    [[nodiscard]] const darts::TimeBudget& reachable() const { return reachable_; }

    // Roulette. Models of what is still to come do not compare: where another one holds, in another medium or by
    // another way out, the expected contribution is measured anew.
    void startRoulette(const darts::Guide& guide, int medium, float throughput);
    /// Probability of going on; 1 where the roulette starts.
    [[nodiscard]] float survival(const darts::Guide& guide, int medium, float throughput);
    /// Into how many copies the walk goes on, itself included: where its expected contribution has grown too much, and
    /// out of bodies by darts::SplittingSchedule before that.
    [[nodiscard]] int copiesBy(const darts::Guide& guide);

    // Connection.
    /// A straight way starts whose connection is drawn in flight, when the surface ahead is known, unless connect()
    /// comes before.
    void startWay() {
        connection_ = Later{};
        shared_.reset();
    }
    /// Before the direction that is to suit it.
    void connect(const darts::ConnectionSample& connection) { connection_ = connection; }

    // Direction.
    template <typename Scatterer, typename Random>
    [[nodiscard]] darts::DirectionSample sampleDirection(const darts::Guide& guide, const Scatterer& scatterer,
                                                         Random&& random) const {
        const bool drawn = std::holds_alternative<darts::ConnectionSample>(connection_);
        return guide.sampleDirection(budget_, drawn ? std::get<darts::ConnectionSample>(connection_) : NoConnection,
                                     scatterer, random);
    }
    /// What a flight's control vertex depends on.
    struct Line {
        const darts::Guide& guide;
        float h;        ///< 1 - cos of the angle between the way and the target's direction
        double elapsed; ///< the walk's time at the ray's origin
        bool shares;    ///< ordinary vertices share with control vertices: controlVertexPdf() will be asked for
    };
    /// Places the control vertex of a connection drawn before, which now lies on the way.
    void place(const Line& way) {
        if (!std::holds_alternative<darts::ConnectionSample>(connection_)) return;
        const auto placed = onWay(way, std::get<darts::ConnectionSample>(connection_), Infinity);
        if (way.shares) shared_ = Shared{&way.guide, budget_, way.h, 0.0f};
        if (placed)
            connection_ = *placed;
        else
            connection_ = Over{};
    }
    /// Beyond a boundary that light passes straight at its speed, at this distance.
    void crossIndexMatched(float distance);

    // Flight.
    [[nodiscard]] darts::Heading headingOf(const Vec3f& direction) const {
        return budget_.heading(darts::vec3(direction));
    }
    /// Distance beyond which nothing can be in time; for flights through what scatters, if its guide is to end them.
    [[nodiscard]] float bound(const Vec3f& direction) const {
        return reachable_.latest(darts::oneMinusCosine(darts::vec3(direction), reachable_.axis)).firstLeg();
    }
    [[nodiscard]] float bound(const darts::Guide& guide, float h) const {
        return guide.distance().bound(reachable_, h);
    }
    /// The control vertex between the ray's origin and the surface ahead, if there is one. Its connection is drawn now
    /// by draw(budget) if it has not been before.
    template <typename Draw>
    [[nodiscard]] std::optional<OnWay> meetControlVertex(const Line& way, float surface, Draw&& draw) {
        if (std::holds_alternative<Later>(connection_)) return drawControlVertex(way, surface, draw);
        place(way);
        return takeControlVertex(surface);
    }
    /// Density per length along the ray of control vertices at `distance`: a function of the straight way. None if they
    /// do not share, or if none can lie before the surface.
    [[nodiscard]] std::optional<float> controlVertexPdf(float distance) const {
        if (!shared_) return std::nullopt;
        return shared_->guide->pdfControlVertex(shared_->budget, shared_->h, shared_->behind + distance);
    }
    template <typename Random>
    [[nodiscard]] darts::DistanceSample sampleDistance(const darts::Guide& guide, const darts::Heading& heading,
                                                       float surface, const Rgb& throughput, Random&& random) const {
        return guide.sampleDistance(reachable_, heading, surface, darts::vec3(throughput), random);
    }

  private:
    enum class Known { Nothing, TimeBudget, EscapeModel };
    struct Later {}; ///< not drawn yet
    struct Over {};  ///< its control vertex is behind, or there is none
    /// How the connections of the present straight way were drawn.
    struct Shared {
        const darts::Guide* guide;
        darts::TimeBudget budget; ///< of the connection's length
        float h;
        float behind; ///< distance from where it was drawn to the ray's origin
    };
    /// The expected contribution that the walk is measured by, and the model it holds for.
    struct First {
        float logContribution; ///< logarithm
        int medium;
        darts::EscapeModel model;
    };

    static constexpr darts::ConnectionSample NoConnection{};

    template <typename Draw>
    std::optional<OnWay> drawControlVertex(const Line& way, float surface, Draw&& draw) {
        shared_.reset();
        if (!budget_.alive()) return std::nullopt;
        const darts::TimeBudget before = darts::Guide::beforeSurface(budget_, way.h, surface);
        if (!before.alive()) return std::nullopt;
        const darts::ConnectionSample connection = draw(before);
        if (way.shares) shared_ = Shared{&way.guide, before, way.h, 0.0f};
        return onWay(way, connection, surface);
    }
    std::optional<OnWay> takeControlVertex(float surface) {
        if (!std::holds_alternative<OnWay>(connection_)) return std::nullopt;
        const OnWay ahead = std::get<OnWay>(connection_);
        if (!(ahead.vertex.distance < surface)) return std::nullopt;
        connection_ = Over{};
        if (!(ahead.vertex.distance >= 0.0f)) return std::nullopt;
        return ahead;
    }
    [[nodiscard]] std::optional<OnWay> onWay(const Line& way, const darts::ConnectionSample& connection,
                                             float surface) const {
        const auto vertex = way.guide.controlVertex(budget_, connection, way.h, surface);
        if (!vertex) return std::nullopt;
        return OnWay{*vertex, budget_.shortest + double(connection.excess - budget_.low), way.elapsed};
    }

    Known known_ = Known::Nothing;
    darts::TimeBudget budget_, reachable_; ///< at the vertex that they were set at
    float extraLength_ = 0.0f;             ///< of reachable_ over budget_, a length
    std::variant<Later, darts::ConnectionSample, OnWay, Over> connection_;
    std::optional<Shared> shared_;
    std::optional<First> first_;
    float logContribution_ = 0.0f; ///< logarithm, at the last survival()
    /// Mean number of walks alive, after roulette, that stem from this walk's start.
    float expectedOffspring_ = 1.0f;
    darts::SplittingSchedule splits_;
};

} // namespace tungsten::transport
