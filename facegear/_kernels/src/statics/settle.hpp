// Where all bodies stand when every flank, bearing and torque is in balance, position by position.
//
// The energy of one-sided flanks, bearings (with clearance or without) and torques is convex and, with a
// linear law and but for the clearances, quadratic between changes of contact: a semismooth Newton method
// (Hintermueller et al. 2003), each step an active set with its equations solved, with an exact line search
// that makes it global. Pinions touch each other through the gears only, so each is eliminated by itself (3 x
// 3) and the gears remain (4 or 6 unknowns each).
//
// A body that nothing holds may be stopped by a flank that only just closes, by less than its position can be
// resolved. Such a flank counts as closed in the next step, unless that would pull it open: the search would
// else stay where it is.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "statics/energy.hpp"
#include "statics/laws.hpp"
#include "statics/springs.hpp"
#include "tables.hpp"

namespace facegear::statics {

// Springs to ground in the matrix only, over the stiffest contact: they give free bodies a next position.
constexpr double TIE = 1e-10, FIRST_TIE = 1e-1;
constexpr int MAX_STEPS = 200;
// Part of a whole step's approach by which a flank that stopped the step may still be open.
constexpr double JUST_CLOSED = 1e-9;
// Residual from which a stalled search is looked at, and roundings of the largest sum of forces that count as
// balance: backlash of some mm leaves more than the tolerance, and a free body would slide on to no end.
// `facegear/machine/statics.py` accepts 32 of them.
constexpr double NEARLY = 1e-9, ROUNDINGS = 4.0;

// Factorises the leading 3 x 3 (upper triangle) by Cholesky's method, and applies the factor to the columns
// right of it.
inline void eliminate(Table<double> block) {
    for (Index r = 0; r < 3; ++r) {
        const double root = std::sqrt(block(r, r));
        for (Index c = r; c < block.columns; ++c) block(r, c) /= root;
        for (Index below = r + 1; below < 3; ++below) {
            const double factor = block(r, below);
            for (Index c = below; c < block.columns; ++c) block(below, c) -= factor * block(r, c);
        }
    }
}

// Subtracts what an eliminated pinion adds to the core.
inline void reduce_core(Table<double> block, Table<double> core) {
    for (Index r = 0; r < 3; ++r) {
        for (Index a = 0; a < core.rows; ++a) {
            const double factor = block(r, 3 + a);
            if (factor == 0.0) continue;
            for (Index b = a; b <= core.rows; ++b) core(a, b) -= factor * block(r, 3 + b);
        }
    }
}

// Solves symmetric equations, upper triangle and right side in `core` (g, g + 1).
inline void solve_core(Table<double> core, double* solution) {
    const Index size = core.rows;
    for (Index r = 0; r < size; ++r) {
        for (Index below = r + 1; below < size; ++below) {
            const double factor = core(r, below) / core(r, r);
            for (Index c = below; c <= size; ++c) core(below, c) -= factor * core(r, c);
        }
    }
    for (Index r = size - 1; r >= 0; --r) {
        double total = core(r, size);
        for (Index c = r + 1; c < size; ++c) total -= core(r, c) * solution[c];
        solution[r] = total / core(r, r);
    }
}

// The unknowns of an eliminated pinion, those of the core known.
inline void substitute_back(Table<double> block, const double* of_core, double* solution) {
    const Index core_size = block.columns - 4;
    for (Index r = 2; r >= 0; --r) {
        double total = block(r, block.columns - 1);
        for (Index b = 0; b < core_size; ++b) total -= block(r, 3 + b) * of_core[b];
        for (Index c = r + 1; c < 3; ++c) total -= block(r, c) * solution[c];
        solution[r] = total / block(r, r);
    }
}

inline double largest_magnitude(const Values& values) {
    double largest = 0.0;
    for (const double value : values) largest = std::max(largest, std::fabs(value));
    return largest;
}

// What is found at K positions.
struct Settled {
    Table<double> displacements; // (K, n), m
    Table<double> forces;        // (K, F), N
    List<double> residuals;      // (K,), largest imbalance over the largest force
};

// Searches the positions of one machine one after the other, each from where the one before was found.
template <class Law>
class Search {
  public:
    Search(const Springs& springs, const Law& law, double tolerance, const double* start)
        : springs(springs),
          law(law),
          tolerance(tolerance),
          displacement(start, start + springs.unknowns()),
          gradient(displacement.size()),
          step(displacement.size()),
          over(count(springs.flanks())),
          rate(over.size()),
          stops(over.size()),
          closed(over.size()),
          equations(springs.pinions(), springs.core_size()) {}

