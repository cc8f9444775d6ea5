// The Python module: one submodule for each part, bound in a file of its own.
#include <nanobind/nanobind.h>

#include "bindings/parts.hpp"

namespace nb = nanobind;

namespace {

// Whether the processor has the instructions of the level x86-64-v3.
bool has_x86_64_v3() {
#if (defined(__x86_64__) || defined(_M_X64)) && defined(__GNUC__)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
#else
    return false;
#endif
}

} // namespace

NB_MODULE(KERNELS_MODULE, module) {
    nb::set_leak_warnings(false); // what lives to the end lives in caches of Python functions
    module.attr("SOURCES_HASH") = KERNELS_SOURCES_HASH;
    module.def("has_x86_64_v3", &has_x86_64_v3);
    facegear::bind_arithmetic(module.def_submodule("arithmetic"));
    facegear::bind_motion(module.def_submodule("motion"));
}
