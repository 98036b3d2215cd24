// libFuzzer's way in, once for each target: FUZZ_TARGET is its name.

#include "fuzz/Targets.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
    for (const auto& target : tungsten::fuzz::targets())
        if (target.name == FUZZ_TARGET) target.run({reinterpret_cast<const char*>(bytes), size});
    return 0;
}
