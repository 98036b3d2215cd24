#include "Measure.h"

#include "Image.h"
#include "Walk.h"

#include "tungsten/core/Random.h"

#include <array>
#include <atomic>
#include <thread>

namespace infinite_medium {

namespace {

using tungsten::RandomStream;
using tungsten::Sampler;

constexpr double EmitterAngle = 30.0 * 3.14159265358979323846 / 180.0;
constexpr size_t PilotPaths = 200;

/// Calls measure(case, variant) for all pairs, several at a time: one thread each, so that thread time is its cost.
template <typename Measure>
void forAllPairs(size_t cases, size_t variants, unsigned threads, Measure&& measure) {
    std::atomic<size_t> next{0};
    std::vector<std::thread> workers;
    for (unsigned t = 0; t < threads; ++t)
        workers.emplace_back([&] {
            for (size_t i = next++; i < cases * variants; i = next++) measure(i / variants, i % variants);
        });
    for (std::thread& worker : workers) worker.join();
}

/// Paths of a batch, from the time that a first few took.
size_t batchSize(double pilotSeconds, const Budget& budget) {
    if (budget.paths > 0) return std::max(size_t(budget.paths) / size_t(budget.batches), size_t(2));
    const double paths = budget.seconds / budget.batches * double(PilotPaths) / std::max(pilotSeconds, 1e-9);
    return size_t(std::clamp(paths, 64.0, 1e7));
}

/// Random numbers of path `index`; pilot paths take indices of their own.
Sampler pathRandom(const Budget& budget, uint32_t pass, uint64_t index) {
    return Sampler(budget.seed, RandomStream::Test, pass, index);
}

/// Null: the library's.
std::shared_ptr<const darts::EdaTable> ownTable(const Variant& variant, const darts::Medium& medium) {
    if (!variant.table) return nullptr;
    const float albedo = medium.sigmaS.x / medium.sigmaT().x;
    return std::make_shared<const darts::EdaTable>(darts::EdaTable::build(albedo, medium.g, *variant.table, 1));
}

Measurement measurePath(const Case& c, const Variant& variant, const Budget& budget, uint32_t pass) {
    const darts::Medium medium = c.medium();
    const darts::Guide guide(variant.settings(c), medium, ownTable(variant, medium));
    const Route route{{0, 0, 0}, {0, 0, 1}, {c.gateStart, c.gateEnd()}};
    const Walk<> walk(guide, route, variant.parts);
    const auto sine = float(std::sqrt(1 - ReceiverCosine * ReceiverCosine));
    const darts::Vec3 direction{sine, 0, float(ReceiverCosine)};
    uint64_t index = 0;
    const auto batch = [&](size_t paths) {
        Moments moments;
        for (size_t i = 0; i < paths; ++i) {
            Sampler sampler = pathRandom(budget, pass, index++);
            double value = 0;
            walk.fromRay(
                direction, [&] { return sampler.next1D(); },
                [&](const LastScattering& last) { value += radiance(last, medium, route.gate); });
            moments.add(value);
        }
        return moments;
    };
    double start = threadSeconds();
    batch(PilotPaths);
    const size_t paths = batchSize(threadSeconds() - start, budget);
    Moments total;
    std::vector<double> means, variances;
    start = threadSeconds();
    for (int i = 0; i < budget.batches; ++i) {
        const Moments moments = batch(paths);
        means.push_back(moments.mean());
        variances.push_back(moments.variance());
        total = total + moments;
    }
    Measurement m;
    m.cost = 1e9 * (threadSeconds() - start) / total.count;
    m.estimate = batchMeans(means);
    m.variance = median(variances);
    m.kurtosis = total.kurtosis();
    m.paths = total.count;
    return m;
}

/// The photons of a batch, path by path.
struct PhotonBatch {
    std::vector<Photon> photons;
    std::vector<size_t> ends; ///< of every path
    double rays = 0;
};

/// Pixel by pixel sums of what paths add to an image.
class ImageMoments {
  public:
    explicit ImageMoments(const Image& image)
        : image_(image), path_(image.size()), first_(image.size()), second_(image.size()), batches_(image.size()) {}

    void addBatch(const PhotonBatch& batch, double scale) {
        std::fill(first_.begin(), first_.end(), 0.0);
        std::fill(second_.begin(), second_.end(), 0.0);
        Moments moments;
        size_t begin = 0;
        for (const size_t end : batch.ends) {
            moments.add(addPath(batch, begin, end, scale));
            begin = end;
        }
        const double n = moments.count;
        double variance = 0;
        for (size_t pixel = 0; pixel < first_.size(); ++pixel) {
            const double mean = first_[pixel] / n;
            variance += (second_[pixel] / n - mean * mean) * n / (n - 1);
            batches_[pixel].push_back(mean);
        }
        means_.push_back(moments.mean());
        variances_.push_back(variance);
        total_ = total_ + moments;
    }
    [[nodiscard]] Measurement measurement(double cost) const {
        Measurement m;
        m.estimate = batchMeans(means_);
        m.variance = median(variances_);
        m.kurtosis = total_.kurtosis();
        m.cost = cost;
        m.paths = total_.count;
        for (const std::vector<double>& pixel : batches_) m.pixels.push_back(batchMeans(pixel));
        return m;
    }

