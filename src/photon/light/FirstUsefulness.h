#pragma once
// What Russian roulette measures light paths by where they get into a body that light must leave.

#include <cmath>
#include <vector>

namespace tungsten::photon {

/// The usefulness of useful light at its first vertex, by medium. Where light gets in at many places of which few are
/// good for the image, measuring each path by its own first usefulness would walk all of them at the same cost.
class FirstUsefulness {
  public:
    explicit FirstUsefulness(size_t media) : squares_(media) {}

    /// The logarithm of a pilot path's usefulness at its first vertex (darts::Guide::logUsefulness).
    void record(int medium, float logged) {
        Squares& squares = squares_[size_t(medium)];
        if (logged > squares.top) {
            squares.sum *= std::exp(2.0 * (double(squares.top) - double(logged)));
            squares.top = logged;
        }
        squares.sum += std::exp(2.0 * (double(logged) - double(squares.top)));
        ++squares.count;
        squares.logged = squares.top + 0.5f * float(std::log(squares.sum / squares.count));
    }
    /// Logarithm of the root mean square over a medium's pilot paths: between their mean and what most of the useful
    /// light has. Very low where there were none.
    [[nodiscard]] float logged(int medium) const { return squares_[size_t(medium)].logged; }

  private:
    static constexpr float Lowest = -1e30f;
    struct Squares {
        float top = Lowest; ///< logarithm of the largest
        double sum = 0.0;   ///< relative to its square
        int count = 0;
        float logged = Lowest;
    };
    std::vector<Squares> squares_;
};

} // namespace tungsten::photon
