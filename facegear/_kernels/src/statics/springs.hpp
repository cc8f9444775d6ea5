// One-sided flanks, bearings and torques of a machine, whose elastic energy statics minimises.
#pragma once

#include <cmath>

#include "tables.hpp"

namespace facegear::statics {

// F flanks, P pinions, n unknowns: x, y and turn of every pinion, then w of every gear; all are lengths. Each
// flank joins one pinion and one gear; pinions touch each other through the other unknowns only. N, m.
struct Springs {
    Table<const double> jacobian;       // (F, 3 + w), by the unknowns of a flank's pinion and of its gear
    List<const Index> pinion;           // (F,), the first unknown of that pinion
    List<const Index> gear;             // (F,), the first unknown of that gear
    Table<const double> pinion_bearing; // (P, 3): xx, xy, yy
    List<const double> clearance;       // (P,), where positive with xx = yy and xy = 0
    List<const Index> core_row;    // (E,), upper entries of the stiffness among the other unknowns, counted
    List<const Index> core_column; // (E,)  from the first of them
    List<const double> core_value; // (E,)
    List<const double> loads;      // (n,), forces

    Index flanks() const { return jacobian.rows; }
    Index pinions() const { return pinion_bearing.rows; }
    Index unknowns() const { return loads.size; }
    Index first() const { return 3 * pinions(); }
    Index core_size() const { return unknowns() - first(); }
};

// The unknown that a column of a flank's row of the Jacobian belongs to.
inline Index unknown_of(const Springs& springs, Index flank, Index column) {
    return column < 3 ? springs.pinion[flank] + column : springs.gear[flank] + column - 3;
}

// How much a flank is pressed in by a motion (n,), m.
inline double along(const Springs& springs, Index flank, const double* motion) {
    double total = 0.0;
    for (Index j = 0; j < springs.jacobian.columns; ++j) {
        total += springs.jacobian(flank, j) * motion[unknown_of(springs, flank, j)];
    }
    return total;
}

struct Force {
    double x, y;
};

// Second derivatives of a bearing's energy, N/m.
struct Stiffness {
    double xx, xy, yy;
};

// Part by which a spring is stretched that acts beyond a clearance: 1 - c / r, none within it.
inline double stretched_part(double distance, double clearance) {
    return distance > clearance ? 1.0 - clearance / distance : 0.0;
}

// Force of a pinion's bearing away from x, y.
inline Force bearing_force(const Springs& springs, Index pinion, double x, double y) {
    const double* stiffness = springs.pinion_bearing.row(pinion);
    const double clearance = springs.clearance[pinion];
    if (clearance > 0.0) {
        const double factor = stiffness[0] * stretched_part(std::sqrt(x * x + y * y), clearance);
        return {factor * x, factor * y};
    }
    return {stiffness[0] * x + stiffness[1] * y, stiffness[1] * x + stiffness[2] * y};
}

// Derivatives of bearing_force: k (1 - c / r) across the displacement and k along it, beyond a clearance.
inline Stiffness bearing_stiffness(const Springs& springs, Index pinion, double x, double y) {
    const double* stiffness = springs.pinion_bearing.row(pinion);
    const double clearance = springs.clearance[pinion];
    if (!(clearance > 0.0)) return {stiffness[0], stiffness[1], stiffness[2]};
    const double distance = std::sqrt(x * x + y * y);
    if (!(distance > clearance)) return {0.0, 0.0, 0.0};
    const double across = stiffness[0] * stretched_part(distance, clearance);
    const double ahead = (stiffness[0] - across) / (distance * distance);
    return {across + ahead * x * x, ahead * x * y, across + ahead * y * y};
}

} // namespace facegear::statics
