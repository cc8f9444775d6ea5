// The load-dependent law: between two levels of the amount the force is a cubic, whose coefficients are
// Fourier series of the phase (docs/explanation/mesh_law.md).
#pragma once

#include <algorithm>
#include <vector>

#include "motion/constants.hpp"
#include "motion/fourier.hpp"
#include "motion/layout.hpp"
#include "motion/touching_flanks.hpp"

namespace facegear::motion {

struct LoadDependentLaw {
    static constexpr bool curved = true, ahead_by_forces = false, by_mesh = true, moves = false;

    Index kinds = 0, level_count = 0, harmonics = 1; // harmonics with the mean
    std::vector<double>
        table; // (kinds, levels, harmonics, 2, 4): of the powers of the amount since the piece began
    std::vector<double> levels; // (kinds, levels), m
    std::vector<Index> kind;    // of each contact
    std::vector<double> breaks; // none: smooth in the phase

    Index contacts() const { return static_cast<Index>(kind.size()); }
    Index terms() const { return harmonics; }
    // Whether machines with either law may share scratch space.
    bool alike(const LoadDependentLaw& other) const {
        return contacts() == other.contacts() && harmonics == other.harmonics;
    }
    const double* cubic(Index contact, Index piece) const {
        return table.data() + (kind[contact] * level_count + piece - 1) * harmonics * 8;
    }
    double level(Index contact, Index number) const { return levels[kind[contact] * level_count + number]; }

    template <class L>
    class Motion;
};

// With d the deflection since the piece began, c0 .. c3 the coefficients of the piece:
//     F = c0 + d rise,   rise = c1 + d bend,   bend = c2 + d c3,   dF/dd = rise + d (2 bend - c2).
template <class L>
class LoadDependentLaw::Motion {
    using V = typename L::V;

  public:
    Motion(const LoadDependentLaw& law, Index rows)
        : zeroth_(room_.table<L>(rows, law.contacts())),
          first_(room_.table<L>(rows, law.contacts())),
          second_(room_.table<L>(rows, law.contacts())),
          third_(room_.table<L>(rows, law.contacts())),
          bend_(room_.table<L>(rows, law.contacts())),
          rise_(room_.table<L>(rows, law.contacts())),
          lever_(room_.table<L>(rows, law.contacts())),
          slope_{room_.table<L>(rows, law.contacts()), nullptr},
          turned_(2 * law.harmonics * L::lanes),
          touching_(zeroth_.width) {}

    // Room for parts of series of up to so many terms.
    void make_room(Index terms) { parts_ = room_.numbers(8 * terms * L::lanes); }

    void enter(const LoadDependentLaw& law, double factor, int machine) {
        law_[machine] = &law;
        factor_[machine] = factor;
    }

    void expand_phase(Expansion<L>&, const Index*, const double*, Index) {}

    // The series of the four coefficients of every contact's piece, odd ones on a back flank. state: as the
    // contacts'.
    void expand_pieces(Expansion<L>& expansion, const TouchingFlanks<L>& touching, Table<L> state,
                       Index rows) {
        const Index terms = law_[0]->harmonics, span = 2 * expansion.terms() * L::lanes;
        std::fill(touching_.begin(), touching_.end(), 0);
        for (Index b = 0; b < state.width && b < zeroth_.width; ++b) {
            for (int lane = 0; lane < L::lanes; ++lane) {
                const bool is_touching =
                    turn_lane(expansion, state.data[b * L::lanes + lane], touching.contact_of(b, lane), lane);
                touching_[b] = touching_[b] || is_touching;
            }
            if (!touching_[b]) continue;
            gather(expansion.terms());
            const Table<L>* tables[] = {&zeroth_, &first_, &second_, &third_};
            for (int power = 0; power < 4; ++power)
                expansion.expand_parts(parts_ + power * span, terms, rows, *tables[power], b);
        }
    }

    // Whether a contact of a block touches.
    bool touches(Index block) const { return touching_[block]; }

