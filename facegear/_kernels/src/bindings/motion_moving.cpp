#include "bindings/motion_make_runner.hpp"

namespace facegear {

template std::unique_ptr<motion::AnyRunner> make_runner<motion::MovingLaw>(
    const std::shared_ptr<const motion::System>&, motion::Index, bool, const std::vector<double>&,
    const std::vector<double>&);

} // namespace facegear
