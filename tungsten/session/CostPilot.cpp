#include "tungsten/session/CostPilot.h"

#include "tungsten/core/Errors.h"
#include "tungsten/film/FilmErrors.h"
#include "tungsten/session/Memory.h"
#include "tungsten/session/Passes.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace tungsten {

namespace {

constexpr std::array<uint32_t, 3> Indices{0, 15, 255};
constexpr double MostPasses = 1e9;

double wallNow() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Passes of one index.
struct Sample {
    Film film, bias;
    double cpu = 0.0, wall = 0.0; ///< of a pass, measuring its bias left out

    [[nodiscard]] double variance() const { return film.meanSquaredError() * double(film.passes()); }
};

/// Least squares of logarithms, over the indices. All 0 where one of the values is not above 0.
PowerLaw fitted(const std::array<double, Indices.size()>& values) {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (size_t k = 0; k < Indices.size(); ++k) {
        if (!(values[k] > 0.0)) return {};
        const double u = std::log(double(Indices[k]) + 1.0), v = std::log(values[k]);
        n += 1.0;
        x += u;
        y += v;
        xx += u * u;
        xy += u * v;
    }
    const double exponent = (n * xy - x * y) / (n * xx - x * x);
    return {std::exp((y - exponent * x) / n), exponent};
}

/// The same with an exponent between these: what a few passes of heavy tails say otherwise is noise.
PowerLaw fitted(const std::array<double, Indices.size()>& values, double least, double most) {
    PowerLaw law = fitted(values);
    if (law.exponent >= least && law.exponent <= most) return law;
    law.exponent = std::clamp(law.exponent, least, most);
    double log = 0.0;
    for (size_t k = 0; k < Indices.size(); ++k)
        log += (std::log(values[k]) - law.exponent * std::log(double(Indices[k]) + 1.0)) / double(Indices.size());
    law.first = std::exp(log);
    return law;
}

/// How fast kernels narrow: the exponent of their width.
double widthExponent(const Integrator& integrator) {
    return std::log(integrator.kernelWidth(Indices[1])) / std::log(double(Indices[1]) + 1.0);
}

/// What a square may be too large by, as that of RelativeBias, since neighbouring pixels have noise in common: the
/// squared factor of the sample that is known worst, or that of a single number where few passes tell nothing.
double squaredBoundFactor(const std::array<Sample, Indices.size()>& samples) {
    double factor = 0.0;
    for (const Sample& sample : samples) factor = std::fmax(factor, boundFactor(sample.bias));
    return factor > 0.0 ? factor * factor : 4.0;
}

/// Of the samples' bias images, as far apart as the law of the passes' variance says: few passes of noise that pixels
/// share know none of them well, but all together. None where one is unknown.
std::optional<PowerLaw> biasVariance(const std::array<Sample, Indices.size()>& samples, const PowerLaw& passes) {
    double scale = 0.0;
    for (size_t k = 0; k < samples.size(); ++k) {
        const double variance = samples[k].bias.meanSquaredError();
        if (!(variance > 0.0)) return std::nullopt;
        scale += variance / PowerLaw{1.0, passes.exponent}.at(Indices[k]) / double(samples.size());
    }
    return PowerLaw{scale, passes.exponent};
}

/// Products of the samples' bias images, summed over their pixels and frames, per value.
using BiasProducts = std::array<std::array<double, Indices.size()>, Indices.size()>;

BiasProducts biasProducts(const std::array<Sample, Indices.size()>& samples) {
    BiasProducts products{};
    const Film& first = samples[0].bias;
    const double share = 1.0 / (3.0 * double(first.frames()) * double(first.width()) * double(first.height()));
    for (int frame = 0; frame < first.frames(); ++frame) {
        std::array<Image, Indices.size()> images;
        for (size_t k = 0; k < samples.size(); ++k) images[k] = samples[k].bias.mean(frame);
        for (size_t i = 0; i < images[0].pixels.size(); ++i)
            for (size_t k = 0; k < samples.size(); ++k)
                for (size_t l = 0; l < samples.size(); ++l)
                    products[k][l] += double(images[k].pixels[i].dot(images[l].pixels[i])) * share;
    }
    return products;
}

/// The samples' bias images are one image times a power of their kernels' width, with noise.
struct BiasFit {
    double square; ///< of that image, noise included
    double noise;
    [[nodiscard]] double likelihood() const { return square / noise; }
};

BiasFit fitBias(const BiasProducts& products, const PowerLaw& variances, double exponent) {
    std::array<double, Indices.size()> weights{};
    double sum = 0.0, square = 0.0;
    for (size_t k = 0; k < weights.size(); ++k) {
        const double factor = std::pow(double(Indices[k]) + 1.0, exponent), variance = variances.at(Indices[k]);
        weights[k] = factor / variance;
        sum += factor * factor / variance;
    }
    for (size_t k = 0; k < weights.size(); ++k)
        for (size_t l = 0; l < weights.size(); ++l) square += weights[k] * weights[l] * products[k][l];
    return {square / (sum * sum), 1.0 / sum};
}

/// 0 where it does not rise above its own noise. Smooth light's falls with the square of the width, that of its edges
/// more slowly: the power is what the samples say.
PowerLaw biasLaw(const std::array<Sample, Indices.size()>& samples, const PowerLaw& passes,
                 const Integrator& integrator) {
    constexpr int Powers = 20;
    const std::optional<PowerLaw> variances = biasVariance(samples, passes);
    if (!variances) return {};
    const BiasProducts products = biasProducts(samples);
    const double squared = 2.0 * widthExponent(integrator);
    double exponent = squared;
    for (int i = 0; i < Powers; ++i) {
        const double other = squared * double(i) / Powers;
        if (fitBias(products, *variances, other).likelihood() > fitBias(products, *variances, exponent).likelihood())
            exponent = other;
    }
    const BiasFit fit = fitBias(products, *variances, exponent);
    const double more = std::max(fit.square - fit.noise, 0.0);
    const double doubt = (squaredBoundFactor(samples) - 1.0) * std::sqrt(fit.noise * (fit.noise + 2.0 * more));
    return more > doubt ? PowerLaw{std::sqrt(more - 0.5 * doubt), exponent} : PowerLaw{};
}

template <typename Of>
std::array<double, Indices.size()> each(const std::array<Sample, Indices.size()>& samples, const Of& of) {
    std::array<double, Indices.size()> values{};
    for (size_t k = 0; k < values.size(); ++k) values[k] = of(samples[k]);
    return values;
}

double meanOf(const std::array<double, Indices.size()>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value / double(values.size());
    return sum;
}

/// Renders the pilot's passes within its time.
class PilotPasses {
  public:
    PilotPasses(Integrator& integrator, const PilotOptions& options, bool measuresBias)
        : integrator_(integrator), options_(options), measuresBias_(measuresBias),
          sizes_(options.samplesPerPass, options.samplesPerPass, integrator.cutsLightPaths()) {}

