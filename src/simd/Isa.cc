/// @file Isa.cc
/// Asks the machine.
#include "simd/Isa.h"

namespace vdbtet {

bool supports(Isa isa) {
    if (isa == Isa::Plain) return true;
#if defined(__x86_64__) && defined(__GNUC__)
    const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
                      __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt");
    const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
    return avx2 && (isa == Isa::Avx2 || avx512);
#else
    return false;
#endif
}

Isa bestIsa() {
    static const Isa kBest = supports(Isa::Avx512) ? Isa::Avx512
                             : supports(Isa::Avx2) ? Isa::Avx2
                                                   : Isa::Plain;
    return kBest;
}

} // namespace vdbtet
