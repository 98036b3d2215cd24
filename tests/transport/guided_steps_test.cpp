// The stages of a guided step: what a walk may ask in which state, and what it gets.

#include "transport/GuidedSteps.h"
#include "transport/Tuning.h"

#include "support/BodyExit.h"

#include <gtest/gtest.h>

namespace tungsten::transport {
namespace {

const darts::Medium Fog{{0.1f, 0.1f, 0.1f}, {1.0f, 1.0f, 1.0f}, 0.0f};

darts::Guide guideWith(float roulette, darts::Greens greens = darts::Greens::Diffusion) {
    darts::Settings settings;
    settings.lengthFirst = true;
    settings.roulette = roulette;
    settings.greens = greens;
    settings.direction = darts::Direction::Phase;
    return {settings, Fog};
}

/// 4 away from the target along z, up to 6 to go.
darts::TimeBudget ahead(double low = 5.0, double high = 6.0) {
    return darts::TimeBudget::of({0.0f, 0.0f, 4.0f}, {low, high});
}

const Vec3f Aslant(0.6f, 0.0f, 0.8f);

darts::ConnectionSample noDraw(const darts::TimeBudget&) {
    ADD_FAILURE() << "a connection was drawn twice";
    return {};
}

TEST(GuidedSteps, LooksInTwoStages) {
    GuidedSteps step;
    EXPECT_FALSE(step.hasTimeBudget());
    step.setTimeBudget(ahead(), 0.5f);
    EXPECT_TRUE(step.hasTimeBudget());
    EXPECT_FALSE(step.hasEscapeModel());
    EXPECT_FLOAT_EQ(step.budget().excess, 2.0f);
    EXPECT_FLOAT_EQ(step.reachable().excess, 2.5f);
    EXPECT_FLOAT_EQ(step.reachable().width, step.budget().width + 0.5f);
    EXPECT_EQ(step.reachable().low, step.budget().low);
    step.setTimeBudgetAndModel(ahead());
    EXPECT_TRUE(step.hasEscapeModel());
    EXPECT_EQ(step.reachable().excess, step.budget().excess);
    step.forget();
    EXPECT_FALSE(step.hasTimeBudget());
}

TEST(GuidedSteps, WhatHasBecomeTooUsefulSplits) {
    const darts::Guide guide = guideWith(0.1f);
    GuidedSteps step;
    step.setTimeBudgetAndModel(ahead());
    step.startRoulette(guide, 0, 1.0f);
    EXPECT_FLOAT_EQ(step.survival(guide, 0, 3.9f), 1.0f);
    EXPECT_EQ(step.copiesBy(guide), 1);
    EXPECT_FLOAT_EQ(step.survival(guide, 0, 20.0f), 1.0f);
    EXPECT_EQ(step.copiesBy(guide), 6);
    // Never more of one walk than the bound allows, however large its expected contribution is.
    float stemming = 6.0f;
    for (int i = 0; i < 100; ++i) {
        EXPECT_FLOAT_EQ(step.survival(guide, 0, 1e6f), 1.0f);
        stemming *= float(step.copiesBy(guide));
    }
    EXPECT_LE(stemming, tuning::MostCopies);
    EXPECT_GT(stemming, 0.1f * tuning::MostCopies);
    // Roulette makes room again.
    EXPECT_LT(step.survival(guide, 0, 1e-4f), 0.01f);
    (void)step.survival(guide, 0, 1e6f);
    EXPECT_GT(step.copiesBy(guide), 8);
}

/// Where half of 16 transport mean free paths is not left yet, by their expected contribution alone; by both where it
/// is.
TEST(GuidedSteps, OutOfBodiesHeavyWalksSplitBesideTheSchedule) {
    const darts::Guide photons(darts::best(darts::Mode::Photon, 0.0f), Fog);
    const darts::Guide paths(darts::best(darts::Mode::Path, 0.0f), Fog);
    const auto copiesOf = [&](const darts::Guide& guide, double longest, float throughput) {
        GuidedSteps step;
        step.setTimeBudgetAndModel(test::outOf(0.5, 3.0, longest, 1.0));
        EXPECT_FLOAT_EQ(step.survival(guide, 0, 1.0f), 1.0f);
        EXPECT_EQ(step.copiesBy(guide), 1);
        if (longest < 10.0) step.setTimeBudgetAndModel(test::outOf(0.5, 3.0, 0.5 * (longest + 3.5), 1.0));
        (void)step.survival(guide, 0, throughput);
        return step.copiesBy(guide);
    };
    EXPECT_EQ(copiesOf(photons, 43.5, 3.9f), 1);
    EXPECT_EQ(copiesOf(photons, 43.5, 40.0f), 11); // 40 / 4 + 1
    EXPECT_EQ(copiesOf(photons, 9.5, 1.0f), 2);
    const int both = copiesOf(photons, 9.5, 40.0f);
    EXPECT_GT(both, 2);
    EXPECT_EQ(both % 2, 0);
    EXPECT_EQ(copiesOf(paths, 43.5, 40.0f), 1);
    EXPECT_EQ(copiesOf(paths, 9.5, 40.0f), 2);
}

TEST(GuidedSteps, OutOfBodiesCameraPathsEndSooner) {
    const darts::Guide guide(darts::best(darts::Mode::Path, 0.0f), Fog);
    for (const bool out : {false, true}) {
        GuidedSteps step;
        step.setTimeBudgetAndModel(out ? test::outOf(0.5, 3.0, 43.5, 1.0) : ahead());
        EXPECT_FLOAT_EQ(step.survival(guide, 0, 1.0f), 1.0f);
        EXPECT_NEAR(step.survival(guide, 0, 0.06f), out ? 0.2f : 1.0f, 1e-4f);
    }
}

/// Both ways to a control vertex must arrive after the length that was drawn.
void expectArrivesAfter(float length, const GuidedSteps::OnWay& met) {
    const Vec3f vertex = Aslant * met.vertex.distance;
    EXPECT_NEAR(met.vertex.distance + (Vec3f(0.0f, 0.0f, 4.0f) - vertex).length(), length, 1e-5f);
    EXPECT_NEAR(met.length, length, 1e-6);
    EXPECT_EQ(met.departure, 3.0);
}

TEST(GuidedSteps, ConnectionDrawnInFlight) {
    const darts::Guide guide = guideWith(0.1f);
    GuidedSteps step;
    step.setTimeBudgetAndModel(ahead());
    const float h = step.headingOf(Aslant).h;
    int draws = 0;
    const auto draw = [&](const darts::TimeBudget& budget) {
        ++draws;
        EXPECT_LT(budget.width, 1.0f) << "connections that end behind the surface are left out";
        return darts::ConnectionSample{budget.low + 0.5f * budget.width, budget.width};
    };
    const auto met = step.meetControlVertex({guide, h, 3.0, true}, 2.8f, draw);
    ASSERT_TRUE(met);
    EXPECT_LT(met->vertex.distance, 2.8f);
    expectArrivesAfter(float(met->length), *met);
    EXPECT_EQ(draws, 1);
    // Density and draw agree; there is none behind the surface.
    ASSERT_TRUE(step.controlVertexPdf(met->vertex.distance));
    EXPECT_GT(*step.controlVertexPdf(met->vertex.distance), 0.0f);
    EXPECT_EQ(*step.controlVertexPdf(2.9f), 0.0f);
    // The next flight of the same way draws its own.
    EXPECT_TRUE(step.meetControlVertex({guide, h, 3.0, false}, 2.8f, draw));
    EXPECT_EQ(draws, 2);
    EXPECT_FALSE(step.controlVertexPdf(1.0f)) << "does not share";
}

TEST(GuidedSteps, ConnectionDrawnBeforeIsMetOnce) {
    const darts::Guide guide = guideWith(0.1f);
    GuidedSteps step;
    step.setTimeBudgetAndModel(ahead());
    step.connect({1.5f, 2.0f});
    const GuidedSteps::Line way{guide, step.headingOf(Aslant).h, 3.0, true};
    const auto met = step.meetControlVertex(way, Infinity, noDraw);
    ASSERT_TRUE(met);
    expectArrivesAfter(5.5f, *met);
    EXPECT_FALSE(step.meetControlVertex(way, Infinity, noDraw)) << "it is behind";
    step.startWay();
    EXPECT_FALSE(step.controlVertexPdf(1.0f)) << "another way";
}

TEST(GuidedSteps, ConnectionGoesOnThroughBoundaries) {
    const darts::Guide guide = guideWith(0.1f);
    GuidedSteps step;
    step.setTimeBudgetAndModel(ahead());
    step.connect({1.5f, 2.0f});
    const float h = step.headingOf(Aslant).h;
    step.place({guide, h, 3.0, true});
    GuidedSteps whole = step;
    const auto there = whole.meetControlVertex({guide, h, 3.0, true}, Infinity, noDraw);
    ASSERT_TRUE(there);
    const float distance = there->vertex.distance, pdf = *step.controlVertexPdf(distance);

    EXPECT_FALSE(step.meetControlVertex({guide, h, 3.0, true}, 0.5f * distance, noDraw)) << "not reached yet";
    step.crossIndexMatched(0.5f * distance);
    EXPECT_EQ(*step.controlVertexPdf(distance - 0.5f * distance), pdf);
    // Time has gone on since: the connection still counts from its own start.
    const auto beyond = step.meetControlVertex({guide, h, 4.0, true}, distance, noDraw);
    ASSERT_TRUE(beyond);
    EXPECT_FLOAT_EQ(beyond->vertex.distance, 0.5f * distance);
    EXPECT_EQ(beyond->departure, 3.0);
    EXPECT_EQ(beyond->length, there->length);

    step.startWay();
    step.connect({1.5f, 2.0f});
    step.place({guide, h, 3.0, true});
    step.crossIndexMatched(1.5f * distance);
    EXPECT_FALSE(step.meetControlVertex({guide, h, 3.0, true}, Infinity, noDraw)) << "it lies in what was passed";
}

TEST(GuidedSteps, DirectionsSuitTheConnectionDrawnBefore) {
    darts::Settings settings;
    settings.lengthFirst = true;
    const darts::Guide guide(settings, Fog);
    const auto density = [&](float excess) {
        GuidedSteps step;
        step.setTimeBudgetAndModel(ahead());
        step.connect({excess, 1.0f});
        const auto half = [] { return 0.5f; };
        return step.sampleDirection(guide, darts::HenyeyGreenstein{}, half).inversePdf;
    };
    EXPECT_NE(density(1.1f), density(1.9f));
}

TEST(GuidedSteps, RouletteStartsAnewWithAnotherModel) {
    const darts::Guide guide = guideWith(0.5f);
    GuidedSteps step;
    step.setTimeBudgetAndModel(ahead());
    EXPECT_EQ(step.survival(guide, 0, 1.0f), 1.0f) << "it starts";
    EXPECT_NEAR(step.survival(guide, 0, 0.25f), 0.5f, 1e-5f);
    step.forget();
    step.setTimeBudgetAndModel(ahead());
    EXPECT_NEAR(step.survival(guide, 0, 0.25f), 0.5f, 1e-5f) << "vertices of one model compare";
    EXPECT_EQ(step.survival(guide, 1, 0.25f), 1.0f) << "another medium";
    EXPECT_NEAR(step.survival(guide, 1, 0.0625f), 0.5f, 1e-5f);
    step.setTimeBudgetAndModel(test::outOf(0.5, 3.0, 43.5, 1.0));
    EXPECT_EQ(step.survival(guide, 1, 1e-6f), 1.0f) << "another way";
}

TEST(GuidedSteps, RouletteCanStartBeforeItIsPlayed) {
    const darts::Guide guide = guideWith(0.5f);
    GuidedSteps step;
    step.setTimeBudgetAndModel(ahead());
    step.startRoulette(guide, 0, 1.0f);
    step.startRoulette(guide, 0, 0.25f); // goes on
    EXPECT_NEAR(step.survival(guide, 0, 0.25f), 0.5f, 1e-5f);
    const darts::Guide never = guideWith(0.0f);
    EXPECT_EQ(step.survival(never, 0, 1e-30f), 1.0f);
}

} // namespace
} // namespace tungsten::transport
