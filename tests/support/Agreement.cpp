#include "support/Agreement.h"

#include "support/SeedShift.h"

#include "support/Folders.h"

#include "tungsten/scene/SceneLoader.h"
#include "tungsten/session/Job.h"
#include "tungsten/session/Memory.h"

#include <optional>
#include <ostream>

namespace tungsten::test {

Method pathMethod(std::string name, std::vector<std::string> fields, uint64_t seed) {
    const std::string type = "type=path_tracer";
    fields.insert(fields.begin(), type);
    return {std::move(name), std::move(fields), false, seed, true};
}
Method guidedPathMethod(std::string name, std::vector<std::string> fields, uint64_t seed, double share) {
    Method method = pathMethod(std::move(name), std::move(fields), seed);
    method.steadyState = false;
    method.share = share;
    return method;
}
Method photonMethod(std::string name, std::vector<std::string> fields, uint64_t seed) {
    fields.insert(fields.begin(), {"type=progressive_transient_photon_map", "alpha=1", "volume_alpha=1",
                                   "fixed_volume_radius=true", "gather_photon_count=1000000"});
    return {std::move(name), std::move(fields), true, seed, true};
}

Method guidedPhotonMethod(std::string name, std::vector<std::string> fields, uint64_t seed, double share) {
    Method method = photonMethod(std::move(name), std::move(fields), seed);
    method.steadyState = false;
    method.share = share;
    return method;
}
Method beamMethod(Method method, double share) {
    method.fields.emplace_back("volume_photon_type=beams");
    method.share = share;
    return method;
}

std::vector<Method> methodsUnderTest() {
    return {
        pathMethod("plain paths", {}, 1),
        photonMethod("plain points", {"volume_photon_type=points"}, 2),
        guidedPhotonMethod("published points", {"darts=published"}, 3, 0.3),
        guidedPhotonMethod("best points", {"darts=best"}, 14, 0.25),
        beamMethod(photonMethod("plain beams", {}, 5), 0.15),
        beamMethod(guidedPhotonMethod("published beams", {"darts=published"}, 6), 0.12),
        beamMethod(guidedPhotonMethod("best beams", {"darts=best"}, 7), 0.08),
        guidedPathMethod("published paths", {"darts=published"}, 8, 0.5),
        guidedPathMethod("best paths", {"darts=best"}, 9, 0.5),
    };
}
std::vector<Method> plainMethods() {
    std::vector<Method> methods = methodsUnderTest();
    methods.resize(2);
    return methods;
}

std::vector<Method> methodsInTests(const std::string& scene) {
    const bool slow = scene == "slow-cloud" || scene == "glass-tank", every = scene == "mirror-fog";
    std::vector<Method> methods;
    for (Method& method : methodsUnderTest()) {
        const bool plain = method.name.starts_with("plain p"), best = method.name.starts_with("best"),
                   paths = method.name.ends_with("paths");
        if (!every && !plain && !(slow ? paths : best)) continue;
        // Guided methods need less to be hardly noisier than the plain paths that they are compared with.
        const bool needsAll = scene == "glass-tank" || (every && method.name.ends_with("beams"));
        if (!plain && !needsAll) method.share *= every ? 0.6 : paths && !slow ? 0.25 : 0.5;
        methods.push_back(std::move(method));
    }
    return methods;
}

namespace {

Vec3d doubles(const Rgb& c) {
    return {double(c.x), double(c.y), double(c.z)};
}
Rgb floats(const Vec3d& v) {
    return {float(v.x), float(v.y), float(v.z)};
}
/// Means of one frame of the pass in progress over its blocks, then over the image.
std::vector<Vec3d> blockMeansOfPass(Film& film, int frame) {
    const int columns = film.width() / BlockSide, count = blockCount(film.width(), film.height());
    std::vector<Vec3d> means(size_t(count), Vec3d(0.0));
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) {
            const Vec3d pixel = doubles(film.passPixel(frame, x, y));
            means[size_t((y / BlockSide) * columns + x / BlockSide)] += pixel / double(BlockSide * BlockSide);
            means.back() += pixel / double(film.width() * film.height());
        }
    return means;
}

/// An integrator ready to render passes of a scene at one kernel radius.
class PassRenderer {
  public:
    /// Throws InputError for anything that the build does not know, warnings about the integrator block included: a
    /// method that is not there must not be taken for one that agrees.
    PassRenderer(const AgreementScene& scene, const Method& method, double radius) {
        std::vector<std::string> overrides = scene.overrides;
        for (const std::string& field : method.fields) overrides.push_back("integrator." + field);
        if (scene.steadyState) removeGate(overrides);
        const std::string r = std::to_string(radius);
        if (method.kernel)
            overrides.insert(overrides.end(),
                             {"integrator.gather_radius=" + r, "integrator.volume_gather_radius=" + r,
                              "integrator.photon_count=" + std::to_string(int(scene.effort.photons * method.share)),
                              "integrator.volume_photon_count=100000000"});
        overrides.push_back("camera.resolution=[" + std::to_string(scene.width) + "," + std::to_string(scene.height) +
                            "]");
        const LoadedScene loaded = loadScene(scene.file, {{}, overrides});
        scene_ = loaded.scene;
        const auto& known = registry().entries();
        const auto found = known.find(loaded.integratorType);
        if (found == known.end()) throw InputError(method.name, "no integrator '" + loaded.integratorType + "'");
        integrator_ = found->second.factory(loaded.scene, loaded.integratorSettings);
        loaded.integratorSettings.warnAboutUnknown();
        for (const Problem& warning : loaded.diagnostics->warnings)
            if (warning.path.rfind("integrator", 0) == 0) loaded.diagnostics->problems.push_back(warning);
        throwIfProblems(*loaded.diagnostics);
        SceneFacts facts = analyseScene(*scene_);
        Features features = featuresOf(*scene_, facts);
        integrator_->plan(facts, features);
        integrator_->prepare(facts, {}, statistics_);
        film_ = filmOf(*scene_);
    }
    /// The film holds the pass until the next one.
    Film& render(const PassInfo& pass) {
        film_.beginPass();
        integrator_->renderPass(pass, film_, statistics_);
        film_.endPass(double(pass.samples));
        return film_;
    }
    [[nodiscard]] const Film& film() const { return film_; }
    [[nodiscard]] Film& pass() { return film_; }

