#include "photon/PrimitivePilot.h"

#include "photon/PhotonIntegrator.h"
#include "photon/Tuning.h"
#include "transport/SharePilot.h"
#include "transport/Tuning.h"

#include "tungsten/film/FilmErrors.h"
#include "tungsten/integrator/Names.h"

#include <algorithm>
#include <cmath>

namespace tungsten::photon {

namespace {

/// Pixels of the pilots' image, at most, over all frames, and of each frame at least: enough for kernels and paths of
/// light to look as they will.
constexpr double MostPixels = 4096.0, LeastPixels = 256.0;

/// The scene as seen in a smaller image, over the same geometry.
std::shared_ptr<const Scene> smallScene(const Scene& scene) {
    auto small = std::make_shared<Scene>(scene);
    if (small->camera.detectors()) return small;
    Vec2i& size = small->camera.resolution;
    const double most = std::max(MostPixels / double(scene.transport.gate.frames), LeastPixels);
    const double part = std::sqrt(most / (double(size.x) * double(size.y)));
    if (part >= 1.0) return small;
    size = {std::max(int(double(size.x) * part), 1), std::max(int(double(size.y) * part), 1)};
    return small;
}

double pixelsOf(const Scene& scene) {
    return double(scene.camera.resolution.x) * double(scene.camera.resolution.y);
}

/// Nanoseconds of what passes have counted, had they `ratio` times as many camera paths.
double costOf(const Statistics& counted, const VolumePrimitive& primitive, double ratio) {
    const auto& costs = tuning::PassNanoseconds;
    const auto count = [&](const std::string& counter) { return double(counted.counter(counter)); };
    const double walks =
        costs.path * count(counter::Photons) + costs.ray * count(counter::Rays) +
        costs.mediumEvent * count(counter::MediumEvents) + costs.surfaceEvent * count(counter::SurfaceEvents) +
        costs.controlVertex * count(counter::ControlVertices) + costs.connection * count(counter::SurfaceConnections) +
        costs.density * count(counter::FlightDensities);
    const auto ofRecords = [&]<typename Primitive>(const Primitive& p) {
        const tuning::PassCosts::Record& record = Primitive::AtVertices      ? costs.point
                                                  : Primitive::LimitsRecords ? costs.slice
                                                                             : costs.beam;
        const double stored = count(p.Stored), splatted = count(counter::SplattedRecords);
        return record.stored * stored + record.ended * count(counter::EndedKernels) +
               ratio * (record.splatted * splatted + record.gathered * (count(p.Gathered) - splatted));
    };
    return walks + std::visit(ofRecords, primitive);
}

/// One primitive's passes.
class Pilot {
  public:
    Pilot(const std::shared_ptr<const Scene>& scene, const PhotonSettings& settings, const SceneFacts& facts,
          const ProgressToken& watch)
        : primitive_(settings.primitive), progressive_(settings.progressive), integrator_(scene, settings),
          film_(scene->camera.resolution.x, scene->camera.resolution.y, scene->transport.gate.frames) {
        Statistics unreported;
        integrator_.prepare(facts, watch, unreported);
        pass_.watch = watch;
        pass_.share = std::min(1.0, tuning::PathsOfPass / double(settings.photonCount));
        renderPass(pass_.share * 1e-6, camera_);
        pass_.share *= affordablePart();
        // Variances are as the inverse of the number of light paths, but where kernels narrow the more there are: then
        // a ray meets as many as their cube root.
        const bool follow = std::visit([&](const auto& p) { return p.radiiFollowRecords(settings); }, primitive_);
        ofWholePass_ = follow ? std::cbrt(pass_.share) : pass_.share;
    }
    void render(uint32_t passes) {
        while (film_.passes() < passes) {
            renderPass(pass_.share, counted_);
            film_.endPass(1.0);
        }
    }
    [[nodiscard]] const VolumePrimitive& primitive() const { return primitive_; }
    [[nodiscard]] uint32_t passes() const { return film_.passes(); }
    [[nodiscard]] double cost() const { return costOf(counted_, primitive_, 1.0); }
    [[nodiscard]] double mean() const { return meanValue(film_); }
    /// Variance times cost of a whole pass in an image of so many times the pixels. `brightest`: the largest mean of
    /// the primitives; what this one has not seen of it in n passes comes at most once in n, with a variance of n times
    /// its square at least: dark images have little noise. Infinite where nothing has arrived.
    [[nodiscard]] double error(double pixelRatio, double brightest) const {
        const double passes = double(film_.passes()), deviation = relativeErrorBound(film_) * mean();
        if (!std::isfinite(deviation)) return Infinity;
        const double missed = brightest - mean(), variance = passes * std::max(deviation * deviation, missed * missed);
        // A pass without light paths costs what camera paths do.
        const double camera = costOf(camera_, primitive_, 1.0);
        const double lightPaths = std::max(costOf(counted_, primitive_, pixelRatio) / passes - camera, 0.0);
        return variance * ofWholePass_ * (lightPaths / pass_.share + pixelRatio * camera);
    }

