// Derivatives of the energy of one-sided flanks, bearings and torques.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "statics/laws.hpp"
#include "statics/springs.hpp"
#include "tables.hpp"

namespace facegear::statics {

using Values = std::vector<double>;

// A machine with its law at one position, phase number `phase`; gap (F,): a flank is pressed in by J q - gap,
// m.
template <class Law>
struct Position {
    const Springs& springs;
    const Law& law;
    Index phase;
    const double* gap;
};

// Equations of a Newton step, upper triangles only: of each pinion a block (3, 3 + g + 1), its own unknowns,
// the g of the core and the right side; of the core (g, g + 1).
struct Equations {
    Values block_values, core_values;
    Index blocks, gears;

    Equations(Index pinions, Index gears)
        : block_values(static_cast<std::size_t>(pinions * 3 * (4 + gears))),
          core_values(static_cast<std::size_t>(gears * (gears + 1))),
          blocks(pinions),
          gears(gears) {}

    Table<double> block(Index pinion) {
        return {block_values.data() + pinion * 3 * (4 + gears), 3, 4 + gears};
    }
    Table<double> core() { return {core_values.data(), gears, gears + 1}; }
    void clear() {
        std::fill(block_values.begin(), block_values.end(), 0.0);
        std::fill(core_values.begin(), core_values.end(), 0.0);
    }
};

// Writes how far each flank is pressed in, negative where it is open, m.
template <class Law>
inline void penetrate(const Position<Law>& at, const Values& displacement, Values& over) {
    for (Index f = 0; f < at.springs.flanks(); ++f)
        over[f] = along(at.springs, f, displacement.data()) - at.gap[f];
}

// Writes the forces out of balance; returns the largest single force.
template <class Law>
inline double balance(const Position<Law>& at, const Values& over, const Values& displacement,
                      Values& gradient) {
    const Springs& springs = at.springs;
    double largest = 0.0;
    for (Index j = 0; j < springs.unknowns(); ++j) {
        gradient[j] = -springs.loads[j];
        largest = std::max(largest, std::fabs(springs.loads[j]));
    }
    for (Index i = 0; i < springs.pinions(); ++i) {
        const Force force = bearing_force(springs, i, displacement[3 * i], displacement[3 * i + 1]);
        gradient[3 * i] += force.x;
        gradient[3 * i + 1] += force.y;
    }
    for (Index e = 0; e < springs.core_value.size; ++e) {
        const Index a = springs.first() + springs.core_row[e], b = springs.first() + springs.core_column[e];
        gradient[a] += springs.core_value[e] * displacement[b];
        if (a != b) gradient[b] += springs.core_value[e] * displacement[a];
    }
    for (Index f = 0; f < springs.flanks(); ++f) {
        if (!(over[f] > 0.0)) continue;
        const double force = at.law.at(at.phase, f, over[f]).force;
        largest = std::max(largest, force);
        for (Index j = 0; j < springs.jacobian.columns; ++j) {
            gradient[unknown_of(springs, f, j)] += springs.jacobian(f, j) * force;
        }
    }
    return largest;
}

// One rounding of the largest sum of forces on an unknown, N. A flank's force is known no better than its gap
// and the displacements that close it.
template <class Law>
inline double rounding(const Position<Law>& at, const Values& over, const Values& displacement) {
    const Springs& springs = at.springs;
    const auto moved = [&](Index unknown) { return std::fabs(displacement[unknown]); };
    Values terms(displacement.size());
    for (Index i = 0; i < springs.pinions(); ++i) {
        const double* stiffness = springs.pinion_bearing.row(i);
        const double x = moved(3 * i), y = moved(3 * i + 1), cross = std::fabs(stiffness[1]);
        terms[3 * i] += stiffness[0] * x + cross * y;
        terms[3 * i + 1] += cross * x + stiffness[2] * y;
    }
    for (Index e = 0; e < springs.core_value.size; ++e) {
        const Index a = springs.first() + springs.core_row[e], b = springs.first() + springs.core_column[e];
        const double stiffness = std::fabs(springs.core_value[e]);
        terms[a] += stiffness * moved(b);
        if (a != b) terms[b] += stiffness * moved(a);
    }
    for (Index f = 0; f < springs.flanks(); ++f) {
        if (!(over[f] > 0.0)) continue;
        double length = std::fabs(at.gap[f]);
        for (Index j = 0; j < springs.jacobian.columns; ++j)
            length += std::fabs(springs.jacobian(f, j)) * moved(unknown_of(springs, f, j));
        const double force = at.law.at(at.phase, f, over[f]).slope * length;
        for (Index j = 0; j < springs.jacobian.columns; ++j)
            terms[unknown_of(springs, f, j)] += std::fabs(springs.jacobian(f, j)) * force;
    }
    return std::numeric_limits<double>::epsilon() * *std::max_element(terms.begin(), terms.end());
}

// Adds stiffness J^T J of one flank to the block of its pinion and to the core.
inline void add_flank(const Springs& springs, Index flank, double stiffness, Equations& equations) {
    const double* row = springs.jacobian.row(flank);
    const Index width = springs.jacobian.columns, gear = springs.gear[flank] - springs.first();
    const Table<double> block = equations.block(springs.pinion[flank] / 3), core = equations.core();
    for (Index a = 0; a < 3; ++a) {
        const double factor = stiffness * row[a];
        for (Index b = a; b < 3; ++b) block(a, b) += factor * row[b];
        for (Index b = 3; b < width; ++b) block(a, gear + b) += factor * row[b];
    }
    for (Index a = 3; a < width; ++a) {
        const double factor = stiffness * row[a];
        for (Index b = a; b < width; ++b) core(gear + a - 3, gear + b - 3) += factor * row[b];
    }
}

// Writes second derivatives of the energy, with springs `tie` to ground, and the right side; closed (F,):
// which flanks count as pressed in.
template <class Law>
inline void assemble(const Position<Law>& at, const Values& over, const std::vector<char>& closed,
                     const Values& displacement, const Values& gradient, double tie, Equations& equations) {
    const Springs& springs = at.springs;
    equations.clear();
    for (Index i = 0; i < springs.pinions(); ++i) {
        const Table<double> block = equations.block(i);
        const Stiffness own = bearing_stiffness(springs, i, displacement[3 * i], displacement[3 * i + 1]);
        block(0, 0) = own.xx + tie;
        block(0, 1) = own.xy;
        block(1, 1) = own.yy + tie;
        block(2, 2) = tie;
        for (Index r = 0; r < 3; ++r) block(r, block.columns - 1) = -gradient[3 * i + r];
    }
    const Table<double> core = equations.core();
    for (Index a = 0; a < core.rows; ++a) {
        core(a, a) = tie;
        core(a, core.rows) = -gradient[springs.first() + a];
    }
    for (Index e = 0; e < springs.core_value.size; ++e) {
        core(springs.core_row[e], springs.core_column[e]) += springs.core_value[e];
    }
    for (Index f = 0; f < springs.flanks(); ++f) {
        if (closed[f]) add_flank(springs, f, at.law.at(at.phase, f, std::max(over[f], 0.0)).slope, equations);
    }
}

// Slope and curvature of the energy along a line.
struct Rise {
    double slope, curvature;
};

// Along `step`, which presses flanks in at `rate` (F,), at a fraction of it from where they are pressed in by
// `over`.
template <class Law>
inline Rise rise_along(const Position<Law>& at, const Values& over, const Values& rate,
                       const Values& displacement, const Values& step, double fraction) {
    const Springs& springs = at.springs;
    double slope = 0.0, curvature = 0.0;
    const auto there = [&](Index unknown) { return displacement[unknown] + fraction * step[unknown]; };
    for (Index j = 0; j < springs.unknowns(); ++j) slope -= springs.loads[j] * step[j];
    for (Index i = 0; i < springs.pinions(); ++i) {
        const double dx = step[3 * i], dy = step[3 * i + 1], x = there(3 * i), y = there(3 * i + 1);
        const Force force = bearing_force(springs, i, x, y);
        const Stiffness stiffness = bearing_stiffness(springs, i, x, y);
        slope += force.x * dx + force.y * dy;
        curvature += stiffness.xx * dx * dx + 2.0 * stiffness.xy * dx * dy + stiffness.yy * dy * dy;
    }
    for (Index e = 0; e < springs.core_value.size; ++e) {
        const Index a = springs.first() + springs.core_row[e], b = springs.first() + springs.core_column[e];
        const double stiffness = springs.core_value[e];
        slope += stiffness * step[b] * there(a);
        curvature += stiffness * step[b] * step[a];
        if (a == b) continue;
        slope += stiffness * step[a] * there(b);
        curvature += stiffness * step[a] * step[b];
    }
    for (Index f = 0; f < springs.flanks(); ++f) {
        const double depth = over[f] + fraction * rate[f];
        if (!(depth > 0.0)) continue;
        const ForceAndSlope pressed = at.law.at(at.phase, f, depth);
        slope += pressed.force * rate[f];
        curvature += pressed.slope * rate[f] * rate[f];
    }
    return {slope, curvature};
}

} // namespace facegear::statics
