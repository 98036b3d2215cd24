#pragma once
// Do methods agree? Renders a scene by several methods and compares the means over blocks of pixels within their
// standard errors.

#include "support/SceneFile.h"

#include "tungsten/film/Film.h"

#include <algorithm>
#include <cmath>
#include <iosfwd>
#include <memory>
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
Method pathMethod(std::string name, std::vector<std::string> fields, uint64_t seed);
Method guidedPathMethod(std::string name, std::vector<std::string> fields, uint64_t seed, double share = 1.0);
Method photonMethod(std::string name, std::vector<std::string> fields, uint64_t seed);
/// Without a gate there is nothing to guide light paths to: plain ones.
Method guidedPhotonMethod(std::string name, std::vector<std::string> fields, uint64_t seed, double share = 1.0);
Method beamMethod(Method method, double share);

/// The methods under test: one line each. The first is what the others are compared with.
std::vector<Method> methodsUnderTest();
/// Those that prove the harness itself.
std::vector<Method> plainMethods();
/// Those that a test has the time for on a scene, and with the samples that it needs; benchmarks/agreement runs all.
/// Guided light paths and beams take long through refraction and slow light.
std::vector<Method> methodsInTests(const std::string& scene);

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

inline double channelMean(const Vec3d& v) {
    return (v.x + v.y + v.z) / 3.0;
}
inline int blockCount(int width, int height) {
    return (width / BlockSide) * (height / BlockSide) + 1;
}

/// Renders a scene by a method. With a kernel every fourth pass is rendered at two radii, R and R/2, from the same
/// photons: the difference d = L(R) - L(R/2) tells the bias with little noise, and L(R/2) - d/3 is free of its leading
/// term, of order R^2 (Richardson). Errors add up, as the two are correlated.
BlockMeans renderBlocks(const AgreementScene& scene, const Method& method);

/// Standard errors that one block may be off by, and that all blocks may be off by in the rms: chances below 1e-6 and,
/// should noise make only five of the blocks independent, 2e-4.
inline constexpr double MostSigmas = 5.0, MostRmsSigmas = 2.2;

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
std::ostream& operator<<(std::ostream& out, const Agreement& a);

/// Throws std::logic_error unless both renders have the same size.
Agreement compare(const BlockMeans& method, const BlockMeans& reference);

} // namespace tungsten::test
