// Roller bearings in five motions, each roller cut into slices (de Mul et al. 1989): a slice carries
// q = k delta^(10/9), as ISO/TS 16281 has it.
//
// A slice at x along its roller approaches by a + b x: a is the motion of the roller's middle along the
// normal, b its tilt. So all slices of a roller need two coordinates.
#pragma once

#include <cmath>

#include "bearings/position.hpp"
#include "bearings/ring.hpp"
#include "tables.hpp"

namespace facegear::bearings {

// A bearing of Z rollers in n slices; lengths in m, stiffness in N/m^(10/9).
struct Rollers {
    List<const double> cosine, sine;     // (Z,) of the angle of each roller, from x towards y
    List<const double> positions, drops; // (n,) of the slices along the roller; drop of one contact's profile
    double radius;                       // of the circle of the rollers' middles
    double normal_radial, normal_axial;
    double direction; // 1, or -1 where z is mirrored
    double clearance; // along the normal
    double stiffness; // of a slice, both contacts in series
    double centrifugal, free_position,
        free_energy; // force on each roller along the normal, N; position (m) and energy (J) without inner
                     // ring

    Rows rows(Index roller) const {
        const double c = cosine[roller], s = sine[roller], lever = normal_axial * radius;
        return {{normal_radial * c, normal_radial * s, normal_axial, lever * s, -lever * c},
                {0.0, 0.0, 0.0, -direction * s, direction * c}};
    }
    // 2^(10/9): of two equal contacts in series each is so much stiffer than both.
    double contact_stiffness() const { return stiffness * 2.0 * std::cbrt(std::cbrt(2.0)); }
};

// Load of a slice, N, and its derivative, N/m.
struct SliceLoad {
    double load, slope;
};

inline SliceLoad slice_load(double approach, double stiffness) {
    if (approach <= 0.0) return {0.0, 0.0};
    const double slope = stiffness * std::cbrt(std::cbrt(approach));
    return {slope * approach, 10.0 / 9.0 * slope};
}

// Slices that approach by first + second x - `part` of the drop.
inline Derivatives press(const Rollers& bearing, Position position, double part, double stiffness) {
    Derivatives sum;
    for (Index k = 0; k < bearing.positions.size; ++k) {
        const double x = bearing.positions[k];
        const double approach = position.first + position.second * x - part * bearing.drops[k];
        const SliceLoad slice = slice_load(approach, stiffness);
        if (slice.slope == 0.0) continue;
        sum.energy += 9.0 / 19.0 * slice.load * approach;
        sum.first += slice.load;
        sum.second += slice.load * x;
        sum.first_first += slice.slope;
        sum.first_second += slice.slope * x;
        sum.second_second += slice.slope * x * x;
    }
    return sum;
}

// A roller between both rings under centrifugal force, by its position and tilt from the outer ring.
struct ThrownRoller {
    const Rollers& bearing;
    Position ring; // approach and tilt of the inner ring towards the outer one

    Position gap_to_ring(Position roller) const {
        return {ring.first - roller.first, ring.second - roller.second};
    }
    Derivatives inner(Position roller) const {
        return press(bearing, gap_to_ring(roller), 1.0, bearing.contact_stiffness());
    }
    Derivatives outer(Position roller) const {
        return press(bearing, roller, 1.0, bearing.contact_stiffness());
    }
    Derivatives at(Position roller) const {
        const Derivatives i = inner(roller), e = outer(roller);
        return {i.energy + e.energy - bearing.centrifugal * roller.first,
                e.first - i.first - bearing.centrifugal,
                e.second - i.second,
                i.first_first + e.first_first,
                i.first_second + e.first_second,
                i.second_second + e.second_second};
    }
    double arm() const { return std::fabs(bearing.positions[bearing.positions.size - 1]); }
    // By which the force alone would move the roller as far as the rings are apart: one slice that holds a
    // roller leaves it free to tilt.
    double softest() const { return bearing.centrifugal / size({bearing.free_position, 0.0}); }
    double size(Position roller) const {
        return std::fabs(roller.first) + std::fabs(ring.first) + bearing.drops[0] +
               arm() * (std::fabs(roller.second) + std::fabs(ring.second));
    }
    // Half-way between both rings, but not above the position that the force alone gives.
    Position start() const {
        const double half = 0.5 * ring.first;
        return {half > bearing.free_position ? half : bearing.free_position, 0.5 * ring.second};
    }
};

// Approach and tilt of the rings at a roller.
inline Position approach(const Rollers& bearing, const Rows& rows, const double* motion) {
    return {rows.first_of(motion) - bearing.clearance, rows.second_of(motion)};
}

// Places of a roller under centrifugal force; false where none is found.
inline bool find_position(const ThrownRoller& thrown, Position& roller) {
    roller = {thrown.bearing.free_position, 0.0};
    if (thrown.inner(roller).energy == 0.0) return true;
    roller = thrown.start();
    return settle(thrown, roller);
}

// Derivatives of a roller's energy by approach and tilt of the rings; false where the roller finds no
// position.
inline bool respond(const Rollers& bearing, Position ring, Derivatives& result) {
    if (bearing.centrifugal == 0.0) {
        result = press(bearing, ring, 2.0, bearing.stiffness);
        return true;
    }
    const ThrownRoller thrown{bearing, ring};
    Position roller{0.0, 0.0};
    const bool is_found = find_position(thrown, roller);
    const Derivatives inner = thrown.inner(roller), outer = thrown.outer(roller);
    result = inner;
    result.energy = inner.energy + outer.energy - bearing.centrifugal * roller.first - bearing.free_energy;
    put_in_series(inner, outer, result);
    return is_found;
}

// Adds all rollers at a motion (5,); returns how many of them found no position.
inline Index respond(const Rollers& bearing, const double* motion, Response& response) {
    Index lost = 0;
    for (Index roller = 0; roller < bearing.cosine.size; ++roller) {
        const Rows rows = bearing.rows(roller);
        Derivatives element;
        lost += !respond(bearing, approach(bearing, rows, motion), element);
        rows.add(element, response);
    }
    return lost;
}

// Writes the loads (Z, n, 2) of all slices on inner and outer ring, N; returns how many rollers found no
// position.
inline Index write_loads(const Rollers& bearing, const double* motion, double* loads) {
    const Index slices = bearing.positions.size;
    Index lost = 0;
    for (Index number = 0; number < bearing.cosine.size; ++number) {
        const Position ring = approach(bearing, bearing.rows(number), motion);
        const bool is_thrown = bearing.centrifugal != 0.0;
        Position roller{0.0, 0.0};
        if (is_thrown) lost += !find_position({bearing, ring}, roller);
        const double stiffness = is_thrown ? bearing.contact_stiffness() : bearing.stiffness;
        for (Index k = 0; k < slices; ++k) {
            const double x = bearing.positions[k], drop = bearing.drops[k];
            const double outer = roller.first + roller.second * x;
            const double whole = ring.first + ring.second * x;
            double* row = loads + 2 * (number * slices + k);
            row[0] = slice_load(whole - outer - (is_thrown ? 1.0 : 2.0) * drop, stiffness).load;
            row[1] = is_thrown ? slice_load(outer - drop, stiffness).load : row[0];
        }
    }
    return lost;
}

} // namespace facegear::bearings
