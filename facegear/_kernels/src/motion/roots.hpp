// First zero of a polynomial in an interval, certain to be found or excluded.
//
// Bernstein coefficients bound the polynomial, and the interval is halved until they have one change of sign
// or none (Lane and Riesenfeld, BIT 21, 1981).
#pragma once

#include <cmath>
#include <vector>

#include "motion/layout.hpp"

namespace facegear::motion {

constexpr int max_depth = 48;
// Part of an interval beside its end in which a zero may be that of the next one.
constexpr double beside = 1e-12;
// Halley's last step, over the interval: the error after it is of the order of its cube.
constexpr double close_enough = 1e-7;
constexpr double never = 2.0;

// Conversion from power to Bernstein coefficients on [0, 1], lower triangular: b_i = sum_k C(i, k) /
// C(degree, k) a_k.
inline std::vector<double> bernstein_matrix(Index degree) {
    std::vector<double> matrix((degree + 1) * (degree + 1), 0.0);
    for (Index i = 0; i <= degree; ++i) {
        double ratio = 1.0;
        for (Index k = 0; k <= i; ++k) {
            matrix[i * (degree + 1) + k] = ratio;
            ratio *= k < degree ? static_cast<double>(i - k) / static_cast<double>(degree - k) : 0.0;
        }
    }
    return matrix;
}

// The one zero between low and high of each polynomial that is pending (1), any number of the others:
// Halley's method kept inside a shrinking bracket.
template <class V, class Term>
[[gnu::always_inline]] inline V refine_root(Term term, Index degree, V low, V high, V at_low, V at_high,
                                            V pending) {
    const V none = V::splat(0.0), one = V::splat(1.0), half = V::splat(0.5);
    const V sign = where_positive(at_high, one, -one), width = high - low;
    V t = low + width * at_low / (at_low - at_high), root = t;
    // Another zero may lie at the end, to rounding.
    t = where_positive(high - t - V::splat(beside) * width, t, half * (low + high));
    for (int turn = 0; turn < 100 && positive_lanes(pending) != 0; ++turn) {
        V value = term(degree), slope = none, bend = none; // bend: half the second derivative
        for (Index i = degree - 1; i >= 0; --i) {
            bend = bend * t + slope;
            slope = slope * t + value;
            value = value * t + term(i);
        }
        const V rise = sign * value, size = absolute(value);
        high = where_positive(rise, t, high);
        low = where_positive(rise, low, t);
        const V step = t - value * slope / (slope * slope - value * bend);
        const V inside = smaller(step - low, high - step),
                close = V::splat(close_enough) - absolute(step - t);
        const V met = where_positive(close, where_positive(-inside, none, one), none);
        const V narrow = V::splat(4e-16) - (high - low);
        const V next = where_positive(larger(inside, met), step, half * (low + high));
        t = where_positive(size, next, t);
        root = where_positive(pending, t, root);
        pending = where_positive(where_positive(size, larger(met, narrow), one), none, pending);
    }
    return root;
}

// Scratch space for zeros of polynomials of one degree.
class RootFinder {
  public:
    explicit RootFinder(Index degree)
        : degree_(degree),
          conversion_(bernstein_matrix(degree)),
          rows_((max_depth + 2) * (degree + 1)),
          polynomial_(degree + 1) {}

    Index degree() const { return degree_; }
    const double* conversion() const { return conversion_.data(); }
    double* polynomial() { return polynomial_.data(); }

    // Smallest t in (0, 1] where the polynomial changes sign, or `never`. Zeros of even order that do not
    // change the sign are passed over.
    double first_root() {
        const double* c = polynomial_.data();
        double rest = 0.0;
        for (Index k = 1; k <= degree_; ++k) rest += std::fabs(c[k]);
        if (std::fabs(c[0]) > rest) return never;
        convert(c, 0);
        int depth = 0;
        double left = 0.0, width = 1.0;
        double before = 0.0; // a value of the sign that the interval before ends with
        while (true) {
            double last = before;
            const int changes = sign_changes(depth, last);
            const double begin = row(depth)[0];
            if (changes == 1) {
                // To rounding: the two intervals give their common end different signs.
                if (begin != 0.0 && (begin > 0.0) == (last > 0.0)) return left;
                return refine_root(c, degree_, left, left + width, begin, last);
            }
            if (changes > 1 && depth < max_depth) {
                halve(depth++);
                width *= 0.5;
                continue;
            }
            // Nothing in this interval: go on with the next one to the right.
            before = last;
            left += width;
            if (depth == 0 || left >= 1.0) return never;
            while (depth > 1 && std::fmod(left / (2.0 * width), 1.0) == 0.0) {
                width *= 2.0;
                --depth;
            }
            restart(left, width, depth);
        }
    }

    // The next zero after a spurious one at the start: it is divided out of the polynomial first.
    double root_after(double root) {
        double carry = polynomial_[degree_];
        for (Index i = degree_ - 1; i >= 0; --i) {
            const double value = polynomial_[i];
            polynomial_[i] = carry;
            carry = value + root * carry;
        }
        polynomial_[degree_] = 0.0;
        return first_root();
    }

    // The one zero between low and high of one polynomial.
    static double refine_root(const double* c, Index degree, double low, double high, double at_low,
                              double at_high) {
        if (at_high == 0.0) return high;
        using V = Lanes<1>;
        const auto term = [&](Index i) { return V::splat(c[i]); };
        return motion::refine_root(term, degree, V::splat(low), V::splat(high), V::splat(at_low),
                                   V::splat(at_high), V::splat(1.0))[0];
    }

  private:
    double* row(int depth) { return rows_.data() + depth * (degree_ + 1); }

    void convert(const double* c, int depth) {
        double* b = row(depth);
        for (Index i = 0; i <= degree_; ++i) {
            double total = 0.0;
            for (Index k = 0; k <= i; ++k) total += conversion_[i * (degree_ + 1) + k] * c[k];
            b[i] = total;
        }
    }

    // Changes of sign of the coefficients after a value `last`, which becomes their last that is not zero.
    int sign_changes(int depth, double& last) {
        int changes = 0;
        const double* b = row(depth);
        for (Index i = 0; i <= degree_; ++i) {
            if (b[i] == 0.0) continue;
            if (last != 0.0 && (last > 0.0) != (b[i] > 0.0)) ++changes;
            last = b[i];
        }
        return changes;
    }

    // Coefficients of the left half, into the next row (de Casteljau).
    void halve(int depth) {
        const double* whole = row(depth);
        double* half = row(depth + 1);
        for (Index i = 0; i <= degree_; ++i) half[i] = whole[i];
        for (Index level = 1; level <= degree_; ++level)
            for (Index i = degree_; i >= level; --i) half[i] = 0.5 * (half[i] + half[i - 1]);
    }

    // Coefficients on [left, left + width] afresh, by Taylor shift and scaling.
    void restart(double left, double width, int depth) {
        double* shifted = row(max_depth + 1);
        for (Index k = 0; k <= degree_; ++k) shifted[k] = polynomial_[k];
        for (Index start = 0; start < degree_; ++start)
            for (Index k = degree_ - 1; k >= start; --k) shifted[k] += left * shifted[k + 1];
        double scale = 1.0;
        for (Index k = 0; k <= degree_; ++k) {
            shifted[k] *= scale;
            scale *= width;
        }
        convert(shifted, depth);
    }

    Index degree_;
    std::vector<double> conversion_, rows_, polynomial_;
};

} // namespace facegear::motion