  private:
    /// The part of a pass's light paths with which the least number of passes stays within the budget.
    [[nodiscard]] double affordablePart() {
        constexpr double Trial = 1.0 / 16.0, Budget = double(transport::tuning::MostPilotCost) / tuning::LeastPasses;
        Statistics trial;
        renderPass(pass_.share * Trial, trial);
        const auto costOfPass = [&](const Statistics& pass) { return costOf(pass, primitive_, 1.0); };
        const double lightPaths = (costOfPass(trial) - costOfPass(camera_)) / Trial;
        return lightPaths > Budget ? std::max(Budget / lightPaths, Trial) : 1.0;
    }

    VolumePrimitive primitive_;
    bool progressive_;
    PhotonIntegrator integrator_;
    Film film_;
    PassInfo pass_;
    double ofWholePass_ = 1.0;    ///< its variance over that of a pass here
    Statistics counted_, camera_; ///< of all passes; of one that has hardly any light paths

    void renderPass(double share, Statistics& counted) {
        PassInfo pass = pass_;
        pass.share = share;
        pass.index = progressive_ ? uint32_t(std::min(std::round(tuning::MiddlePass / share), 4e9)) : 0;
        pass.firstSample = film_.passes();
        pass.seed = transport::PilotKey + film_.passes();
        film_.beginPass();
        integrator_.renderPass(pass, film_, counted);
    }
};

/// The primitives that are still in the running, the best one first.
class Comparison {
  public:
    Comparison(std::vector<std::unique_ptr<Pilot>> pilots, double pixelRatio)
        : best_(pilots.front()->primitive()), pilots_(std::move(pilots)), pixelRatio_(pixelRatio) {}

