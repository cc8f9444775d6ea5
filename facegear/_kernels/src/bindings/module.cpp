// The Python module: one submodule for each part, bound in a file of its own.
#include <nanobind/nanobind.h>

#include "bindings/parts.hpp"
#include "processor.hpp"

NB_MODULE(KERNELS_MODULE, module) {
    nanobind::set_leak_warnings(false); // what lives to the end lives in caches of Python functions
    module.attr("SOURCES_HASH") = KERNELS_SOURCES_HASH;
    module.attr("COMPILER") = KERNELS_COMPILER;
    module.attr("USE_X86_64_V3") = KERNELS_X86_64_V3 && facegear::has_x86_64_v3();
    facegear::bind_arithmetic(module.def_submodule("arithmetic"));
    facegear::bind_flanks(module.def_submodule("flanks"));
    facegear::bind_samples(module.def_submodule("samples"));
    facegear::bind_statics(module.def_submodule("statics"));
    facegear::bind_strength(module.def_submodule("strength"));
    facegear::bind_bearings(module.def_submodule("bearings"));
    facegear::bind_contact(module.def_submodule("contact"));
    facegear::bind_motion(module.def_submodule("motion"));
}
