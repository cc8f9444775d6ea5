// What runs are asked for, and what they leave.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <vector>

#include "motion/constants.hpp"
#include "motion/layout.hpp"

namespace facegear::motion {

enum class Status : Index { done = 0, too_many_steps = 1, not_finite = 2 };

// What all machines of a run are asked for.
struct Asked {
    Index per_period = 0; // samples of the coordinates in each period
    Index batches = 0;    // of whole periods in which sums are taken; 0 leaves them out
    Index columns = 0;    // disturbances
    bool growth = false;  // of the first disturbance, which is brought back to length one after every period
    bool fine = false;    // steps as short as disturbances need
    Index kept = 0;       // of the last periods, the states at whose ends are kept
    Index steps = 0;      // of the first steps, whose polynomials are kept
    Index turns = 0;      // maxima and minima of each deflection that are kept
};

// Length of an array with the given lengths of its axes. Throws std::length_error where none can be so long:
// a product that overflows would make a short array.
inline std::size_t length_of(std::initializer_list<Index> axes) {
    constexpr Index longest = std::numeric_limits<Index>::max() / static_cast<Index>(sizeof(double));
    if (std::min(axes) == 0) return 0;
    Index product = 1;
    for (const Index axis : axes) {
        if (axis > longest / product)
            throw std::length_error("more numbers are asked for than an array can hold");
        product *= axis;
    }
    return static_cast<std::size_t>(product);
}

// Arrays [machine][...] of n coordinates and m contacts; those that were not asked for are empty.
struct Log {
    Asked asked;
    Index machines = 0, n = 0, m = 0, order = 0, longest = 0; // the most periods of a machine
    std::vector<double> ends;                                 // (kept, 2, n)
    std::vector<double> samples;                              // (longest * per_period, n)
    std::vector<double> tangents;                             // (columns, 2, n), moved along
    std::vector<double> growth;                               // (longest,) logarithms
    std::vector<double> divergence;                           // integral of the trace, with disturbances
    std::vector<double>
        fractions; // (3, m) phase open, on the drive and on the back flank, rad; where the flanks of a
                   // mesh stand for themselves the third is, at its drive flank, how long both touch
    std::vector<double> origin, level;         // (n,), (m,) about which coordinates and deflections are taken
    std::vector<double> coordinates, products; // (batches, n), (batches, n, n) upper half
    std::vector<double> deflections, squared;  // (batches, m)
    std::vector<double> forces;                // (2, m) elastic force over w^2 and its magnitude
    std::vector<double> minimum, maximum, pull; // (m,) extremes; smallest force of spring and damper over w^2
    std::vector<Index> taken, status;           // steps, and how the run ended
    // Of one machine: the first steps' polynomials, and the extrema of the deflections in the order they are
    // met.
    std::vector<double> step_starts, step_lengths, step_coordinates, step_deflections;
    std::vector<Index> step_states;
    std::vector<double> turning_points; // (m, 2, turns) maxima, then minima
    std::vector<Index> turning_counts;  // (m, 2), also of those that have no room

    Log(Asked what, Index count, Index of_n, Index of_m, Index of_order, Index periods)
        : asked(what), machines(count), n(of_n), m(of_m), order(of_order), longest(periods) {
        const Index summed = asked.batches > 0 ? count : 0;
        const bool shares = asked.batches > 0 || asked.per_period > 0 || asked.columns > 0;
        ends.resize(length_of({count, asked.kept, 2, n}));
        samples.resize(length_of({count, longest, asked.per_period, n}));
        tangents.resize(length_of({count, asked.columns, 2, n}));
        growth.resize(length_of({asked.growth ? count : 0, longest}));
        divergence.resize(count);
        fractions.resize(length_of({shares ? count : 0, 3, m}));
        origin.resize(length_of({summed, n}));
        level.resize(length_of({summed, m}));
        coordinates.resize(length_of({summed, asked.batches, n}));
        products.resize(length_of({summed, asked.batches, n, n}));
        deflections.resize(length_of({summed, asked.batches, m}));
        squared.resize(length_of({summed, asked.batches, m}));
        forces.resize(length_of({summed, 2, m}));
        minimum.assign(length_of({summed, m}), infinity);
        maximum.assign(length_of({summed, m}), -infinity);
        pull.resize(length_of({summed, m}));
        taken.resize(count);
        status.resize(count);
        step_starts.resize(asked.steps);
        step_lengths.resize(asked.steps);
        step_coordinates.resize(length_of({asked.steps, order + 1, n}));
        step_deflections.resize(length_of({asked.steps, order + 1, m}));
        step_states.resize(length_of({asked.steps, m}));
        turning_points.assign(length_of({2, m, asked.turns}), -infinity);
        turning_counts.resize(asked.turns > 0 ? 2 * m : 0);
    }
};

} // namespace facegear::motion
