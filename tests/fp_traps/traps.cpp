// Preloaded into a program, it lists every instruction that divides by zero or computes what is no number: traps of
// floating-point exceptions in all threads. Each is counted by place, stepped over with traps off, and the program goes
// on. The list is appended to the file that FP_TRAPS names: module, offset in it, kind, count.

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <csignal>
#include <dlfcn.h>
#include <ucontext.h>
#include <xmmintrin.h>

namespace {

constexpr uint32_t Invalid = 1u << 7, DivideByZero = 1u << 9; ///< mask bits of MXCSR
constexpr uint32_t Raised = 0x3F;                             ///< its flags
constexpr greg_t SingleStep = 0x100;                          ///< of EFLAGS

struct Place {
    std::atomic<uintptr_t> address{0};
    std::atomic<int> kind{0};
    std::atomic<bool> foreign{false}; ///< in no module of the project
    std::atomic<uint64_t> count{0};
};
bool trapping = false; ///< until the program ends
constexpr size_t Places = 1u << 14;
Place places[Places];

bool isForeign(uintptr_t address) {
    Dl_info module{};
    if (dladdr(reinterpret_cast<void*>(address), &module) == 0) return true;
    return !std::strstr(module.dli_fname, "tungsten") && !std::strstr(module.dli_fname, "_tests");
}

/// Returns whether the place is foreign.
bool count(uintptr_t address, int kind) {
    for (size_t i = (address * 0x9E3779B97F4A7C15u) >> 50, tried = 0; tried < Places; i = (i + 1) % Places, ++tried) {
        uintptr_t empty = 0;
        Place& place = places[i];
        if (place.address.compare_exchange_strong(empty, address)) {
            place.kind = kind;
            place.foreign = isForeign(address);
        }
        if (place.address != address) continue;
        ++place.count;
        return place.foreign;
    }
    return true;
}

void onTrap(int, siginfo_t* info, void* data) {
    auto& context = static_cast<ucontext_t*>(data)->uc_mcontext;
    const bool foreign = count(uintptr_t(context.gregs[REG_RIP]), info->si_code);
    context.fpregs->mxcsr = (context.fpregs->mxcsr & ~Raised) | Invalid | DivideByZero;
    // Elsewhere traps stay off until the thread's next query of the scene has ended.
    if (!foreign) context.gregs[REG_EFL] |= SingleStep;
}

void onStep(int, siginfo_t*, void* data) {
    auto& context = static_cast<ucontext_t*>(data)->uc_mcontext;
    context.fpregs->mxcsr &= ~(Raised | Invalid | DivideByZero);
    context.gregs[REG_EFL] &= ~SingleStep;
}

void handle(int signal, void (*handler)(int, siginfo_t*, void*)) {
    struct sigaction action {};
    action.sa_sigaction = handler;
    action.sa_flags = SA_SIGINFO | SA_NODEFER;
    sigaction(signal, &action, nullptr);
}

/// Traps are off while it lives, and on from then on.
struct Untrapped {
    Untrapped() { _mm_setcsr(_mm_getcsr() | Invalid | DivideByZero); }
    ~Untrapped() {
        if (trapping) _mm_setcsr(_mm_getcsr() & ~(Raised | Invalid | DivideByZero));
    }
};

template <typename Function>
Function* following(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

/// Threads that start later have the starter's traps.
__attribute__((constructor)) void start() {
    if (!std::getenv("FP_TRAPS")) return;
    trapping = true;
    handle(SIGFPE, onTrap);
    handle(SIGTRAP, onStep);
    _mm_setcsr(_mm_getcsr() & ~(Raised | Invalid | DivideByZero));
}

__attribute__((destructor)) void finish() {
    const char* name = std::getenv("FP_TRAPS");
    if (!name) return;
    trapping = false;
    _mm_setcsr(_mm_getcsr() | Invalid | DivideByZero);
    std::FILE* out = std::fopen(name, "a");
    if (!out) return;
    for (const Place& place : places) {
        Dl_info module{};
        const uintptr_t address = place.address;
        if (address == 0 || dladdr(reinterpret_cast<void*>(address), &module) == 0) continue;
        std::fprintf(out, "%s\t%zx\t%s\t%llu\n", module.dli_fname,
                     size_t(address - reinterpret_cast<uintptr_t>(module.dli_fbase)),
                     place.kind == FPE_FLTDIV ? "divide by zero" : "invalid",
                     static_cast<unsigned long long>(place.count.load()));
    }
    std::fclose(out);
}

} // namespace

// Embree divides by components of directions that are 0, millions of times; its queries are not looked at.
extern "C" {

__attribute__((visibility("default"))) void rtcIntersect1(void* scene, void* context, void* ray) {
    static auto* const query = following<void(void*, void*, void*)>("rtcIntersect1");
    const Untrapped off;
    query(scene, context, ray);
}

__attribute__((visibility("default"))) void rtcOccluded1(void* scene, void* context, void* ray) {
    static auto* const query = following<void(void*, void*, void*)>("rtcOccluded1");
    const Untrapped off;
    query(scene, context, ray);
}

__attribute__((visibility("default"))) bool rtcPointQuery(void* scene, void* query, void* context, void* function,
                                                          void* data) {
    static auto* const ask = following<bool(void*, void*, void*, void*, void*)>("rtcPointQuery");
    const Untrapped off;
    return ask(scene, query, context, function, data);
}
}
