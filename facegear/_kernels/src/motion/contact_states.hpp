// Contact state of every mesh: open, or in which piece of its law, on which flank.
#pragma once

#include <cmath>

#include "motion/work.hpp"

namespace facegear::motion {

// How far a deflection with a rate may be from an edge and still counts as standing on it.
template <class L, class Law>
typename L::V edge_margin(const Work<L, Law>& w, typename L::V rate) {
    using V = typename L::V;
    return V::splat(edge_width) * L::every(w.scale) + V::splat(edge_time) * absolute(rate);
}

// What follows from state and side of a block of contacts, whose pieces begin and end at `begin` and `end`.
template <class L, class Law>
void take_states(Work<L, Law>& w, Index b, typename L::V begin, typename L::V end) {
    using V = typename L::V;
    const V none = V::splat(0.0), side = w.side.at(0, b), touching = absolute(side);
    const V from_drive = w.upper.at(0, b) + begin, from_back = w.lower.at(0, b) - begin;
    const V edge = where_positive(side, from_drive, where_positive(-side, from_back, none));
    w.active.put(0, b, touching);
    w.acting.put(0, b,
                 w.shape->damping_when_open ? w.mesh_damping.at(0, b)
                                            : where_positive(touching, w.mesh_damping.at(0, b), none));
    w.extent.put(0, b, where_positive(side, end - begin, begin - end));
    w.deflection.add(0, b, w.edge.at(0, b) - edge);
    w.edge.put(0, b, edge);
}

// State of a contact that stands where piece `level` begins and moves in a direction.
inline double state_beside(double level, double direction) {
    if (level > 0.0) return direction > 0.0 ? level : level - 1.0;
    return direction < 0.0 ? level : level + 1.0;
}
inline double sign_of(double state) { return state > 0.0 ? 1.0 : state < 0.0 ? -1.0 : 0.0; }

// Where a piece of the law of a contact begins and ends; rows of rings have one.
template <class L, class Law>
void ends_of_piece(const Work<L, Law>& w, Index contact, int machine, double state, double& begin,
                   double& end) {
    begin = 0.0, end = infinity;
    if (state == 0.0 || contact >= w.shape->contacts) return;
    const Index piece = static_cast<Index>(std::fabs(state));
    begin = w.law.begin_of(machine, contact, piece);
    end = w.law.end_of(machine, contact, piece);
}

// Give one contact of one machine a state.
template <class L, class Law>
void set_state(Work<L, Law>& w, Index contact, int machine, double state) {
    const auto of = [&](Table<L> table) -> double& { return table.one(0, contact, machine); };
    double begin, end;
    ends_of_piece(w, contact, machine, state, begin, end);
    const double edge = state > 0.0 ? of(w.upper) + begin : state < 0.0 ? of(w.lower) - begin : 0.0;
    of(w.state) = state;
    of(w.side) = sign_of(state);
    of(w.active) = std::fabs(sign_of(state));
    of(w.acting) = state == 0.0 && !w.shape->damping_when_open ? 0.0 : of(w.mesh_damping);
    of(w.extent) = state > 0.0 ? end - begin : begin - end;
    of(w.deflection) += of(w.edge) - edge;
    of(w.edge) = edge;
}

// The piece of one contact's law that holds its amount beyond the edge, or where it begins if the contact
// stands there.
template <class L, class Law>
void find_piece(Work<L, Law>& w, Index b, int lane, double margin) {
    const Index contact = entity_of<L>(b, lane), at = b * L::lanes + lane;
    const int machine = machine_of<L>(lane);
    double& state = w.state.data[at];
    double& level = w.level.data[at];
    if (level != 0.0 || w.lower.data[at] >= w.upper.data[at]) return;
    const double bound = state > 0.0 ? w.upper.data[at] : w.lower.data[at], sign = state;
    const double amount = std::fabs(w.deflection.data[at] - bound);
    const Index piece = w.law.piece_of(machine, contact, amount);
    state = sign * static_cast<double>(piece);
    if (piece > 1 && amount - w.law.begin_of(machine, contact, piece) <= margin)
        level = state;
    else if (w.law.end_of(machine, contact, piece) - amount <= margin)
        level = state + sign;
    if (level != 0.0) state = state_beside(level, w.deflection.row(1)[at]);
}

// The pieces of a curved law that contacts of a block are in, and where they begin and end. Mostly they are
// those that were found last.
template <class L, class Law>
void find_pieces(Work<L, Law>& w, Index b, typename L::V margin, typename L::V& begin, typename L::V& end) {
    using V = typename L::V;
    const V none = V::splat(0.0), one = V::splat(1.0), side = w.state.at(0, b),
            known = w.known_state.at(0, b);
    const V lower = w.lower.at(0, b), upper = w.upper.at(0, b), on_level = absolute(w.level.at(0, b));
    const V amount = absolute(w.deflection.at(0, b) - where_positive(side, upper, lower));
    const V from = w.known_begin.at(0, b), to = w.known_end.at(0, b);
    V same = where_positive(smaller(amount - from, to - amount) - margin, one, none);
    same = where_positive(side * known, same, none);
    same = where_positive(on_level, none, where_positive(upper - lower, same, none));
    w.state.put(0, b, where_positive(same, known, side));
    begin = where_positive(same, from, none);
    end = where_positive(same, to, V::splat(infinity));
    const V asked = where_positive(same, none, absolute(side) + on_level);
    const unsigned lanes = positive_lanes(asked);
    for (int lane = 0; lanes != 0 && lane < L::lanes; ++lane) {
        const Index contact = entity_of<L>(b, lane);
        if (!((lanes >> lane) & 1u) || contact >= w.shape->contacts) continue;
        find_piece(w, b, lane, margin[lane]);
        double first, last;
        ends_of_piece(w, contact, machine_of<L>(lane), w.state.data[b * L::lanes + lane], first, last);
        begin.set(lane, first);
        end.set(lane, last);
    }
    w.known_state.put(0, b, w.state.at(0, b));
    w.known_begin.put(0, b, begin);
    w.known_end.put(0, b, end);
}

// Contact states from deflection and, on a level of the law, its direction of motion.
template <class L, class Law>
void find_states(Work<L, Law>& w) {
    using V = typename L::V;
    const V plus = V::splat(1.0), none = V::splat(0.0), minus = V::splat(-1.0);
    for (Index b = 0; b < w.state.width; ++b) {
        const V lower = w.lower.at(0, b), upper = w.upper.at(0, b);
        const V deflection = w.deflection.at(0, b), rate = w.deflection.at(1, b),
                margin = edge_margin(w, rate);
        const V over = deflection - upper, under = lower - deflection;
        const V off_upper = absolute(over) - margin, off_lower = absolute(under) - margin;
        const V beyond = where_positive(over, plus, where_positive(under, minus, none));
        const V back = where_positive(-rate, minus, none), drive = where_positive(rate, plus, none);
        const V side = where_positive(off_upper, where_positive(off_lower, beyond, back), drive);
        const V level = where_positive(off_upper, where_positive(off_lower, none, minus), plus);
        const V clearance = upper - lower; // without any, a contact is never open
        w.state.put(0, b, where_positive(clearance, side, plus));
        w.level.put(0, b, where_positive(clearance, level, none));
        w.edge.put(0, b, none);
        w.parting.put(0, b, none);
        V begin = none, end = V::splat(infinity);
        if (Law::curved) find_pieces(w, b, margin, begin, end);
        const V state = w.state.at(0, b);
        w.side.put(0, b, where_positive(state, plus, where_positive(-state, minus, none)));
        take_states(w, b, begin, end);
    }
}

// Where a contact stands on a level with hardly any speed, its place a little later decides; true if one
// changed.
//
// After `shortest`, or later where rounding would decide: a body at rest that is just being touched starts
// with the cube of time.
template <class L, class Law>
bool correct_states(Work<L, Law>& w) {
    bool changed = false;
    for (Index b = 0; b < w.level.width; ++b) {
        if (positive_lanes(absolute(w.level.at(0, b))) == 0) continue;
        for (int lane = 0; lane < L::lanes; ++lane) {
            const Index contact = entity_of<L>(b, lane), at = b * L::lanes + lane;
            const int machine = machine_of<L>(lane);
            const double level = w.level.data[at];
            if (level == 0.0 || contact >= w.m) continue;
            // Mean rate from now until `ahead`, to third order.
            const auto rise = [&](double ahead) {
                return w.deflection.row(1)[at] +
                       ahead * (w.deflection.row(2)[at] + ahead * w.deflection.row(3)[at]);
            };
            double ahead = shortest, soon = rise(ahead);
            while (ahead < latest && std::fabs(soon) <= still * w.scale[machine]) {
                ahead *= 1e2;
                soon = rise(ahead);
            }
            const double wanted = state_beside(level, soon);
            if (wanted == w.state.data[at]) continue;
            set_state(w, contact, machine, wanted);
            changed = true;
        }
    }
    return changed;
}

} // namespace facegear::motion
