// Vectors of doubles. This file is the only place that knows the processor and the compiler's extensions.
//
// With GCC and Clang a vector of four is the compiler's own type: AVX2 where the module is compiled for it,
// two registers of SSE2 or NEON otherwise. Elsewhere, and where FACEGEAR_SCALAR is defined, it is an array of
// doubles with the same operators. Eight lanes are two vectors of four: GCC 12 turns vectors of 64 bytes
// without AVX-512 into memory traffic, ten times slower.
#pragma once

#include <cmath>
#include <cstring>

namespace facegear {

#if (defined(__GNUC__) || defined(__clang__)) && !defined(FACEGEAR_SCALAR)
#define FACEGEAR_VECTOR_EXTENSION 1
#endif

// `Width` doubles side by side; arithmetic is lane by lane.
template <int Width>
struct Lanes {
    double lane[Width];

    static Lanes load(const double* from) {
        Lanes result;
        std::memcpy(result.lane, from, sizeof result.lane);
        return result;
    }
    static Lanes splat(double value) {
        Lanes result;
        for (double& each : result.lane) each = value;
        return result;
    }
    void store(double* to) const { std::memcpy(to, lane, sizeof lane); }
    double operator[](int number) const { return lane[number]; }
    void set(int number, double value) { lane[number] = value; }

    template <class Function>
    static Lanes each(Function function) {
        Lanes result;
        for (int i = 0; i < Width; ++i) result.lane[i] = function(i);
        return result;
    }
    friend Lanes operator+(Lanes a, Lanes b) {
        return each([&](int i) { return a.lane[i] + b.lane[i]; });
    }
    friend Lanes operator-(Lanes a, Lanes b) {
        return each([&](int i) { return a.lane[i] - b.lane[i]; });
    }
    friend Lanes operator*(Lanes a, Lanes b) {
        return each([&](int i) { return a.lane[i] * b.lane[i]; });
    }
    friend Lanes operator/(Lanes a, Lanes b) {
        return each([&](int i) { return a.lane[i] / b.lane[i]; });
    }
    friend Lanes operator-(Lanes a) {
        return each([&](int i) { return -a.lane[i]; });
    }
    friend Lanes absolute(Lanes a) {
        return each([&](int i) { return std::fabs(a.lane[i]); });
    }
    friend Lanes smaller(Lanes a, Lanes b) {
        return each([&](int i) { return a.lane[i] < b.lane[i] ? a.lane[i] : b.lane[i]; });
    }
    friend Lanes larger(Lanes a, Lanes b) {
        return each([&](int i) { return a.lane[i] > b.lane[i] ? a.lane[i] : b.lane[i]; });
    }
    // In each lane `yes` where `value` is above zero, else `no`.
    friend Lanes where_positive(Lanes value, Lanes yes, Lanes no) {
        return each([&](int i) { return value.lane[i] > 0.0 ? yes.lane[i] : no.lane[i]; });
    }
};

#ifdef FACEGEAR_VECTOR_EXTENSION

typedef double FourDoubles __attribute__((vector_size(32)));
typedef long long FourIntegers __attribute__((vector_size(32)));

template <>
struct Lanes<4> {
    FourDoubles lane;

    [[gnu::always_inline]] static Lanes load(const double* from) {
        Lanes result;
        std::memcpy(&result.lane, from, sizeof result.lane);
        return result;
    }
    [[gnu::always_inline]] static Lanes splat(double value) {
        return {FourDoubles{value, value, value, value}};
    }
    [[gnu::always_inline]] void store(double* to) const { std::memcpy(to, &lane, sizeof lane); }
    double operator[](int number) const { return lane[number]; }
    void set(int number, double value) { lane[number] = value; }

    [[gnu::always_inline]] friend Lanes operator+(Lanes a, Lanes b) { return {a.lane + b.lane}; }
    [[gnu::always_inline]] friend Lanes operator-(Lanes a, Lanes b) { return {a.lane - b.lane}; }
    [[gnu::always_inline]] friend Lanes operator*(Lanes a, Lanes b) { return {a.lane * b.lane}; }
    [[gnu::always_inline]] friend Lanes operator/(Lanes a, Lanes b) { return {a.lane / b.lane}; }
    [[gnu::always_inline]] friend Lanes operator-(Lanes a) { return {-a.lane}; }
    [[gnu::always_inline]] friend Lanes absolute(Lanes a) {
        return {(FourDoubles)((FourIntegers)a.lane & (0x7fffffffffffffffll))}; // without the bit of the sign
    }
    [[gnu::always_inline]] friend Lanes smaller(Lanes a, Lanes b) {
        return {a.lane < b.lane ? a.lane : b.lane};
    }
    [[gnu::always_inline]] friend Lanes larger(Lanes a, Lanes b) {
        return {a.lane > b.lane ? a.lane : b.lane};
    }
    [[gnu::always_inline]] friend Lanes where_positive(Lanes value, Lanes yes, Lanes no) {
        return {value.lane > 0.0 ? yes.lane : no.lane};
    }
};

template <>
struct Lanes<8> {
    Lanes<4> low, high;

