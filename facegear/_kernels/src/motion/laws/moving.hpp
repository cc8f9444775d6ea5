// The load-dependent law of meshes whose place in the mesh cycle moves with their pinions.
//
//     V(s + p, x),   F = V_x along the deflection,   Q = V_p along the place
//
// p, rad, is how far a pinion's turning and float have carried its flank on beside the even rotation: a row
// of the deflections behind those of contacts and rings. Force and reaction come from one energy, so that no
// energy is lost or gained but that of the drive, which keeps s even.
//
// With a = s + p the cosines and sines of its multiples follow from (cos j a)' = -j a' sin j a and (sin j a)'
// = j a' cos j a, and the coefficients of the cubics are sums of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "motion/constants.hpp"
#include "motion/fourier.hpp"
#include "motion/layout.hpp"
#include "motion/touching_flanks.hpp"

namespace facegear::motion {

struct MovingLaw {
    static constexpr bool curved = true, ahead_by_forces = true, by_mesh = false, moves = true;
    static constexpr int powers = 5; // of the amount in the energy, from the power 0 on

    Index kinds = 0, level_count = 0, harmonics = 1; // harmonics with the mean
    std::vector<double>
        table; // (kinds, levels, harmonics, 2, powers): energy by powers of the amount since the piece began
    std::vector<double> levels; // (kinds, levels), m
    std::vector<Index> kind;    // of each contact
    Index first_place = 0;      // row of the deflections with the place of the first contact
    std::vector<double> breaks; // none: smooth in the phase

    Index contacts() const { return static_cast<Index>(kind.size()); }
    Index terms() const { return harmonics; }
    bool alike(const MovingLaw& other) const {
        return contacts() == other.contacts() && harmonics == other.harmonics &&
               first_place == other.first_place;
    }
    const double* energy(Index contact, Index piece) const {
        return table.data() + (kind[contact] * level_count + piece - 1) * harmonics * 2 * powers;
    }
    double level(Index contact, Index number) const { return levels[kind[contact] * level_count + number]; }

    template <class L>
    class Motion;
};

template <class L>
class MovingLaw::Motion {
    using V = typename L::V;
    using S = typename L::S;

  public:
    Motion(const MovingLaw& law, Index rows)
        : count_(law.contacts()),
          harmonics_(law.harmonics),
          first_place_(law.first_place),
          place_(room_.table<L>(rows, count_)),
          cosine_(room_.table<L>(rows, count_ * law.harmonics)),
          sine_(room_.table<L>(rows, count_ * law.harmonics)),
          force_(room_.table<L>(rows, count_)),
          slope_{room_.table<L>(rows, count_), nullptr},
          mixed_(room_.table<L>(rows, count_)),
          bend_(room_.table<L>(rows, count_)),
          reaction_(room_.table<L>(rows, count_)),
          touching_(room_.table<L>(1, count_)),
          parts_(room_.table<L>(2 * powers * law.harmonics, count_)) {
        for (Table<L>* group : {by_power_, by_place_, by_bend_})
            for (int power = 0; power < powers; ++power) group[power] = room_.table<L>(rows, count_);
        for (Table<L>& each : amounts_) each = room_.table<L>(rows, count_);
    }

    void make_room(Index) {}

    void enter(const MovingLaw& law, double factor, int machine) {
        law_[machine] = &law;
        factor_[machine] = factor;
    }

    // Places change with the motion: all that the phase gives is the angle from which they count.
    void expand_phase(Expansion<L>& expansion, const Index*, const double*, Index) {
        if (harmonics_ > 1) start_cosine_ = expansion.cosine(1), start_sine_ = expansion.sine(1);
    }

    void expand_pieces(Expansion<L>&, const TouchingFlanks<L>&, Table<L> state, Index) {
        for (Index e = 0; e < count_; ++e) {
            for (int machine = 0; machine < L::machines; ++machine) {
                const Index piece = static_cast<Index>(state.one(0, e, machine));
                touching_.one(0, e, machine) = piece > 0 ? 1.0 : 0.0;
                const double* from = piece > 0 ? law_[machine]->energy(e, piece) : nullptr;
                for (Index part = 0; part < 2 * powers * harmonics_; ++part)
                    parts_.one(part, e, machine) = from ? factor_[machine] * from[part] : 0.0;
            }
        }
    }

