// Responses of the sensor and pulses of emitters: what is read, and what is refused.

#include "scene/problems_of.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

using test::problemsOf;
using test::SceneFile;

const char* const LampInFog = R"({
    "media": [{"name": "fog", "type": "homogeneous", "sigma_s": 1}],
    "primitives": [{"name": "lamp", "type": "point", "emission": 1, "ext_medium": "fog"}],
    "camera": {"type": "pinhole", "medium": "fog", "resolution": [8, 4]},
    "integrator": {"type": "path_tracer", "transient_time_center": 4, "transient_time_width": 2}
})";

TEST(TimeProfiles, AResponseBringsItsOwnGate) {
    const SceneFile file(LampInFog);
    const auto transport = [&](const std::string& response) {
        return loadScene(file.path(), {{}, {"integrator.temporal_response=" + response}}).scene->transport;
    };
    const TransportSettings tabulated = transport(R"({"times": [1, 2, 4], "values": [0, 3, 0]})");
    EXPECT_DOUBLE_EQ(tabulated.gate.start, 1.0);
    EXPECT_DOUBLE_EQ(tabulated.gate.end(), 4.0);
    EXPECT_EQ(tabulated.response.values, (std::vector<double>{0, 3, 0}));
    const TransportSettings gaussian = transport(R"({"type": "gaussian", "center": 5, "sigma": 0.5})");
    EXPECT_DOUBLE_EQ(gaussian.gate.start, 3.0);
    EXPECT_DOUBLE_EQ(gaussian.gate.end(), 7.0);
    EXPECT_DOUBLE_EQ(gaussian.response.values[32], 1.0);
    EXPECT_NEAR(gaussian.response.values[40], std::exp(-0.5), 1e-12);
    EXPECT_DOUBLE_EQ(transport(R"({"type": "box", "start": 2, "end": 2.5})").gate.frameWidth, 0.5);
    EXPECT_TRUE(loadScene(file.path()).scene->transport.response.empty());
}

TEST(TimeProfiles, BadResponsesAreErrors) {
    const auto problems = [](const std::string& fields) {
        return problemsOf(
            R"({"primitives": [{"type": "point", "emission": 1}], "integrator": {"transient_time_center": 1,
                              "transient_time_width": 1, )" +
            fields + "}}");
    };
    const std::string good = R"("temporal_response": {"times": [0, 1], "values": [1, 1]})";
    EXPECT_EQ(problems(good), "");
    const std::vector<std::pair<std::string, std::string>> bad{
        {R"("temporal_response": {"times": [0], "values": [1]})",
         "integrator.temporal_response.times: expected as many"},
        {R"("temporal_response": {"times": [0, 1], "values": [1]})", "at least two"},
        {R"("temporal_response": {"times": [0, 1, 1], "values": [1, 2, 1]})", "increasing times"},
        {R"("temporal_response": {"times": [0, 1], "values": [1, -1]})",
         "temporal_response.values: expected no negative value, found -1"},
        {R"("temporal_response": {"times": [0, 1], "values": [0, 0]})", "zero at all times"},
        {R"("temporal_response": {"type": "box", "start": 2, "end": 1})", "temporal_response.end: expected increasing"},
        {R"("temporal_response": {"type": "gaussian", "sigma": 0})", "temporal_response.sigma"},
        {R"("temporal_response": {"type": "gausian"})", "did you mean 'gaussian'?"},
        {R"("temporal_response": {"times": [0, NaN], "values": [1, 1]})", "temporal_response.times[1]"},
        {R"("temporal_response": {"type": "exponential", "decay": -2})", "temporal_response.decay"},
        {R"("delta_time_gate": true, )" + good, "leave out delta_time_gate"},
        {R"("time_normalization": "integral", )" + good, "time_normalization"}};
    for (const auto& [fields, expected] : bad)
        EXPECT_NE(problems(fields).find(expected), std::string::npos) << fields << "\n" << problems(fields);
}

TEST(TimeProfiles, AResponseOfASequenceIsADelay) {
    const SceneFile file(LampInFog);
    const auto transport = [&](const std::string& frames) {
        return loadScene(file.path(), {{},
                                       {"integrator.temporal_response={\"type\": \"box\", \"start\": 2, \"end\": 3}",
                                        "integrator.start_time=5", "integrator.transient_time_width=0.5", frames}})
            .scene->transport;
    };
    for (const int frames : {1, 4}) {
        const TransportSettings sequence = transport("integrator.frame_num=" + std::to_string(frames));
        EXPECT_EQ(sequence.gate.frames, frames);
        EXPECT_DOUBLE_EQ(sequence.gate.start, 5.0);
        EXPECT_TRUE(sequence.response.empty());
        EXPECT_EQ(sequence.delay.times, (std::vector<double>{2, 3}));
    }
    const TransportSettings gate = transport("integrator.frame_num=0");
    EXPECT_TRUE(gate.delay.empty());
    EXPECT_DOUBLE_EQ(gate.gate.start, 2.0);
}

