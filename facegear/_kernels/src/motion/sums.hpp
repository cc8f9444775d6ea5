// Integrals and extremes of the motion, taken from the step polynomials themselves.
//
// Products of two polynomials are integrated by Gauss's rule with a quarter of the order's number of nodes
// and one more, whose error lies below that of the step (a term that the rule misses is the square of one
// half way to the last); extremes are the polynomials' own. So nothing depends on how densely the motion is
// sampled.
#pragma once

#include <vector>

#include "motion/log.hpp"
#include "motion/switches.hpp"
#include "motion/taylor.hpp"
#include "motion/work.hpp"

namespace facegear::motion {

// Parts of a step between whose ends an extremum is looked for, and steps of Newton's method there.
constexpr int extremum_looks = 8, extremum_turns = 4;

// What is added up over a batch of periods, or over all periods of a machine: as in Log, machine by machine.
template <class L>
struct Tally {
    using V = typename L::V;

    Tally(Index n, Index m, std::vector<double> gauss_nodes, std::vector<double> gauss_weights)
        : nodes(std::move(gauss_nodes)), weights(std::move(gauss_weights)) {
        const Index count = static_cast<Index>(nodes.size());
        for (Table<L>* each : {&origin, &coordinates}) *each = room.table<L>(1, n);
        for (Table<L>* each : {&level, &deflections, &squared, &minimum, &maximum, &pull, &value})
            *each = room.table<L>(1, m);
        forces = room.table<L>(2, m);
        fractions = room.table<L>(3, m);
        products = room.table<L>(n, n);
        off = room.table<L>(count, n);
        heavy = room.table<L>(count, n);
    }

