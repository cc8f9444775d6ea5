// The position of a rolling element between both rings, where its energy is least.
#pragma once

#include <cmath>
#include <limits>

#include "bearings/ring.hpp"

namespace facegear::bearings {

// Newton steps and halvings of a line search after which a search is given up; real elements need some ten.
constexpr int MAX_STEPS = 200, MAX_HALVINGS = 60;
// A step this small beside the size of the coordinates, in units of rounding, ends a search.
constexpr double ROUNDINGS = 4.0 * std::numeric_limits<double>::epsilon();
// Slope at the end of a step, over that at its beginning, from which the step is shortened.
constexpr double STEEP = 0.1;

struct Position {
    double first, second;

    Position moved(Position step, double fraction) const {
        return {first + fraction * step.first, second + fraction * step.second};
    }
};

// Step that solves H step = -gradient, with a spring to ground where H leaves a direction free.
inline Position newton_step(const Derivatives& at) {
    const double tie = 1e-14;
    const double first_first = at.first_first * (1.0 + tie) + std::numeric_limits<double>::min();
    const double second_second = at.second_second * (1.0 + tie) + std::numeric_limits<double>::min();
    const double determinant = first_first * second_second - at.first_second * at.first_second;
    return {-(second_second * at.first - at.first_second * at.second) / determinant,
            -(first_first * at.second - at.first_second * at.first) / determinant};
}

// Moves a position to the minimum of a convex energy, by Newton's method; false where it does not get there.
// `energy.at(position)` returns derivatives, `energy.is_small(step, position)` whether a step is mere
// rounding.
template <class Energy>
inline bool settle(const Energy& energy, Position& position) {
    Derivatives here = energy.at(position);
    for (int i = 0; i < MAX_STEPS; ++i) {
        const Position step = newton_step(here);
        const auto slope = [&](const Derivatives& at) {
            return at.first * step.first + at.second * step.second;
        };
        const double start = slope(here);
        if (!std::isfinite(start)) return false;
        if (start == 0.0) return true;
        // The energy is convex along the step: its slope tells on which side of the minimum a position is.
        double low = 0.0, high = 1.0, fraction = 1.0;
        Derivatives there = energy.at(position.moved(step, 1.0));
        for (int j = 0; j < MAX_HALVINGS; ++j) {
            const double ahead = slope(there);
            if (std::fabs(ahead) <= STEEP * std::fabs(start) || (ahead < 0.0 && fraction == 1.0)) break;
            (ahead < 0.0 ? low : high) = fraction;
            fraction = 0.5 * (low + high);
            there = energy.at(position.moved(step, fraction));
        }
        position = position.moved(step, fraction);
        here = there;
        if (energy.is_small({fraction * step.first, fraction * step.second}, position)) return true;
    }
    return false;
}

// What remains of the inner contact's stiffness once the element follows: H_i - H_i (H_i + H_e)^-1 H_i, which
// is H_e (H_i + H_e)^-1 H_i.
inline void eliminate_position(const Derivatives& inner, const Derivatives& total, Derivatives& result) {
    const double determinant =
        total.first_first * total.second_second - total.first_second * total.first_second;
    const bool is_free = inner.first_first == 0.0 && inner.second_second == 0.0;
    if (is_free || !(determinant > 0.0)) {
        result.first_first = result.first_second = result.second_second = 0.0;
        return;
    }
    const double a = inner.first_first, b = inner.first_second, c = inner.second_second;
    const double inverse[3] = {total.second_second / determinant, -total.first_second / determinant,
                               total.first_first / determinant};
    const double a_first = a * inverse[0] + b * inverse[1], a_second = a * inverse[1] + b * inverse[2];
    const double b_first = b * inverse[0] + c * inverse[1], b_second = b * inverse[1] + c * inverse[2];
    result.first_first = a - (a_first * a + a_second * b);
    result.first_second = b - (a_first * b + a_second * c);
    result.second_second = c - (b_first * b + b_second * c);
}

} // namespace facegear::bearings
