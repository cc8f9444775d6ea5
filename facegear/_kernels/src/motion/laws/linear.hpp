// The linear law: a stiffness k(s) that depends on the phase, times the amount pressed in.
//
// Every law is a struct of numbers at a mesh frequency of 1 rad/s, with a class `Motion<L>` that expands the
// force of all contacts along the motions of the machines of a layout; what it must offer stands in
// laws/all.hpp.
#pragma once

#include <vector>

#include "motion/constants.hpp"
#include "motion/fourier.hpp"
#include "motion/layout.hpp"
#include "motion/touching_flanks.hpp"

namespace facegear::motion {

struct LinearLaw {
    static constexpr bool curved = false, ahead_by_forces = false, by_mesh = false, moves = false;

    FourierRows fourier;     // k of each kind, N/m
    std::vector<Index> kind; // of each contact
    std::vector<double>
        breaks; // phases (rad) between which k is smooth, from 0 to 2 pi; none: smooth throughout
    Index degrees = 0;
    std::vector<double>
        pieces; // (pieces, degrees, contacts): added to k, powers of the phase since the last break

    Index contacts() const { return static_cast<Index>(kind.size()); }
    Index terms() const { return fourier.terms; }
    // Whether machines with either law may share scratch space.
    bool alike(const LinearLaw& other) const {
        return kind == other.kind && breaks == other.breaks && degrees == other.degrees &&
               fourier.kinds == other.fourier.kinds && fourier.terms == other.fourier.terms;
    }

    template <class L>
    class Motion;
};

template <class L>
class LinearLaw::Motion {
    using V = typename L::V;

  public:
    Motion(const LinearLaw& law, Index rows)
        // Where lanes are machines, contacts of a kind share its series.
        : shared_(L::lanes == L::machines && law.pieces.empty()),
          series_(room_.table<L>(2 * law.terms(), shared_ ? law.fourier.kinds : law.contacts())),
          slope_{room_.table<L>(rows + 1, shared_ ? law.fourier.kinds : law.contacts()),
                 shared_ ? law.kind.data() : nullptr},
          next_(room_.table<L>(1, law.contacts())),
          ahead_(room_.table<L>(1, law.contacts())),
          polynomial_(law.degrees) {}

    void make_room(Index) {}

    // Take the numbers of a machine; factor: 1 / w^2.
    void enter(const LinearLaw& law, double factor, int machine) {
        law_[machine] = &law;
        factor_[machine] = factor;
        shared_ ? enter_series(law.fourier, factor, machine, series_)
                : enter_series(law.fourier, law.kind, factor, machine, series_);
    }

    // The first `rows` coefficients of what depends on the phase alone. piece and ahead: of each machine the
    // stretch between two breaks, and the phase since the first of them.
    void expand_phase(Expansion<L>& expansion, const Index* piece, const double* ahead, Index rows) {
        const LinearLaw& law = *law_[0];
        expansion.expand(series_, law.terms(), rows, slope_.table);
        for (int machine = 0; law.degrees > 0 && machine < L::machines; ++machine)
            for (Index m = 0; m < law.contacts(); ++m) add_piece(machine, m, piece[machine], ahead[machine]);
    }

    // What depends on the pieces that contacts are in, too: nothing.
    void expand_pieces(Expansion<L>&, const TouchingFlanks<L>&, Table<L>, Index) {}

    // F = k d: coefficient i of the force of a block of contacts. Two coefficients share a pass over the
    // series: an even one leaves the next one, but for the deflection's coefficient that is not known yet.
    V force(Table<L> deflection, Index i, Index block) {
        const double* k = slope_.begin(block);
        V slope = V::load(k), force = V::splat(0.0), next = force;
        if (i % 2 == 1) return slope * deflection.at(i, block) + next_.at(0, block);
        for (Index j = 0; j <= i; ++j) {
            const V own = deflection.at(i - j, block);
            force = slope * own + force;
            k += slope_.table.stride();
            slope = V::load(k);
            next = slope * own + next;
        }
        next_.put(0, block, next);
        return force;
    }

    void expand_slopes(Table<L>, Index) {}
    Series<L> slope() const { return slope_; }

    void look_ahead(Index order, V step) {
        for (Index c = 0; c < slope_.table.width; ++c)
            ahead_.put(0, c, value_ahead(slope_.table, order, step, c));
    }
    V force_ahead(V deflection, Index, V, Index block) const {
        return ahead_.at(0, slope_.column ? slope_.column[block] : block) * deflection;
    }

    // The piece that holds an amount, from 1, and the amounts at which a piece begins and ends.
    Index piece_of(int, Index, double) const { return 1; }
    double begin_of(int, Index, Index) const { return 0.0; }
    double end_of(int, Index, Index) const { return infinity; }

  private:
    void add_piece(int machine, Index m, Index piece, double ahead) {
        const LinearLaw& law = *law_[machine];
        const Index degrees = law.degrees;
        for (Index i = 0; i < degrees; ++i)
            polynomial_[i] = factor_[machine] * law.pieces[(piece * degrees + i) * law.contacts() + m];
        shift_polynomial(polynomial_.data(), degrees, ahead);
        for (Index i = 0; i < degrees; ++i) slope_.table.one(i, m, machine) += polynomial_[i];
    }

    Room room_;
    bool shared_;
    Table<L> series_;
    Series<L> slope_;
    Table<L> next_; // what is known of the next coefficient of the forces
    Table<L> ahead_;
    std::vector<double> polynomial_;
    const LinearLaw* law_[L::machines] = {};
    double factor_[L::machines] = {};
};

} // namespace facegear::motion