    Room room;
    std::vector<double> nodes, weights; // on [0, 1]
    Table<L> origin, coordinates, level, deflections, squared, minimum, maximum, pull, forces, fractions,
        products;
    Table<L> off, heavy; // coordinates at the nodes of a step, from their origin, and times their weights
    Table<L> value;      // deflections at a node
};

// Half of what the drive flank's value is above its edge less what the back flank's is.
template <class L, class Law>
typename L::S between(const Work<L, Law>& w, typename L::S drive, typename L::S back, Index mesh) {
    using S = typename L::S;
    return S::splat(0.5) * ((drive - w.upper.of(0, mesh)) - (back - w.upper.of(0, mesh + w.shape->pairs)));
}

// Count from where a motion starts, so that squares keep their digits.
template <class L, class Law>
void start_sums(const Work<L, Law>& w, Tally<L>& tally) {
    if (positive_lanes(w.fresh) == 0) return;
    const auto fresh = L::every(w.fresh);
    for (Index b = 0; b < w.y.width; ++b)
        tally.origin.put(0, b, where_positive(fresh, w.y.at(0, b), tally.origin.at(0, b)));
    for (Index b = 0; b < w.deflection.width; ++b)
        tally.value.put(0, b, w.deflection.at(0, b) + w.edge.at(0, b));
    for (Index mesh = 0; mesh < w.shape->pairs; ++mesh)
        tally.value.set(0, mesh,
                        between(w, tally.value.of(0, mesh), tally.value.of(0, mesh + w.shape->pairs), mesh));
    for (Index b = 0; b < w.deflection.width; ++b)
        tally.level.put(0, b, where_positive(fresh, tally.value.at(0, b), tally.level.at(0, b)));
}

// Add deflections and forces at a step ahead, with a weight.
template <class L, class Law>
void add_contacts(Work<L, Law>& w, Tally<L>& tally, typename L::S at, typename L::S weight) {
    using V = typename L::V;
    const V ahead = L::every(at), heavy = L::every(weight);
    const Index of_law = blocks_of<L>(w.shape->contacts), pairs = w.shape->pairs;
    w.law.look_ahead(w.order, ahead);
    struct Motion {
        V deflection = V::splat(0.0), rate = deflection;
    };
    const auto move = [&](Index b) {
        Motion moved;
        for (Index i = w.order; i >= 0; --i) {
            moved.rate = moved.rate * ahead + moved.deflection;
            moved.deflection = moved.deflection * ahead + w.deflection.at(i, b);
        }
        return moved;
    };
    const auto add = [&](Index b, const Motion& moved, V elastic) {
        const V side = w.side.at(0, b);
        const V push = w.acting.at(0, b) * moved.rate + w.active.at(0, b) * elastic;
        tally.value.put(0, b, moved.deflection + w.edge.at(0, b));
        w.force.put(0, b, absolute(side) * elastic);
        tally.pull.put(0, b, smaller(tally.pull.at(0, b), side * push));
    };
    for (Index mesh = 0; mesh < w.touching.pairs(); ++mesh) {
        const Motion drive = move(mesh), back = move(mesh + pairs);
        const V touching = w.touching.of_flank(drive.deflection, back.deflection, mesh);
        const V elastic = w.law.force_ahead(touching, w.order, ahead, mesh);
        add(mesh, drive, elastic);
        add(mesh + pairs, back,
            w.touching.is_one(mesh) ? elastic
                                    : w.law.force_ahead(back.deflection, w.order, ahead, mesh + pairs));
    }
    for (Index b = 2 * w.touching.pairs(); b < w.deflection.width; ++b) {
        const Motion moved = move(b);
        add(b, moved, b < of_law ? w.law.force_ahead(moved.deflection, w.order, ahead, b) : V::splat(0.0));
    }
    for (Index mesh = 0; mesh < pairs; ++mesh) {
        tally.value.set(0, mesh, between(w, tally.value.of(0, mesh), tally.value.of(0, mesh + pairs), mesh));
        w.force.set(0, mesh, w.force.of(0, mesh) - w.force.of(0, mesh + pairs));
    }
    for (Index b = 0; b < w.deflection.width; ++b) {
        const V off = tally.value.at(0, b) - tally.level.at(0, b), force = w.force.at(0, b);
        tally.deflections.add(0, b, heavy * off);
        tally.squared.add(0, b, heavy * off * off);
        tally.forces.add(0, b, heavy * force);
        tally.forces.add(1, b, heavy * absolute(force));
    }
}

// Largest values over the step of sign times polynomials: the best of a few points, then Newton's method on
// the slope between their neighbours.
template <class V>
V largest_over_step(const std::vector<V>& terms, Index order, double sign) {
    const V none = V::splat(0.0), factor = V::splat(sign);
    V best = V::splat(-1e300), at = none;
    for (int look = 0; look <= extremum_looks; ++look) {
        const V t = V::splat(static_cast<double>(look) / extremum_looks);
        V value = none;
        for (Index i = order; i >= 0; --i) value = value * t + factor * terms[i];
        at = where_positive(value - best, t, at);
        best = larger(best, value);
    }
    const V part = V::splat(1.0 / extremum_looks);
    const V low = larger(none, at - part), high = smaller(V::splat(1.0), at + part);
    V bends = V::splat(1.0);
    for (int turn = 0; turn < extremum_turns; ++turn) {
        V value = none, slope = none, bend = none;
        for (Index i = order; i >= 0; --i) {
            bend = bend * at + V::splat(2.0) * slope;
            slope = slope * at + value;
            value = value * at + factor * terms[i];
        }
        best = where_positive(bends, larger(best, value), best);
        bends = where_positive(-bend, bends, none);
        at = where_positive(bends, smaller(larger(at - slope / bend, low), high), at);
    }
    return best;
}

// Widen extremes that are known by those of polynomials over the step, which may reach past them.
template <class V>
void widen(const std::vector<V>& terms, Index order, V& minimum, V& maximum) {
    const Reach<V> reach = reach_of(terms[0], order, [&](Index i) { return terms[i]; });
    if (positive_lanes(reach.top(V::splat(1.0)) - maximum) != 0)
        maximum = larger(maximum, largest_over_step(terms, order, 1.0));
    if (positive_lanes(minimum - reach.bottom(V::splat(1.0))) != 0)
        minimum = smaller(minimum, -largest_over_step(terms, order, -1.0));
}

// Write the terms of a deflection in powers of the fraction of the step.
template <class L, class Law>
void put_down(Work<L, Law>& w, Index b) {
    using V = typename L::V;
    const V length = L::every(w.length);
    V power = V::splat(1.0);
    for (Index i = 0; i <= w.order; ++i) {
        w.terms[i] = power * w.deflection.at(i, b);
        power = power * length;
    }
}

// Extremes of the deflections, or of those of meshes with two flanks.
template <class L, class Law>
void add_extremes(Work<L, Law>& w, Tally<L>& tally) {
    using V = typename L::V;
    using S = typename L::S;
    const Index pairs = w.shape->pairs;
    for (Index b = 0; pairs == 0 && b < w.deflection.width; ++b) {
        put_down(w, b);
        w.terms[0] = w.terms[0] + w.edge.at(0, b);
        V minimum = tally.minimum.at(0, b), maximum = tally.maximum.at(0, b);
        widen(w.terms, w.order, minimum, maximum);
        tally.minimum.put(0, b, minimum);
        tally.maximum.put(0, b, maximum);
    }
    for (Index mesh = 0; mesh < pairs; ++mesh) {
        S power = S::splat(1.0);
        for (Index i = 0; i <= w.order; ++i) {
            w.finder[i] =
                power * S::splat(0.5) * (w.deflection.of(i, mesh) - w.deflection.of(i, mesh + pairs));
            power = power * w.length;
        }
        const S drive = w.deflection.of(0, mesh) + w.edge.of(0, mesh);
        w.finder[0] = between(w, drive, w.deflection.of(0, mesh + pairs) + w.edge.of(0, mesh + pairs), mesh);
        S minimum = tally.minimum.of(0, mesh), maximum = tally.maximum.of(0, mesh);
        widen(w.finder, w.order, minimum, maximum);
        tally.minimum.set(0, mesh, minimum);
        tally.maximum.set(0, mesh, maximum);
    }
}

// Add the steps to the sums.
template <class L, class Law>
void add_step(Work<L, Law>& w, Tally<L>& tally) {
    using V = typename L::V;
    using S = typename L::S;
    const Index nodes = static_cast<Index>(tally.nodes.size());
    start_sums(w, tally);
    for (Index node = 0; node < nodes; ++node) {
        const S ahead = w.length * S::splat(tally.nodes[node]),
                weight = w.length * S::splat(tally.weights[node]);
        look_ahead(w, ahead);
        for (Index b = 0; b < w.y.width; ++b) {
            const V off = w.sample.at(0, b) - tally.origin.at(0, b), heavy = L::every(weight) * off;
            tally.off.put(node, b, off);
            tally.heavy.put(node, b, heavy);
            tally.coordinates.add(0, b, heavy);
        }
        add_contacts(w, tally, ahead, weight);
    }
    for (Index k = 0; k < w.n; ++k) {
        for (Index b = k * L::machines / L::lanes; b < w.y.width; ++b) {
            V total = tally.products.at(k, b);
            for (Index node = 0; node < nodes; ++node)
                total = tally.heavy.spread(node, k) * tally.off.at(node, b) + total;
            tally.products.put(k, b, total);
        }
    }
    add_contacts(w, tally, w.length,
                 S::splat(0.0)); // flanks are pulled most where they part, at the end of a step
    add_extremes(w, tally);
}

// Add the phase that every contact spends open and on either flank.
template <class L, class Law>
void add_fractions(const Work<L, Law>& w, Tally<L>& tally) {
    using V = typename L::V;
    using S = typename L::S;
    const V length = L::every(w.length), none = V::splat(0.0);
    for (Index b = 0; b < w.side.width; ++b) {
        const V side = w.side.at(0, b);
        const V drive = where_positive(side, length, none), back = where_positive(-side, length, none);
        tally.fractions.add(0, b, length - (drive + back));
        tally.fractions.add(1, b, drive);
        tally.fractions.add(2, b, back);
    }
    const Index pairs = w.shape->pairs;
    for (Index mesh = 0; mesh < pairs; ++mesh) {
        const S other = where_positive(w.side.of(0, mesh + pairs), w.length, S::splat(0.0));
        const S both = where_positive(w.side.of(0, mesh), other, S::splat(0.0));
        tally.fractions.set(2, mesh, tally.fractions.of(2, mesh) + both);
    }
}

// Start the next batch of a machine.
template <class L>
void clear_batch(Tally<L>& tally, int machine, Index n, Index m) {
    for (Index k = 0; k < n; ++k) {
        tally.coordinates.one(0, k, machine) = 0.0;
        for (Index other = k; other < n; ++other) tally.products.one(k, other, machine) = 0.0;
    }
    for (Index row = 0; row < m; ++row)
        for (const Table<L>& each : {tally.deflections, tally.squared}) each.one(0, row, machine) = 0.0;
}

// Start the sums of a lane's next machine.
template <class L>
void clear_tally(Tally<L>& tally, int machine, Index n, Index m) {
    clear_batch(tally, machine, n, m);
    for (Index row = 0; row < m; ++row) {
        for (Index i = 0; i < 2; ++i) tally.forces.one(i, row, machine) = 0.0;
        for (Index i = 0; i < 3; ++i) tally.fractions.one(i, row, machine) = 0.0;
        tally.minimum.one(0, row, machine) = infinity;
        tally.maximum.one(0, row, machine) = -infinity;
        tally.pull.one(0, row, machine) = 0.0;
    }
}

// Write a row of a table, for one machine, to where `out` points.
template <class L>
void write_row(Table<L> table, Index row, Index entities, int machine, double* out) {
    for (Index e = 0; e < entities; ++e) out[e] = table.one(row, e, machine);
}

// Write a batch that a machine has run through.
template <class L>
void keep_batch(const Tally<L>& tally, int machine, Index number, Index batch, Log& log) {
    const Index n = log.n, m = log.m, at = number * log.asked.batches + batch;
    write_row(tally.coordinates, 0, n, machine, log.coordinates.data() + at * n);
    for (Index k = 0; k < n; ++k)
        for (Index other = k; other < n; ++other)
            log.products[(at * n + k) * n + other] = tally.products.one(k, other, machine);
    write_row(tally.deflections, 0, m, machine, log.deflections.data() + at * m);
    write_row(tally.squared, 0, m, machine, log.squared.data() + at * m);
}

// Write what was added up over all periods of a machine.
template <class L>
void keep_whole(const Tally<L>& tally, int machine, Index number, Log& log) {
    const Index n = log.n, m = log.m;
    if (!log.fractions.empty())
        for (Index i = 0; i < 3; ++i)
            write_row(tally.fractions, i, m, machine, log.fractions.data() + (3 * number + i) * m);
    if (log.asked.batches == 0) return;
    write_row(tally.origin, 0, n, machine, log.origin.data() + number * n);
    write_row(tally.level, 0, m, machine, log.level.data() + number * m);
    write_row(tally.minimum, 0, m, machine, log.minimum.data() + number * m);
    write_row(tally.maximum, 0, m, machine, log.maximum.data() + number * m);
    write_row(tally.pull, 0, m, machine, log.pull.data() + number * m);
    for (Index i = 0; i < 2; ++i)
        write_row(tally.forces, i, m, machine, log.forces.data() + (2 * number + i) * m);
}

} // namespace facegear::motion
