#pragma once
// Do methods agree? Renders a scene by several methods and compares the means over blocks of pixels within their
// standard errors.

#include "support/Folders.h"
#include "support/SceneFile.h"

#include "tungsten/render/Plugin.h"
#include "tungsten/render/SceneFilm.h"
#include "tungsten/scene/SceneLoader.h"

#include <algorithm>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace tungsten::test {

/// A way of rendering: values of the scene's integrator block, "field=value".
struct Method {
    std::string name;
    std::vector<std::string> fields;
    bool kernel = false;     ///< estimates density with a kernel: rendered with two radii, extrapolated to radius 0
    uint64_t seed = 1;       ///< methods with the same seed may share random numbers
    bool steadyState = true; ///< also renders without a gate
    double share = 1.0; ///< of the scene's samples or light paths per pass, for methods with less noise or dear paths
};
inline Method pathMethod(std::string name, std::vector<std::string> fields, uint64_t seed) {
    fields.insert(fields.begin(), "type=path_tracer");
    return {std::move(name), std::move(fields), false, seed, true};
}
inline Method guidedPathMethod(std::string name, std::vector<std::string> fields, uint64_t seed, double share = 1.0) {
    Method method = pathMethod(std::move(name), std::move(fields), seed);
    method.steadyState = false;
    method.share = share;
    return method;
}
inline Method photonMethod(std::string name, std::vector<std::string> fields, uint64_t seed) {
    fields.insert(fields.begin(), {"type=progressive_transient_photon_map", "alpha=1", "volume_alpha=1",
                                   "fixed_volume_radius=true", "gather_photon_count=1000000"});
    return {std::move(name), std::move(fields), true, seed, true};
}

/// Without a gate there is nothing to guide light paths to: plain ones.
inline Method guidedPhotonMethod(std::string name, std::vector<std::string> fields, uint64_t seed, double share = 1.0) {
    Method method = photonMethod(std::move(name), std::move(fields), seed);
    method.steadyState = false;
    method.share = share;
    return method;
}
inline Method beamMethod(Method method, double share) {
    method.fields.emplace_back("volume_photon_type=beams");
    method.share = share;
    return method;
}

/// The methods under test: one line each. The first is what the others are compared with.
inline std::vector<Method> methodsUnderTest() {
    return {
        pathMethod("plain paths", {}, 1),
        photonMethod("plain points", {"volume_photon_type=points"}, 2),
        guidedPhotonMethod("published points", {"darts=published"}, 3, 0.3),
        guidedPhotonMethod("best points", {"darts=best"}, 4, 0.15),
        beamMethod(photonMethod("plain beams", {}, 5), 0.15),
        beamMethod(guidedPhotonMethod("published beams", {"darts=published"}, 6), 0.12),
        beamMethod(guidedPhotonMethod("best beams", {"darts=best"}, 7), 0.08),
        guidedPathMethod("published paths", {"darts=published"}, 8, 0.5),
        guidedPathMethod("best paths", {"darts=best"}, 9, 0.5),
    };
}
/// Those that prove the harness itself.
inline std::vector<Method> plainMethods() {
    std::vector<Method> methods = methodsUnderTest();
    methods.resize(2);
    return methods;
}

/// Those that a test has the time for on a scene; benchmarks/agreement runs all. Guided light paths and beams take long
/// through refraction and slow light.
inline std::vector<Method> methodsInTests(const std::string& scene) {
    const bool slow = scene == "slow-cloud" || scene == "glass-tank", every = scene == "mirror-fog";
    std::vector<Method> methods;
    for (Method& method : methodsUnderTest()) {
        const bool plain = method.name.starts_with("plain p"), best = method.name.starts_with("best"),
                   paths = method.name.ends_with("paths");
        if (every || plain || (slow ? paths : best)) methods.push_back(std::move(method));
    }
    return methods;
}

/// Samples spent on one method.
struct Effort {
    uint32_t pathPasses, pathSamples; ///< samples per pixel and pass
    uint32_t photonPasses;            ///< of a method with a kernel, one sample per pixel each
    int photons;                      ///< light paths per pass
};

/// A scene file, how it is changed for the proof, and how much work it takes.
struct AgreementScene {
    std::string name;
    std::filesystem::path file;
    std::vector<std::string> overrides; ///< "path.to.field=value"
    int width, height;                  ///< multiples of the blocks' side
    double radius;                      ///< larger kernel radius, surfaces and volumes; the smaller one is half of it
    Effort effort;
    std::shared_ptr<const SceneFile> keepsFile; ///< of a scene built from text
    bool steadyState = false;                   ///< rendered without a gate
};

inline constexpr int BlockSide = 8;

/// Block means of a render, and the whole images they come from.
struct BlockMeans {
    int frames = 0, blocks = 0; ///< the last block is the whole image
    std::vector<Vec3d> mean;    ///< [frame * blocks + block]
    std::vector<Vec3d> error;  ///< standard error, from the spread of the passes (pixels of one pass may share photons)
    std::vector<Vec3d> shrink; ///< mean at the larger radius minus that at the smaller one; 0 without a kernel
    std::vector<Image> images; ///< per frame; with a kernel, at the smaller radius