    V force(Table<L> deflection, Index i, Index block) {
        for (Index e = first_of(block); e < last_of(block); ++e) {
            if (positive_lanes(touching_.of(0, e)) == 0) {
                force_.set(i, e, S::splat(0.0));
                reaction_.set(i, e, S::splat(0.0));
                continue;
            }
            amounts_[0].set(i, e, deflection.of(i, e));
            for (int power = 1; power < powers - 1; ++power)
                amounts_[power].set(i, e, convolution(amounts_[power - 1], e, amounts_[0], e, i));
            turn(deflection.of(i, first_place_ + e), i, e);
            for (int power = 0; power < powers; ++power) {
                by_power_[power].set(i, e, series(power, i, e, 0));
                by_place_[power].set(i, e, series(power, i, e, 1));
            }
            force_.set(i, e, polynomial(by_power_, 1, i, e));
            reaction_.set(i, e, polynomial(by_place_, 0, i, e));
        }
        return force_.at(i, block);
    }

    // Slopes of the force by the amount and by the place, and of the reaction by the place.
    void expand_slopes(Table<L>, Index order) {
        for (Index e = 0; e < count_; ++e) {
            const bool touches = positive_lanes(touching_.of(0, e)) != 0;
            for (Index i = 0; i <= order; ++i) {
                const S none = S::splat(0.0);
                slope_.table.set(i, e, touches ? polynomial(by_power_, 2, i, e) : none);
                mixed_.set(i, e, touches ? polynomial(by_place_, 1, i, e) : none);
            }
            if (touches)
                for (Index i = 0; i <= order; ++i)
                    for (int power = 0; power < powers; ++power)
                        by_bend_[power].set(i, e, series(power, i, e, 2));
            for (Index i = 0; i <= order; ++i)
                bend_.set(i, e, touches ? polynomial(by_bend_, 0, i, e) : S::splat(0.0));
        }
    }
    Series<L> slope() const { return slope_; }

    // What the places of a disturbance add to coefficient i of the forces.
    V disturbed_force(Table<L> turned, Index i, Index block) const {
        V total = V::splat(0.0);
        for (Index e = first_of(block); e < last_of(block); ++e)
            force_of_lane(total, e, convolution(mixed_, e, turned, first_place_ + e, i));
        return total;
    }

    // Put coefficient i of the reactions along the places, times the factor, into the forces.
    void push_places(Table<L> deflection, Table<L> active, Index i, double factor, bool disturbed,
                     Table<L> force) const {
        for (Index e = 0; e < count_; ++e) {
            const S reaction = disturbed ? convolution(mixed_, e, deflection, e, i) +
                                               convolution(bend_, e, deflection, first_place_ + e, i)
                                         : reaction_.of(i, e);
            force.set(0, first_place_ + e, S::splat(factor) * active.of(0, e) * reaction);
        }
    }

    void look_ahead(Index, V) {}
    V force_ahead(V, Index order, V step, Index block) const {
        return value_ahead(force_, order, step, block);
    }

    Index piece_of(int machine, Index contact, double amount) const {
        Index low = 0, high = law_[machine]->level_count;
        while (high - low > 1) {
            const Index middle = (low + high) / 2;
            (law_[machine]->level(contact, middle) <= amount ? low : high) = middle;
        }
        return low + 1;
    }
    double begin_of(int machine, Index contact, Index piece) const {
        return law_[machine]->level(contact, piece - 1);
    }
    double end_of(int machine, Index contact, Index piece) const {
        return piece < law_[machine]->level_count ? law_[machine]->level(contact, piece) : infinity;
    }

  private:
    static constexpr Index per_block = L::lanes / L::machines;
    Index first_of(Index block) const { return block * per_block; }
    Index last_of(Index block) const { return std::min((block + 1) * per_block, count_); }

    static void force_of_lane(V& total, Index e, S value) {
        if constexpr (L::machines == 1)
            total.set(static_cast<int>(e % per_block), value[0]);
        else
            total = value;
    }