  private:
    /// Returns the path's sum over the image.
    double addPath(const PhotonBatch& batch, size_t begin, size_t end, double scale) {
        touched_.clear();
        for (size_t i = begin; i < end; ++i)
            image_.gather(batch.photons[i], [&](size_t pixel, float value) {
                if (path_[pixel] == 0) touched_.push_back(pixel);
                path_[pixel] += double(value) * scale;
            });
        double sum = 0;
        for (const size_t pixel : touched_) { // a pixel may be listed twice: the second time it is 0
            sum += path_[pixel];
            first_[pixel] += path_[pixel];
            second_[pixel] += path_[pixel] * path_[pixel];
            path_[pixel] = 0;
        }
        return sum;
    }

    const Image& image_;
    std::vector<double> path_, first_, second_;
    std::vector<std::vector<double>> batches_; ///< [pixel][batch]
    std::vector<size_t> touched_;
    std::vector<double> means_, variances_;
    Moments total_;
};

std::array<Measurement, 2> measurePhoton(const Case& c, const Variant& variant, const Budget& budget, uint32_t pass) {
    const darts::Medium medium = c.medium();
    const darts::Guide guide(variant.settings(c), medium, ownTable(variant, medium));
    const darts::Vec3 emitter{0, float(std::sin(EmitterAngle)), float(std::cos(EmitterAngle))};
    const Route route{emitter, {0, 0, 0}, {c.gateStart, c.gateEnd()}};
    const Walk<> walk(guide, route, variant.parts);
    const auto radius = float(c.kernelRadius);
    const Image cone(View::Cone, radius, medium.sigmaT().x, medium.g),
        sphere(View::Sphere, radius, medium.sigmaT().x, medium.g);
    uint64_t index = 0;
    const auto trace = [&](size_t paths) {
        PhotonBatch batch;
        for (size_t i = 0; i < paths; ++i) {
            Sampler sampler = pathRandom(budget, pass, index++);
            batch.rays += walk.fromEmitter(
                [&] { return sampler.next1D(); },
                [&](const LastScattering& last) {
                    batch.photons.push_back({last.position, last.before, float(last.throughput), last.order});
                });
            batch.ends.push_back(batch.photons.size());
        }
        return batch;
    };
    ImageMoments coneMoments(cone), sphereMoments(sphere);
    const double scale = 1 / c.gateWidth;
    double start = threadSeconds();
    const PhotonBatch pilot = trace(PilotPaths);
    ImageMoments(cone).addBatch(pilot, scale);
    ImageMoments(sphere).addBatch(pilot, scale);
    const size_t paths = batchSize(threadSeconds() - start, budget);
    double seconds = 0, rays = 0;
    for (int i = 0; i < budget.batches; ++i) {
        start = threadSeconds();
        const PhotonBatch batch = trace(paths);
        seconds += threadSeconds() - start;
        rays += batch.rays;
        coneMoments.addBatch(batch, scale);
        sphereMoments.addBatch(batch, scale);
    }
    const double total = double(paths) * budget.batches, cost = (1e9 * seconds + budget.nsPerRay * rays) / total;
    return {coneMoments.measurement(cost), sphereMoments.measurement(cost)};
}

Experiment emptyExperiment(const char* title, darts::Mode mode, const std::vector<Case>& cases,
                           const std::vector<Variant>& variants) {
    return {title, baseline(mode), cases, variants,
            std::vector<std::vector<Measurement>>(cases.size(), std::vector<Measurement>(variants.size()))};
}

/// Different for every pair, so that all estimates are independent.
uint32_t passOf(size_t caseIndex, size_t variantIndex, darts::Mode mode) {
    return uint32_t(caseIndex << 12 | variantIndex << 1) | (mode == darts::Mode::Photon ? 1u : 0u);
}

} // namespace

Experiment measurePaths(std::vector<Case> cases, std::vector<Variant> variants, const Budget& budget) {
    Experiment e = emptyExperiment("Path mode", darts::Mode::Path, cases, variants);
    forAllPairs(cases.size(), variants.size(), budget.threads, [&](size_t c, size_t v) {
        e.measurements[c][v] = measurePath(cases[c], variants[v], budget, passOf(c, v, darts::Mode::Path));
    });
    return e;
}

std::vector<Experiment> measurePhotons(std::vector<Case> cases, std::vector<Variant> variants, const Budget& budget) {
    std::vector<Experiment> images{emptyExperiment("Photon mode, cone", darts::Mode::Photon, cases, variants),
                                   emptyExperiment("Photon mode, sphere", darts::Mode::Photon, cases, variants)};
    forAllPairs(cases.size(), variants.size(), budget.threads, [&](size_t c, size_t v) {
        const auto both = measurePhoton(cases[c], variants[v], budget, passOf(c, v, darts::Mode::Photon));
        for (size_t i = 0; i < 2; ++i) images[i].measurements[c][v] = both[i];
    });
    return images;
}

} // namespace infinite_medium