  private:
    static void removeGate(std::vector<std::string>& overrides) {
        for (std::string& field : overrides)
            if (field == "integrator.type=progressive_transient_photon_map")
                field = "integrator.type=progressive_photon_map";
        overrides.insert(overrides.end(), {"integrator.frame_num=0", "integrator.transient_time_center=-1",
                                           "integrator.transient_time_width=0"});
    }
    static const IntegratorRegistry& registry() {
        static const IntegratorRegistry loaded = [] {
            IntegratorRegistry fresh;
            const std::vector<Problem> problems = loadPlugins({binaryFolder()}, fresh);
            if (!problems.empty()) throw InputError(problems);
            return fresh;
        }();
        return loaded;
    }

    std::shared_ptr<const Scene> scene_;
    std::unique_ptr<Integrator> integrator_;
    Statistics statistics_;
    Film film_;
};

/// Accumulates the block means of passes: a film with one column per block.
class BlockFilm {
  public:
    BlockFilm(int blocks, int frames) : film_(blocks, 1, frames) {}
    /// Adds a pass, or the difference of two passes (`minus`).
    void add(Film& pass, Film* minus = nullptr) {
        film_.beginPass();
        for (int frame = 0; frame < film_.frames(); ++frame) {
            const std::vector<Vec3d> means = blockMeansOfPass(pass, frame);
            const std::vector<Vec3d> others =
                minus ? blockMeansOfPass(*minus, frame) : std::vector<Vec3d>(means.size());
            for (size_t block = 0; block < means.size(); ++block)
                film_.set(frame, int(block), 0, floats(minus ? means[block] - others[block] : means[block]));
        }
        film_.endPass(1.0);
    }
    [[nodiscard]] Vec3d mean(int frame, int block) const { return doubles(film_.mean(frame).at(block, 0)); }
    [[nodiscard]] Vec3d error(int frame, int block) const { return doubles(film_.standardError(frame).at(block, 0)); }

  private:
    Film film_;
};

/// Every so many passes are rendered at both radii.
constexpr uint32_t ShrinkEvery = 4;

} // namespace