    // Coefficient i of cosines and sines of the multiples of the angle of a contact.
    void turn(S place, Index i, Index e) {
        place_.set(i, e, place);
        if (i == 0) {
            S cos_j = S::splat(1.0), sin_j = S::splat(0.0), cosine = cos_j, sine = sin_j;
            for (int lane = 0; lane < L::machines; ++lane) {
                const double c = std::cos(place[lane]), s = std::sin(place[lane]);
                cosine.set(lane, start_cosine_[lane] * c - start_sine_[lane] * s);
                sine.set(lane, start_sine_[lane] * c + start_cosine_[lane] * s);
            }
            for (Index j = 0; j < harmonics_; ++j) {
                cosine_.set(0, e * harmonics_ + j, cos_j);
                sine_.set(0, e * harmonics_ + j, sin_j);
                const S next = cos_j * cosine - sin_j * sine;
                sin_j = sin_j * cosine + cos_j * sine;
                cos_j = next;
            }
            return;
        }
        for (Index j = 1; j < harmonics_; ++j) {
            S of_cosine = S::splat(0.0), of_sine = of_cosine;
            for (Index k = 1; k <= i; ++k) {
                // The phase itself goes on at the rate 1.
                const S rate =
                    S::splat(static_cast<double>(k)) * place_.of(k, e) + S::splat(k == 1 ? 1.0 : 0.0);
                of_cosine = of_cosine - rate * sine_.of(i - k, e * harmonics_ + j);
                of_sine = of_sine + rate * cosine_.of(i - k, e * harmonics_ + j);
            }
            const S factor = S::splat(static_cast<double>(j) / static_cast<double>(i));
            cosine_.set(i, e * harmonics_ + j, factor * of_cosine);
            sine_.set(i, e * harmonics_ + j, factor * of_sine);
        }
    }

    // Coefficient i of the energy's factor of a power of the amount, or of its first or second derivative by
    // the place.
    S series(int power, Index i, Index e, int derivative) const {
        S total = S::splat(0.0);
        if (i == 0 && derivative == 0) total = parts_.of(powers + power, e);
        for (Index j = 1; j < harmonics_; ++j) {
            const S of_sine = parts_.of(2 * powers * j + power, e),
                    of_cosine = parts_.of(2 * powers * j + powers + power, e);
            const S cosine = cosine_.of(i, e * harmonics_ + j), sine = sine_.of(i, e * harmonics_ + j);
            const double order = static_cast<double>(j);
            if (derivative == 0)
                total = total + of_cosine * cosine + of_sine * sine;
            else if (derivative == 1)
                total = total + S::splat(order) * (of_sine * cosine - of_cosine * sine);
            else
                total = total - S::splat(order * order) * (of_cosine * cosine + of_sine * sine);
        }
        return total;
    }

    // Coefficient i of a derivative by the amount of the sum of factors[power] amount^power.
    S polynomial(const Table<L>* factors, int derivative, Index i, Index e) const {
        S total = S::splat(0.0);
        for (int power = derivative; power < powers; ++power) {
            double weight = 1.0;
            for (int down = 0; down < derivative; ++down) weight *= static_cast<double>(power - down);
            const int left = power - derivative;
            const S term = left == 0 ? factors[power].of(i, e)
                                     : convolution(factors[power], e, amounts_[left - 1], e, i);
            total = total + S::splat(weight) * term;
        }
        return total;
    }

    S convolution(Table<L> first, Index of_first, Table<L> second, Index of_second, Index i) const {
        S total = S::splat(0.0);
        for (Index j = 0; j <= i; ++j) total = first.of(i - j, of_first) * second.of(j, of_second) + total;
        return total;
    }

    Room room_;
    Index count_, harmonics_, first_place_;
    S start_cosine_ = S::splat(1.0), start_sine_ = S::splat(0.0);
    Table<L> place_, cosine_, sine_, force_;
    Series<L> slope_;
    Table<L> mixed_, bend_, reaction_, touching_, parts_;            // slopes of F by p, of Q by p, and Q
    Table<L> by_power_[powers], by_place_[powers], by_bend_[powers]; // factors of the energy, and derivatives
    Table<L> amounts_[powers - 1];                                   // powers of the amount, from the first
    const MovingLaw* law_[L::machines] = {};
    double factor_[L::machines] = {};
};

} // namespace facegear::motion
