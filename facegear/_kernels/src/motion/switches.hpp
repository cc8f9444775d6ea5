// The first contact switch inside the step of each machine, by the polynomials of the deflections.
//
// A way is a polynomial over the fraction of the step whose first zero is a switch: a deflection's way from a
// level, or the force of a contact that only pushes. Those that bounds do not exclude are gathered from all
// contacts and machines, one in each lane of a vector, so that hardly a lane is idle while changes of sign
// are counted and zeros refined. No zero depends on which others are gathered beside it.
#pragma once

#include <algorithm>

#include "motion/parting.hpp"
#include "motion/roots.hpp"
#include "motion/work.hpp"

namespace facegear::motion {

// Bounds of a polynomial over a part of the step, with room for rounding: the first term grows with the part,
// further ones at most with its square.
template <class V>
struct Reach {
    V start, rise, up, down, slack; // up, down: sums of the further terms above zero and below

    V top(V part) const { return start + part * (larger(rise, V::splat(0.0)) + part * up) + slack; }
    V bottom(V part) const { return start + part * (smaller(rise, V::splat(0.0)) - part * down) - slack; }
    // Above zero where a level lies within; equality counts.
    V of(V level, V part) const { return smaller(top(part) - level, level - bottom(part)); }
};
template <class V, class Term>
[[gnu::always_inline]] inline Reach<V> reach_of(V start, Index order, Term term) {
    const V rise = term(1), half = V::splat(0.5);
    V sum = V::splat(0.0), sizes = sum;
    for (Index i = 2; i <= order; ++i) {
        const V own = term(i);
        sum = sum + own;
        sizes = sizes + absolute(own);
    }
    // Terms above zero add up to half of sizes + sum, those below to half of sizes - sum.
    const V slack = (absolute(rise) + sizes) * V::splat(1e-12);
    return {start, rise, half * (sizes + sum), half * (sizes - sum), slack};
}

// How often the Bernstein coefficients of the ways change their sign over the step, and the last of them: the
// values at its end.
template <class V>
struct SignChanges {
    V count, at_end;
};
template <class L, class Law>
SignChanges<typename L::V> sign_changes(const Work<L, Law>& w) {
    using V = typename L::V;
    const double* conversion = w.roots.conversion();
    const V start = w.ways.at(0, 0), one = V::splat(1.0);
    V changes = V::splat(0.0), last = start, value = start;
    for (Index i = 1; i <= w.order; ++i) {
        const double* weights = conversion + i * w.rows;
        V even = start, odd = V::splat(0.0);
        Index k = 1;
        for (; k < i; k += 2) {
            even = w.ways.at(k, 0) * V::splat(weights[k]) + even;
            odd = w.ways.at(k + 1, 0) * V::splat(weights[k + 1]) + odd;
        }
        if (k == i) even = w.ways.at(k, 0) * V::splat(weights[k]) + even;
        value = even + odd;
        // Zeros are passed over: they are neither larger than zero times one sign nor the other.
        const V opposite = where_positive(last, -one, one) * value;
        changes = where_positive(opposite, changes + one, changes);
        last = where_positive(absolute(value), value, last);
    }
    return {changes, value};
}

// The first of several zeros of the way in a lane, by bounds that are halved.
template <class L, class Law>
double first_of_several(Work<L, Law>& w, int lane) {
    double* polynomial = w.roots.polynomial();
    for (Index i = 0; i <= w.order; ++i) polynomial[i] = w.ways.row(i)[lane];
    double root = w.roots.first_root();
    if (w.way_ignores[lane] && root * w.length[w.way_machine[lane]] < shortest)
        root = w.roots.root_after(root);
    return root;
}

// Let the ways that are gathered be polynomials of the fraction of their machines' steps.
template <class L, class Law>
void scale_ways(Work<L, Law>& w) {
    using V = typename L::V;
    double lengths[L::lanes];
    for (int lane = 0; lane < L::lanes; ++lane) lengths[lane] = w.length[w.way_machine[lane]];
    const V length = V::load(lengths);
    V power = V::splat(1.0);
    for (Index i = 1; i <= w.order; ++i) {
        power = power * length;
        w.ways.put(i, 0, power * w.ways.at(i, 0));
    }
}

// The zeros of the ways that change their sign once; `never` of the others. A zero at the end itself counts.
template <class L, class Law>
typename L::V single_roots(const Work<L, Law>& w, const SignChanges<typename L::V>& changes) {
    using V = typename L::V;
    const V none = V::splat(0.0), one = V::splat(1.0);
    const V single = where_positive(V::splat(1.5) - changes.count, changes.count, none);
    const V met_at_end = where_positive(absolute(changes.at_end), none, single);
    const V pending = where_positive(met_at_end, none, single);
    const auto term = [&](Index i) { return w.ways.at(i, 0); };
    const V root = refine_root(term, w.order, none, one, w.ways.at(0, 0), changes.at_end, pending);
    return where_positive(pending, root, where_positive(met_at_end, one, V::splat(never)));
}

// Find the first zeros of the ways that are gathered, and let go of them.
template <class L, class Law>
void finish_ways(Work<L, Law>& w) {
    scale_ways(w);
    const auto changes = sign_changes(w);
    double counts[L::lanes], roots[L::lanes];
    changes.count.store(counts);
    single_roots(w, changes).store(roots);
    for (int lane = 0; lane < w.way_count; ++lane) {
        if (counts[lane] == 0.0) continue;
        const int machine = w.way_machine[lane];
        // What follows at once was decided by the rates already.
        const bool spurious = w.way_ignores[lane] && roots[lane] * w.length[machine] < shortest;
        const double root = spurious || counts[lane] > 1.0 ? first_of_several(w, lane) : roots[lane];
        w.first_switch[machine] = std::min(w.first_switch[machine], root);
    }
    w.way_count = 0;
}

// Gather the way of a lane from a level. terms: of a block, by powers of the phase. Where it stands on the
// level, the known zero at the start is divided out.
template <class L, class Law>
void add_way(Work<L, Law>& w, const double* terms, Index stride, int lane, double level, bool stands,
             bool ignores) {
    const int place = w.way_count++;
    double* way = w.ways.data + place;
    const double* from = terms + lane + (stands ? stride : 0);
    const Index last = stands ? w.order - 1 : w.order;
    for (Index i = 0; i <= last; ++i) way[i * L::lanes] = from[i * stride];
    if (stands)
        way[w.order * L::lanes] = 0.0;
    else
        way[0] -= level;
    w.way_machine[place] = machine_of<L>(lane);
    w.way_ignores[place] = ignores;
    if (w.way_count == L::lanes) finish_ways(w);
}

// Gather the ways of the deflections of a block from a level, where they are wanted (1) or stand on it (1).
template <class L, class Law>
[[gnu::always_inline]] inline void look_at_level(Work<L, Law>& w, Index b, typename L::V level,
                                                 typename L::V standing, typename L::V wanted) {
    const unsigned lanes = positive_lanes(wanted), stand = positive_lanes(standing);
    if (lanes == 0) return;
    double levels[L::lanes];
    level.store(levels);
    for (int lane = 0; lane < L::lanes; ++lane) {
        if (!((lanes >> lane) & 1u)) continue;
        const bool stands = (stand >> lane) & 1u;
        add_way(w, w.deflection.begin(b), w.deflection.stride(), lane, levels[lane], stands, stands);
    }
}

// The part of each machine's step in which a switch may still be the first.
template <class L, class Law>
typename L::V searched_part(const Work<L, Law>& w) {
    return L::every(L::S::load(w.first_switch));
}

// Gather the ways of the forces of contacts that only push to zero.
template <class L, class Law>
void look_at_force(Work<L, Law>& w, Index b) {
    using V = typename L::V;
    const V one = V::splat(1.0), none = V::splat(0.0);
    const V zero_now = w.parting.at(0, b),
            on_edge = where_positive(absolute(absolute(w.level.at(0, b)) - one), none, one);
    const V touching = absolute(w.side.at(0, b));
    const V able = where_positive(w.upper.at(0, b) - w.lower.at(0, b), touching, none);
    if (positive_lanes(able) == 0) return;
    for (Index i = 0; i < w.order; ++i) w.terms[i] = push_of(w, i, b);
    w.terms[w.order] = none;
    const auto scaled = [&](Index i) { return w.powers[i] * w.terms[i]; };
    const V reach = reach_of(w.terms[0], w.order, scaled).of(none, searched_part(w));
    const unsigned zero = positive_lanes(zero_now), edge = positive_lanes(on_edge);
    const unsigned lanes = positive_lanes(where_positive(able, where_positive(zero_now, one, reach), none));
    const double* terms = reinterpret_cast<const double*>(w.terms.data());
    for (int lane = 0; lane < L::lanes; ++lane) {
        if (!((lanes >> lane) & 1u)) continue;
        const bool stands = (zero >> lane) & 1u, ignores = ((zero | edge) >> lane) & 1u;
        add_way(w, terms, L::lanes, lane, 0.0, stands, ignores);
    }
}

// The two levels that deflections of a block may pass, and whether (1) they stand on them: open, a contact
// may reach either edge; pressed in, both ends of the piece of its law.
template <class V>
struct Levels {
    V near, far, on_near, on_far;
};
template <class L, class Law>
[[gnu::always_inline]] inline Levels<typename L::V> levels_of(const Work<L, Law>& w, Index b) {
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

// Where deflections of a block may pass their two levels in the part of the step that is searched (above
// zero).
template <class V>
struct Wanted {
    V near, far;
};
template <class L, class Law>
[[gnu::always_inline]] inline Wanted<typename L::V> wanted_of(const Work<L, Law>& w, Index b,
                                                              const Levels<typename L::V>& levels) {
    using V = typename L::V;
    const V one = V::splat(1.0), none = V::splat(0.0), part = searched_part(w);
    const V able = where_positive(w.upper.at(0, b) - w.lower.at(0, b), one, none);
    const Reach<V> reach{w.deflection.at(0, b), w.reach.at(0, b), w.reach.at(1, b), w.reach.at(2, b),
                         w.reach.at(3, b)};
    const auto wanted = [&](V level, V standing) {
        return where_positive(able, where_positive(standing, one, reach.of(level, part)), none);
    };
    return {wanted(levels.near, levels.on_near), wanted(levels.far, levels.on_far)};
}

// The way of each machine that seems to pass its level first, by its value and rate: number 2 block, or
// 2 block + 1 for the far level.
template <class V>
struct Likely {
    V number = V::splat(-1.0), level = V::splat(0.0), at = V::splat(infinity);

    void compare(V wanted, V standing, V other_level, V start, V rise, Index other) {
        const V none = V::splat(0.0), late = V::splat(2.0);
        const V when = (other_level - start) / rise;
        const V sooner = where_positive(when, smaller(when, late), late); // no number counts as late
        V better = where_positive(wanted, at - sooner, none);
        better = where_positive(standing, none, better);
        number = where_positive(better, V::splat(static_cast<double>(other)), number);
        level = where_positive(better, other_level, level);
        at = where_positive(better, sooner, at);
    }
};

// Bound the deflections of all blocks over the step, and find where they may pass a level at all.
template <class L, class Law>
Likely<typename L::V> bound_ways(Work<L, Law>& w) {
    using V = typename L::V;
    Likely<V> likely;
    for (Index b = 0; b < w.deflection.width; ++b) {
        w.may_switch[b] = positive_lanes(w.upper.at(0, b) - w.lower.at(0, b)) != 0;
        if (!w.may_switch[b]) continue;
        const V start = w.deflection.at(0, b);
        const Reach<V> reach =
            reach_of(start, w.order, [&](Index i) { return w.powers[i] * w.deflection.at(i, b); });
        const V rows[] = {reach.rise, reach.up, reach.down, reach.slack};
        for (Index row = 0; row < 4; ++row) w.reach.put(row, b, rows[row]);
        const Levels<V> levels = levels_of(w, b);
        const Wanted<V> wanted = wanted_of(w, b, levels);
        const unsigned near = positive_lanes(wanted.near), far = positive_lanes(wanted.far);
        w.may_switch[b] = (near | far) != 0;
        if (L::machines == 1) continue; // which way is the first is not asked
        if (near) likely.compare(wanted.near, levels.on_near, levels.near, start, reach.rise, 2 * b);
        if (far) likely.compare(wanted.far, levels.on_far, levels.far, start, reach.rise, 2 * b + 1);
    }
    return likely;
}

// Shorten the step of each machine to the first contact switch inside it.
//
// Side by side, the switch that seems to be the first of each machine is found first, in lanes that are all
// at work: hardly another deflection can pass a level before it.
template <class L, class Law>
void until_switch(Work<L, Law>& w) {
    using V = typename L::V;
    using S = typename L::S;
    if (!w.shape->opens) return;
    const V none = V::splat(0.0), length = L::every(w.length);
    std::fill(w.first_switch, w.first_switch + L::machines, 1.0);
    w.powers[0] = V::splat(1.0);
    for (Index i = 1; i <= w.order; ++i) w.powers[i] = length * w.powers[i - 1];
    const Likely<V> likely = bound_ways(w);
    for (int lane = 0; L::machines > 1 && lane < L::lanes; ++lane) {
        const Index number = static_cast<Index>(likely.number[lane]);
        if (number >= 0)
            add_way(w, w.deflection.begin(number / 2), w.deflection.stride(), lane, likely.level[lane], false,
                    false);
    }
    if (w.way_count > 0) finish_ways(w);
    for (Index b = 0; b < w.deflection.width; ++b) {
        if (w.may_switch[b]) {
            const Levels<V> levels = levels_of(w, b);
            const Wanted<V> wanted = wanted_of(w, b, levels);
            const V near = likely.number - V::splat(static_cast<double>(2 * b)), far = near - V::splat(1.0);
            look_at_level(w, b, levels.near, levels.on_near,
                          where_positive(absolute(near), wanted.near, none));
            look_at_level(w, b, levels.far, levels.on_far, where_positive(absolute(far), wanted.far, none));
        }
        if (w.shape->push_only && b < blocks_of<L>(w.shape->contacts)) look_at_force(w, b);
    }
    if (w.way_count > 0) finish_ways(w);
    w.length = w.length * S::load(w.first_switch);
}

} // namespace facegear::motion