    BlockMeans() = default;
    BlockMeans(int frameCount, int blockCount)
        : frames(frameCount), blocks(blockCount), mean(size_t(frameCount) * size_t(blockCount), Vec3d(0.0)),
          error(mean), shrink(mean) {}
    [[nodiscard]] size_t index(int frame, int block) const { return size_t(frame) * size_t(blocks) + size_t(block); }
    [[nodiscard]] const Vec3d& whole(int frame) const { return mean[index(frame, blocks - 1)]; }
};

inline Vec3d doubles(const Rgb& c) {
    return {double(c.x), double(c.y), double(c.z)};
}
inline Rgb floats(const Vec3d& v) {
    return {float(v.x), float(v.y), float(v.z)};
}
inline double channelMean(const Vec3d& v) {
    return (v.x + v.y + v.z) / 3.0;
}
inline int blockCount(int width, int height) {
    return (width / BlockSide) * (height / BlockSide) + 1;
}

/// Means of one frame of the pass in progress over its blocks, then over the image.
inline std::vector<Vec3d> blockMeansOfPass(Film& film, int frame) {
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
        EffectPlan plan = analyseScene(*scene_);
        integrator_->plan(plan);
        integrator_->prepare(plan, statistics_);
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
inline constexpr uint32_t ShrinkEvery = 4;

/// Renders a scene by a method. With a kernel every fourth pass is rendered at two radii, R and R/2, from the same
/// photons: the difference d = L(R) - L(R/2) tells the bias with little noise, and L(R/2) - d/3 is free of its leading
/// term, of order R^2 (Richardson). Errors add up, as the two are correlated.
inline BlockMeans renderBlocks(const AgreementScene& scene, const Method& method) {
    PassRenderer fine(scene, method, 0.5 * scene.radius), coarse(scene, method, scene.radius);
    const uint32_t passes = method.kernel ? scene.effort.photonPasses : scene.effort.pathPasses;
    const uint32_t samples = method.kernel ? 1 : uint32_t(scene.effort.pathSamples * method.share);
    const int frames = fine.film().frames(), blocks = blockCount(scene.width, scene.height);
    BlockFilm values(blocks, frames), shrink(blocks, frames);
    for (uint32_t pass = 0; pass < passes; ++pass) {
        const PassInfo info{pass, uint64_t(pass) * samples, samples, method.seed};
        values.add(fine.render(info));
        if (method.kernel && pass % ShrinkEvery == 0) shrink.add(coarse.render(info), &fine.pass());
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

/// Standard errors that one block may be off by, and that all blocks may be off by in the rms: chances below 1e-6 and,
/// should noise make only five of the blocks independent, 2e-4.
inline constexpr double MostSigmas = 5.0, MostRmsSigmas = 2.2;

/// Result of a comparison. The last figures are relative to the mean over image and frames.
struct Agreement {
    double worst = 0.0;     ///< largest |difference| / allowed
    double rmsSigmas = 0.0; ///< rms over blocks of the differences beyond the bias, in standard errors
    int frame = 0, block = 0, channel = 0;
    double value = 0.0, reference = 0.0, allowed = 0.0; ///< there, absolute
    double difference = 0.0;                            ///< of the means over image and frames
    double deviation = 0.0;                             ///< rms difference of the blocks
    double blockError = 0.0;                            ///< rms combined standard error of the blocks
    double wholeError = 0.0;                            ///< the same of the images' means
    double shrink = 0.0; ///< rms over blocks of the change from the larger radius to the smaller one

    /// Part of what is allowed that was used up: methods agree when it is at most 1.
    [[nodiscard]] double score() const { return std::max(worst, rmsSigmas / MostRmsSigmas); }
};
inline std::ostream& operator<<(std::ostream& out, const Agreement& a) {
    return out << a.worst << " of what is allowed, at frame " << a.frame << " block " << a.block << " channel "
               << a.channel << ": " << a.value << ", expected " << a.reference << " +- " << a.allowed
               << "; rms of blocks " << a.rmsSigmas << " standard errors"
               << "; relative to the mean: difference " << a.difference << ", rms deviation of blocks " << a.deviation
               << ", standard error of blocks " << a.blockError << ", of images " << a.wholeError
               << ", change with the radius " << a.shrink;
}

/// Sums of squares over blocks, frames and channels.
struct SquareSums {
    double deviation = 0.0, blockError = 0.0, wholeError = 0.0, shrink = 0.0, sigmas = 0.0;
};

/// Combined standard error of two methods in one channel of a block, and what they may differ by besides: 2/3 of the
/// change with the radius (what extrapolation leaves if the bias falls only linearly, as it does at edges), and a
/// hundredth of the mean, for blocks too dark to know their own error.
struct Allowance {
    double error, bias;
    Allowance(const BlockMeans& method, const BlockMeans& reference, size_t i, int channel, const Vec3d& mean)
        : error(std::hypot(method.error[i][channel], reference.error[i][channel])),
          bias(2.0 / 3.0 * (std::abs(method.shrink[i][channel]) + std::abs(reference.shrink[i][channel])) +
               0.01 * mean[channel]) {}
    [[nodiscard]] double total() const { return MostSigmas * error + bias; }
    /// Standard errors that a difference beyond the bias amounts to.
    [[nodiscard]] double sigmas(double difference) const {
        const double beyond = std::abs(difference) - bias;
        return beyond > 0.0 ? beyond / error : 0.0;
    }
};

inline void compareBlock(const BlockMeans& method, const BlockMeans& reference, int frame, int block, const Vec3d& mean,
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

inline Agreement compare(const BlockMeans& method, const BlockMeans& reference) {
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
