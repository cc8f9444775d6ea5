#pragma once

#include "bindings/motion_runners.hpp"

namespace facegear {

template <class Law>
std::unique_ptr<motion::AnyRunner> make_runner(const std::shared_ptr<const motion::System>& system,
                                               motion::Index order, bool many,
                                               const std::vector<double>& nodes,
                                               const std::vector<double>& weights) {
    using namespace motion;
    if (many) return std::make_unique<Runner<Machines<abreast>, Law>>(system, order, nodes, weights);
    return std::make_unique<Runner<Coordinates<4>, Law>>(system, order, nodes, weights);
}

} // namespace facegear