    [[nodiscard]] bool undecided() const {
        constexpr auto Budget = double(transport::tuning::MostPilotCost);
        if (pilots_.size() == 1 || next_ > tuning::MostPasses) return false;
        if (cost_ < Budget) return true;
        // More than that only where slices, with a lead as it is, would prove themselves by it.
        const double passes = 0.5 * next_ * tuning::SliceCost * Budget / cost_;
        return cost_ < tuning::SliceCost * Budget &&
               leadOfSlices_ * std::min(passes, double(tuning::MostPasses)) > tuning::SlicePasses;
    }
    /// Renders as many passes of each again as there are, and drops what is far worse.
    void render() {
        double brightest = 0.0;
        cost_ = 0.0;
        for (const auto& pilot : pilots_) {
            pilot->render(next_);
            cost_ += pilot->cost();
            brightest = std::max(brightest, pilot->mean());
        }
        const auto error = [&](const auto& pilot) { return pilot->error(pixelRatio_, brightest); };
        std::stable_sort(pilots_.begin(), pilots_.end(),
                         [&](const auto& a, const auto& b) { return error(a) < error(b); });
        // What slices contribute has no bound. Were their variance to grow with the number of passes, as it does with
        // the heaviest tails, they would be ahead of kernels until so many: till then kernels compete by themselves.
        const double least = error(pilots_.front()), doubt = 1.0 / std::sqrt(double(next_));
        const Pilot* const kernel = bestKernel(error, 1.0 + doubt);
        const double lead = kernel ? error(kernel) / least : Infinity;
        const bool slicesAhead = !isKernel(*pilots_.front()),
                   proven = slicesAhead && double(next_) * lead > tuning::SlicePasses;
        leadOfSlices_ = slicesAhead && !proven ? lead : 0.0;
        best_ = (kernel && !proven ? kernel : pilots_.front().get())->primitive();
        const double leastOfKernels = kernel && !proven ? error(kernel) : least;
        // Variances of so many passes are known to about this factor.
        const double factor = 1.0 + tuning::FarWorse * doubt;
        if (std::isfinite(least))
            std::erase_if(pilots_, [&](const auto& pilot) {
                if (error(pilot) <= factor * (isKernel(*pilot) ? leastOfKernels : least)) return false;
                dropped_ += pilot->passes();
                return true;
            });
        next_ *= 2;
    }
    [[nodiscard]] const VolumePrimitive& best() const { return best_; }
    [[nodiscard]] uint64_t passes() const {
        uint64_t passes = dropped_;
        for (const auto& pilot : pilots_) passes += pilot->passes();
        return passes;
    }

  private:
    static bool isKernel(const Pilot& pilot) { return !std::holds_alternative<Slices>(pilot.primitive()); }
    /// Points, or beams if they are better by more than the factor: at flat angles what they contribute has no bound,
    /// so that few passes make them look better than they are. Null where slices alone are left.
    [[nodiscard]] const Pilot* bestKernel(const auto& error, double factor) const {
        const Pilot *points = nullptr, *beams = nullptr;
        for (const auto& pilot : pilots_) {
            if (std::holds_alternative<Points>(pilot->primitive())) points = pilot.get();
            if (std::holds_alternative<Beams>(pilot->primitive())) beams = pilot.get();
        }
        return !points || (beams && factor * error(beams) < error(points)) ? beams : points;
    }

    VolumePrimitive best_;
    std::vector<std::unique_ptr<Pilot>> pilots_;
    double pixelRatio_, cost_ = 0.0;
    double leadOfSlices_ = 0.0;           ///< over kernels, which they have yet to prove
    uint32_t next_ = tuning::LeastPasses; ///< passes of each
    uint64_t dropped_ = 0;                ///< passes of those that are no longer in the running
};

std::string typeOf(const VolumePrimitive& primitive) {
    return std::visit(Overloaded{[](const Slices& slices) { return std::string(sliceName(slices.kind).type); },
                                 [](const auto& kernels) { return std::string(kernels.Type); }},
                      primitive);
}

} // namespace

std::string primitivesToMeasure(const std::vector<VolumePrimitive>& alternatives) {
    std::string all;
    for (const VolumePrimitive& one : alternatives) all += (all.empty() ? "" : ", ") + typeOf(one);
    return "measured before the first pass: " + all;
}

MeasuredPrimitive measurePrimitives(const std::shared_ptr<const Scene>& scene, const PhotonSettings& settings,
                                    const SceneFacts& facts, const ProgressToken& watch) {
    const std::shared_ptr<const Scene> small = smallScene(*scene);
    PhotonSettings one = settings;
    one.alternatives.clear();
    std::vector<std::unique_ptr<Pilot>> pilots;
    for (const VolumePrimitive& primitive : settings.alternatives) {
        one.primitive = primitive;
        pilots.push_back(std::make_unique<Pilot>(small, one, facts, watch));
    }
    Comparison comparison(std::move(pilots), pixelsOf(*scene) / pixelsOf(*small));
    while (comparison.undecided()) comparison.render();
    return {comparison.best(),
            typeOf(comparison.best()) + ": least variance x cost of " + std::to_string(settings.alternatives.size()) +
                " primitives in a pilot",
            comparison.passes()};
}

} // namespace tungsten::photon
