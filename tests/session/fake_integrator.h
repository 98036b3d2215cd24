#pragma once
// An integrator whose image is random numbers keyed by (seed, pass, pixel, frame): enough to test a session.

#include "support/SceneFile.h"

#include "tungsten/core/Random.h"
#include "tungsten/film/FilmRows.h"
#include "tungsten/session/Session.h"

#include <deque>
#include <functional>
#include <sstream>

namespace tungsten::test {

class FakeIntegrator : public Integrator {
  public:
    std::vector<PassInfo> passes;
    std::function<void(const PassInfo&)> afterPass = [](const PassInfo&) {};
    std::function<void(const ProgressToken&)> preparing = [](const ProgressToken&) {};
    float noise = 1.0f; ///< pixels are uniform in [1 - noise, 1]
    float bias = 0.0f;  ///< that it says it leaves, with a noise of its own; 0: it leaves none
    bool prepared = false;
    bool cutsPaths = false; ///< that it says it can

    void plan(SceneFacts&, Features& features) const override { features.describe("fake", true, "a test"); }
    void prepare(const SceneFacts&, const ProgressToken& watch, Statistics&) override {
        preparing(watch);
        prepared = true;
    }
    [[nodiscard]] bool leavesBias(const SceneFacts&) const override { return bias > 0.0f; }
    [[nodiscard]] bool cutsLightPaths() const override { return cutsPaths; }
    void renderPass(const PassInfo& pass, Film& film, Statistics& statistics) override {
        for (int frame = 0; frame < film.frames(); ++frame)
            for (int y = 0; y < film.height(); ++y)
                for (int x = 0; x < film.width(); ++x) {
                    const auto path = uint64_t((frame * film.height() + y) * film.width() + x);
                    Sampler sampler(pass.seed, RandomStream::Test, pass.index, path);
                    film.set(frame, x, y, Rgb(1.0f - noise * sampler.next1D()));
                    if (pass.bias) pass.bias->add(frame, x, y, Rgb(bias * (0.9f + 0.2f * sampler.next1D())));
                }
        statistics.add("fake passes", 1);
        passes.push_back(pass);
        afterPass(pass);
    }
};

/// A tiny scene; `integrator` and `renderer` are the blocks' contents.
inline std::string tinyScene(const std::string& integrator,
                             const std::string& renderer = R"("spp": 8, "spp_step": 2)") {
    return R"({"primitives": [{"name": "lamp", "type": "point", "emission": 1}],
               "camera": {"type": "pinhole", "resolution": [6, 4]},
               "integrator": {"type": "path_tracer")" +
           (integrator.empty() ? "" : ", " + integrator) + "}, \"renderer\": {" + renderer + "}}";
}
inline const char* const ThreeFrames = R"("start_time": 2, "transient_time_width": 0.5, "frame_num": 3)";

/// Renders a scene with a fake integrator the way the command does.
class SessionFixture {
  public:
    explicit SessionFixture(const std::string& json) : file(json), loaded(loadScene(file.path())) {
        options.spp = loaded.renderer.spp;
        options.sppStep = loaded.renderer.sppStep;
        options.quiet = true;
        outputs = resolveOutputs(loaded.renderer, file.path(), {});
    }
    const SessionResult& run() {
        SessionResult& result = results.emplace_back();
        SceneFacts facts = analyseScene(*loaded.scene);
        Features features = featuresOf(*loaded.scene, facts);
        integrator.plan(facts, features);
        runSession(loaded, integrator, facts, features, outputs, options, result);
        return result;
    }
    [[nodiscard]] std::filesystem::path folder() const { return file.path().parent_path(); }
    [[nodiscard]] bool has(const std::string& name) const { return std::filesystem::exists(folder() / name); }

    SceneFile file;
    LoadedScene loaded;
    FakeIntegrator integrator;
    OutputFiles outputs;
    SessionOptions options;
    std::deque<SessionResult> results; ///< of every run
};

/// The film's exact state.
inline std::string bitsOf(const Film& film) {
    std::ostringstream out;
    FilmRows::writeState(film, out);
    return out.str();
}

} // namespace tungsten::test
