// The flank of each mesh that touches: where machines run side by side, one of them touches the drive flank
// of a mesh and another the back flank, but few of them both.
//
// So a block of a law's tables holds for each machine the flank that touches there, and the force of a mesh
// is found once. Where a machine touches both flanks of a mesh, each of them has a block of its own, as it
// has where meshes stand for themselves. A machine comes to the same digits either way.
#pragma once

#include <vector>

#include "motion/layout.hpp"

namespace facegear::motion {

template <class L>
class TouchingFlanks {
    using V = typename L::V;

  public:
    TouchingFlanks(Index pairs, Index rows)
        : pairs_(pairs), is_one_(pairs, 0), back_(room_.table<L>(1, pairs)) {
        state_ = room_.table<L>(1, 2 * pairs);
        for (Table<L>* each : {&deflection_, &turned_}) *each = room_.table<L>(rows, 2 * pairs);
    }

    // Choose the flanks by the states of the contacts, before the law expands its pieces.
    void choose(Table<L> state) {
        const V none = V::splat(0.0);
        for (Index mesh = 0; mesh < pairs_; ++mesh) {
            const V drive = state.at(0, mesh), back = state.at(0, mesh + pairs_);
            is_one_[mesh] = positive_lanes(absolute(drive * back)) == 0;
            back_.put(0, mesh, is_one_[mesh] ? absolute(back) : none);
            state_.put(0, mesh, is_one_[mesh] ? drive + back : drive);
            state_.put(0, mesh + pairs_, is_one_[mesh] ? none : back);
        }
    }

    // Meshes whose flanks may share a block; whether those of a mesh do.
    Index pairs() const { return pairs_; }
    bool is_one(Index mesh) const { return is_one_[mesh]; }
    // The block that holds a contact, and the contact of a lane in a block.
    Index block_of(Index contact) const {
        const Index mesh = contact - pairs_;
        return pairs_ > 0 && mesh >= 0 && mesh < pairs_ && is_one_[mesh] ? mesh : contact;
    }
    Index contact_of(Index block, int lane) const {
        const bool is_back = block < pairs_ && back_.data[block * L::lanes + lane] > 0.0;
        return entity_of<L>(block, lane) + (is_back ? pairs_ : 0);
    }
    V of_flank(V drive, V back, Index mesh) const { return where_positive(back_.at(0, mesh), back, drive); }

    // States, and deflections of a motion or a disturbance, by block of the law.
    Table<L> states(Table<L> of_contacts) const { return pairs_ > 0 ? state_ : of_contacts; }
    Table<L> deflections(Table<L> of_contacts, bool disturbed) const {
        return pairs_ == 0 ? of_contacts : disturbed ? turned_ : deflection_;
    }

    // Take a row of the deflections of all contacts.
    void take(Table<L> of_contacts, Index row, bool disturbed) const {
        const Table<L> to = disturbed ? turned_ : deflection_;
        for (Index mesh = 0; mesh < pairs_; ++mesh) {
            const V drive = of_contacts.at(row, mesh), back = of_contacts.at(row, mesh + pairs_);
            to.put(row, mesh, of_flank(drive, back, mesh));
            if (!is_one_[mesh]) to.put(row, mesh + pairs_, back);
        }
    }

  private:
    Room room_;
    Index pairs_; // 0 where no block holds flanks of several machines
    std::vector<char> is_one_;
    Table<L> state_, back_; // back: above zero where the block of a mesh holds the back flank
    Table<L> deflection_, turned_;
};

} // namespace facegear::motion
