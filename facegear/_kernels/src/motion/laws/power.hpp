// The power law F = factor(s) c x^n of the amount x pressed in, n > 1 (Hertz: 1.5).
//
// x^n has no Taylor series at zero. Below a small level it is therefore the cubic a x^2 + b x^3 with slope
// zero at zero that has value and slope of x^n at the level (Hermite): the first piece; x^n itself is the
// second.
#pragma once

#include <cmath>
#include <vector>

#include "motion/constants.hpp"
#include "motion/fourier.hpp"
#include "motion/layout.hpp"
#include "motion/touching_flanks.hpp"

namespace facegear::motion {

struct PowerLaw {
    static constexpr bool curved = true, ahead_by_forces = true, by_mesh = false, moves = false;

    FourierRows factor; // of all contacts: one kind
    double size = 1.0, exponent = 1.5, level = 1e-3;
    Index count = 1;            // contacts
    std::vector<double> breaks; // none: smooth in the phase

    Index contacts() const { return count; }
    Index terms() const { return factor.terms; }
    bool alike(const PowerLaw& other) const {
        return count == other.count && exponent == other.exponent && level == other.level &&
               terms() == other.terms();
    }
    double square_part() const { return (3.0 - exponent) * std::pow(level, exponent - 2.0); }
    double cube_part() const { return (exponent - 2.0) * std::pow(level, exponent - 3.0); }

    template <class L>
    class Motion;
};

template <class L>
class PowerLaw::Motion {
    using V = typename L::V;
    using S = typename L::S;

  public:
    Motion(const PowerLaw& law, Index rows)
        : law_(&law),
          series_(room_.table<L>(2 * law.terms(), 1)),
          factor_(room_.table<L>(rows, 1)),
          side_(room_.table<L>(1, law.count)),
          second_piece_(room_.table<L>(1, law.count)),
          amount_(room_.table<L>(rows, law.count)),
          square_(room_.table<L>(rows, law.count)),
          shape_(room_.table<L>(rows, law.count)),
          bent_(room_.table<L>(rows, law.count)),
          force_(room_.table<L>(rows, law.count)),
          slope_{room_.table<L>(rows, law.count), nullptr} {}

    void make_room(Index) {}

    void enter(const PowerLaw& law, double factor, int machine) {
        enter_series(law.factor, factor * law.size, machine, series_);
    }

    void expand_phase(Expansion<L>& expansion, const Index*, const double*, Index rows) {
        expansion.expand(series_, law_->terms(), rows, factor_);
    }

    void expand_pieces(Expansion<L>&, const TouchingFlanks<L>&, Table<L> state, Index) {
        const V none = V::splat(0.0), one = V::splat(1.0);
        for (Index b = 0; b < side_.width; ++b) {
            const V piece = state.at(0, b);
            side_.put(0, b, where_positive(piece, one, where_positive(-piece, -one, none)));
            second_piece_.put(0, b, absolute(piece) - V::splat(1.5));
        }
    }

    V force(Table<L> deflection, Index i, Index b) {
        const V side = side_.at(0, b), second = second_piece_.at(0, b), none = V::splat(0.0);
        const V begin = V::splat(i == 0 ? law_->level : 0.0);
        amount_.put(i, b, side * deflection.at(i, b) + where_positive(second, begin, none));
        square_.put(i, b, product(amount_, amount_, i, b));
        const V cubic = V::splat(law_->square_part()) * square_.at(i, b) +
                        V::splat(law_->cube_part()) * product(square_, amount_, i, b);
        shape_.put(i, b, where_positive(second, power(law_->exponent, i, b, shape_), cubic));
        force_.put(i, b, where_positive(absolute(side), side * by_factor(shape_, i, b), none));
        return force_.at(i, b);
    }

    void expand_slopes(Table<L>, Index order) {
        const double n = law_->exponent;
        for (Index b = 0; b < side_.width; ++b) {
            const V second = second_piece_.at(0, b), touching = absolute(side_.at(0, b)),
                    none = V::splat(0.0);
            for (Index i = 0; i <= order; ++i) {
                const V cubic = V::splat(2.0 * law_->square_part()) * amount_.at(i, b) +
                                V::splat(3.0 * law_->cube_part()) * square_.at(i, b);
                bent_.put(i, b, where_positive(second, power(n - 1.0, i, b, bent_), cubic));
                const V risen = where_positive(second, V::splat(n), V::splat(1.0)) * by_factor(bent_, i, b);
                slope_.table.put(i, b, where_positive(touching, risen, none));
            }
        }
    }
    Series<L> slope() const { return slope_; }

    void look_ahead(Index, V) {}
    V force_ahead(V, Index order, V step, Index b) const { return value_ahead(force_, order, step, b); }

    Index piece_of(int, Index, double amount) const { return amount < law_->level ? 1 : 2; }
    double begin_of(int, Index, Index piece) const { return piece == 1 ? 0.0 : law_->level; }
    double end_of(int, Index, Index piece) const { return piece == 1 ? law_->level : infinity; }

  private:
    // Coefficient i of amount^exponent, those before it known; of any number where the amount is none.
    V power(double exponent, Index i, Index b, Table<L> out) const {
        const V start = amount_.at(0, b);
        if (i == 0) {
            V value = start;
            for (int lane = 0; lane < L::lanes; ++lane) value.set(lane, std::pow(start[lane], exponent));
            return value;
        }
        V total = V::splat(0.0);
        for (Index j = 1; j <= i; ++j) {
            const double weight =
                (exponent * static_cast<double>(j) - static_cast<double>(i - j)) / static_cast<double>(i);
            total = V::splat(weight) * amount_.at(j, b) * out.at(i - j, b) + total;
        }
        return total / start;
    }

    // Coefficient i of the factor times a series.
    V by_factor(Table<L> series, Index i, Index b) const {
        V total = V::splat(0.0);
        for (Index j = 0; j <= i; ++j) total = factor_.spread(j, 0) * series.at(i - j, b) + total;
        return total;
    }

    Room room_;
    const PowerLaw* law_;
    Table<L> series_, factor_, side_, second_piece_, amount_, square_, shape_, bent_, force_;
    Series<L> slope_;
};

} // namespace facegear::motion
