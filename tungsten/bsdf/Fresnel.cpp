#include "tungsten/bsdf/Fresnel.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>

namespace tungsten {

namespace {

float fresnelConductor(float eta, float k, float cosTheta) {
    const float cos2 = cosTheta * cosTheta, sin2 = std::max(1.0f - cos2, 0.0f);
    const float t = eta * eta - k * k - sin2;
    const float m = std::sqrt(t * t + 4.0f * eta * eta * k * k);
    const float a = std::sqrt(std::max(0.5f * (m + t), 0.0f));
    const float rs = (m + cos2 - 2.0f * a * cosTheta) / (m + cos2 + 2.0f * a * cosTheta);
    const float x = m * cos2 + sin2 * sin2, y = 2.0f * a * cosTheta * sin2;
    const float rp = x + y > 0.0f ? rs * (x - y) / (x + y) : rs;
    return 0.5f * (rs + rp);
}

} // namespace

Rgb fresnelConductor(const Rgb& eta, const Rgb& k, float cosTheta) {
    const float c = std::clamp(std::abs(cosTheta), 0.0f, 1.0f);
    return {fresnelConductor(eta.x, k.x, c), fresnelConductor(eta.y, k.y, c), fresnelConductor(eta.z, k.z, c)};
}

float averageFresnel(float eta) {
    const auto integrand = [eta](double c) { return 2.0 * double(fresnelDielectric(eta, float(c))) * c; };
    // The integrand has a kink at the critical angle; splitting there keeps the quadrature exact.
    const double critical = eta > 1.0f ? std::sqrt(1.0 - 1.0 / (double(eta) * double(eta))) : 0.0;
    using Quadrature = boost::math::quadrature::gauss_kronrod<double, 31>;
    return float(Quadrature::integrate(integrand, 0.0, critical, 8, 1e-6) +
                 Quadrature::integrate(integrand, critical, 1.0, 8, 1e-6));
}

} // namespace tungsten
