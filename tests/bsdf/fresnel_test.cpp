// What dielectrics and conductors reflect.

#include "tungsten/bsdf/Bsdf.h"
#include "tungsten/bsdf/Fresnel.h"

#include <gtest/gtest.h>

#include <complex>

namespace tungsten {
namespace {

TEST(Fresnel, DielectricAtNormalIncidenceBrewsterAndCritical) {
    EXPECT_NEAR(fresnelDielectric(1.0f / 1.5f, 1.0f), 0.04f, 1e-6f);
    EXPECT_NEAR(fresnelDielectric(1.0f / 1.5f, -1.0f), 0.04f, 1e-6f);
    EXPECT_EQ(fresnelDielectric(1.5f, 0.5f), 1.0f);
    EXPECT_NEAR(averageFresnel(1.5f), 0.59635f, 2e-5f);
}

TEST(Fresnel, ConductorAgreesWithComplexArithmetic) {
    for (const double cosTheta : {1.0, 0.7, 0.2, 0.01}) {
        const std::complex<double> n(0.2, 3.9), one(1.0, 0.0);
        const std::complex<double> cosT = std::sqrt(one - (1.0 - cosTheta * cosTheta) / (n * n));
        const auto rs = (cosTheta - n * cosT) / (cosTheta + n * cosT),
                   rp = (n * cosTheta - cosT) / (n * cosTheta + cosT);
        const double expected = 0.5 * (std::norm(rs) + std::norm(rp));
        EXPECT_NEAR(double(fresnelConductor(Rgb(0.2f), Rgb(3.9f), float(cosTheta)).x), expected, 1e-4);
    }
}

TEST(Conductors, KnownByName) {
    EXPECT_EQ(conductorNames().size(), 7u);
    EXPECT_FALSE(conductorByName("Unobtainium"));
    EXPECT_FLOAT_EQ(conductorByName("Ag")->second.x, 4.8283433224f);
}

} // namespace
} // namespace tungsten
