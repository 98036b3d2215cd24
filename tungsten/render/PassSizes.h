#pragma once
// How much of a render one pass takes.

#include <cstdint>
#include <string>

namespace tungsten {

struct PassSize {
    uint32_t samples = 1; ///< per pixel
    double share = 1.0;   ///< of the light paths of a whole pass
    double weight = 1.0;  ///< samples per pixel of the render that are done by it
};

/// Passes of `step` samples per pixel, and smaller ones where even the first does not end in time. Where light paths
/// can be cut, so many cut passes trace as many light paths as the whole ones that they are made of.
class PassSizes {
  public:
    PassSizes(uint64_t samples, uint64_t step, bool cutsLightPaths)
        : samples_(double(samples)), step_(step), cutsLightPaths_(cutsLightPaths) {}

    /// False: passes are as small as they get.
    [[nodiscard]] bool canCut() const;
    /// Makes all passes from now on smaller, if they can be: a quarter of what was done of one, `fraction`, or about.
    void cut(double fraction);
    [[nodiscard]] double share() const { return 1.0 / parts_; }
    /// "passes are cut to 1 sample per pixel".
    [[nodiscard]] std::string text() const;
    /// Of the next pass after passes of this weight in all.
    [[nodiscard]] PassSize next(double done) const;
    /// Everything that is left after passes of this weight in all, as one pass.
    [[nodiscard]] PassSize rest(double done) const;
    /// Passes that are left after passes of this weight in all.
    [[nodiscard]] uint32_t left(double done) const;

  private:
    [[nodiscard]] uint32_t samplesOfPass() const;

    double samples_; ///< of the render
    uint64_t step_;
    bool cutsLightPaths_;
    double parts_ = 1.0; ///< of a whole pass
};

} // namespace tungsten
