// Each function binds the kernels of one part to a submodule.
#pragma once

#include <nanobind/nanobind.h>

namespace facegear {

void bind_arithmetic(nanobind::module_ module);
void bind_motion(nanobind::module_ module);

} // namespace facegear