    [[gnu::always_inline]] static Lanes load(const double* from) {
        return {Lanes<4>::load(from), Lanes<4>::load(from + 4)};
    }
    [[gnu::always_inline]] static Lanes splat(double value) {
        return {Lanes<4>::splat(value), Lanes<4>::splat(value)};
    }
    [[gnu::always_inline]] void store(double* to) const {
        low.store(to);
        high.store(to + 4);
    }
    double operator[](int number) const { return number < 4 ? low[number] : high[number - 4]; }
    void set(int number, double value) { number < 4 ? low.set(number, value) : high.set(number - 4, value); }

    [[gnu::always_inline]] friend Lanes operator+(Lanes a, Lanes b) {
        return {a.low + b.low, a.high + b.high};
    }
    [[gnu::always_inline]] friend Lanes operator-(Lanes a, Lanes b) {
        return {a.low - b.low, a.high - b.high};
    }
    [[gnu::always_inline]] friend Lanes operator*(Lanes a, Lanes b) {
        return {a.low * b.low, a.high * b.high};
    }
    [[gnu::always_inline]] friend Lanes operator/(Lanes a, Lanes b) {
        return {a.low / b.low, a.high / b.high};
    }
    [[gnu::always_inline]] friend Lanes operator-(Lanes a) { return {-a.low, -a.high}; }
    [[gnu::always_inline]] friend Lanes absolute(Lanes a) { return {absolute(a.low), absolute(a.high)}; }
    [[gnu::always_inline]] friend Lanes smaller(Lanes a, Lanes b) {
        return {smaller(a.low, b.low), smaller(a.high, b.high)};
    }
    [[gnu::always_inline]] friend Lanes larger(Lanes a, Lanes b) {
        return {larger(a.low, b.low), larger(a.high, b.high)};
    }
    [[gnu::always_inline]] friend Lanes where_positive(Lanes value, Lanes yes, Lanes no) {
        return {where_positive(value.low, yes.low, no.low), where_positive(value.high, yes.high, no.high)};
    }
};

#endif

// A number whose bit i says whether lane i is above zero.
template <int Width>
inline unsigned positive_lanes(Lanes<Width> value) {
    unsigned bits = 0;
    for (int i = 0; i < Width; ++i) bits |= static_cast<unsigned>(value[i] > 0.0) << i;
    return bits;
}

// Rows of four become columns.
inline void transpose(Lanes<4>& a, Lanes<4>& b, Lanes<4>& c, Lanes<4>& d) {
#if defined(FACEGEAR_VECTOR_EXTENSION) && (defined(__clang__) || __GNUC__ >= 12)
    const FourDoubles low_1 = __builtin_shufflevector(a.lane, b.lane, 0, 4, 2, 6);
    const FourDoubles high_1 = __builtin_shufflevector(a.lane, b.lane, 1, 5, 3, 7);
    const FourDoubles low_2 = __builtin_shufflevector(c.lane, d.lane, 0, 4, 2, 6);
    const FourDoubles high_2 = __builtin_shufflevector(c.lane, d.lane, 1, 5, 3, 7);
    a.lane = __builtin_shufflevector(low_1, low_2, 0, 1, 4, 5);
    b.lane = __builtin_shufflevector(high_1, high_2, 0, 1, 4, 5);
    c.lane = __builtin_shufflevector(low_1, low_2, 2, 3, 6, 7);
    d.lane = __builtin_shufflevector(high_1, high_2, 2, 3, 6, 7);
#else
    Lanes<4>* rows[] = {&a, &b, &c, &d};
    for (int i = 0; i < 4; ++i) {
        for (int j = i + 1; j < 4; ++j) {
            const double upper = (*rows[i])[j];
            rows[i]->set(j, (*rows[j])[i]);
            rows[j]->set(i, upper);
        }
    }
#endif
}

// The sums of the lanes of four vectors.
inline Lanes<4> lane_sums(Lanes<4> a, Lanes<4> b, Lanes<4> c, Lanes<4> d) {
    transpose(a, b, c, d);
    return (a + b) + (c + d);
}

#if defined(FACEGEAR_VECTOR_EXTENSION) && defined(__AVX__)
inline unsigned positive_lanes(Lanes<4> value) {
    return static_cast<unsigned>(__builtin_ia32_movmskpd256((FourDoubles)(value.lane > 0.0)));
}
#endif
#ifdef FACEGEAR_VECTOR_EXTENSION
inline unsigned positive_lanes(Lanes<8> value) {
    return positive_lanes(value.low) | positive_lanes(value.high) << 4;
}
#endif

// first * second + third, fused where the processor can.
template <int Width>
inline Lanes<Width> multiply_add(Lanes<Width> first, Lanes<Width> second, Lanes<Width> third) {
    return first * second + third;
}

} // namespace facegear
