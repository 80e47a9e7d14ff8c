/// @file Isa.h
/// Runs a kernel compiled for the best instruction set at hand.
///
/// A kernel is a loop that the compiler turns into vectors. It is inlined into one function for each
/// instruction set, and the machine decides which one runs. All give the same bytes: lanes do the same
/// operations in the same order as single numbers do, and nothing is fused (-ffp-contract=off).
#pragma once

namespace vdbtet {

enum class Isa { Plain, Avx2, Avx512 };

/// @return whether this machine, and this compiler, can run it.
bool supports(Isa isa);

/// @return the best one that is supported.
Isa bestIsa();

/// What a kernel and all that it calls must be declared, to be compiled for the instruction set of its
/// caller.
#define VDBTET_KERNEL __attribute__((always_inline))

#if defined(__x86_64__) && defined(__GNUC__)
#define VDBTET_AVX2 __attribute__((target("avx2,bmi,bmi2,popcnt")))
#define VDBTET_AVX512 __attribute__((target("avx2,bmi,bmi2,popcnt,avx512f,avx512dq,avx512bw,avx512vl")))
#else
#define VDBTET_AVX2
#define VDBTET_AVX512
#endif

template <typename Kernel>
VDBTET_AVX2 void runAvx2(const Kernel& kernel) {
    kernel();
}
template <typename Kernel>
VDBTET_AVX512 void runAvx512(const Kernel& kernel) {
    kernel();
}

/// Run @a kernel, a lambda declared VDBTET_KERNEL.
template <typename Kernel>
void runOn(Isa isa, const Kernel& kernel) {
    switch (isa) {
    case Isa::Avx512:
        return runAvx512(kernel);
    case Isa::Avx2:
        return runAvx2(kernel);
    case Isa::Plain:
        return kernel();
    }
}

} // namespace vdbtet
