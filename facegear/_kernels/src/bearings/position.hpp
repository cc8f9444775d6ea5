// The position of a rolling element between both rings, where its energy is least.
#pragma once

#include <cmath>
#include <limits>

#include "bearings/ring.hpp"

namespace facegear::bearings {

// Newton steps and evaluations along one of them after which a search is given up. Elements need some ten
// steps; hundreds where a ring is a millimetre off and a ball follows its groove.
constexpr int MAX_STEPS = 2000, MAX_HALVINGS = 60;
// A step this small beside the size of the coordinates ends a search, or forces that a move of this size
// makes: a ball that hardly touches gives way so easily along its grooves that rounded forces move it
// further.
constexpr double ROUNDINGS = 4.0 * std::numeric_limits<double>::epsilon();
// Spring to ground over the softest contact: steps lose no more than this part of their length.
constexpr double TIE = 1e-3;
// Determinant over the product of the diagonal from which two directions count as one.
constexpr double FLAT = 1e-9;
// Slope at the end of a step, over that at its beginning, from which the step is shortened.
constexpr double STEEP = 0.1;

struct Position {
    double first, second;

    Position moved(Position step, double fraction) const {
        return {first + fraction * step.first, second + fraction * step.second};
    }
};

// Step that solves (H + tie) step = -gradient: a spring to ground where no contact holds the element.
inline Position newton_step(const Derivatives& at, double tie, double arm) {
    const double first_first = at.first_first + tie, second_second = at.second_second + tie * arm * arm;
    const double determinant = first_first * second_second - at.first_second * at.first_second;
    return {-(second_second * at.first - at.first_second * at.second) / determinant,
            -(first_first * at.second - at.first_second * at.first) / determinant};
}

// Moves a position to the minimum of a convex energy, by Newton's method; false where it does not get there.
// Of an energy, `at(position)` returns derivatives, `size(position)` a length, and `arm()` the length that
// makes one of the second coordinate.
template <class Energy>
inline bool settle(const Energy& energy, Position& position) {
    Derivatives here = energy.at(position);
    const double arm = energy.arm(), tie = TIE * energy.softest();
    for (int i = 0; i < MAX_STEPS; ++i) {
        const Position step = newton_step(here, tie, arm);
        const auto slope = [&](const Derivatives& at) {
            return at.first * step.first + at.second * step.second;
        };
        const double start = slope(here);
        if (!std::isfinite(start)) return false;
        if (start == 0.0) return true;
        // The energy is convex along the step: its slope tells on which side of the minimum a position is.
        double low = 0.0, high = std::numeric_limits<double>::infinity(), fraction = 1.0;
        Derivatives there = energy.at(position.moved(step, 1.0));
        for (int j = 0; j < MAX_HALVINGS; ++j) {
            const double ahead = slope(there);
            if (std::fabs(ahead) <= STEEP * std::fabs(start)) break;
            (ahead < 0.0 ? low : high) = fraction;
            fraction = std::isfinite(high) ? 0.5 * (low + high) : 4.0 * fraction;
            there = energy.at(position.moved(step, fraction));
        }
        position = position.moved(step, fraction);
        here = there;
        const double small = ROUNDINGS * energy.size(position);
        const double moved = fraction * (std::fabs(step.first) + arm * std::fabs(step.second));
        const double force = std::fabs(here.first) + std::fabs(here.second) / arm;
        const double stiffness = here.first_first + here.second_second / (arm * arm);
        if (moved <= small || force <= small * stiffness) return true;
    }
    return false;
}

// Stiffness of both contacts in a row once the element follows, H_e (H_i + H_e)^-1 H_i: the Schur complement
// of the inner one, without the difference of large numbers.
inline void put_in_series(const Derivatives& inner, const Derivatives& outer, Derivatives& result) {
    double sum[3] = {inner.first_first + outer.first_first, inner.first_second + outer.first_second,
                     inner.second_second + outer.second_second};
    if (inner.first_first + inner.second_second == 0.0 || outer.first_first + outer.second_second == 0.0) {
        result.first_first = result.first_second = result.second_second = 0.0;
        return;
    }
    // A roller that one slice alone holds is free to tilt about it: its two stiffnesses have one direction.
    if (sum[2] == 0.0) sum[2] = sum[0]; // by the slice in its middle, against which nothing tilts
    if (sum[0] * sum[2] - sum[1] * sum[1] < FLAT * sum[0] * sum[2]) {
        sum[0] *= 1.0 + FLAT;
        sum[2] *= 1.0 + FLAT;
    }
    const double determinant = sum[0] * sum[2] - sum[1] * sum[1];
    // Columns of (H_i + H_e)^-1 H_i.
    const double a = (sum[2] * inner.first_first - sum[1] * inner.first_second) / determinant;
    const double b = (sum[0] * inner.first_second - sum[1] * inner.first_first) / determinant;
    const double c = (sum[2] * inner.first_second - sum[1] * inner.second_second) / determinant;
    const double d = (sum[0] * inner.second_second - sum[1] * inner.first_second) / determinant;
    result.first_first = outer.first_first * a + outer.first_second * b;
    result.first_second = 0.5 * (outer.first_first * c + outer.first_second * d + outer.first_second * a +
                                 outer.second_second * b);
    result.second_second = outer.first_second * c + outer.second_second * d;
}

} // namespace facegear::bearings
