#include "support/PathsAndPhotons.h"

#include "path/PathTracer.h"
#include "path/light/LightTracer.h"
#include "photon/PhotonIntegrator.h"

namespace tungsten::test {

namespace {
template <typename Made>
std::unique_ptr<Rendered> renderBy(const std::filesystem::path& file, const RenderOptions& options) {
    return render(file, options, [](std::shared_ptr<const Scene> scene, const ObjectReader& settings) {
        return std::make_unique<Made>(std::move(scene), settings);
    });
}
} // namespace

std::unique_ptr<Rendered> renderPathFile(const std::filesystem::path& file, const RenderOptions& options) {
    RenderOptions paths = options;
    paths.overrides.emplace_back("integrator.type=path_tracer");
    return renderBy<path::PathTracer>(file, paths);
}
std::unique_ptr<Rendered> renderPaths(const std::string& json, const RenderOptions& options) {
    return renderPathFile(SceneFile(json).path(), options);
}
std::unique_ptr<Rendered> renderLightFile(const std::filesystem::path& file, const RenderOptions& options) {
    return renderBy<path::LightTracer>(file, options);
}
std::unique_ptr<Rendered> renderLight(const std::string& json, const RenderOptions& options) {
    return renderLightFile(SceneFile(json).path(), options);
}

std::unique_ptr<Rendered> renderPhotonFile(const std::filesystem::path& file, const RenderOptions& options,
                                           bool progressive) {
    return render(file, options, [=](std::shared_ptr<const Scene> scene, const ObjectReader& settings) {
        return std::make_unique<photon::PhotonIntegrator>(std::move(scene), settings, progressive);
    });
}
std::unique_ptr<Rendered> renderPhotons(const std::string& json, const RenderOptions& options) {
    return renderPhotonFile(SceneFile(json).path(), options);
}
std::unique_ptr<Rendered> renderBeams(const std::string& json, RenderOptions options) {
    const std::string beams = "integrator.volume_photon_type=beams";
    options.overrides.insert(options.overrides.begin(), beams);
    return renderPhotons(json, options);
}

void expectSameBlocks(const Rendered& a, const Rendered& b, int frame, double bias, double largestError) {
    const Image va = a.film.mean(frame), vb = b.film.mean(frame);
    const Image ea = a.film.standardError(frame), eb = b.film.standardError(frame);
    const double average = b.mean(frame);
    ASSERT_GT(average, 0.0);
    double errors = 0.0;
    const int columns = va.width / 8, blocks = columns * (va.height / 8);
    for (int block = 0; block < blocks; ++block) {
        double difference = 0.0, correlated = 0.0, independent = 0.0;
        for (int i = 0; i < 64; ++i) {
            const int x = 8 * (block % columns) + i % 8, y = 8 * (block / columns) + i / 8;
            difference += double(va.at(x, y).y - vb.at(x, y).y) / 64.0;
            correlated += double(ea.at(x, y).y) / 64.0;
            independent += double(eb.at(x, y).y * eb.at(x, y).y) / (64.0 * 64.0);
        }
        const double error = std::sqrt(correlated * correlated + independent);
        EXPECT_LT(std::abs(difference), 4.0 * error + bias * average) << "frame " << frame << " block " << block;
        errors += error / blocks;
    }
    EXPECT_LT(errors, largestError * average) << "frame " << frame << ": the test would not see a wrong value";
}

} // namespace tungsten::test
