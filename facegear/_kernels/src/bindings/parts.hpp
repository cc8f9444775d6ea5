// Included first, since it brings Python's header, which comes before those of the standard library.
// Each function binds the kernels of one part to a submodule.
#pragma once

#include <nanobind/nanobind.h>

namespace facegear {

void bind_arithmetic(nanobind::module_ module);
void bind_flanks(nanobind::module_ module);
void bind_samples(nanobind::module_ module);
void bind_statics(nanobind::module_ module);
void bind_strength(nanobind::module_ module);
void bind_bearings(nanobind::module_ module);
void bind_contact(nanobind::module_ module);
void bind_motion(nanobind::module_ module);

} // namespace facegear
