// Elementary functions of many numbers at once, to rounding; of one number those of the standard library.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "motion/constants.hpp"
#include "simd.hpp"

namespace facegear::motion {

constexpr double smallest_size = 1e-300;

template <int W>
inline Lanes<W> square_root(Lanes<W> value) {
    for (int i = 0; i < W; ++i) value.set(i, std::sqrt(value[i]));
    return value;
}

// value = mantissa 2^exponent with a mantissa in [1, 2), of positive normal numbers.
template <int W>
inline void split(Lanes<W> value, Lanes<W>& mantissa, Lanes<W>& exponent) {
    for (int i = 0; i < W; ++i) {
        const double number = value[i];
        std::uint64_t bits;
        std::memcpy(&bits, &number, sizeof bits);
        exponent.set(i, static_cast<double>(static_cast<std::int64_t>(bits >> 52) - 1023));
        bits = (bits & ((std::uint64_t{1} << 52) - 1)) | (std::uint64_t{1023} << 52);
        double rest;
        std::memcpy(&rest, &bits, sizeof rest);
        mantissa.set(i, rest);
    }
}

// Two to the power of whole numbers between -1022 and 1023.
template <int W>
inline Lanes<W> power_of_two(Lanes<W> power) {
    for (int i = 0; i < W; ++i) {
        const auto bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(power[i]) + 1023) << 52;
        double value;
        std::memcpy(&value, &bits, sizeof value);
        power.set(i, value);
    }
    return power;
}

// Natural logarithm of numbers from smallest_size on: log m = 2 atanh((m - 1) / (m + 1)).
template <int W>
inline Lanes<W> logarithm(Lanes<W> value) {
    using V = Lanes<W>;
    V rest = V::splat(1.0), power = V::splat(0.0);
    split(value, rest, power);
    const V one = V::splat(1.0), over = rest - V::splat(1.4142135623730951);
    power = where_positive(over, power + one, power);
    rest = where_positive(over, rest * V::splat(0.5), rest);
    const V ratio = (rest - one) / (rest + one), square = ratio * ratio;
    V total = V::splat(0.0);
    for (int i = 11; i >= 0; --i) total = total * square + V::splat(2.0 / (2 * i + 1));
    return power * V::splat(0.69314718055994530942) + total * ratio;
}
inline Lanes<1> logarithm(Lanes<1> value) { return Lanes<1>::splat(std::log(value[0])); }

// e to the power of numbers between -700 and 700.
template <int W>
inline Lanes<W> exponential(Lanes<W> value) {
    using V = Lanes<W>;
    V power = value * V::splat(1.0 / 0.69314718055994530942);
    for (int i = 0; i < W; ++i) power.set(i, std::nearbyint(power[i]));
    const V rest = value - power * V::splat(0.69314718055994530942);
    constexpr double inverse_factorials[] = {1.0,
                                             1.0,
                                             1.0 / 2,
                                             1.0 / 6,
                                             1.0 / 24,
                                             1.0 / 120,
                                             1.0 / 720,
                                             1.0 / 5040,
                                             1.0 / 40320,
                                             1.0 / 362880,
                                             1.0 / 3628800,
                                             1.0 / 39916800,
                                             1.0 / 479001600,
                                             1.0 / 6227020800,
                                             1.0 / 87178291200};
    V total = V::splat(0.0);
    for (int i = 14; i >= 0; --i) total = total * rest + V::splat(inverse_factorials[i]);
    return total * power_of_two(power);
}
inline Lanes<1> exponential(Lanes<1> value) { return Lanes<1>::splat(std::exp(value[0])); }

// Sine and cosine of angles from 0 to 2 pi: by series for a quarter of angle - pi, doubled twice.
template <int W>
inline std::pair<Lanes<W>, Lanes<W>> sine_and_cosine(Lanes<W> angle) {
    using V = Lanes<W>;
    const V quarter = (angle - V::splat(0.5 * tau)) * V::splat(0.25), square = quarter * quarter;
    V sine = V::splat(0.0), cosine = V::splat(0.0);
    double odd = 1.0 / 121645100408832000.0, even = 1.0 / 6402373705728000.0; // 1 / 19!, 1 / 18!
    for (int i = 9; i >= 0; --i) {
        const double sign = i % 2 == 0 ? 1.0 : -1.0;
        sine = sine * square + V::splat(sign * odd);
        cosine = cosine * square + V::splat(sign * even);
        odd *= (2.0 * i + 1.0) * (2.0 * i);
        even *= 2.0 * i * (2.0 * i - 1.0);
    }
    sine = sine * quarter;
    for (int i = 0; i < 2; ++i) {
        const V twice = V::splat(2.0) * sine, single = sine;
        sine = twice * cosine;
        cosine = V::splat(1.0) - twice * single;
    }
    return {-sine, -cosine};
}
inline std::pair<Lanes<1>, Lanes<1>> sine_and_cosine(Lanes<1> angle) {
    return {Lanes<1>::splat(std::sin(angle[0])), Lanes<1>::splat(std::cos(angle[0]))};
}

} // namespace facegear::motion
