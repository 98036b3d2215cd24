#include "tungsten/session/Memory.h"

#include "tungsten/scene/SceneLoader.h"

#include <algorithm>

#include <sys/resource.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace tungsten {

void requireMemory(const LoadedScene& loaded, double films, double integratorBytes, double limit) {
    const Vec2i size = loaded.scene->camera.resolution;
    const double film = films * filmMemoryOf(*loaded.scene), all = film + integratorBytes;
    const double most = limit > 0.0 ? limit : availableMemoryBytes();
    if (all <= most) return;
    throw InputError(loaded.diagnostics->file,
                     "needs about " + memoryText(all) + " of memory (" + memoryText(film) + " for " +
                         std::to_string(size.x) + "x" + std::to_string(size.y) + " pixels in " +
                         std::to_string(loaded.scene->transport.gate.frames) + " frames, " +
                         memoryText(integratorBytes) + " for the integrator), " +
                         (limit > 0.0 ? "--memory-limit is " : "there are ") + memoryText(most) +
                         "; use fewer frames, photons or a smaller --resolution");
}

void keepFreedMemory() {
#ifdef __GLIBC__
    constexpr int LargestThreshold = 32 << 20, Kept = 512 << 20; // more the library does not take
    // NOLINTBEGIN(concurrency-mt-unsafe): before there are other threads
    mallopt(M_MMAP_THRESHOLD, LargestThreshold);
    mallopt(M_TRIM_THRESHOLD, Kept);
    // NOLINTEND(concurrency-mt-unsafe)
#endif
}

void limitMemory(double bytes, unsigned threads) {
    constexpr double MiB = 1024.0 * 1024.0, Libraries = 256.0 * MiB, PerThread = 16.0 * MiB;
    rlimit limit{};
    getrlimit(RLIMIT_DATA, &limit);
    limit.rlim_cur = std::min(rlim_t(bytes + Libraries + PerThread * threads), limit.rlim_max);
    setrlimit(RLIMIT_DATA, &limit);
}

} // namespace tungsten
