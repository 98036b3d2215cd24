#include "tungsten/camera/ReconstructionFilter.h"

#include <map>

namespace tungsten {

namespace {

constexpr int Bins = 31; ///< per half axis, as in the scene format

const std::map<std::string, FilterType>& filterTypes() {
    static const std::map<std::string, FilterType> types{{"dirac", FilterType::Dirac},
                                                         {"box", FilterType::Box},
                                                         {"tent", FilterType::Tent},
                                                         {"gaussian", FilterType::Gaussian},
                                                         {"mitchell_netravali", FilterType::MitchellNetravali},
                                                         {"catmull_rom", FilterType::CatmullRom},
                                                         {"lanczos", FilterType::Lanczos}};
    return types;
}

/// The two-parameter family of Mitchell and Netravali (1988).
float cubic(float x, float b, float c) {
    x = std::abs(x);
    if (x < 1.0f)
        return ((12.0f - 9.0f * b - 6.0f * c) * x * x * x + (-18.0f + 12.0f * b + 6.0f * c) * x * x +
                (6.0f - 2.0f * b)) /
               6.0f;
    if (x < 2.0f)
        return ((-b - 6.0f * c) * x * x * x + (6.0f * b + 30.0f * c) * x * x + (-12.0f * b - 48.0f * c) * x +
                (8.0f * b + 24.0f * c)) /
               6.0f;
    return 0.0f;
}

float sinc(float x) {
    return std::abs(x) < 1e-4f ? 1.0f : std::sin(Pi * x) / (Pi * x);
}

} // namespace

ReconstructionFilter::ReconstructionFilter(FilterType type) : type_(type) {
    if (type == FilterType::Dirac || type == FilterType::Box) return;
    // Bin i of the half axis has the filter's magnitude at i / 31 of the half width.
    std::vector<float> weights(Bins);
    for (int i = 0; i < Bins; ++i) weights[size_t(i)] = std::abs(eval(float(i) / Bins * halfWidth()));
    bins_ = Distribution1D(weights);
}

float ReconstructionFilter::halfWidth() const {
    switch (type_) {
    case FilterType::Dirac:
        return 0.0f;
    case FilterType::Box:
        return 0.5f;
    case FilterType::Tent:
        return 1.0f;
    case FilterType::Gaussian:
    case FilterType::MitchellNetravali:
    case FilterType::CatmullRom:
    case FilterType::Lanczos:
        break;
    }
    return 2.0f;
}

float ReconstructionFilter::eval(float x) const {
    switch (type_) {
    case FilterType::Dirac:
        return 0.0f;
    case FilterType::Box:
        return std::abs(x) <= 0.5f ? 1.0f : 0.0f;
    case FilterType::Tent:
        return std::max(1.0f - std::abs(x), 0.0f);
    case FilterType::Gaussian:
        return std::max(std::exp(-2.0f * x * x) - std::exp(-8.0f), 0.0f);
    case FilterType::MitchellNetravali:
        return cubic(x, 1.0f / 3.0f, 1.0f / 3.0f);
    case FilterType::CatmullRom:
        return cubic(x, 0.0f, 0.5f);
    case FilterType::Lanczos:
        return std::abs(x) < 2.0f ? sinc(x) * sinc(0.5f * x) : 0.0f;
    }
    return 0.0f;
}

Vec2f ReconstructionFilter::sample(const Vec2f& u) const {
    if (type_ == FilterType::Dirac) return {0.0f, 0.0f};
    if (type_ == FilterType::Box) return {u.x - 0.5f, u.y - 0.5f};
    const auto axis = [this](float v) {
        const float sign = v < 0.5f ? -1.0f : 1.0f;
        const auto bin = bins_.sample(v < 0.5f ? 2.0f * v : 2.0f * v - 1.0f);
        // The format's table is off by one: bin i spans (i + 1, i + 2) / 31, so nothing falls within 1/31 of the
        // centre.
        return sign * (float(bin.index) + 1.0f + bin.remapped) / float(Bins) * halfWidth();
    };
    return {axis(u.x), axis(u.y)};
}

float ReconstructionFilter::pdf(float offset) const {
    if (type_ == FilterType::Dirac) return 0.0f;
    if (type_ == FilterType::Box) return offset >= -0.5f && offset < 0.5f ? 1.0f : 0.0f;
    const float place = std::abs(offset) / halfWidth() * float(Bins) - 1.0f; // sample() without its last step
    if (!(place >= 0.0f && place < float(Bins))) return 0.0f;
    return bins_.probability(size_t(place)) * 0.5f * float(Bins) / halfWidth();
}

float ReconstructionFilter::reach() const {
    const bool tabulated = bins_.size() > 0;
    return tabulated ? halfWidth() * float(Bins + 1) / float(Bins) : halfWidth();
}

std::optional<FilterType> filterByName(const std::string& name) {
    const auto found = filterTypes().find(name);
    return found == filterTypes().end() ? std::nullopt : std::optional(found->second);
}

std::vector<std::string> filterNames() {
    std::vector<std::string> names;
    for (const auto& [name, type] : filterTypes()) names.push_back(name);
    return names;
}

} // namespace tungsten
