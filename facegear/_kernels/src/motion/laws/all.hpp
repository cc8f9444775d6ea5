// The laws that contacts can have. A new one is a header like linear.hpp, and its name here.
//
// A law offers, beside its numbers: `curved`, whether the slope depends on the amount; `ahead_by_forces`,
// whether force_ahead needs all coefficients of the forces; `by_mesh`, whether a block may hold the flank of
// a mesh that touches (touching_flanks.hpp); `moves`, whether meshes have rows for their places (moving.hpp);
// `breaks`; `contacts()`; `terms()`, the harmonics
// with the mean; `alike(other)`, whether they may share scratch space; and Motion<L> with
//     make_room(terms)                                of series of up to so many terms
//     enter(law, factor, machine)                     take the numbers of a machine, forces times the factor
//     expand_phase(expansion, piece, ahead, rows)     coefficients of what depends on the phase alone
//     expand_pieces(expansion, touching, state, rows) and of what depends on the pieces that contacts are in
//     force(deflection, i, block)                     coefficient i of the forces, asked for after i - 1
//     expand_slopes(deflection, order), slope()       the series of dF/dd along the motion
//     look_ahead(order, step), force_ahead(...)       forces at a step ahead
//     piece_of, begin_of, end_of                      pieces, from 1, between levels of the amount
// Deflections are counted from the level at which the piece of a contact begins; on a back flank they are
// negative.
#pragma once

#include <memory>
#include <variant>

#include "motion/laws/linear.hpp"
#include "motion/laws/load_dependent.hpp"
#include "motion/laws/moving.hpp"
#include "motion/laws/power.hpp"

namespace facegear::motion {

using Law = std::variant<std::shared_ptr<const LinearLaw>, std::shared_ptr<const LoadDependentLaw>,
                         std::shared_ptr<const PowerLaw>, std::shared_ptr<const MovingLaw>>;

} // namespace facegear::motion
