// Weights, ways, times and bodies against 50 digits: densities of every size a float has, gates of 1e-7 of the arrival,
// positions just inside a body and far from the origin.

#include "transport/Balance.h"
#include "transport/BoundedMedium.h"
#include "transport/GateBounds.h"
#include "transport/TimeSensor.h"
#include "transport/Vertex.h"

#include "support/Exact.h"
#include "support/LogUniform.h"

#include "tungsten/core/Warp.h"

namespace tungsten::transport {
namespace {

using test::Exact;
using test::LargestError;
using test::logUniform;

Exact exactDot(const Vec3f& a, const Vec3f& b) {
    return Exact(a.x) * b.x + Exact(a.y) * b.y + Exact(a.z) * b.z;
}
Vec3f anywhere(Sampler& s, float scale) {
    return warp::squareToSphere(s.next2D()) * (scale * s.next1D());
}

TEST(TransportAccuracy, WeightsOfTechniques) {
    LargestError two("balance_of_two"), three("balance_of_three"), power("power_heuristic"), flight("free_flight");
    for (uint64_t i = 0; i < 3000; ++i) {
        Sampler s(61, RandomStream::Test, 0, i);
        const double size = logUniform(s, 1e-30, 1e30);
        const auto density = [&] { return float(size * logUniform(s, 1e-7, 1e7)); };
        const float a = density(), b = density(), c = i % 5 == 0 ? 0.0f : density();
        two.add(double(balance(a, c)), Exact(a) / (Exact(a) + c));
        three.add(double(balance(a, b, c)), Exact(a) / (Exact(a) + b + c));
        power.add(double(powerHeuristic(a, b)), Exact(a) * a / (Exact(a) * a + Exact(b) * b));
        const auto sigma = float(logUniform(s, 1e-9, 1e4)), d = float(logUniform(s, 1e-6, 60.0) / double(sigma));
        flight.add(double(pdfFreeFlight(sigma, d)), sigma * exp(-Exact(sigma) * d),
                   sigma * exp(-Exact(sigma) * d) * (1 + Exact(sigma) * d));
    }
    EXPECT_TRUE(two.within(2e-7));
    EXPECT_TRUE(three.within(3e-7));
    EXPECT_TRUE(power.within(3e-7));
    EXPECT_TRUE(flight.within(1.7e-7));
}

TEST(TransportAccuracy, StraightWaysAndDensitiesAtTheirEnds) {
    LargestError distance("distance"), direction("direction"), density("area_density"), end("connection_end");
    const Medium fog;
    for (uint64_t i = 0; i < 3000; ++i) {
        Sampler s(62, RandomStream::Test, 0, i);
        const auto scale = float(logUniform(s, 1e-6, 1e6)), near = scale * float(logUniform(s, 1e-4, 1.0));
        const Vec3f from = anywhere(s, scale), to = from + anywhere(s, near);
        const auto way = connectionSegment(from, to);
        if (!way) continue;
        const std::array<Exact, 3> offset{Exact(to.x) - from.x, Exact(to.y) - from.y, Exact(to.z) - from.z};
        const Exact exactly = sqrt(offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2]);
        distance.add(double(way->distance), exactly);
        for (int axis = 0; axis < 3; ++axis)
            direction.add(double(way->direction[axis]), offset[size_t(axis)] / exactly, Exact(1));
        const Vertex vertex(fog, to, way->direction, Region{});
        const float pdf = s.next1D() + 0.1f;
        density.add(double(vertex.areaDensity(pdf, way->direction, way->distance)), pdf / (exactly * exactly));
        const SubpathEnd sent{vertex, Rgb(pdf)};
        end.add(double(connectionEndpoint(*way, sent).weight.x), pdf / (4 * test::ExactPi * exactly * exactly));
    }
    EXPECT_TRUE(distance.within(2.2e-7));
    EXPECT_TRUE(direction.within(2e-7));
    EXPECT_TRUE(density.within(5e-7));
    EXPECT_TRUE(end.within(6e-7));
}

/// What arrives at the gate's first and just before its last moment passes; what is late by twice the slack does not.
TEST(TransportAccuracy, TimesOfArrival) {
    LargestError soonest("soonest");
    for (uint64_t i = 0; i < 3000; ++i) {
        Sampler s(63, RandomStream::Test, 0, i);
        TimeGate gate;
        gate.steadyState = false;
        gate.start = logUniform(s, 1e-3, 1e5);
        gate.frameWidth = gate.start * logUniform(s, 1e-7, 1.0);
        SceneFacts facts;
        facts.highestSpeed = float(logUniform(s, 1e-3, 1e3));
        const GateBounds bounds(gate, facts);
        const double time = gate.start * s.nextDouble(), left = gate.start + gate.frameWidth * s.nextDouble() - time;
        const double first = (gate.start - time) * double(facts.highestSpeed),
                     distance = left * double(facts.highestSpeed);
        soonest.add(bounds.soonest(time, distance), time + Exact(distance) / facts.highestSpeed);
        for (const double in : {first, distance}) {
            EXPECT_TRUE(bounds.mayArrive(time, in));
            EXPECT_TRUE(bounds.beforeEnd(time, in));
        }
        const double late = (gate.end() * (1.0 + 2.0 * FlightSlack) - time) * double(facts.highestSpeed);
        EXPECT_FALSE(bounds.mayArrive(time, late));
        EXPECT_FALSE(bounds.beforeEnd(time, late));
        const double early = (gate.start * (1.0 - 2.0 * FlightSlack) - time) * double(facts.highestSpeed);
        if (early > 0.0) {
            EXPECT_FALSE(bounds.mayArrive(time, early));
        }
    }
    EXPECT_TRUE(soonest.within(4e-16));
}

/// Shares of frames, arrivals and weights of a linear response.
TEST(TransportAccuracy, SensorsWithDelays) {
    LargestError share("share"), start("arrivals_start"), length("arrivals_end"), weight("weight");
    for (uint64_t i = 0; i < 500; ++i) {
        Sampler s(64, RandomStream::Test, 0, i);
        const double begin = 2.0 * s.nextDouble() - 1.0, width = logUniform(s, 1e-3, 10.0);
        Scene scene;
        TimeGate& gate = scene.transport.gate;
        gate = {false, false, logUniform(s, 1e-2, 1e3), logUniform(s, 1e-3, 1.0), 5};
        Emitter lamp;
        lamp.pulse = {{begin, begin + width}, {1.0, 0.0}}; // falls linearly
        scene.emitters.push_back(lamp);
        const TimeSensor sensor = TimeSensor::of(scene, gate);
        const Exact from(begin), over = Exact(begin + width) - from;
        start.add(sensor.arrivals.start, Exact(gate.start) - Exact(begin + width), Exact(gate.end()) + over);
        length.add(sensor.arrivals.end(), Exact(gate.start) + 5 * Exact(gate.frameWidth) - from,
                   Exact(gate.end()) + over);
        const double time = gate.start - begin - width + (gate.end() - gate.start + width) * s.nextDouble();
        const auto until = [&](const Exact& at) { // part of the pulse before
            const Exact x = (at - time - from) / over;
            return x <= 0 ? Exact(0) : x >= 1 ? Exact(1) : Exact(1 - (1 - x) * (1 - x));
        };
        sensor.spread(time, scene.emitters[0], [&](int frame, float part) {
            const Exact frameStart = Exact(gate.start) + Exact(gate.frameWidth) * frame;
            // Times have the rounding of the gate's.
            const Exact rounding = (Exact(gate.end()) + over) * 1e-9 / over;
            share.add(double(part), until(frameStart + Exact(gate.frameWidth)) - until(frameStart), 1 + rounding);
        });
        scene.emitters[0].pulse = {};
        scene.transport.response = {{gate.start, gate.start + gate.frameWidth}, {1.0, 0.0}};
        gate.frames = 1;
        const double seen = gate.start + gate.frameWidth * s.nextDouble();
        const Exact gone = (Exact(seen) - gate.start) / (Exact(gate.start + gate.frameWidth) - gate.start);
        weight.add(double(TimeSensor::of(scene, gate).weight(seen)), 2 * (1 - gone),
                   1 + Exact(gate.start) * 1e-9 / gate.frameWidth);
    }
    EXPECT_TRUE(share.within(6e-8));
    EXPECT_TRUE(start.within(2e-15));
    EXPECT_TRUE(length.within(2e-15));
    EXPECT_TRUE(weight.within(1.2e-7));
}

TEST(TransportAccuracy, WaysOutOfSimpleBodies) {
    LargestError sphere("sphere"), normal("sphere_normal"), block("block");
    for (uint64_t i = 0; i < 3000; ++i) {
        Sampler s(65, RandomStream::Test, 0, i);
        const auto radius = float(logUniform(s, 1e-4, 1e5));
        Sphere ball;
        ball.centre = anywhere(s, 3.0f * radius);
        ball.radius = radius;
        BoundedMedium body;
        body.sphere = &ball;
        // Anywhere inside, half of them just under the surface.
        const float depth = i % 2 == 0 ? s.next1D() : float(logUniform(s, 1e-6, 1.0));
        const Vec3f position = ball.centre + warp::squareToSphere(s.next2D()) * (radius * (1.0f - depth)),
                    direction = warp::squareToSphere(s.next2D());
        const BoundedMedium::BoundaryHit exit = body.intersectBoundary(position, direction);
        std::array<Exact, 3> from;
        Exact along = 0, squared = 0, unit = exactDot(direction, direction);
        for (int axis = 0; axis < 3; ++axis) {
            from[size_t(axis)] = Exact(position[axis]) - ball.centre[axis];
            along += from[size_t(axis)] * direction[axis];
            squared += from[size_t(axis)] * from[size_t(axis)];
        }
        // Ways that graze the sphere leave by a root of a difference.
        const Exact inside = Exact(radius) * radius - squared;
        if (!(inside > 0)) continue;
        const Exact distance = (sqrt(along * along + unit * inside) - along) / unit;
        sphere.add(double(exit.distance), distance, Exact(radius));
        for (int axis = 0; axis < 3; ++axis)
            normal.add(double(exit.face.normal[axis]), (from[size_t(axis)] + distance * direction[axis]) / radius,
                       Exact(1));
        BoundedMedium walls;
        for (int axis = 0; axis < 3; ++axis)
            for (const float side : {-1.0f, 1.0f}) {
                Vec3f out(0.0f), corner = ball.centre + Vec3f(radius);
                out[axis] = side;
                corner[axis] = ball.centre[axis] + side * radius;
                walls.faces.push_back({corner, out});
            }
        Exact nearest = 1e30;
        for (const BoundedMedium::Face& face : walls.faces) {
            const Exact cosine = exactDot(direction, face.normal);
            const Exact under = exactDot(face.point, face.normal) - exactDot(position, face.normal);
            if (cosine > 0 && under / cosine < nearest) nearest = under / cosine;
        }
        block.add(double(walls.intersectBoundary(position, direction).distance), nearest, nearest + radius);
    }
    EXPECT_TRUE(sphere.within(8e-6));
    EXPECT_TRUE(normal.within(6e-6));
    EXPECT_TRUE(block.within(1.4e-7));
}

} // namespace
} // namespace tungsten::transport
