#include "support/Quadrature.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>

namespace tungsten::test {

template <unsigned Points>
double integrate(const std::function<double(double)>& f, double low, double high, unsigned depth, double tolerance) {
    return boost::math::quadrature::gauss_kronrod<double, Points>::integrate(f, low, high, depth, tolerance);
}

template double integrate<15>(const std::function<double(double)>&, double, double, unsigned, double);
template double integrate<31>(const std::function<double(double)>&, double, double, unsigned, double);
template double integrate<61>(const std::function<double(double)>&, double, double, unsigned, double);

} // namespace tungsten::test