TEST(TimeProfiles, PulsesAreOfEmitters) {
    const auto scene = [](const std::string& emitter, const std::string& integrator) {
        return R"({"primitives": [{"name": "lamp", "type": "point", "emission": 1, )" + emitter +
               R"(}], "integrator": {"type": "path_tracer", )" + integrator + "}}";
    };
    const std::string gate = R"("transient_time_center": 1, "transient_time_width": 1)";
    const auto pulse = [&](const std::string& fields) {
        const SceneFile file(scene(R"("pulse": )" + fields, gate));
        return loadScene(file.path()).scene->emitters.front().pulse;
    };
    EXPECT_EQ(pulse(R"({"type": "box", "start": 1, "end": 3})").times, (std::vector<double>{1, 3}));
    EXPECT_EQ(pulse(R"({"times": [0, 1, 5], "values": [0, 2, 0]})").values, (std::vector<double>{0, 2, 0}));
    const TimeProfile decay = pulse(R"({"type": "exponential", "start": 2, "decay": 0.5})");
    EXPECT_DOUBLE_EQ(decay.times.front(), 2.0);
    EXPECT_DOUBLE_EQ(decay.times.back(), 10.0);
    EXPECT_DOUBLE_EQ(decay.times[16], 2.5);
    EXPECT_DOUBLE_EQ(decay.values[16], std::exp(-1.0));
    const std::vector<std::pair<std::string, std::string>> bad{
        {R"({"times": [0, NaN], "values": [1, 1]})", "primitives[0].pulse.times[1]"},
        {R"({"times": [0, 1], "values": [1, NaN]})", "primitives[0].pulse.values[1]"},
        {R"({"times": [0, 1], "values": [1, -1]})", "primitives[0].pulse.values: expected no negative value"},
        {R"({"times": [0, 1e300], "values": [1, 1]})", "primitives[0].pulse.times[1]"},
        {R"({"type": "box", "start": 1, "end": 1})", "primitives[0].pulse.end: expected increasing times"},
        {R"({"type": "gaussian", "sigma": 0})", "primitives[0].pulse.sigma"},
        {R"({"type": "exponential", "decay": 0})", "primitives[0].pulse.decay"},
        {R"({"type": "exponentil"})", "did you mean 'exponential'?"},
        {R"({"type": "gaussian"})", "primitives[0].pulse.sigma: missing, expected a number from 1e-18"},
        {R"({"type": "exponential", "start": 2})", "primitives[0].pulse.decay: missing, expected"},
        {R"({"type": "box", "start": 2})", "primitives[0].pulse.end: missing, expected a number"},
        {R"({"type": "gaussian", "fwhm": 0.5})", "primitives[0].pulse.fwhm: unknown field, expected center, sigma or "
                                                 "type: a gaussian's sigma is fwhm / 2.3548"},
        {R"({"type": "gaussian", "sigme": 0.5})", "did you mean 'sigma'?"},
        {R"({"sigma": 0.5})",
         "pulse.sigma: unknown field, expected times, type or values: that takes the type gaussian"},
        {R"("long")", "primitives[0].pulse"}};
    for (const auto& [fields, expected] : bad)
        EXPECT_NE(problemsOf(scene(R"("pulse": )" + fields, gate)).find(expected), std::string::npos)
            << fields << "\n"
            << problemsOf(scene(R"("pulse": )" + fields, gate));
    const std::string notANumber = problemsOf(scene(R"("pulse": {"times": [0, 1], "values": [1, NaN]})", gate));
    EXPECT_EQ(notANumber.find("as many values"), std::string::npos) << "one mistake, one error: " << notANumber;
    const std::string box = R"("pulse": {"type": "box", "end": 1})";
    for (const char* integrator :
         {R"("delta_time_gate": true)", R"("temporal_response": {"type": "box", "start": 2, "end": 3})"})
        EXPECT_NE(problemsOf(scene(box, integrator)).find("primitives[0].pulse: "), std::string::npos) << integrator;
    EXPECT_EQ(problemsOf(scene(box, R"("max_bounces": 3)")), "") << "steady state";
    EXPECT_NE(problemsOf(scene(R"("emission_time": 1e18, "pulse": {"type": "box", "end": 1e18})", gate))
                  .find("light would go"),
              std::string::npos);
}

} // namespace
} // namespace tungsten
