// What contacts and bearings do at the samples of a motion, in one pass over arrays of them.
#pragma once

#include <algorithm>
#include <cmath>

#include "tables.hpp"

namespace facegear::samples {

// R bearings with clearance, whose springs act beyond it.
struct Rings {
    List<const double> stiffness; // (R,), N/m
    List<const double> clearance; // (R,), m
    List<const Index> body;       // (R,)
    double lag;                   // damping over stiffness, s
};

// Writes forces (bodies, 3, K) along x and y of rings that have moved by `displacement` (R, 2, K) at `speed`
// (R, 2, K): F = k (1 - c / r) (x, y), and lag times dF/dt beside it.
inline void write_ring_forces(const Rings& rings, const double* displacement, const double* speed,
                              Index count, double* forces) {
    for (Index r = 0; r < rings.body.size; ++r) {
        const double *x = displacement + 2 * r * count, *y = x + count;
        const double *dx = speed + 2 * r * count, *dy = dx + count;
        double *along_x = forces + 3 * rings.body[r] * count, *along_y = along_x + count;
        const double stiffness = rings.stiffness[r], clearance = rings.clearance[r];
        for (Index k = 0; k < count; ++k) {
            const double distance = std::max(std::sqrt(x[k] * x[k] + y[k] * y[k]), clearance);
            const double lag = distance > clearance ? rings.lag : 0.0;
            const double free = clearance / distance;
            const double turned = free * (x[k] * dx[k] + y[k] * dy[k]) / (distance * distance) * lag;
            const double along = stiffness * (1.0 - free + turned), across = stiffness * (1.0 - free) * lag;
            along_x[k] = along * x[k] + across * dx[k];
            along_y[k] = along * y[k] + across * dy[k];
        }
    }
}

// Deflections of M contacts over B mesh periods of K samples.
struct Deflections {
    double* values; // (M, B, K), m
    Index contacts, periods, samples;
};

// Turns deflections into how far contacts are pressed in: without the errors (K, M) of the period, above
// `upper` (M,), or below `lower` (M,) as a negative amount. A contact with lower >= upper is never open: both
// directions count from `upper`.
inline void press_in(const Deflections& deflections, Table<const double> errors, List<const double> lower,
                     List<const double> upper) {
    double* value = deflections.values;
    for (Index m = 0; m < deflections.contacts; ++m) {
        const double above = upper[m], below = std::min(lower[m], above);
        for (Index b = 0; b < deflections.periods; ++b) {
            for (Index k = 0; k < deflections.samples; ++k, ++value) {
                const double deflection = *value - errors(k, m);
                *value = deflection - std::min(std::max(deflection, below), above);
            }
        }
    }
}

// Writes loads (2 M, K) of drive flanks, then back flanks, of forces (M, K) that meshes transmit: nothing
// where a force is at most the part `rounding` of the largest of all.
inline void split_loads(Table<const double> forces, double rounding, Table<double> loads) {
    const Index count = forces.rows * forces.columns;
    double largest = 0.0;
    for (Index i = 0; i < count; ++i) largest = std::max(largest, std::fabs(forces.data[i]));
    const double counted = rounding * largest;
    for (Index i = 0; i < count; ++i) {
        const double force = forces.data[i];
        loads.data[i] = force > counted ? force : 0.0;
        loads.data[i + count] = -force > counted ? -force : 0.0;
    }
}

} // namespace facegear::samples
