// The gear's flank in closed form, as facegear/teeth/generated_flank.py has it for all kinds of teeth
// (docs/explanation/geometry.md; Litvin and Fuentes 2004, chapter 18). Angles in rad, lengths in m.
//
// Parameters are roll, the distance along the normal from the shaper's base cylinder over that cylinder's
// radius, and the slope psi of the normal.
#pragma once

#include <algorithm>
#include <cmath>

#include "flanks/blank.hpp"
#include "flanks/vectors.hpp"

namespace facegear::flanks {

// Newton's method for psi on the tip edge: most steps, the largest of them, and one whose square is below
// rounding.
constexpr int PSI_STEPS = 60;
constexpr double LARGEST_PSI_STEP = 0.1;
constexpr double CLOSE = 1e-8;
// Shifts (rad) of a start from which Newton's method went to the wrong side of the singular line.
constexpr double SHIFTS[] = {0.0, 0.15, -0.2, 0.35};

// Where the shaper generates a point, before the gear turns to its body frame, and derivatives by psi.
template <class Number>
struct Generated {
    Number x, y, z, x_psi, y_psi, z_psi;
    Number tilt;               // of the normal along y over its cosine along the shaper's section
    Number place, place_slope; // of the normal's foot along the shaper's axis
};

// The point at the transverse length of roll `length` from the foot.
template <class Number>
inline Generated<Number> generated(const Side& side, Number length, Turn<Number> psi) {
    const Shaper& shaper = side.shaper;
    const Number base = alike<Number>(shaper.base), shaft_cosine = alike<Number>(shaper.shaft_cosine);
    const Number upright = alike<Number>(side.upright);
    const Number secant = alike<Number>(1.0) / psi.cosine;
    const Number up_psi = base * psi.sine - length * psi.cosine;
    const Number x_psi = base * psi.cosine + length * psi.sine, up = alike<Number>(shaper.lift) - x_psi;
    const Number x = alike<Number>(shaper.offset) + up_psi;
    const Number foot_x = alike<Number>(shaper.offset) + base * psi.sine;
    const Number tilt = alike<Number>(side.tilt) - shaft_cosine * psi.sine;
    const Number foot_y = (alike<Number>(side.reach) - tilt * foot_x) * secant;
    const Number y = foot_y + length * tilt;
    const Number y_psi = foot_y * psi.sine * secant + shaft_cosine * x - base * tilt;
    const Number place = (y - shaft_cosine * up) * upright;
    return {
        x,
        y,
        (up - shaft_cosine * y) * upright,
        x_psi,
        y_psi,
        (up_psi - shaft_cosine * y_psi) * upright,
        tilt,
        place - alike<Number>(side.lead) * length,
        (y_psi - shaft_cosine * up_psi) * upright,
    };
}

// The gear's turn since the shaper generated a point whose normal has its foot at a place of the axis.
template <class Number>
inline Number gear_turn(const Side& side, Number roll, Number psi, Number place) {
    const Number along = place - alike<Number>(side.shaper.middle);
    return alike<Number>(side.shaper.ratio) * (psi + alike<Number>(side.shaper.phase)) +
           (alike<Number>(side.roll_turn) * roll - alike<Number>(side.place_turn) * along);
}

// A point of the flank in the gear's body frame, with derivatives by roll and psi.
template <class Number>
struct FlankPoint {
    Frame<Number> frame;
    Number turn;               // of the gear since the shaper generated it
    Number place, place_slope; // of the normal's foot along the shaper's axis, m, and its derivative by psi
};

// From where the shaper generates it, by the gear's turn since then.
template <class Number>
inline FlankPoint<Number> turned_point(const Side& side, Turn<Number> slope, const Generated<Number>& from,
                                       Number angle, Turn<Number> turn) {
    const Number across = alike<Number>(side.across), by_roll = alike<Number>(side.roll_turn);
    const Number by_psi =
        alike<Number>(side.shaper.ratio) - alike<Number>(side.place_turn) * from.place_slope;
    const Vector<Number> point = turn.of({from.x, from.y, from.z});
    const Number down = alike<Number>(side.fall) + alike<Number>(side.shaper.shaft_sine) * slope.sine;
    const Vector<Number> along = turn.of({-(across * slope.cosine), across * from.tilt, -(across * down)});
    const Vector<Number> aside = turn.of({from.x_psi, from.y_psi, from.z_psi});
    return {
        {
            point,
            {along.x - by_roll * point.y, along.y + by_roll * point.x, along.z},
            {aside.x - by_psi * point.y, aside.y + by_psi * point.x, aside.z},
        },
        angle,
        from.place,
        from.place_slope,
    };
}

inline FlankPoint<double> flank_point(const Side& side, double roll, double psi) {
    const Turn<double> slope = turn_by<STEEP_TERMS>(psi);
    const auto from = generated(side, side.across * roll, slope);
    const double angle = gear_turn(side, roll, psi, from.place);
    return turned_point(side, slope, from, angle, turn_by<SMALL_TERMS>(angle));
}

// Cosine of the outward normal with a direction, times the base radius.
template <class Number>
inline Number facing(const Side& side, const Frame<Number>& frame, Vector<Number> way) {
    const Vector<Number> point = frame.point;
    return alike<Number>(side.roll_turn) * (point.x * way.y - point.y * way.x) - dot(frame.by_first, way);
}

// Whether the flank has not ended at a roll, where the shaper's tip rounding begins, on a normal with its
// foot at `place`.
inline bool is_before_end(const Side& side, double roll, double place) {
    const Shaper& shaper = side.shaper;
    const double s = shaper.base * roll - shaper.tip_rounding, across = side.cosine * s;
    const double radius = shaper.tip_centre + (place + shaper.sine * s - shaper.middle) * shaper.taper;
    return s <= 0.0 || across * across + shaper.base * shaper.base <= radius * radius;
}

// Gear angle of the tip edge, from the tooth's middle, at a gear radius; not a number where it is not found.
inline double tip_edge_angle(const Side& side, const Line& tip, double radius) {
    const double height = tip.at(radius), shaft_cosine = side.shaper.shaft_cosine;
    const double near = Guess::at(side.guess.psi, radius - side.guess.radius, 0.0);
    for (const double shift : SHIFTS) {
        double psi = near + shift;
        for (int i = 0; i < PSI_STEPS; ++i) {
            const Turn<double> slope = turn_by<STEEP_TERMS>(psi);
            const auto foot = generated(side, 0.0, slope);
            // the height falls by so much per length of roll
            const double down = (slope.sine + shaft_cosine * foot.tilt) * side.upright;
            const double length = (foot.z - height) / down;
            const auto edge = generated(side, length, slope);
            const double by_psi = edge.z_psi / down;
            const double growth = 2 * (edge.x * (edge.x_psi - by_psi * slope.cosine) +
                                       edge.y * (edge.y_psi + by_psi * edge.tilt));
            const double excess = edge.x * edge.x + edge.y * edge.y - radius * radius;
            const double step = std::clamp(excess / growth, -LARGEST_PSI_STEP, LARGEST_PSI_STEP);
            psi -= step;
            if (!(std::fabs(step) < CLOSE)) continue;
            // beyond the singular line the radius falls with the slope
            if (!(growth > 0)) break;
            const double by_length = -step * by_psi;
            const double x = edge.x - step * edge.x_psi - by_length * slope.cosine,
                         y = edge.y - step * edge.y_psi + by_length * edge.tilt;
            const double place = foot.place - step * foot.place_slope;
            return std::atan2(x, y) - gear_turn(side, (length + by_length) / side.across, psi, place);
        }
    }
    return UNKNOWN;
}

} // namespace facegear::flanks
