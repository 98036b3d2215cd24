#pragma once

#include <string>

namespace tungsten::test {

/// One pixel that looks from `from` to `to` (JSON arrays) along a thin bundle of parallel rays.
inline std::string lookAlong(const std::string& from, const std::string& to, const std::string& up,
                             const std::string& medium = "") {
    return R"("camera": {"type": "orthographic", "orthographic_size": 0.0001, "resolution": [1, 1],
              "reconstruction_filter": "dirac", )" +
           (medium.empty() ? "" : R"("medium": ")" + medium + R"(", )") + R"("transform": {"position": )" + from +
           R"(, "look_at": )" + to + R"(, "up": )" + up + "}}";
}

} // namespace tungsten::test
