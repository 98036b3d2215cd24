#include "tungsten/core/AvailableMemory.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>

#include <sys/resource.h>
#include <unistd.h>

namespace tungsten {

namespace {

constexpr double Unlimited = std::numeric_limits<double>::infinity();

/// The number that a file begins with; none where there is no such file, or "max" in it.
double numberIn(const std::string& file) {
    double number = Unlimited;
    std::ifstream(file) >> number ? void() : void(number = Unlimited);
    return number;
}

double availableOnMachine() {
    std::ifstream in("/proc/meminfo");
    std::string name, unit;
    for (double kibibytes = 0.0; in >> name >> kibibytes; std::getline(in, unit))
        if (name == "MemAvailable:") return kibibytes * 1024.0;
    return Unlimited;
}

double leftInControlGroup() {
    const std::string folder = "/sys/fs/cgroup/";
    const double largest = numberIn(folder + "memory.max"), used = numberIn(folder + "memory.current");
    return largest < Unlimited && used < Unlimited ? std::max(largest - used, 0.0) : Unlimited;
}

double leftOfOwnLimit() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_DATA, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return Unlimited;
    double pages = 0.0; // total, resident, shared, text, library, data
    std::ifstream in("/proc/self/statm");
    for (int i = 0; i < 6; ++i) in >> pages;
    return in ? std::max(double(limit.rlim_cur) - pages * double(::sysconf(_SC_PAGESIZE)), 0.0) : Unlimited;
}

} // namespace

double availableMemoryBytes() {
    return std::min({availableOnMachine(), leftInControlGroup(), leftOfOwnLimit()});
}

std::string memoryText(double bytes) {
    const char* const units[] = {"bytes", "KiB", "MiB", "GiB", "TiB", "PiB"};
    size_t unit = 0;
    for (; bytes >= 1024.0 && unit + 1 < std::size(units); ++unit) bytes /= 1024.0;
    char text[48];
    std::snprintf(text, sizeof text, "%.3g %s", bytes, units[unit]);
    return text;
}

} // namespace tungsten
