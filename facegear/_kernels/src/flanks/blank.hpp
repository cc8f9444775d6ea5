// The face gear that rays are cut with: tooth 0 in the gear's body frame, seen in a mirror where its drive
// flank stands on the right (docs/explanation/geometry.md).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "tables.hpp"

namespace facegear::flanks {

// Places of the fillet from which searches begin.
constexpr std::size_t FILLET_HEIGHTS = 17;

// The shaper and its place against the gear; lengths in m, angles in rad.
struct Shaper {
    double base;         // radius of the base cylinder
    double ratio;        // tooth number of the shaper over that of the gear
    double phase;        // angle from the middle of its space to the involute's start, in the middle section
    double sine;         // of the base helix, signed
    double middle;       // place along its axis of the middle section
    double lift;         // distance of the planes of both axes
    double offset;       // of its axis from the gear's
    double shaft_sine;   // of the angle between both axes
    double shaft_cosine; // of that angle
    double taper;        // growth of the tip's radius along the axis
    double tip_centre;   // distance of the centre of the tip rounding from the axis, in the middle section
    double tip_rounding; // radius of that rounding
};

// Where searches on a side begin, over the distance (m) of a place from a gear radius and its depth (m) below
// the tip. Roll and psi of the flank are polynomials of second degree in both, for depths up to `depth`.
struct Guess {
    double radius, depth;
    std::array<double, 6> roll, psi;
    std::array<double, 3> edge;                // gear angle of the tip edge, in rising powers of the distance
    double edge_error;                         // larger than any error of that angle, rad
    std::array<double, FILLET_HEIGHTS> fillet; // depths below the tip at even steps of the fillet's angle

    static double at(const std::array<double, 6>& factors, double along, double down) {
        return factors[0] + along * (factors[1] + along * factors[3] + down * factors[4]) +
               down * (factors[2] + down * factors[5]);
    }

    double edge_at(double gear_radius) const {
        const double along = gear_radius - radius;
        return edge[0] + along * (edge[1] + along * edge[2]);
    }
};

// A right side of a tooth, and what its closed forms ask for again and again.
struct Side {
    Shaper shaper;
    Guess guess;
    double cosine;     // of the base helix
    double lead;       // its tangent
    double across;     // transverse length of roll per roll, m
    double reach;      // base radius over ratio, m
    double tilt;       // lead times sine of the shaft angle
    double fall;       // lead times cosine of the shaft angle
    double upright;    // 1 over sine of the shaft angle
    double roll_turn;  // turn of the gear per roll
    double place_turn; // turn of the gear per length along the shaper's face, rad/m

    Side(const Shaper& shaper, const Guess& guess)
        : shaper(shaper),
          guess(guess),
          cosine(std::sqrt(1.0 - shaper.sine * shaper.sine)),
          lead(shaper.sine / cosine),
          across(shaper.base * cosine),
          reach(shaper.base / shaper.ratio),
          tilt(lead * shaper.shaft_sine),
          fall(lead * shaper.shaft_cosine),
          upright(1.0 / shaper.shaft_sine),
          roll_turn(-shaper.ratio / cosine),
          place_turn(shaper.ratio * lead / shaper.base) {}
};

// A straight meridian of a surface about the gear's axis: heights over gear radii.
struct Line {
    double height; // at the axis, m
    double slope;

    double at(double radius) const { return height + slope * radius; }
};

// Numbers of the gear; lengths in m, angles in rad.
struct Blank {
    Side flank;        // the right side of the tooth
    Side back;         // its left side, in the mirror
    double inner;      // inner radius
    double outer;      // outer radius
    Line tip;          // tip land
    Line root;         // root land, nearly
    double root_bulge; // largest distance of the root land from that line
    double pitch;      // angle of a pitch
    double module;     // normal module
    Line middle;       // x of the tooth's middle over y
    double aside;      // largest distance along x of points from there
    double fillet_top; // height over the tip that no point of the fillet exceeds; negative
};

// Points of the flank: a second start where Newton's first fails, and proof that a ray misses. As many points
// stand at each of the gear radii, one radius after the other.
struct FlankSample {
    Table<const double> points;  // (m, 3), m
    Table<const double> normals; // (m, 3)
    List<const double> rolls;    // (m,), rad
    List<const double> psis;     // (m,), rad
    List<const bool> inner;      // (m,), whether a point is away from the flank's edges
    double spacing;              // largest distance of neighbours, m
    List<const double> radii;    // (r,), m
};

} // namespace facegear::flanks
