#include "photon/CameraPass.h"

#include "photon/CameraGather.h"
#include "photon/Tuning.h"

#include "tungsten/integrator/Names.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

constexpr size_t TileSide = 8;

void report(const CameraGatherCounters& counters, const VolumeGathers& volume, Statistics& statistics) {
    report(counters.steps, statistics);
    statistics.add("gathered photons", counters.gathered);
    statistics.add(counter::GatheredOnSurfaces, counters.gathered);
    statistics.add(counter::GatheredRecords, counters.gatheredInVolumes);
    std::visit(
        Overloaded{[](std::monostate) {},
                   [&](const auto& gather) { statistics.add(gather.GatheredCounter, counters.gatheredInVolumes); }},
        volume);
    statistics.add(counter::NonFiniteSamples, counters.nonFinite);
}

/// Follows a highlight path.
struct HighlightGather {
    CameraGather& gather;
    uint32_t part;

    void segment(const CameraSubpath& state, const std::optional<SurfaceHit>& hit) {
        gather.segmentPart(state, hit, part);
    }
    void surface(const CameraSubpath& state, const SurfaceInteraction& surface) {
        gather.highlight(state, surface, 1.0f / float(tuning::HighlightPaths));
    }
    void escaped(const CameraSubpath&) const {}
};

/// Pixel by pixel, tiles in parallel.
class CameraPass {
  public:
    CameraPass(const Scene& scene, const GatherStructures& structures, const CameraRecord* record, const PassInfo& pass,
               Film& film)
        : scene_(scene), structures_(structures), record_(record), pass_(pass), film_(film),
          first_(record ? record->sample : uint32_t(pass.firstSample)), samples_(record ? 1 : pass.samples),
          scale_(1.0 / (double(pass.samples) * (gate().steadyState ? 1.0 : gate().frameWidth))) {}

    void run(Statistics& statistics) const {
        const auto width = size_t(scene_.camera.resolution.x), height = size_t(scene_.camera.resolution.y);
        pass_.watch.stage("gather", width * height);
        tbb::parallel_for(tbb::blocked_range2d<size_t>(0, height, TileSide, 0, width, TileSide), [&](const auto& tile) {
            CameraGatherCounters counters;
            Workspace workspace{FrameSums(size_t(gate().frames)), FrameSums(size_t(gate().frames)), {}};
            for (size_t y = tile.rows().begin(); y < tile.rows().end(); ++y) {
                for (size_t x = tile.cols().begin(); x < tile.cols().end(); ++x)
                    renderPixel(int(x), int(y), workspace, counters);
                pass_.watch.advance(tile.cols().size());
            }
            report(counters, structures_.volume, statistics);
        });
    }

  private:
    [[nodiscard]] const TimeGate& gate() const { return structures_.sensor.gate; }

    void renderPixel(int x, int y, Workspace& workspace, CameraGatherCounters& counters) const {
        std::fill(workspace.sums.begin(), workspace.sums.end(), Vec3d(0.0));
        for (uint32_t s = 0; s < samples_; ++s) {
            pass_.watch.advanceWithin(1, s);
            addSample({x, y}, first_ + s, workspace, counters);
        }
        for (int frame = 0; frame < gate().frames; ++frame) {
            const Vec3d value = workspace.sums[size_t(frame)] * scale_;
            const Rgb pixel{float(value.x), float(value.y), float(value.z)};
            if (isFinite(pixel))
                film_.add(frame, x, y, pixel);
            else
                ++counters.nonFinite;
        }
    }

    /// One camera path, and the highlight paths of pixels that have them.
    void addSample(const Vec2i& at, uint32_t sample, Workspace& workspace, CameraGatherCounters& counters) const {
        const size_t pixel = size_t(at.y) * size_t(scene_.camera.resolution.x) + size_t(at.x);
        const Sampler lights(pass_.seed, RandomStream::Emitter, sample, pixel);
        const bool oversampled = structures_.glossy && structures_.glossy->oversampled(pixel);
        CameraGather gather(scene_, structures_, lights, oversampled, workspace, counters);
        if (record_) {
            record_->replay(scene_, pixel, gather);
        } else {
            Sampler sampler(pass_.seed, RandomStream::Camera, sample, pixel);
            follow(at, sampler, gather, counters);
        }
        if (!oversampled) return;
        const Sampler paths(pass_.seed, RandomStream::Highlight, sample, pixel);
        for (uint32_t k = 0; k < tuning::HighlightPaths; ++k) {
            Sampler sampler = paths.branch(RandomStream::Highlight, k);
            follow(at, sampler, HighlightGather{gather, k}, counters);
        }
    }

    template <typename Shown>
    void follow(const Vec2i& at, Sampler& sampler, Shown&& shown, CameraGatherCounters& counters) const {
        const Vec2f uFilter = sampler.next2D(), uLens = sampler.next2D();
        const Ray ray = scene_.camera.generateRay(at, uFilter, uLens);
        counters.steps += followCameraSubpath(scene_, ray, structures_.rules, sampler, shown, pass_.watch);
    }

    const Scene& scene_;
    const GatherStructures& structures_;
    const CameraRecord* record_;
    const PassInfo& pass_;
    Film& film_;
    uint32_t first_, samples_; ///< of a pixel
    double scale_;             ///< of a pixel's sum
};

} // namespace

void renderCameraPass(const Scene& scene, const GatherStructures& structures, const CameraRecord* record,
                      const PassInfo& pass, Film& film, Statistics& statistics) {
    CameraPass(scene, structures, record, pass, film).run(statistics);
}

} // namespace tungsten::photon
