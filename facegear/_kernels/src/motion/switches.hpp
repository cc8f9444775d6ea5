// The first contact switch inside the step of each machine, by the polynomials of the deflections.
//
// A way is a polynomial over the fraction of the step whose first zero is a switch: a deflection's way from a
// level, or the force of a contact that only pushes. Ways are looked at block by block; those that change
// their sign within the step are gathered machine by machine, so that hardly a lane is idle while their zeros
// are refined.
#pragma once

#include <algorithm>

#include "motion/parting.hpp"
#include "motion/roots.hpp"
#include "motion/work.hpp"

namespace facegear::motion {

// Bounds of a polynomial over the step, with room for rounding.
template <class V>
struct Reach {
    V top, bottom;
    // Above zero where a level lies within; equality counts.
    V of(V level) const { return smaller(top - level, level - bottom); }
};
template <class V>
Reach<V> reach_of(const V* terms, Index order) {
    V above = V::splat(0.0), below = above;
    for (Index i = 1; i <= order; ++i) {
        above = above + larger(terms[i], V::splat(0.0));
        below = below + smaller(terms[i], V::splat(0.0));
    }
    const V slack = (above - below) * V::splat(1e-12);
    return {terms[0] + above + slack, terms[0] + below - slack};
}

// Write the terms of a deflection in powers of the fraction of the step.
template <class L, class Law>
void put_down(Work<L, Law>& w, Index b) {
    using V = typename L::V;
    const V length = L::every(w.length);
    V power = V::splat(1.0);
    w.scaled[0] = w.deflection.at(0, b);
    for (Index i = 1; i <= w.order; ++i) {
        power = power * length;
        w.scaled[i] = power * w.deflection.at(i, b);
    }
}

// How often the Bernstein coefficients of the polynomials in `terms` change their sign over the step.
template <class L, class Law>
typename L::V sign_changes(const Work<L, Law>& w) {
    using V = typename L::V;
    const double* conversion = w.roots.conversion();
    const V start = w.terms[0], one = V::splat(1.0);
    V changes = V::splat(0.0), last = start;
    for (Index i = 1; i <= w.order; ++i) {
        const double* weights = conversion + i * w.rows;
        V even = start, odd = V::splat(0.0);
        Index k = 1;
        for (; k < i; k += 2) {
            even = w.terms[k] * V::splat(weights[k]) + even;
            odd = w.terms[k + 1] * V::splat(weights[k + 1]) + odd;
        }
        if (k == i) even = w.terms[k] * V::splat(weights[k]) + even;
        const V value = even + odd;
        // Zeros are passed over: they are neither larger than zero times one sign nor the other.
        const V opposite = where_positive(last, -one, one) * value;
        changes = where_positive(opposite, changes + one, changes);
        last = where_positive(absolute(value), value, last);
    }
    return changes;
}

// Add what stands in `terms` to the ways of the machines that want it (1) if it changes its sign within the
// step; ignores: where (1) a zero at once was decided by the rates already.
template <class L, class Law>
void add_ways(Work<L, Law>& w, typename L::V wanted, typename L::V ignores) {
    using V = typename L::V;
    const V changes = sign_changes(w);
    const unsigned candidates = positive_lanes(where_positive(wanted, changes, V::splat(0.0)));
    if (candidates == 0) return;
    for (int lane = 0; lane < L::lanes; ++lane) {
        if (!((candidates >> lane) & 1u)) continue;
        const int machine = machine_of<L>(lane);
        const Index way = w.way_counts[machine]++;
        w.way_changes.one(way, 0, machine) = changes[lane];
        w.way_ignores.one(way, 0, machine) = ignores[lane];
        for (Index i = 0; i <= w.order; ++i) w.ways.one(way * w.rows + i, 0, machine) = w.terms[i][lane];
    }
}

// Add the ways from a level of those that are able (1). Where a deflection stands on the level (1), the known
// zero at the start is divided out.
template <class L, class Law>
void look_at_level(Work<L, Law>& w, typename L::V level, typename L::V standing, typename L::V able,
                   const Reach<typename L::V>& reach) {
    using V = typename L::V;
    const V start = w.scaled[0] - level, none = V::splat(0.0);
    const V wanted = where_positive(able, where_positive(standing, V::splat(1.0), reach.of(level)), none);
    if (positive_lanes(wanted) == 0) return;
    w.terms[0] = where_positive(standing, w.scaled[1], start);
    for (Index i = 1; i < w.order; ++i) w.terms[i] = where_positive(standing, w.scaled[i + 1], w.scaled[i]);
    w.terms[w.order] = where_positive(standing, none, w.scaled[w.order]);
    add_ways(w, wanted, standing);
}

// Add the ways of the forces of contacts that only push to zero.
template <class L, class Law>
void look_at_force(Work<L, Law>& w, Index b) {
    using V = typename L::V;
    const V one = V::splat(1.0), none = V::splat(0.0), length = L::every(w.length);
    const V zero_now = w.parting.at(0, b),
            on_edge = where_positive(absolute(absolute(w.level.at(0, b)) - one), none, one);
    const V touching = absolute(w.side.at(0, b));
    const V able = where_positive(w.upper.at(0, b) - w.lower.at(0, b), touching, none);
    if (positive_lanes(able) == 0) return;
    V power = one, next = push_of(w, 0, b);
    for (Index i = 0; i < w.order; ++i) {
        const V own = next;
        next = i + 1 < w.order ? push_of(w, i + 1, b) : none;
        w.terms[i] = power * where_positive(zero_now, next, own);
        power = power * length;
    }
    w.terms[w.order] = none;
    const V reach = reach_of(w.terms.data(), w.order).of(none);
    const V wanted = where_positive(able, where_positive(zero_now, one, reach), none);
    if (positive_lanes(wanted) == 0) return;
    add_ways(w, wanted, where_positive(zero_now, one, on_edge));
}

// The one zero before `first` of a way of the machines that want it, `never` of the others and where it comes
// later: Newton's method kept inside a shrinking bracket.
template <class L, class Law>
typename L::S refine_ways(const Work<L, Law>& w, Index way, typename L::S first, typename L::S wanted) {
    using S = typename L::S;
    const auto term = [&](Index i) { return w.ways.of(way * w.rows + i, 0); };
    const S none = S::splat(0.0), one = S::splat(1.0), half = S::splat(0.5);
    S low = none, high = first;
    const S at_low = term(0);
    S at_high = term(w.order);
    for (Index i = w.order - 1; i >= 0; --i) at_high = at_high * high + term(i);
    const S sign = where_positive(at_high, one, -one);
    // A zero at the end itself counts.
    const S met_at_end = where_positive(absolute(at_high), none, one);
    S pending = where_positive(-(sign * at_low), where_positive(wanted, one, none), none);
    S root = where_positive(where_positive(met_at_end, wanted, none), high, S::splat(never));
    pending = where_positive(met_at_end, none, pending);
    if (positive_lanes(pending) == 0) return root;
    S t = high * at_low / (at_low - at_high);
    t = where_positive(S::splat(1.0 - beside) * high - t, t, half * high);
    for (int iteration = 0; iteration < 100; ++iteration) {
        S value = term(w.order), slope = none;
        for (Index i = w.order - 1; i >= 0; --i) {
            slope = slope * t + value;
            value = value * t + term(i);
        }
        const S rise = sign * value, size = absolute(value);
        high = where_positive(rise, t, high);
        low = where_positive(rise, low, t);
        const S step = t - value / slope;
        const S inside = smaller(step - low, high - step);
        const S close = S::splat(close_enough) - absolute(step - t), narrow = S::splat(4e-16) - (high - low);
        const S met = where_positive(size, where_positive(inside, close, narrow), one);
        const S next = where_positive(inside, step, half * (low + high));
        t = where_positive(size, next, t);
        root = where_positive(pending, t, root);
        pending = where_positive(met, none, pending);
        if (positive_lanes(pending) == 0) break;
    }
    return root;
}

// The first of several zeros of a way of one machine, by bounds that are halved.
template <class L, class Law>
double first_of_several(Work<L, Law>& w, Index way, int machine) {
    double* polynomial = w.roots.polynomial();
    for (Index i = 0; i <= w.order; ++i) polynomial[i] = w.ways.one(way * w.rows + i, 0, machine);
    double root = w.roots.first_root();
    if (w.way_ignores.one(way, 0, machine) > 0.0 && root * w.length[machine] < shortest)
        root = w.roots.root_after(root);
    return root;
}

// The fraction of each machine's step at which the first of its ways has its first zero, or 1.
template <class L, class Law>
typename L::S first_switch(Work<L, Law>& w) {
    using S = typename L::S;
    S first = S::splat(1.0);
    const Index most = *std::max_element(w.way_counts, w.way_counts + L::machines);
    for (Index way = 0; way < most; ++way) {
        S wanted = S::splat(0.0);
        for (int machine = 0; machine < L::machines; ++machine)
            if (w.way_counts[machine] > way) wanted.set(machine, 1.0);
        const S none = S::splat(0.0), several = w.way_changes.of(way, 0) - S::splat(1.5);
        S root = refine_ways(w, way, first, where_positive(several, none, wanted));
        // What follows at once was decided by the rates already.
        const S early = S::splat(shortest) - root * w.length;
        const S spurious = where_positive(w.way_ignores.of(way, 0), early, -S::splat(1.0));
        root = where_positive(spurious, S::splat(never), root);
        first = smaller(first, root);
        const unsigned alone =
            positive_lanes(where_positive(spurious, wanted, where_positive(several, wanted, none)));
        for (int machine = 0; machine < L::machines; ++machine)
            if ((alone >> machine) & 1u)
                first.set(machine, std::min(first[machine], first_of_several(w, way, machine)));
    }
    return first;
}

// The two levels that deflections of a block may pass, and whether (1) they stand on them: open, a contact
// may reach either edge; pressed in, both ends of the piece of its law.
template <class V>
struct Levels {
    V near, far, on_near, on_far;
};
template <class L, class Law>
Levels<typename L::V> levels_of(const Work<L, Law>& w, Index b) {
    using V = typename L::V;
    const V one = V::splat(1.0), none = V::splat(0.0);
    const V side = w.side.at(0, b), touching = absolute(side), state = w.state.at(0, b),
            level = w.level.at(0, b);
    const V on_level = where_positive(absolute(level), one, none);
    const auto standing = [&](V number) { return where_positive(absolute(level - number), none, on_level); };
    return {where_positive(touching, none, w.upper.at(0, b)),
            where_positive(touching, w.extent.at(0, b), w.lower.at(0, b)),
            standing(where_positive(touching, state, one)),
            standing(where_positive(touching, state + side, -one))};
}

// Shorten the step of each machine to the first contact switch inside it.
template <class L, class Law>
void until_switch(Work<L, Law>& w) {
    using V = typename L::V;
    if (!w.shape->opens) return;
    const V one = V::splat(1.0), none = V::splat(0.0);
    std::fill(w.way_counts, w.way_counts + L::machines, Index{0});
    for (Index b = 0; b < w.deflection.width; ++b) {
        const V able = where_positive(w.upper.at(0, b) - w.lower.at(0, b), one, none);
        if (positive_lanes(able) == 0) continue;
        put_down(w, b);
        const Reach<V> reach = reach_of(w.scaled.data(), w.order);
        const Levels<V> levels = levels_of(w, b);
        look_at_level(w, levels.near, levels.on_near, able, reach);
        look_at_level(w, levels.far, levels.on_far, able, reach);
        if (w.shape->push_only && b < blocks_of<L>(w.shape->contacts)) look_at_force(w, b);
    }
    w.length = w.length * first_switch(w);
}

} // namespace facegear::motion
