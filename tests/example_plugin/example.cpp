// A plugin on one page: the integrator `ambient_occlusion`, whose pixels are the cosine-weighted fraction of the
// hemisphere above the first surface that is free within `distance`.

#include "tungsten/core/Random.h"
#include "tungsten/core/Warp.h"
#include "tungsten/integrator/Plugin.h"

#include <tbb/parallel_for.h>

namespace {

using namespace tungsten;

class AmbientOcclusion : public Integrator {
  public:
    AmbientOcclusion(std::shared_ptr<const Scene> scene, const ObjectReader& settings)
        : scene_(std::move(scene)),
          distance_(float(
              settings.number("distance", 1.0, {"length", "how far rays must travel freely"}, Range::positive()))) {}

    void plan(SceneFacts&, Features& features) const override {
        features.describe("ambient occlusion", true, "the hemisphere above the first surface is tested");
    }
    void prepare(const SceneFacts&, const ProgressToken&, Statistics&) override {}

    void renderPass(const PassInfo& pass, Film& film, Statistics& statistics) override {
        const StageTimer timer(statistics, "occlusion");
        tbb::parallel_for(0, film.height(), [&](int y) {
            for (int x = 0; x < film.width(); ++x) {
                float sum = 0.0f;
                for (uint32_t s = 0; s < pass.samples; ++s) {
                    const uint64_t path = uint64_t(y) * uint64_t(film.width()) + uint64_t(x);
                    Sampler sampler(pass.seed, RandomStream::Camera, uint32_t(pass.firstSample + s), path);
                    sum += openness({x, y}, sampler);
                }
                // A time-resolved scene shows the same image in every frame.
                for (int frame = 0; frame < film.frames(); ++frame)
                    film.set(frame, x, y, Rgb(sum / float(pass.samples)));
            }
        });
        statistics.add("occlusion rays", uint64_t(film.width()) * uint64_t(film.height()) * pass.samples);
    }

  private:
    /// One sample: 1 if a cosine-distributed ray from the first surface travels `distance_` freely, else 0.
    [[nodiscard]] float openness(const Vec2i& pixel, Sampler& sampler) const {
        const Vec2f uFilter = sampler.next2D(), uLens = sampler.next2D(), uDirection = sampler.next2D();
        const Ray ray = scene_->camera.generateRay(pixel, uFilter, uLens);
        const auto hit = scene_->geometry->intersect(ray);
        if (!hit) return 0.0f;
        const Frame frame(hit->ng.dot(ray.direction) < 0.0f ? hit->ng : -hit->ng);
        const Vec3f direction = frame.toWorld(warp::squareToCosineHemisphere(uDirection));
        Ray shadow = hit->spawnRay(direction);
        shadow.tMax = distance_;
        return scene_->geometry->occluded(shadow) ? 0.0f : 1.0f;
    }

    std::shared_ptr<const Scene> scene_;
    float distance_;
};

void registerIntegrators(IntegratorRegistry& registry) {
    registry.add("ambient_occlusion", "free fraction of the hemisphere above the first surface (example plugin)",
                 [](std::shared_ptr<const Scene> scene, const ObjectReader& settings) {
                     return std::make_unique<AmbientOcclusion>(std::move(scene), settings);
                 });
}

} // namespace

extern "C" const tungsten::PluginDescriptor* tungstenPlugin() {
    static const tungsten::PluginDescriptor descriptor{tungsten::PluginAbi, "example", registerIntegrators};
    return &descriptor;
}
