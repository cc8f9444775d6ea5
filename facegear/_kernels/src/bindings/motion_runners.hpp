// Runners by layout and law, each compiled in a file of its own.
#pragma once

#include <memory>
#include <vector>

#include "motion/run.hpp"

namespace facegear {

// Machines that run side by side.
constexpr int abreast = 8;

// A runner for machines of a system: of one at a time, or of many side by side.
template <class Law>
std::unique_ptr<motion::AnyRunner> make_runner(const std::shared_ptr<const motion::System>& system,
                                               motion::Index order, bool many,
                                               const std::vector<double>& nodes,
                                               const std::vector<double>& weights);

} // namespace facegear