BlockMeans renderBlocks(const AgreementScene& scene, const Method& method) {
    PassRenderer fine(scene, method, 0.5 * scene.radius);
    std::optional<PassRenderer> coarse;
    if (method.kernel) coarse.emplace(scene, method, scene.radius);
    const uint32_t passes = method.kernel ? scene.effort.photonPasses : scene.effort.pathPasses;
    const uint32_t samples = method.kernel ? 1 : uint32_t(scene.effort.pathSamples * method.share);
    const int frames = fine.film().frames(), blocks = blockCount(scene.width, scene.height);
    BlockFilm values(blocks, frames), shrink(blocks, frames);
    for (uint32_t pass = 0; pass < passes; ++pass) {
        const PassInfo info{pass, uint64_t(pass) * samples, samples, method.seed + seedShift()};
        values.add(fine.render(info));
        if (method.kernel && pass % ShrinkEvery == 0) shrink.add(coarse->render(info), &fine.pass());
    }
    BlockMeans result(frames, blocks);
    for (int frame = 0; frame < frames; ++frame) {
        result.images.push_back(fine.film().mean(frame));
        for (int block = 0; block < blocks; ++block) {
            const size_t i = result.index(frame, block);
            result.shrink[i] = shrink.mean(frame, block);
            result.mean[i] = values.mean(frame, block) - result.shrink[i] / 3.0;
            result.error[i] = values.error(frame, block);
            if (method.kernel) result.error[i] += shrink.error(frame, block) / 3.0;
        }
    }
    return result;
}

std::ostream& operator<<(std::ostream& out, const Agreement& a) {
    return out << a.worst << " of what is allowed, at frame " << a.frame << " block " << a.block << " channel "
               << a.channel << ": " << a.value << ", expected " << a.reference << " +- " << a.allowed
               << "; rms of blocks " << a.rmsSigmas << " standard errors"
               << "; relative to the mean: difference " << a.difference << ", rms deviation of blocks " << a.deviation
               << ", standard error of blocks " << a.blockError << ", of images " << a.wholeError
               << ", change with the radius " << a.shrink;
}

namespace {

/// Sums of squares over blocks, frames and channels.
struct SquareSums {
    double deviation = 0.0, blockError = 0.0, wholeError = 0.0, shrink = 0.0, sigmas = 0.0;
};

void compareBlock(const BlockMeans& method, const BlockMeans& reference, int frame, int block, const Vec3d& mean,
                  SquareSums& sums, Agreement& result) {
    const size_t i = reference.index(frame, block);
    for (int c = 0; c < 3; ++c) {
        const Allowance allowance(method, reference, i, c, mean);
        const double shrink = method.shrink[i][c], difference = method.mean[i][c] - reference.mean[i][c];
        const double allowed = allowance.total();
        if (block == reference.blocks - 1) {
            sums.wholeError += allowance.error * allowance.error;
        } else {
            sums.sigmas += allowance.sigmas(difference) * allowance.sigmas(difference);
            sums.blockError += allowance.error * allowance.error;
            sums.shrink += shrink * shrink;
            sums.deviation += difference * difference;
        }
        if (std::abs(difference) <= result.worst * allowed) continue;
        result.worst = std::abs(difference) / allowed;
        result.frame = frame;
        result.block = block;
        result.channel = c;
        result.value = method.mean[i][c];
        result.reference = reference.mean[i][c];
        result.allowed = allowed;
    }
}

} // namespace

Agreement compare(const BlockMeans& method, const BlockMeans& reference) {
    if (method.frames != reference.frames || method.blocks != reference.blocks)
        throw std::logic_error("renders of different sizes cannot be compared");
    Vec3d methodMean(0.0), mean(0.0);
    for (int frame = 0; frame < reference.frames; ++frame) {
        methodMean += method.whole(frame) / double(reference.frames);
        mean += reference.whole(frame) / double(reference.frames);
    }
    Agreement result;
    SquareSums sums;
    for (int frame = 0; frame < reference.frames; ++frame)
        for (int block = 0; block < reference.blocks; ++block)
            compareBlock(method, reference, frame, block, mean, sums, result);
    const double average = channelMean(mean), images = 3.0 * reference.frames, blocks = images * (reference.blocks - 1);
    result.rmsSigmas = std::sqrt(sums.sigmas / blocks);
    result.difference = channelMean(methodMean) / average - 1.0;
    result.deviation = std::sqrt(sums.deviation / blocks) / average;
    result.blockError = std::sqrt(sums.blockError / blocks) / average;
    result.wholeError = std::sqrt(sums.wholeError / images) / average;
    result.shrink = std::sqrt(sums.shrink / blocks) / average;
    return result;
}

} // namespace tungsten::test