    // Three products with one series side by side; the newest coefficients, which need each other, come last.
    V force(Table<L> deflection, Index i, Index block) {
        if (!touching_[block]) return V::splat(0.0);
        // Deflections have a row for every ring, too, which the law's own tables have not.
        const Index stride = zeroth_.stride(), deflection_stride = deflection.stride();
        const double* third = third_.begin(block);
        const double* bend = bend_.begin(block);
        const double* rise = rise_.begin(block);
        const double* d = deflection.begin(block) + i * deflection_stride;
        V by_third = second_.at(i, block), by_bend = first_.at(i, block), by_rise = zeroth_.at(i, block);
        for (Index j = 0; j < i; ++j) {
            const V own = V::load(d);
            by_third = V::load(third) * own + by_third;
            by_bend = V::load(bend) * own + by_bend;
            by_rise = V::load(rise) * own + by_rise;
            third += stride, bend += stride, rise += stride, d -= deflection_stride;
        }
        const V start = V::load(d), bent = V::load(third) * start + by_third, risen = bent * start + by_bend;
        bend_.put(i, block, bent);
        rise_.put(i, block, risen);
        return risen * start + by_rise;
    }

    // The series of the slope, once the forces up to `order` are known.
    void expand_slopes(Table<L> deflection, Index order) {
        for (Index b = 0; b < zeroth_.width; ++b) {
            for (Index i = 0; touching_[b] && i <= order; ++i) {
                lever_.put(i, b, V::splat(2.0) * bend_.at(i, b) - second_.at(i, b));
                slope_.table.put(i, b, rise_.at(i, b) + product(lever_, deflection, i, b));
            }
        }
    }
    Series<L> slope() const { return slope_; }

    void look_ahead(Index, V) {}
    V force_ahead(V deflection, Index order, V step, Index block) const {
        if (!touching_[block]) return V::splat(0.0);
        V total = value_ahead(third_, order, step, block) * deflection;
        total = (total + value_ahead(second_, order, step, block)) * deflection;
        total = (total + value_ahead(first_, order, step, block)) * deflection;
        return total + value_ahead(zeroth_, order, step, block);
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
    // What the coefficients of one lane's contact are made of; zeros where it is open. True if it touches.
    bool turn_lane(const Expansion<L>& expansion, double piece, Index m, int lane) {
        const int machine = machine_of<L>(lane);
        const LoadDependentLaw& law = *law_[machine];
        Lanes<4>* even = turned_.data() + 2 * law.harmonics * lane;
        if (m >= law.contacts() || piece == 0.0) {
            std::fill(even, even + 2 * law.harmonics, Lanes<4>::splat(0.0));
            return false;
        }
        const double size = factor_[machine], odd = piece > 0.0 ? size : -size;
        Lanes<4> factor = Lanes<4>::splat(size);
        factor.set(0, odd);
        factor.set(2, odd);
        const Index number = static_cast<Index>(piece < 0.0 ? -piece : piece);
        expansion.turn_four(law.cubic(m, number), law.harmonics, machine, factor, even, even + law.harmonics);
        return true;
    }

    // Turn the four coefficients of each lane into lanes of each coefficient, [even, odd][term of span].
    void gather(Index span) {
        const Index terms = law_[0]->harmonics;
        for (Index at = 0; at < 2 * terms; ++at) {
            double* to = parts_ + (at < terms ? at : span + at - terms) * L::lanes;
            const auto of_lane = [&](int lane) { return turned_[2 * terms * lane + at]; };
            int lane = 0;
            for (; lane + 4 <= L::lanes; lane += 4) {
                Lanes<4> zeroth = of_lane(lane), first = of_lane(lane + 1), second = of_lane(lane + 2),
                         third = of_lane(lane + 3);
                transpose(zeroth, first, second, third);
                zeroth.store(to + lane);
                first.store(to + 2 * span * L::lanes + lane);
                second.store(to + 4 * span * L::lanes + lane);
                third.store(to + 6 * span * L::lanes + lane);
            }
            for (; lane < L::lanes; ++lane)
                for (int power = 0; power < 4; ++power)
                    to[2 * power * span * L::lanes + lane] = of_lane(lane)[power];
        }
    }

    Room room_;
    Table<L> zeroth_, first_, second_, third_, bend_, rise_, lever_;
    Series<L> slope_;
    std::vector<Lanes<4>> turned_; // [lane][even, odd][term]: of the four coefficients of each lane's contact
    double* parts_ = nullptr;      // [coefficient][even, odd][term]: of all lanes
    std::vector<char> touching_;
    const LoadDependentLaw* law_[L::machines] = {};
    double factor_[L::machines] = {};
};

} // namespace facegear::motion
