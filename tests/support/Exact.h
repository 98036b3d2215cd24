#pragma once
// 50 decimal digits, and how far from them is what was computed. Each largest error is a property of its test:
// --gtest_output=xml:FILE has them all.

#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

namespace tungsten::test {

using Exact = boost::multiprecision::cpp_bin_float_50;
inline const Exact ExactPi = boost::math::constants::pi<Exact>();

/// Of one function over many arguments.
class LargestError {
  public:
    /// `name`: of the function, as a word.
    explicit LargestError(std::string name) : name_(std::move(name)) {}

    /// Relative to the exact value, or to `scale` > 0. What is not finite is infinitely wrong.
    void add(double value, const Exact& exact, const Exact& scale) {
        ++count_;
        const double error =
            std::isfinite(value) ? double(abs(Exact(value) - exact) / scale) : std::numeric_limits<double>::infinity();
        if (error <= largest_) return;
        largest_ = error;
        value_ = value;
        exact_ = exact;
        index_ = count_ - 1;
    }
    void add(double value, const Exact& exact) {
        add(value, exact, exact == 0 ? Exact(std::numeric_limits<float>::min()) : Exact(abs(exact)));
    }
    /// After at least `least` arguments.
    [[nodiscard]] testing::AssertionResult within(double bound, uint64_t least = 100) const {
        testing::Test::RecordProperty(name_, std::to_string(largest_ * 1e9) + "e-9 of " + std::to_string(count_));
        if (count_ < least) return testing::AssertionFailure() << name_ << ": only " << count_ << " arguments";
        if (largest_ <= bound) return testing::AssertionSuccess();
        return testing::AssertionFailure() << name_ << ": error " << largest_ << ", at argument " << index_ << ": "
                                           << value_ << ", exactly " << exact_;
    }

  private:
    std::string name_;
    double largest_ = -1.0, value_ = 0.0;
    Exact exact_ = 0;
    uint64_t count_ = 0, index_ = 0;
};

} // namespace tungsten::test
