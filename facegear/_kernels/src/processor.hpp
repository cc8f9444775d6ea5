// Which instructions the processor has.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__)
#include <cpuid.h>
#endif

namespace facegear {

// Whether processor and operating system offer the level x86-64-v3 (System V ABI, x86-64 supplement,
// table 3.1).
// __builtin_cpu_supports would ask less, and says no to everything where zig 0.17 compiled it.
inline bool has_x86_64_v3() {
#if defined(__x86_64__) && defined(__GNUC__)
    unsigned eax = 0, ebx = 0, ecx = 0, edx = 0;
    const unsigned of_leaf_1 = bit_FMA | bit_MOVBE | bit_OSXSAVE | bit_AVX | bit_F16C;
    if (__get_cpuid(1, &eax, &ebx, &ecx, &edx) == 0 || (ecx & of_leaf_1) != of_leaf_1) return false;
    const unsigned of_leaf_7 = bit_BMI | bit_AVX2 | bit_BMI2;
    if (__get_cpuid_count(7, 0, &eax, &ebx, &ecx, &edx) == 0 || (ebx & of_leaf_7) != of_leaf_7) return false;
    if (__get_cpuid(0x80000001, &eax, &ebx, &ecx, &edx) == 0 || (ecx & bit_LZCNT) == 0) return false;
    // The operating system saves the registers of SSE and AVX (bits 1 and 2 of XCR0).
    unsigned saved = 0, saved_high = 0;
    __asm__("xgetbv" : "=a"(saved), "=d"(saved_high) : "c"(0));
    return (saved & 6) == 6;
#else
    return false;
#endif
}

} // namespace facegear