    void prepare(const SceneFacts& facts) {
        ProgressMonitor monitor([&] { return stops(end()); });
        Statistics statistics;
        try {
            integrator_.prepare(facts, ProgressToken(monitor), statistics);
        } catch (const PassCancelled&) {
            brokenOff_ = monitor.progress();
            throw;
        }
        prepared_ = wallNow();
    }
    /// Rounds of one pass of each index, at least as many as asked for and for as long. Throws PassCancelled where that
    /// cannot be.
    void render(const Scene& scene) {
        while (!firstRound(scene)) sizes_.cut(brokenOff_.ofPass);
        uint32_t round = 1;
        try {
            for (; round < options_.rounds || wallNow() - begin_ < options_.seconds; ++round) renderRound(round, end());
        } catch (const PassCancelled&) {
            if (round < options_.rounds || interrupted()) throw;
        }
    }
    [[nodiscard]] bool interrupted() const { return options_.interrupted && options_.interrupted->load(); }
    [[nodiscard]] const std::array<Sample, Indices.size()>& samples() const { return samples_; }
    /// What part of a whole pass each of them is.
    [[nodiscard]] double share() const { return sizes_.next(0.0).weight / double(options_.samplesPerPass); }
    /// How much longer a whole pass takes. Not 1 / share(): no pass has less than one sample of each pixel. By a whole
    /// pass that was broken off, if there was one.
    [[nodiscard]] double longer() const {
        const double wall = meanOf(each(samples_, [](const Sample& s) { return s.wall; }));
        return passSecondsKnown_ ? std::clamp(passSeconds_ / std::max(wall, 1e-9), 1.0, 1.0 / share()) : 1.0 / share();
    }
    /// Why there are too few.
    [[nodiscard]] std::string whyTooFew() const {
        const std::string limit = " the " + brief(options_.seconds) + " s that --timeout leaves each method";
        if (prepared_ == 0.0) return "preparing takes longer than" + limit + " (" + brokenOff_.stage + ")";
        char seconds[32];
        std::snprintf(seconds, sizeof seconds, "%.2g", passSeconds_);
        return std::string("a pass takes ") + (passSecondsKnown_ ? "about " : "more than ") + seconds +
               " s: not even " + std::to_string(options_.rounds * Indices.size()) + " small ones end within" + limit;
    }

