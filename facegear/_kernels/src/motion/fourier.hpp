// Taylor coefficients of Fourier series of the phase s. Series are [harmonic][sine, cosine][block].
#pragma once

#include <algorithm>
#include <vector>

#include "motion/functions.hpp"
#include "motion/layout.hpp"

namespace facegear::motion {

// Series of some kinds: (kinds, 2, terms), sine part first, a term for the mean and each harmonic.
struct FourierRows {
    Index kinds = 0, terms = 1;
    std::vector<double> values;
    double at(Index kind, int part, Index term) const { return values[(kind * 2 + part) * terms + term]; }
};

// Parts of Count harmonics, which stay in registers while one row follows another.
// (Spelled out one by one, as compilers keep arrays of vectors in memory.)
template <class V, int Count>
struct Harmonics {
    V even, odd;
    Harmonics<V, Count - 1> rest;

    // parts: [even, odd][term], the mean first.
    void load(const double* parts, Index terms) {
        constexpr int lanes = sizeof(V) / sizeof(double);
        even = V::load(parts + lanes);
        odd = V::load(parts + (terms + 1) * lanes);
        rest.load(parts + lanes, terms);
    }
    // The sum of the harmonics in an even or an odd row; powers: of the row, the mean first.
    V sum_even(const double* powers) const { return rest.add_even(powers + 1, even * V::splat(powers[1])); }
    V sum_odd(const double* powers) const { return rest.add_odd(powers + 1, odd * V::splat(powers[1])); }
    V add_even(const double* powers, V sum) const {
        return rest.add_even(powers + 1, even * V::splat(powers[1]) + sum);
    }
    V add_odd(const double* powers, V sum) const {
        return rest.add_odd(powers + 1, odd * V::splat(powers[1]) + sum);
    }
};
template <class V>
struct Harmonics<V, 0> {
    void load(const double*, Index) {}
    V add_even(const double*, V sum) const { return sum; }
    V add_odd(const double*, V sum) const { return sum; }
};

// What series of up to `terms` terms need to be expanded in `rows` coefficients at the phases of the
// machines.
template <class L>
class Expansion {
    using V = typename L::V;
    using S = typename L::S;

  public:
    Expansion() = default;
    Expansion(Index terms, Index rows)
        : terms_(terms), powers_(rows * terms), angles_(room_.numbers(2 * terms * L::machines)) {
        parts_ = room_.numbers(2 * terms * L::lanes);
        // j^i / i! with the signs of the cosine's and the sine's series.
        for (Index j = 0; j < terms; ++j) {
            double power = 1.0;
            for (Index i = 0; i < rows; ++i) {
                if (i > 0)
                    power *= static_cast<double>(j) / static_cast<double>(i) * (i % 2 == 0 ? -1.0 : 1.0);
                powers_[i * terms + j] = power;
            }
        }
    }

    // Cosines and sines of the multiples of the phases.
    void set_phase(S s) {
        const auto [sine, cosine] = sine_and_cosine(s);
        S cos_j = S::splat(1.0), sin_j = S::splat(0.0);
        for (Index j = 0; j < terms_; ++j) {
            cos_j.store(angles_ + 2 * j * L::machines);
            sin_j.store(angles_ + (2 * j + 1) * L::machines);
            const S next = cos_j * cosine - sin_j * sine;
            sin_j = cos_j * sine + sin_j * cosine;
            cos_j = next;
        }
    }
    S cosine(Index j) const { return S::load(angles_ + 2 * j * L::machines); }
    S sine(Index j) const { return S::load(angles_ + (2 * j + 1) * L::machines); }
    double cosine_of(Index j, int machine) const { return angles_[2 * j * L::machines + machine]; }
    double sine_of(Index j, int machine) const { return angles_[(2 * j + 1) * L::machines + machine]; }

    // The first `rows` coefficients of `terms` terms of series at the phases.
    void expand(Table<L> series, Index terms, Index rows, Table<L> out) {
        for (Index b = 0; b < out.width; ++b) {
            for (Index j = 0; j < terms; ++j) {
                const V cos_j = L::every(cosine(j)), sin_j = L::every(sine(j));
                const V sine_part = series.at(2 * j, b), cosine_part = series.at(2 * j + 1, b);
                (cosine_part * cos_j + sine_part * sin_j).store(parts_ + j * L::lanes);
                (sine_part * cos_j - cosine_part * sin_j).store(parts_ + (terms_ + j) * L::lanes);
            }
            expand_parts(parts_, terms, rows, out, b);
        }
    }

