// The face gear that rays are cut with: the right side of tooth 0 in the gear's body frame
// (docs/explanation/geometry.md).
#pragma once

#include "tables.hpp"

namespace facegear::flanks {

// Numbers of the gear; lengths in m, angles in rad.
struct Blank {
    double base;         // base radius of the shaper
    double ratio;        // tooth number of the shaper over that of the gear
    double space;        // half space angle of the shaper on its base circle
    double lift;         // distance of the planes of both axes
    double tip_centre;   // distance of the centre of the shaper's tip rounding from its axis
    double tip_rounding; // radius of that rounding
    double tip_roll;     // roll at which the flank ends at the fillet
    double edge_start; // where the rounding's centre stands from the vertical when the shaper has not turned
    double inner;      // inner radius
    double outer;      // outer radius
    double tip_plane;  // height of the tip land
    double root_plane; // height of the root land
    double root_start; // angle from the tooth's centre at which the root land begins
    double pitch;      // angle of a pitch
    double aside;      // largest distance of points from the tooth's middle plane
    double fillet_top; // height that no point of the fillet exceeds
    double fillet_start; // slope psi that no normal of the fillet falls below
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
