// The gear's fillet and root land in closed form, as facegear/teeth/generated_fillet.py has them for all
// kinds of teeth: the sweep of a ball along the shaper's tip. Angles in rad, lengths in m.
//
// Parameters are y, the place of the ball's centre along the shaper's axis, and the angle of the normal from
// that of the flank in the shaper's section, 0 at the flank.
#pragma once

#include <cmath>

#include "flanks/blank.hpp"
#include "flanks/vectors.hpp"

namespace facegear::flanks {

// Newton's method for y at a gear radius: most steps, and one (m) whose square is below rounding.
constexpr int PLACE_STEPS = 30;
constexpr double CLOSE_PLACE = 1e-9;

// The ball's centre and its normal where the shaper generates: the equation of meshing is
// k1 cos psi + k2 sin psi = k0.
struct TipSection {
    double y, cosine, sine;           // of the normal's angle
    double centre, roll, roll_y;      // radius of the ball's centre, its length of roll and growth with y
    double a, b, advance, tilt;       // parts of the centre along the normal and across it; of the normal
    double k1, k2, k0, square, steep; // the equation, k1^2 + k2^2, and the root of that less k0^2
    double psi_cosine, psi_sine;

    TipSection(const Side& side, double y, double angle)
        : y(y), cosine(std::cos(angle)), sine(std::sin(angle)) {
        const Shaper& shaper = side.shaper;
        const double base = shaper.base, shaft_sine = shaper.shaft_sine, shaft_cosine = shaper.shaft_cosine;
        centre = shaper.tip_centre + (y - shaper.middle) * shaper.taper;
        roll = std::sqrt(centre * centre - base * base);
        roll_y = centre * shaper.taper / roll;
        a = roll * cosine + base * sine;
        b = base * cosine - roll * sine;
        advance = (centre * shaper.taper + roll * side.lead) / base;
        tilt = side.lead * cosine - sine * advance;
        k1 = y * shaft_sine + shaper.lift * shaft_cosine - a * tilt * shaft_sine;
        k2 = b * tilt * shaft_sine - shaper.offset * shaft_cosine;
        k0 = b * (1.0 / shaper.ratio + shaft_cosine) - shaper.offset * tilt * shaft_sine;
        square = k1 * k1 + k2 * k2;
        steep = std::sqrt(square - k0 * k0);
        psi_cosine = (k1 * k0 - k2 * steep) / square;
        psi_sine = (k2 * k0 + k1 * steep) / square;
    }

    // A vector of the mesh frame by its parts along the normal in the section, across it, and along the axis.
    Vector<double> vector(const Shaper& shaper, double normal, double across, double along) const {
        const double x = across * psi_sine - normal * psi_cosine,
                     up = -(normal * psi_sine + across * psi_cosine);
        return {x, along * shaper.shaft_sine + up * shaper.shaft_cosine,
                up * shaper.shaft_sine - along * shaper.shaft_cosine};
    }

