// Taylor coefficients of the motion between two contact switches.
//
// Between switches the forces are analytic, and coefficient i of the forces needs no more than those up to i
// of the deflections: so the coefficients of y follow from each other by a recurrence that costs one product
// with G, one with its transpose and what the law asks for each order (docs/explanation/dynamics.md).
#pragma once

#include "motion/functions.hpp"
#include "motion/work.hpp"

namespace facegear::motion {

// The first `rows` coefficients of law, friction, error and load at the phases of the machines.
template <class L, class Law>
void expand_excitation(Work<L, Law>& w, Index rows) {
    const System& shape = *w.shape;
    w.expansion.set_phase(w.phase);
    w.law.expand_phase(w.expansion, w.piece, w.ahead, rows);
    w.friction.expand(w.expansion, rows);
    w.expansion.expand(w.error.column ? w.error_of_kinds : w.error_series, shape.error.terms, rows,
                       w.error.table);
    for (Index row = 0; w.drift_terms > 0 && row < w.m; ++row) {
        for (int machine = 0; machine < L::machines; ++machine) {
            for (Index i = 0; i < w.drift_terms; ++i) w.polynomial[i] = w.drift[i * w.m + row];
            shift_polynomial(w.polynomial.data(), w.drift_terms, w.phase[machine]);
            for (Index i = 0; i < w.drift_terms; ++i) w.error.table.one(i, row, machine) += w.polynomial[i];
        }
    }
    if (shape.load.terms > 1) w.expansion.expand(w.load_series, shape.load.terms, rows, w.load);
}

// Row i + 2 of y from the rows before it and the forces.
template <class L, class Law>
void accelerate(Work<L, Law>& w, Table<L> y, Index i, bool disturbed) {
    using V = typename L::V;
    const V rate = V::splat(static_cast<double>(i + 1)),
            factor = V::splat(1.0 / static_cast<double>((i + 1) * (i + 2)));
    const bool loaded = !disturbed && (i == 0 || w.shape->load.terms > 1);
    for (Index b = 0; b < y.width; ++b) {
        const V own = w.damping.at(0, b) * (rate * y.at(i + 1, b)) + w.omega_squared.at(0, b) * y.at(i, b);
        y.put(i + 2, b, factor * (loaded ? w.load.at(i, b) - own : -own));
    }
}

// Coefficient i of the forces of all contacts, which push back; they carry the factor of the next coefficient
// of y.
template <class L, class Law>
void push_contacts(Work<L, Law>& w, Table<L> deflection, Index i, bool disturbed) {
    using V = typename L::V;
    const V rate = V::splat(static_cast<double>(i + 1)),
            pushed = V::splat(-1.0 / static_cast<double>((i + 1) * (i + 2)));
    const bool kept = w.friction.count() > 0 || (w.shape->push_only && !disturbed);
    const Index of_law = blocks_of<L>(w.shape->contacts);
    const Series<L> slope = w.law.slope();
    const auto push = [&](Index b, V total) {
        if (kept) w.elastic.put(i, b, absolute(w.side.at(0, b)) * total);
        total = w.active.at(0, b) * total + w.acting.at(0, b) * rate * deflection.at(i + 1, b);
        w.force.put(0, b, pushed * total);
    };
    Index first = 0;
    if constexpr (Law::by_mesh) {
        const Table<L> of_blocks = w.touching.deflections(deflection, disturbed);
        const Index pairs = w.touching.pairs();
        const auto force = [&](Index b) {
            if (!w.law.touches(b)) return V::splat(0.0);
            return disturbed ? product(slope, of_blocks, i, b) : w.law.force(of_blocks, i, b);
        };
        for (Index mesh = 0; mesh < pairs; ++mesh) {
            const V total = force(mesh);
            push(mesh, total);
            push(mesh + pairs, w.touching.is_one(mesh) ? total : force(mesh + pairs));
        }
        first = 2 * pairs;
    }
    for (Index b = first; b < deflection.width; ++b) {
        V total = V::splat(0.0);
        const bool touching =
            b < of_law &&
            (L::machines == 1 || positive_lanes(kept ? absolute(w.side.at(0, b)) : w.active.at(0, b)));
        if (touching) total = disturbed ? product(slope, deflection, i, b) : w.law.force(deflection, i, b);
        if constexpr (Law::moves)
            if (touching && disturbed) total = total + w.law.disturbed_force(deflection, i, b);
        push(b, total);
    }
    if constexpr (Law::moves)
        w.law.push_places(deflection, w.active, i, -1.0 / static_cast<double>((i + 1) * (i + 2)), disturbed,
                          w.force);
}

// Fill rows first + 2 to last + 1 of y and of deflection from the rows before them. Row 0 of the deflections
// is counted from the edge. A disturbance of the motion is moved by the slopes of the forces along it, which
// must be known.
template <class L, class Law>
void recurrence(Work<L, Law>& w, Index first, Index last, Table<L> y, Table<L> deflection, bool disturbed) {
    const auto expand_rings = [&](Index i) {
        if (w.rings.count() == 0) return;
        disturbed ? w.rings.expand_disturbed(deflection, i) : w.rings.expand(deflection, w.active, i);
    };
    if (first == 0) {
        expand_rings(0);
        expand_rings(1);
        w.products.find_pressing(w.active, w.acting);
        for (Index row = 0; row < 2; ++row) w.touching.take(deflection, row, disturbed);
    }
    for (Index i = first; i < last; ++i) {
        const double factor = 1.0 / static_cast<double>((i + 1) * (i + 2));
        push_contacts(w, deflection, i, disturbed);
        w.rings.push(w.active, i, -factor, w.force);
        accelerate(w, y, i, disturbed);
        w.products.push(w.force, y, i + 2);
        w.products.couple(y, i);
        w.friction.rub(w.elastic, w.side, i, factor, w.products, y, i + 2);
        w.products.deflect(y, i + 2, disturbed ? nullptr : &w.error, deflection);
        w.touching.take(deflection, i + 2, disturbed);
        expand_rings(i + 2);
    }
}

// Step at which each of the last two terms is below the tolerance times the length scale (Jorba and Zou
// 2005).
template <class L, class Law>
typename L::S step_length(const Work<L, Law>& w) {
    using V = typename L::V;
    using S = typename L::S;
    const S target = w.tolerance * w.scale;
    S power = S::splat(600.0);
    for (Index i = w.order - 1; i <= w.order; ++i) {
        V size = V::splat(0.0);
        for (Index b = 0; b < w.y.width; ++b) size = w.weights.at(0, b) * absolute(w.y.at(i, b)) + size;
        const S whole = larger(Products<L>::sum(size), S::splat(smallest_size));
        power = smaller(logarithm(target / whole) * S::splat(1.0 / static_cast<double>(i)), power);
    }
    return exponential(larger(power, S::splat(-600.0)));
}

// Value and derivative by s of polynomials a step ahead, by Horner's rule, into rows of another table.
template <class L>
void move_ahead(Table<L> y, Index order, typename L::S step, Table<L> out, Index value_row, Index slope_row) {
    using V = typename L::V;
    const V ahead = L::every(step);
    for (Index b = 0; b < y.width; ++b) {
        V value = y.at(order, b), slope = V::splat(0.0);
        for (Index i = order - 1; i >= 0; --i) {
            slope = slope * ahead + value;
            value = value * ahead + y.at(i, b);
        }
        out.put(value_row, b, value);
        out.put(slope_row, b, slope);
    }
}

// Values alone, into `sample`.
template <class L, class Law>
void look_ahead(Work<L, Law>& w, typename L::S step) {
    for (Index b = 0; b < w.y.width; ++b) w.sample.put(0, b, value_ahead(w.y, w.order, L::every(step), b));
}

} // namespace facegear::motion
