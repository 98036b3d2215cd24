#include "tungsten/io/OutputFilm.h"

#include "tungsten/io/Result.h"

#include <memory>

namespace tungsten {

namespace {

Image exposed(Image image, float factor) {
    for (Rgb& pixel : image.pixels) pixel *= factor;
    return image;
}

} // namespace

OutputFilm::OutputFilm(const Film& film, const Film& bias, const Scene& scene, const std::string& metadata,
                       const std::optional<ExposureChoice>& exposure)
    : film_(film), bias_(bias), scene_(scene), metadata_(metadata),
      exposure_(exposure.value_or(ExposureChoice{!scene.transport.gate.steadyState, 0.0})) {}

Image OutputFilm::overFrame(Image average) const {
    return inOutputUnits(std::move(average), scene_, 1);
}

Image OutputFilm::whole() const {
    return inOutputUnits(film_.meanOverFrames(), scene_, film_.frames());
}

Image OutputFilm::shownFrame(int frame) const {
    return exposed(this->frame(frame), framesFactor());
}

Image OutputFilm::shownWhole() const {
    Image image = whole();
    if (!exposure_.automatic) return exposed(std::move(image), exposureFactor(exposure_.stops));
    const auto automatic = std::make_unique<AutomaticExposure>();
    automatic->include(image);
    return exposed(std::move(image), automatic->factor());
}

float OutputFilm::framesFactor() const {
    if (!exposure_.automatic) return exposureFactor(exposure_.stops);
    if (!framesFactor_) {
        const auto automatic = std::make_unique<AutomaticExposure>();
        for (int frame = 0; frame < film_.frames(); ++frame) automatic->include(this->frame(frame));
        framesFactor_ = automatic->factor();
    }
    return *framesFactor_;
}

} // namespace tungsten