    // The fillet's point as the shaper generates it.
    Vector<double> point(const Shaper& shaper) const {
        const double level = 1.0 / std::sqrt(1.0 + tilt * tilt), rounding = shaper.tip_rounding;
        const Vector<double> from_axis = vector(shaper, a + rounding * level, b, y + rounding * tilt * level);
        return from_axis + Vector<double>{shaper.offset, shaper.lift * shaper.shaft_cosine,
                                          shaper.lift * shaper.shaft_sine};
    }
};

// A point of the fillet in the gear's body frame, the slope psi of its normal and its derivatives.
struct FilletPoint {
    Frame<double> frame;
    double psi, psi_y, psi_angle;
};

inline FilletPoint fillet_point(const Side& side, double y, double angle) {
    const Shaper& shaper = side.shaper;
    const TipSection at(side, y, angle);
    const double base = shaper.base, shaft_sine = shaper.shaft_sine, shaft_cosine = shaper.shaft_cosine;
    const double rounding = shaper.tip_rounding, c = at.cosine, s = at.sine, a = at.a, b = at.b;
    const double tilt = at.tilt, both = 1.0 / shaper.ratio + shaft_cosine;
    const double a_y = at.roll_y * c, b_y = -at.roll_y * s;
    const double advance_y = (shaper.taper * shaper.taper + at.roll_y * side.lead) / base;
    const double tilt_y = -s * advance_y, tilt_angle = -side.lead * s - c * at.advance;
    const double k1_y = shaft_sine * (1.0 - a_y * tilt - a * tilt_y);
    const double k1_angle = -shaft_sine * (b * tilt + a * tilt_angle);
    const double k2_y = (b_y * tilt + b * tilt_y) * shaft_sine;
    const double k2_angle = (b * tilt_angle - a * tilt) * shaft_sine;
    const double k0_y = b_y * both - shaper.offset * tilt_y * shaft_sine;
    const double k0_angle = -a * both - shaper.offset * tilt_angle * shaft_sine;
    const double psi = std::atan2(at.psi_sine, at.psi_cosine);
    const double psi_y = (k1_y * at.psi_cosine + k2_y * at.psi_sine - k0_y) / at.steep;
    const double psi_angle = (k1_angle * at.psi_cosine + k2_angle * at.psi_sine - k0_angle) / at.steep;
    const double level = 1.0 / std::sqrt(1.0 + tilt * tilt), level_tilt = -tilt * level * level * level;
    const double outer = a + rounding * level, along_tilt = level + tilt * level_tilt;
    const double rolled = (at.roll + side.lead * (y - shaper.middle)) / base;
    const double phase = shaper.phase - rounding / (base * side.cosine);
    const double angle_of_turn = -shaper.ratio * (rolled - phase - psi + angle);
    const double turn_y = -shaper.ratio * ((at.roll_y + side.lead) / base - psi_y);
    const double turn_angle = -shaper.ratio * (1.0 - psi_angle);
    const Turn<double> turn{std::cos(angle_of_turn), std::sin(angle_of_turn)};
    const Vector<double> point = turn.of(at.point(shaper));
    const auto tangent = [&](double a_i, double b_i, double y_i, double tilt_i, double psi_i, double turn_i) {
        const double outer_i = a_i + rounding * level_tilt * tilt_i;
        const Vector<double> way = turn.of(at.vector(shaper, outer_i - b * psi_i, b_i + outer * psi_i,
                                                     y_i + rounding * along_tilt * tilt_i));
        return Vector<double>{way.x - turn_i * point.y, way.y + turn_i * point.x, way.z};
    };
    return {
        {point, tangent(a_y, b_y, 1.0, tilt_y, psi_y, turn_y),
         tangent(b, -a, 0.0, tilt_angle, psi_angle, turn_angle)},
        psi,
        psi_y,
        psi_angle,
    };
}

// The largest angle of the normal, at the fillet's lowest place.
inline double last_angle(const Side& side, double y) {
    const Shaper& shaper = side.shaper;
    const double centre = shaper.tip_centre + (y - shaper.middle) * shaper.taper;
    return std::atan2(shaper.base, std::sqrt(centre * centre - shaper.base * shaper.base));
}

// y of the shaper's tip, nearly, where it is lowest at a gear radius.
inline double tip_place(const Shaper& shaper, double radius) {
    const double level = std::sqrt(std::fmax(radius * radius - shaper.offset * shaper.offset, 0.0));
    const double below = shaper.tip_centre - shaper.lift;
    return (level + below * shaper.shaft_cosine) / shaper.shaft_sine;
}

// The end of the fillet, where it touches the root land: height, growth of the height per gear radius, and
// gear angle from the tooth's middle. Not numbers where the shaper does not reach the radius.
struct RootEdge {
    double height, slope, angle;
};

inline RootEdge root_edge(const Side& side, double radius) {
    double y = tip_place(side.shaper, radius);
    for (int i = 0; i < PLACE_STEPS; ++i) {
        const double last = last_angle(side, y);
        const TipSection at(side, y, last);
        const double turn_of_last = -side.shaper.base * at.roll_y / (at.centre * at.centre);
        const Frame<double> frame = fillet_point(side, y, last).frame;
        const Vector<double> point = frame.point, way = frame.by_first + turn_of_last * frame.by_second;
        const double reached = std::sqrt(point.x * point.x + point.y * point.y);
        const double growth = (point.x * way.x + point.y * way.y) / reached;
        const double step = (reached - radius) / growth;
        if (!std::isfinite(step)) break;
        y -= std::fmin(std::fmax(step, -0.2 * radius), 0.2 * radius);
        if (std::fabs(step) < CLOSE_PLACE) {
            const Vector<double> end = point - step * way;
            return {end.z, way.z / growth, std::atan2(end.x, end.y)};
        }
    }
    return {UNKNOWN, UNKNOWN, UNKNOWN};
}

} // namespace facegear::flanks
