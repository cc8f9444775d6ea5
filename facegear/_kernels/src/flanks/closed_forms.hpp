// The gear's surfaces in closed form, the spur case of facegear/teeth/generated_flank.py
// (docs/explanation/geometry.md; Litvin and Fuentes 2004, chapter 18). Angles in rad, lengths in m.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "flanks/blank.hpp"
#include "flanks/vectors.hpp"

namespace facegear::flanks {

// Newton's method for psi at a gear radius: most steps, the largest of them, and one whose square is below
// rounding.
constexpr int PSI_STEPS = 60;
constexpr double LARGEST_PSI_STEP = 0.1;
constexpr double CLOSE = 1e-8;

// The gear's turn since the shaper generated a point of the flank at roll and psi.
template <class Number>
inline Number gear_turn(const Blank& blank, Number roll, Number psi) {
    return alike<Number>(blank.ratio) * (psi - roll - alike<Number>(blank.space));
}

// The flank at a roll, by the gear's turn and the slope psi of the normal; parameters are roll and psi.
template <class Number>
inline Frame<Number> flank_frame(const Blank& blank, Number roll, Turn<Number> turn, Turn<Number> psi) {
    const Number base = alike<Number>(blank.base), ratio = alike<Number>(blank.ratio);
    const Number secant = alike<Number>(1.0) / psi.cosine;
    const Number p = base * (psi.sine - roll * psi.cosine),
                 q = alike<Number>(blank.base / blank.ratio) * secant;
    const Number p_psi = base * (psi.cosine + roll * psi.sine), q_psi = q * psi.sine * secant;
    const Number x = p * turn.cosine - q * turn.sine, y = p * turn.sine + q * turn.cosine;
    return {
        {x, y, alike<Number>(blank.lift) - p_psi},
        {ratio * y - base * turn.cosine * psi.cosine, -(ratio * x) - base * turn.sine * psi.cosine,
         -(base * psi.sine)},
        {p_psi * turn.cosine - q_psi * turn.sine - ratio * y,
         p_psi * turn.sine + q_psi * turn.cosine + ratio * x, p},
    };
}

// Cosine of the outward normal at a slope psi with a direction.
template <class Number>
inline Number facing(Turn<Number> turn, Turn<Number> psi, Vector<Number> way) {
    return psi.cosine * (way.x * turn.cosine + way.y * turn.sine) + way.z * psi.sine;
}

// Height of the fillet where its normal has a slope psi and is generated at q along the pinion's axis.
inline double fillet_height(const Blank& blank, double psi, double q) {
    const auto [cosine, sine] = turn_by(psi);
    const double k = blank.ratio * q / blank.tip_centre, w = std::sqrt(1 - k * k * cosine * cosine);
    return blank.lift - blank.tip_centre * (k * cosine * cosine + sine * w) - blank.tip_rounding * sine;
}

// The fillet; parameters are psi and q. Not a number where no normal of slope psi through the rounding's
// centre meets the instant axis at q.
inline Frame<double> fillet_frame(const Blank& blank, double psi, double q) {
    const double centre = blank.tip_centre, rounding = blank.tip_rounding, ratio = blank.ratio;
    const auto [cosine, sine] = turn_by(psi);
    const double k = ratio * q / centre, w = std::sqrt(1 - k * k * cosine * cosine);
    const double both = w + k * sine, rest = 1 - k * k;
    const double s_chi = -cosine * rest / both, c_chi = k * cosine * cosine + sine * w;
    const double chi_psi = rest / (both * w), chi_q = ratio * cosine / (centre * w);
    const Turn<double> turn = turn_by(ratio * (std::atan2(s_chi, c_chi) - blank.edge_start));
    const double p = centre * s_chi - rounding * cosine, z = blank.lift - centre * c_chi - rounding * sine;
    const double p_psi = centre * c_chi * chi_psi + rounding * sine;
    const double z_psi = centre * s_chi * chi_psi - rounding * cosine;
    const double p_q = centre * c_chi * chi_q, z_q = centre * s_chi * chi_q;
    const double x = p * turn.cosine - q * turn.sine, y = p * turn.sine + q * turn.cosine;
    return {
        {x, y, z},
        {p_psi * turn.cosine - ratio * chi_psi * y, p_psi * turn.sine + ratio * chi_psi * x, z_psi},
        {p_q * turn.cosine - turn.sine - ratio * chi_q * y, p_q * turn.sine + turn.cosine + ratio * chi_q * x,
         z_q},
    };
}

// A residual and its slope by psi.
struct Residual {
    double value, slope;
};

// psi where a residual is zero, from where the contact path's pressure angle belongs to the gear radius; not
// a number where it is not found.
template <class Function>
inline double psi_of_zero(const Blank& blank, double radius, Function residual) {
    double psi = std::acos(blank.base / (blank.ratio * radius));
    for (int i = 0; i < PSI_STEPS; ++i) {
        const auto [value, slope] = residual(psi);
        const double step = std::min(std::max(value / slope, -LARGEST_PSI_STEP), LARGEST_PSI_STEP);
        psi -= step;
        if (std::fabs(step) < CLOSE) return psi;
    }
    return std::numeric_limits<double>::quiet_NaN();
}

// Slope psi of the flank's normal at a gear radius and roll.
inline double psi_at_roll(const Blank& blank, double radius, double roll) {
    return psi_of_zero(blank, radius, [&](double psi) -> Residual {
        const auto [cosine, sine] = turn_by(psi);
        const double p = blank.base * (sine - roll * cosine), q = blank.base / (blank.ratio * cosine);
        const double p_psi = blank.base * (cosine + roll * sine), q_psi = q * sine / cosine;
        return {p * p + q * q - radius * radius, 2 * p * p_psi + 2 * q * q_psi};
    });
}

// Gear angle of the tip edge, from the tooth's middle, at a gear radius.
inline double tip_edge_angle(const Blank& blank, double radius) {
    const double height = (blank.lift - blank.tip_plane) / blank.base;
    const double psi = psi_of_zero(blank, radius, [&](double at) -> Residual {
        const auto [cosine, sine] = turn_by(at);
        const double p = blank.base * (1 - height * cosine) / sine, q = blank.base / (blank.ratio * cosine);
        const double p_psi = blank.base * (height - cosine) / (sine * sine), q_psi = q * sine / cosine;
        return {p * p + q * q - radius * radius, 2 * p * p_psi + 2 * q * q_psi};
    });
    const Turn<double> slope = turn_by(psi);
    const double roll = (height - slope.cosine) / slope.sine;
    const Vector<double> edge = flank_frame(blank, roll, turn_by(gear_turn(blank, roll, psi)), slope).point;
    return std::atan2(edge.x, edge.y);
}

} // namespace facegear::flanks
