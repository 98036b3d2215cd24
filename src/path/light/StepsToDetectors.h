#pragma once
// Steps of a plain light path that is split on its way to detectors, and ended where it goes away from them.

#include "transport/PlainSteps.h"

namespace tungsten::path {

/// What light at a place in a medium is worth to detectors, over what it was worth where its path started: the mean
/// over detectors of what diffusion brings to each, which gets paths of about the same weight whatever its distance.
/// With mu = sqrt(3 sigma_a (sigma_a + sigma_s (1 - g))) that is exp(-mu r) / r in a medium, and (1 + mu r) exp(-mu r)
/// / r^3, the flux of a dipole, out of one that ends (Farrell et al. 1992). Whatever the function, the image is the
/// same.
class DetectorImportance {
  public:
    /// `start`: of the path. `inside`: the detectors are in what scatters.
    DetectorImportance(const Detectors& detectors, bool inside, const Vec3f& start)
        : detectors_(&detectors), inside_(inside), start_(start) {}

    [[nodiscard]] float at(const Vec3f& position, const Medium& medium) const {
        const float scatters = meanComponent(medium.sigmaS()) * (1.0f - medium.phase.g()),
                    absorbs = meanComponent(medium.sigmaA()), mu = std::sqrt(3.0f * absorbs * (absorbs + scatters));
        // Nearer than light keeps its direction, or than the disc is wide, places differ little.
        const float mean = 1.0f / std::max(absorbs + scatters, 1e-20f);
        float sum = 0.0f;
        for (const Detector& detector : detectors_->row) {
            const float least = std::max(mean, detector.radius);
            const float here = std::max((position - detector.position).length(), least),
                        before = std::max((start_ - detector.position).length(), least), nearer = before / here;
            const float slope = inside_ ? 1.0f : sqr(nearer) * (1.0f + mu * here) / (1.0f + mu * before);
            sum += std::min(nearer * slope * std::exp(std::min(mu * (before - here), 80.0f)), Most);
        }
        return sum / float(detectors_->row.size());
    }

  private:
    /// Copies of a path: a bound on its time, where the function is a bad guess.
    static constexpr float Most = 1e4f;

    const Detectors* detectors_;
    bool inside_;
    Vec3f start_;
};

class StepsToDetectors : public transport::PlainLightSteps {
  public:
    explicit StepsToDetectors(const transport::WalkContext& context) : PlainSteps(context) {}
    /// Prepares the steps of the path, once it is known where it starts.
    void startAt(const Vec3f& position) {
        const Scene& scene = context().scene;
        const Medium* medium = scene.medium(scene.cameraRegion);
        importance_.emplace(*scene.camera.detectors(), medium && medium->scatters(), position);
    }

    /// Throughput times importance stays about 1: from half on, and up to twice that, nothing is done.
    int copies(transport::PathState& path, const transport::WalkVertex& vertex) {
        if (!vertex.medium) return 1;
        const float worth = meanComponent(path.throughput) * importance_->at(vertex.position, *vertex.medium);
        if (worth > 2.0f && splits_ < MostSplits) {
            ++splits_;
            return int(worth);
        }
        if (!(worth < 0.5f)) return 1;
        path.random.at(path.interactions, Draw::Connection);
        if (!(path.random.next1D() < worth)) return 0;
        path.throughput = path.throughput / worth;
        return 1;
    }

  private:
    /// Copies run within each other: a bound on the stack, which paths of a million bounces to and fro would meet.
    static constexpr int MostSplits = 1000;

    std::optional<DetectorImportance> importance_;
    int splits_ = 0; ///< of the path and those that it is a copy of
};

} // namespace tungsten::path
