// One step of the integration: as far as the Taylor polynomials hold, or to the next contact switch.
#pragma once

#include "motion/contact_states.hpp"
#include "motion/parting.hpp"
#include "motion/switches.hpp"
#include "motion/taylor.hpp"
#include "motion/work.hpp"

namespace facegear::motion {

// The rest of the period, or of the stretch between two breaks of the law, that a step may take.
template <class L, class Law>
typename L::S rest_of_period(Work<L, Law>& w) {
    using S = typename L::S;
    S rest = smaller(S::splat(tau) - w.phase, w.longest);
    const std::vector<double>& breaks = w.shape->breaks();
    for (int machine = 0; !breaks.empty() && machine < L::machines; ++machine) {
        const double s = w.phase[machine];
        Index piece = 0;
        // A phase that rounding leaves just below a break belongs to the next piece: the step up to the break
        // would have no length.
        while (piece < static_cast<Index>(breaks.size()) - 2 && s >= breaks[piece + 1] - rounding) ++piece;
        w.piece[machine] = piece;
        w.ahead[machine] = s - breaks[piece];
        const double left = breaks[piece + 1] - s;
        if (left < rest[machine]) rest.set(machine, left);
    }
    return rest;
}

// The forces of contacts that the recurrence does not need, where steps, switches or sums do.
template <class L, class Law>
void expand_last_forces(Work<L, Law>& w) {
    if (w.last_force < w.order - 1) return;
    const bool kept = w.shape->push_only || w.friction.count() > 0;
    const Table<L> deflection = w.touching.deflections(w.deflection, false);
    for (Index b = 0; b < blocks_of<L>(w.shape->contacts); ++b) {
        const auto touching = absolute(w.side.at(0, b));
        // A block whose contacts all are open has no force to expand.
        if (positive_lanes(touching) == 0) continue;
        for (Index i = w.order - 1; i <= w.last_force; ++i) {
            const auto force = w.law.force(deflection, i, w.touching.block_of(b));
            if (kept) w.elastic.put(i, b, touching * force);
        }
    }
}

// Expand the pieces of the law that contacts are in.
template <class L, class Law>
void expand_pieces(Work<L, Law>& w) {
    w.touching.choose(w.state);
    w.touching.take(w.deflection, 0, false);
    w.law.expand_pieces(w.expansion, w.touching, w.touching.states(w.state), w.rows);
}

// Find what drives the motions and the contact states at the phases, from rows 0 and 1 of y; the length that
// the steps may have at most.
template <class L, class Law>
typename L::S start_step(Work<L, Law>& w) {
    const typename L::S rest = rest_of_period(w);
    expand_excitation(w, w.rows);
    for (Index b = 0; b < w.active.width; ++b) w.active.put(0, b, L::V::splat(0.0));
    // Displacement and velocity are all that is known before the recurrence, and all that states need first.
    for (Index row = 0; row < 2; ++row) {
        w.products.deflect(w.y, row, &w.error, w.deflection);
        if (w.rings.count() > 0) w.rings.expand(w.deflection, w.active, row);
    }
    find_states(w);
    expand_pieces(w);
    if (w.shape->push_only) find_parting(w);
    return rest;
}

// Correct contact states by the first coefficients of the motions; true if one changed.
template <class L, class Law>
bool correct(Work<L, Law>& w) {
    bool changed = w.shape->opens && correct_states(w);
    // Another state may lie in another piece of the law; parting is judged by the forces of that piece.
    if (changed) expand_pieces(w);
    if (w.shape->push_only) changed = correct_parting(w) || changed;
    return changed;
}

// Expand the motions from rows 0 and 1 of y at the phases, and find the lengths of the steps; y then holds
// the polynomials valid over them. The contact states are found from the motions themselves.
template <class L, class Law>
void advance(Work<L, Law>& w) {
    using S = typename L::S;
    const S rest = start_step(w);
    // A contact that begins on the edge of a state goes where its first coefficient that is not zero points
    // to. That coefficient depends on the states of all contacts, so that states and the first few
    // coefficients are found in turns; the many others are computed once, with the states decided.
    const Index decided = std::min(deciding, w.order - 1);
    for (int guess = 1; guess <= max_guesses; ++guess) {
        recurrence(w, 0, decided, w.y, w.deflection, false);
        // States that contradict each other would never settle: the last guess stands, and a step that ends
        // at a switch at once corrects it.
        if (guess == max_guesses || !correct(w)) break;
    }
    recurrence(w, decided, w.order - 1, w.y, w.deflection, false);
    expand_last_forces(w);
    // Where the step does not reach the end, but one more could, two equal steps do: the second would
    // otherwise be a short one at full cost.
    const S length = step_length(w), half = S::splat(0.5) * rest;
    const S shared = where_positive(length - half, half, length);
    w.length = where_positive(rest - length, shared, rest);
    // A switch is sought only now, as the polynomials need not hold beyond the step.
    until_switch(w);
}

} // namespace facegear::motion
