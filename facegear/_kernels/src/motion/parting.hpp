// Contacts that only push: spring and damper together are cut at zero where flanks are about to part.
//
//     F = max(law(x) + c x', 0) while flanks overlap by x > 0; on the back flank with all signs reversed
//
// (Hunt and Crossley, Journal of Applied Mechanics 42, 1975, on dampers that pull at the end of a contact).
// The cut adds one edge to a contact, law(x) + c x' = 0. The force is continuous there, so disturbances pass
// it unchanged; it jumps only where flanks meet, by c x'.
#pragma once

#include <cmath>

#include "motion/contact_states.hpp"
#include "motion/work.hpp"

namespace facegear::motion {

// Cut the force of every contact whose damper pulls more than its spring pushes.
template <class L, class Law>
void find_parting(Work<L, Law>& w) {
    using V = typename L::V;
    const V plus = V::splat(1.0), none = V::splat(0.0);
    const Table<L> deflection = w.touching.deflections(w.deflection, false);
    for (Index b = 0; b < blocks_of<L>(w.shape->contacts); ++b) {
        const V side = w.side.at(0, b), rate = w.deflection.at(1, b), level = absolute(w.level.at(0, b));
        const V lower = w.lower.at(0, b), upper = w.upper.at(0, b);
        const V spring = side * w.law.force(deflection, 0, w.touching.block_of(b)),
                damper = side * w.mesh_damping.at(0, b) * rate;
        // Overlap, and with it the spring's force, is known to the rounding of the deflection.
        const V overlap =
            absolute(w.deflection.at(0, b) + w.edge.at(0, b) - where_positive(side, upper, lower));
        const V unknown = edge_margin(w, rate) / overlap;
        const V size =
            V::splat(no_force) * (absolute(spring) + absolute(damper)) + unknown * absolute(spring);
        // Neither open contacts nor those on the edge, nor those without any clearance.
        const V edge = where_positive(absolute(level - plus), plus, none);
        const V asked = where_positive(upper - lower, where_positive(absolute(side), edge, none), none);
        const V acts = where_positive(spring + damper, plus, none);
        const V zero = where_positive(absolute(spring + damper) - size, none, plus);
        w.parting.put(0, b, where_positive(asked, zero, none));
        w.active.put(0, b, where_positive(asked, acts, w.active.at(0, b)));
        w.acting.put(
            0, b,
            where_positive(asked, where_positive(acts, w.mesh_damping.at(0, b), none), w.acting.at(0, b)));
    }
}

// Taylor coefficient i of what spring and damper of a block of contacts push together.
template <class L, class Law>
typename L::V push_of(const Work<L, Law>& w, Index i, Index b) {
    using V = typename L::V;
    const V rate = V::splat(static_cast<double>(i + 1)) * w.deflection.at(i + 1, b);
    return w.side.at(0, b) * (w.mesh_damping.at(0, b) * rate + w.elastic.at(i, b));
}

// Where a contact's force is zero, its value after `shortest` decides; true if one changed.
template <class L, class Law>
bool correct_parting(Work<L, Law>& w) {
    bool changed = false;
    for (Index b = 0; b < blocks_of<L>(w.shape->contacts); ++b) {
        if (positive_lanes(w.parting.at(0, b)) == 0) continue;
        const auto rise = push_of(w, 1, b), bend = push_of(w, 2, b);
        for (int lane = 0; lane < L::lanes; ++lane) {
            const Index at = b * L::lanes + lane;
            if (w.parting.data[at] == 0.0) continue;
            const bool acts = rise[lane] + shortest * bend[lane] > 0.0;
            if (acts == (w.active.data[at] > 0.0)) continue;
            w.active.data[at] = acts ? 1.0 : 0.0;
            w.acting.data[at] = acts ? w.mesh_damping.data[at] : 0.0;
            changed = true;
        }
    }
    return changed;
}

// Damping of a block of contacts whose start or end makes the force jump, and so shears disturbances.
template <class L, class Law>
typename L::V shearing_damping(const Work<L, Law>& w, Index b) {
    return w.shape->push_only ? w.mesh_damping.at(0, b) * absolute(w.side.at(0, b)) : w.acting.at(0, b);
}

} // namespace facegear::motion