    // Cosine and sine parts of `terms` terms of four series side by side, [harmonic][sine, cosine][4], at the
    // phase of one machine: what even and odd coefficients are made of. They go to lane `lane` of four blocks
    // of parts.
    void turn_four(const double* series, Index terms, int machine, Lanes<4> factor, Lanes<4>* even,
                   Lanes<4>* odd) const {
        for (Index j = 0; j < terms; ++j) {
            const Lanes<4> cos_j = Lanes<4>::splat(cosine_of(j, machine)),
                           sin_j = Lanes<4>::splat(sine_of(j, machine));
            const Lanes<4> sine_part = factor * Lanes<4>::load(series + 8 * j);
            const Lanes<4> cosine_part = factor * Lanes<4>::load(series + 8 * j + 4);
            even[j] = cosine_part * cos_j + sine_part * sin_j;
            odd[j] = sine_part * cos_j - cosine_part * sin_j;
        }
    }

    // The first `rows` coefficients in a block of what stands in parts, [even, odd][term].
    void expand_parts(const double* parts, Index terms, Index rows, Table<L> out, Index b) const {
        switch (terms - 1) {
            case 1:
                return expand_harmonics<1>(parts, rows, out, b);
            case 2:
                return expand_harmonics<2>(parts, rows, out, b);
            case 3:
                return expand_harmonics<3>(parts, rows, out, b);
            default:
                return expand_any(parts, terms, rows, out, b);
        }
    }
    Index terms() const { return terms_; }

  private:
    template <int Count>
    void expand_harmonics(const double* parts, Index rows, Table<L> out, Index b) const {
        Harmonics<V, Count> harmonics;
        harmonics.load(parts, terms_);
        const double* powers = powers_.data();
        double* to = out.begin(b);
        for (Index i = 0; i < rows; i += 2, powers += 2 * terms_, to += 2 * out.stride()) {
            harmonics.sum_even(powers).store(to);
            if (i + 1 < rows) harmonics.sum_odd(powers + terms_).store(to + out.stride());
        }
        if (rows > 0) out.add(0, b, V::load(parts)); // the mean has one coefficient
    }

    void expand_any(const double* parts, Index terms, Index rows, Table<L> out, Index b) const {
        if (rows > 0) out.put(0, b, V::load(parts) + sum(parts, terms, 0)); // the mean has one coefficient
        Index i = 1;
        for (; i + 1 < rows; i += 2) expand_two(parts, terms, i, b, out);
        if (i < rows) out.put(i, b, sum(parts, terms, i));
    }
    V part(const double* parts, Index i, Index j) const {
        return V::load(parts + ((i % 2) * terms_ + j) * L::lanes);
    }
    V power(Index i, Index j) const { return V::splat(powers_[i * terms_ + j]); }

    // Rows i and i + 1 side by side, without the mean: one alone would wait for each of its additions.
    void expand_two(const double* parts, Index terms, Index i, Index b, Table<L> out) const {
        V first = V::splat(0.0), second = first;
        for (Index j = 1; j < terms; ++j) {
            first = part(parts, i, j) * power(i, j) + first;
            second = part(parts, i + 1, j) * power(i + 1, j) + second;
        }
        out.put(i, b, first);
        out.put(i + 1, b, second);
    }
    V sum(const double* parts, Index terms, Index i) const {
        V total = V::splat(0.0);
        for (Index j = 1; j < terms; ++j) total = part(parts, i, j) * power(i, j) + total;
        return total;
    }

    Index terms_ = 1;
    std::vector<double> powers_;
    Room room_;
    double* angles_ = nullptr;
    double* parts_ = nullptr;
};

// Write series into a table of [2 term + part][kind] of a machine, times a factor.
template <class L>
void enter_series(const FourierRows& rows, double factor, int machine, Table<L> out) {
    for (Index j = 0; j < rows.terms; ++j)
        for (int part = 0; part < 2; ++part)
            for (Index kind = 0; kind < rows.kinds; ++kind)
                out.one(2 * j + part, kind, machine) = factor * rows.at(kind, part, j);
}
// The same of entities that are each of a kind.
template <class L>
void enter_series(const FourierRows& rows, const std::vector<Index>& kind, double factor, int machine,
                  Table<L> out) {
    for (Index j = 0; j < rows.terms; ++j)
        for (int part = 0; part < 2; ++part)
            for (std::size_t entity = 0; entity < kind.size(); ++entity)
                out.one(2 * j + part, static_cast<Index>(entity), machine) =
                    factor * rows.at(kind[entity], part, j);
}

// Coefficients of a polynomial about a point further on by `ahead`.
inline void shift_polynomial(double* c, Index terms, double ahead) {
    for (Index start = 0; start + 1 < terms; ++start)
        for (Index i = terms - 2; i >= start; --i) c[i] += ahead * c[i + 1];
}

} // namespace facegear::motion