    // Settles the machine at phase number `phase`, with gaps (F,); `tie` as TIE. Returns the residual, which
    // is above the tolerance where the position is not solved.
    double settle(Index phase, const double* gap, double tie) {
        const Position<Law> at{springs, law, phase, gap};
        const double* stiffness = law.stiffness.row(phase);
        const double stiffest =
            springs.flanks() > 0 ? *std::max_element(stiffness, stiffness + springs.flanks()) : 0.0;
        std::fill(stops.begin(), stops.end(), 0);
        double residual = 0.0, least = std::numeric_limits<double>::infinity();
        for (int i = 0; i < MAX_STEPS; ++i) {
            penetrate(at, displacement, over);
            const double size = balance(at, over, displacement, gradient),
                         worst = largest_magnitude(gradient);
            residual = size > 0.0 ? worst / size : 0.0;
            if (worst <= tolerance * size) break;
            const bool is_stalled = worst <= NEARLY * size && worst > 0.5 * least;
            if (is_stalled && worst <= ROUNDINGS * rounding(at, over, displacement)) break;
            least = std::min(least, worst);
            take_newton_step(at, tie * stiffest);
            tie = std::max(0.1 * tie, TIE);
            // Forces below the tolerance are no reason to go on: a free body would slide, the others with it.
            double length = 0.0;
            for (const double each : step) length += std::fabs(each);
            move_by(line_minimum(at, tolerance * size * length));
        }
        return residual;
    }

    void write(Index phase, const Settled& settled) const {
        std::copy(displacement.begin(), displacement.end(), settled.displacements.row(phase));
        for (Index f = 0; f < springs.flanks(); ++f) {
            settled.forces(phase, f) = over[f] > 0.0 ? law.at(phase, f, over[f]).force : 0.0;
        }
    }

  private:
    const Springs& springs;
    const Law& law;
    double tolerance;
    Values displacement, gradient, step, over, rate;
    std::vector<char> stops,
        closed; // flanks that stopped the last step by just closing; flanks taken as closed
    Equations equations;

    static std::size_t count(Index size) { return static_cast<std::size_t>(size); }

    // With flanks closed that stopped the last step, unless that would pull one open.
    void take_newton_step(const Position<Law>& at, double tie) {
        for (int i = 0; i < 2; ++i) {
            for (Index f = 0; f < springs.flanks(); ++f) closed[f] = over[f] > 0.0 || stops[f];
            solve_step(at, tie);
            bool is_pulled_open = false;
            for (Index f = 0; f < springs.flanks(); ++f) {
                rate[f] = along(springs, f, step.data());
                is_pulled_open = is_pulled_open || (stops[f] && !(rate[f] >= 0.0));
            }
            if (!is_pulled_open) return;
            std::fill(stops.begin(), stops.end(), 0);
        }
    }

    // Solves (curvature + tie) step = -gradient by block elimination, pinions first.
    void solve_step(const Position<Law>& at, double tie) {
        assemble(at, over, closed, displacement, gradient, tie, equations);
        for (Index i = 0; i < springs.pinions(); ++i) {
            eliminate(equations.block(i));
            reduce_core(equations.block(i), equations.core());
        }
        double* of_core = step.data() + springs.first();
        solve_core(equations.core(), of_core);
        for (Index i = 0; i < springs.pinions(); ++i)
            substitute_back(equations.block(i), of_core, &step[3 * i]);
    }

    // Where the energy is least along the step: 1 as long as no contact changes.
    double line_minimum(const Position<Law>& at, double noise) const {
        const auto rise_at = [&](double fraction) {
            return rise_along(at, over, rate, displacement, step, fraction);
        };
        const double start = rise_at(0.0).slope, close = 1e-9 * std::fabs(start) + noise;
        double low = 0.0, high = 1.0, fraction = 1.0;
        Rise rise = rise_at(1.0);
        if (start >= 0.0 || std::fabs(rise.slope) <= close) return 1.0;
        while (rise.slope < 0.0 && high < 1e30) {
            low = high;
            high *= 2.0;
            fraction = high;
            rise = rise_at(fraction);
        }
        for (int i = 0; i < MAX_STEPS; ++i) {
            if (std::fabs(rise.slope) <= close || high - low <= 1e-15 * high) break;
            fraction = rise.curvature > 0.0 ? fraction - rise.slope / rise.curvature : low;
            if (!(low < fraction && fraction < high)) fraction = 0.5 * (low + high);
            rise = rise_at(fraction);
            (rise.slope < 0.0 ? low : high) = fraction;
        }
        return fraction;
    }

    void move_by(double fraction) {
        for (Index f = 0; f < springs.flanks(); ++f) {
            const bool is_near = over[f] + fraction * rate[f] >= -JUST_CLOSED * rate[f];
            stops[f] = over[f] <= 0.0 && rate[f] > 0.0 && is_near;
        }
        for (std::size_t j = 0; j < step.size(); ++j) displacement[j] += fraction * step[j];
    }
};

// Settles a machine at each phase of its law, with gaps (K, F) in m; the first search starts at `start` (n,).
template <class Law>
inline void settle_all(const Springs& springs, const Law& law, Table<const double> gap, double tolerance,
                       const double* start, const Settled& settled) {
    Search<Law> search(springs, law, tolerance, start);
    for (Index phase = 0; phase < gap.rows; ++phase) {
        settled.residuals[phase] = search.settle(phase, gap.row(phase), phase == 0 ? FIRST_TIE : TIE);
        search.write(phase, settled);
    }
}

} // namespace facegear::statics
