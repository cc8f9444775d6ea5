// What a run keeps of the steps of one machine: their polynomials, and the extrema of the deflections.
#pragma once

#include "motion/log.hpp"
#include "motion/roots.hpp"
#include "motion/work.hpp"

namespace facegear::motion {

// A step is looked through in this many parts, each for one change of direction.
constexpr int extrema_parts = 4;

// Write the polynomials of a step.
template <class L, class Law>
void keep_step(const Work<L, Law>& w, Index number, Log& log) {
    log.step_starts[number] = w.phase[0];
    log.step_lengths[number] = w.length[0];
    for (Index i = 0; i <= w.order; ++i) {
        const Index row = number * (w.order + 1) + i;
        for (Index k = 0; k < w.n; ++k) log.step_coordinates[row * w.n + k] = w.y.one(i, k, 0);
        for (Index contact = 0; contact < w.m; ++contact)
            log.step_deflections[row * w.m + contact] =
                w.deflection.one(i, contact, 0) + (i == 0 ? w.edge.one(0, contact, 0) : 0.0);
    }
    for (Index contact = 0; contact < w.m; ++contact)
        log.step_states[number * w.m + contact] = static_cast<Index>(w.state.one(0, contact, 0));
}

// Write every deflection at which a contact changes its direction within a step.
template <class L, class Law>
void add_turning_points(Work<L, Law>& w, Log& log) {
    const Index order = w.order;
    const double length = w.length[0];
    std::vector<double>& slopes = w.polynomial; // over the fraction of the step
    for (Index contact = 0; contact < w.m; ++contact) {
        double power = length;
        for (Index i = 0; i < order; ++i) {
            slopes[i] = static_cast<double>(i + 1) * power * w.deflection.one(i + 1, contact, 0);
            power *= length;
        }
        double slope = slopes[0];
        for (int part = 0; part < extrema_parts; ++part) {
            const double end = (part + 1.0) / extrema_parts, start = end - 1.0 / extrema_parts;
            double later = slopes[order - 1];
            for (Index i = order - 2; i >= 0; --i) later = later * end + slopes[i];
            if (slope * later < 0.0 || (later == 0.0 && slope != 0.0)) {
                const double t =
                    RootFinder::refine_root(slopes.data(), order - 1, start, end, slope, later) * length;
                double value = w.deflection.one(order, contact, 0);
                for (Index i = order - 1; i >= 0; --i) value = value * t + w.deflection.one(i, contact, 0);
                const Index kind = 2 * contact + (slope > 0.0 ? 0 : 1);
                if (log.turning_counts[kind] < log.asked.turns)
                    log.turning_points[kind * log.asked.turns + log.turning_counts[kind]] =
                        value + w.edge.one(0, contact, 0);
                ++log.turning_counts[kind];
            }
            slope = later;
        }
    }
}

} // namespace facegear::motion
