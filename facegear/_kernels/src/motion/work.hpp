// The numbers of the machines that a layout holds, and the scratch space of their steps.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "motion/constants.hpp"
#include "motion/fourier.hpp"
#include "motion/friction.hpp"
#include "motion/layout.hpp"
#include "motion/products.hpp"
#include "motion/rings.hpp"
#include "motion/roots.hpp"
#include "motion/system.hpp"
#include "motion/touching_flanks.hpp"

namespace facegear::motion {

// Of machines of one structure, for one thread and one order of the steps. Series have a row for each power
// of s.
template <class L, class LawType>
struct Work {
    using V = typename L::V;
    using S = typename L::S;

    Work(std::shared_ptr<const System> system, Index steps_order)
        : shape(std::move(system)),
          order(steps_order),
          rows(steps_order + 1),
          n(shape->n),
          m(shape->m),
          expansion(shape->harmonics(), rows),
          law(law_of(*shape), rows),
          products(*shape),
          rings(*shape, rows),
          friction(*shape, rows),
          touching(L::machines > 1 && LawType::by_mesh ? shape->pairs : 0, rows),
          roots(steps_order),
          polynomial(rows),
          powers(rows),
          terms(rows),
          finder(rows) {
        law.make_room(expansion.terms());
        for (Table<L>* each : {&omega_squared, &damping, &weights, &sample}) *each = room.table<L>(1, n);
        for (Table<L>* each :
             {&mesh_damping, &lower, &upper, &leverage, &force, &state, &side, &level, &active, &acting,
              &edge, &known_state, &known_begin, &known_end, &extent, &parting, &was_acting})
            *each = room.table<L>(1, m);
        for (Table<L>* each : {&y, &load, &turn}) *each = room.table<L>(rows, n);
        for (Table<L>* each : {&deflection, &turned, &elastic}) *each = room.table<L>(rows, m);
        error_series = room.table<L>(2 * shape->error.terms, m);
        error_of_kinds = room.table<L>(2 * shape->error.terms, shape->error.kinds);
        error_terms = room.table<L>(rows, std::max(m, shape->error.kinds));
        load_series = room.table<L>(2 * shape->load.terms, n);
        ways = room.table<L>(rows, 1);
        reach = room.table<L>(4, m);
        may_switch.resize(reach.width);
        for (Index b = 0; b < lower.width; ++b) {
            lower.put(0, b, V::splat(-infinity)); // lanes behind the last contact stay open
            upper.put(0, b, V::splat(infinity));
        }
    }

    static const LawType& law_of(const System& system) {
        return *std::get<std::shared_ptr<const LawType>>(system.law);
    }

    // Take the numbers of a machine into a lane.
    void enter(const Machine& machine, int lane) {
        const double w = machine.frequency, square = w * w;
        const System& system = *machine.system;
        Machine& last = entered[lane];
        const bool same_system = last.system == machine.system, same = same_system && last.frequency == w;
        if (!same_system || (system.coupled && !same)) products.enter(machine, lane);
        last = machine;
        tolerance.set(lane, machine.tolerance);
        fastest.set(lane, machine.fastest);
        if (same) return;
        for (Index k = 0; k < n; ++k) {
            omega_squared.one(0, k, lane) = system.omega_squared[k] / square;
            damping.one(0, k, lane) = system.damping[k] / w;
            weights.one(0, k, lane) = system.weights[k];
        }
        for (Index row = 0; row < m; ++row) {
            mesh_damping.one(0, row, lane) = system.mesh_damping[row] / w;
            lower.one(0, row, lane) = system.lower[row];
            upper.one(0, row, lane) = system.upper[row];
            leverage.one(0, row, lane) = system.leverage[row];
            known_state.one(0, row, lane) = 0.0;
        }
        enter_series(system.error, system.error_kind, 1.0, lane, error_series);
        enter_series(system.error, 1.0, lane, error_of_kinds);
        enter_series(system.load, 1.0 / square, lane, load_series);
        if (system.load.terms == 1)
            for (Index k = 0; k < n; ++k) load.one(0, k, lane) = load_series.one(1, k, lane);
        scale.set(lane, system.scale);
        rings.enter(machine, lane);
        friction.enter(machine, lane);
        law.enter(law_of(system), 1.0 / square, lane);
    }

    // Where lanes are machines, contacts of a kind share the series of the error, unless each drifts.
    void choose_error() {
        const bool shared = L::lanes == L::machines && drift_terms == 0;
        const Index kinds = blocks_of<L>(shape->error.kinds), width = blocks_of<L>(m);
        error = {{error_terms.data, shared ? kinds : width}, shared ? shape->error_kind.data() : nullptr};
    }

    std::shared_ptr<const System> shape;
    Index order, rows, n, m;
    Room room;
    Machine entered[L::machines];

    Table<L> omega_squared, damping, weights;      // over w^2, over w, as System
    Table<L> mesh_damping, lower, upper, leverage; // over w, as System
    S scale = S::splat(1.0), tolerance = S::splat(1.0), fastest = S::splat(1.0);
    Expansion<L> expansion;
    typename LawType::template Motion<L> law;
    Products<L> products;
    Rings<L> rings;
    Friction<L> friction;
    TouchingFlanks<L> touching;

    S phase = S::splat(0.0), length = S::splat(0.0); // of the step in the period, rad
    S longest = S::splat(infinity);                  // that a step may be, rad
    S fresh = S::splat(1.0);                         // 1 in the first step of a machine
    Index piece[L::machines] = {};                   // stretch between two breaks of the law
    double ahead[L::machines] = {};                  // phase since the first of them, rad

    Table<L> y, deflection; // Taylor coefficients; deflections are counted from `edge`
    Table<L> error_series, error_of_kinds, error_terms, load_series, load;
    Series<L> error;  // its terms, by contact or by kind
    Table<L> elastic; // forces of the law, kept where friction or parting needs them
    Table<L> force;   // of a row, with the factor of the next coefficient of y
    Index drift_terms = 0;
    const double* drift = nullptr; // (terms, contacts) of one machine, added to the error

    // Of every contact: `state` is 0 where it is open, p in piece p of the law on the drive flank, -p on the
    // back flank; `side` its sign. `level` is 0 but where a contact stands where piece p (-p) begins.
    // `active` and `acting` (the damping) are zero where nothing is transmitted. Deflections are counted from
    // `edge`, and the piece ends at `extent`. `parting` is 1 where the force of a contact that only pushes is
    // zero now.
    Table<L> state, side, level, active, acting, edge, extent, parting;
    Table<L> known_state, known_begin, known_end; // pieces that were found last, and where they begin and end
    Index last_force = 0; // up to which coefficient the forces are needed: the recurrence finds order - 2

    Table<L> reach; // bounds of the deflections over the step, as rise, up, down and slack of Reach
    std::vector<char> may_switch; // whether a contact of a block may pass a level in the step
    Table<L> ways; // polynomials that may have a zero in the step of their machine, one in each lane
    int way_count = 0, way_machine[L::lanes] = {};
    bool way_ignores[L::lanes] = {};  // a zero at once, which was decided by the rates already
    double first_switch[L::machines]; // fraction of the step
    RootFinder roots;
    std::vector<double> polynomial;
    std::vector<V> powers, terms; // powers of the length of the step
    std::vector<S> finder;

    Table<L> turn, turned, was_acting; // a disturbance, its deflections, damping of the last step
    Table<L> sample;                   // coordinates somewhere in the step
};

} // namespace facegear::motion