  private:
    [[nodiscard]] double end() const { return begin_ + options_.mostSeconds; }
    [[nodiscard]] bool stops(double end) const { return interrupted() || wallNow() > end; }

    /// False: the passes are to be cut.
    bool firstRound(const Scene& scene) {
        for (Sample& sample : samples_) {
            sample = {};
            sample.film = filmOf(scene);
            if (measuresBias_) sample.bias = filmOf(scene);
        }
        const double part = options_.seconds / double(options_.rounds);
        try {
            renderRound(0, sizes_.canCut() ? std::min(wallNow() + part, end()) : end());
            return true;
        } catch (const PassCancelled&) {
            if (stops(end()) || !sizes_.canCut()) throw;
            return false;
        }
    }

    void renderRound(uint32_t round, double end) {
        const PassSize size = sizes_.next(0.0);
        for (size_t k = 0; k < samples_.size(); ++k) {
            // So many cut passes make the whole ones that come before.
            const auto index = uint32_t(std::llround(double(Indices[k]) / size.share));
            PassInfo pass{index, uint64_t(index) * size.samples, size.samples, options_.seed + round};
            pass.bias = measuresBias_ ? &samples_[k].bias : nullptr;
            pass.share = size.share;
            ProgressMonitor monitor([&] { return stops(end); });
            pass.watch = ProgressToken(monitor);
            passBegan_ = wallNow();
            try {
                pass.watch.advance(0);
                renderPass(pass, samples_[k]);
            } catch (const PassCancelled&) {
                brokenOff_ = monitor.progress();
                estimate();
                throw;
            }
        }
    }

    /// How long a whole pass is, by the first that is broken off once it has begun in earnest: small ones are overhead.
    void estimate() {
        constexpr double Known = 0.01;
        if (passSecondsKnown_) return;
        passSecondsKnown_ = brokenOff_.ofPass >= Known && share() == 1.0;
        passSeconds_ = std::max(passSeconds_, (wallNow() - passBegan_) / std::max(brokenOff_.ofPass, Known) / share());
    }

    void renderPass(const PassInfo& pass, Sample& sample) {
        Statistics statistics;
        sample.film.beginPass();
        if (pass.bias) pass.bias->beginPass();
        const double wall = wallNow(), cpu = processCpuSeconds();
        integrator_.renderPass(pass, sample.film, statistics);
        sample.film.endPass(1.0);
        const auto stages = statistics.stages();
        const auto bias = stages.find("bias");
        const Statistics::Stage extra = bias == stages.end() ? Statistics::Stage{} : bias->second;
        const double part = 1.0 / double(sample.film.passes());
        sample.wall += (wallNow() - wall - extra.wallSeconds - sample.wall) * part;
        sample.cpu += (processCpuSeconds() - cpu - extra.cpuSeconds - sample.cpu) * part;
        if (pass.bias) pass.bias->endPass(1.0);
    }

    Integrator& integrator_;
    const PilotOptions& options_;
    bool measuresBias_;
    PassSizes sizes_;
    std::array<Sample, Indices.size()> samples_;
    double begin_ = wallNow(), prepared_ = 0.0, passBegan_ = 0.0, passSeconds_ = 0.0;
    bool passSecondsKnown_ = false;
    PassProgress brokenOff_;
};

PassCosts costsOf(const PilotPasses& passes, const Integrator& integrator, bool measuresBias, double mean) {
    PassCosts costs;
    const auto& samples = passes.samples();
    const double share = passes.share(), longer = passes.longer();
    const auto variance = each(samples, [&](const Sample& s) { return s.variance() * share / (mean * mean); });
    const auto cpu = each(samples, [&](const Sample& s) { return std::max(s.cpu, 1e-9) * longer; });
    const auto wall = each(samples, [&](const Sample& s) { return std::max(s.wall, 1e-9) * longer; });
    if (measuresBias) {
        // Narrower kernels of at most three dimensions bring noise, never take it.
        costs.variance = fitted(variance, 0.0, -3.0 * widthExponent(integrator));
        costs.cpuSeconds = fitted(cpu);
        costs.wallSeconds = fitted(wall);
        costs.bias = biasLaw(samples, costs.variance, integrator);
        costs.bias.first /= mean;
    } else { // no kernels: all passes are alike
        costs.variance.first = meanOf(variance);
        costs.cpuSeconds.first = meanOf(cpu);
        costs.wallSeconds.first = meanOf(wall);
    }
    for (const Sample& sample : samples) costs.passes += sample.film.passes();
    return costs;
}

} // namespace

double PowerLaw::at(uint32_t pass) const {
    return first * std::pow(double(pass) + 1.0, exponent);
}

double PowerLaw::sum(double n) const {
    constexpr double Exact = 256.0;
    const double whole = std::min(std::floor(n), Exact), from = whole + 0.5, to = n + 0.5;
    double sum = 0.0;
    for (double i = 1.0; i <= whole; ++i) sum += std::pow(i, exponent);
    // The rest by its integral.
    const double power = exponent + 1.0;
    sum += std::abs(power) < 1e-9 ? std::log(to / from) : (std::pow(to, power) - std::pow(from, power)) / power;
    return first * sum;
}

double PassCosts::error(double n) const {
    const double systematic = bias.sum(n) / n;
    return std::sqrt(variance.sum(n) / (n * n) + systematic * systematic);
}

std::optional<double> PassCosts::passesFor(double wanted) const {
    if (error(1.0) <= wanted) return 1.0;
    if (error(MostPasses) > wanted) return std::nullopt;
    double low = 0.0, high = std::log(MostPasses);
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (error(std::exp(middle)) > wanted ? low : high) = middle;
    }
    return std::ceil(std::exp(high) - 1e-6);
}

std::optional<PassCosts> measurePasses(const Scene& scene, Integrator& integrator, const SceneFacts& facts,
                                       const PilotOptions& options) {
    const bool measuresBias = integrator.leavesBias(facts);
    PilotPasses passes(integrator, options, measuresBias);
    double prepareWall = 0.0, prepareCpu = 0.0;
    try {
        const double wall = wallNow(), cpu = processCpuSeconds();
        passes.prepare(facts);
        prepareWall = wallNow() - wall;
        prepareCpu = processCpuSeconds() - cpu;
        passes.render(scene);
    } catch (const PassCancelled&) {
        if (passes.interrupted()) throw;
        throw InputError(scene.file.string(), passes.whyTooFew());
    }
    const double mean = meanOf(each(passes.samples(), [](const Sample& s) { return meanValue(s.film); }));
    if (!(mean > 0.0)) return std::nullopt;
    PassCosts costs = costsOf(passes, integrator, measuresBias, mean);
    costs.prepareCpuSeconds = prepareCpu;
    costs.prepareWallSeconds = prepareWall;
    return costs;
}

} // namespace tungsten
