// Points, directions and angles in space, of doubles or of lanes of them.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "simd.hpp"

namespace facegear::flanks {

constexpr double UNKNOWN = std::numeric_limits<double>::quiet_NaN();

// A number of the same type as the others of a formula, alike in all lanes.
template <class Number>
inline Number alike(double value) {
    return Number::splat(value);
}
template <>
inline double alike<double>(double value) {
    return value;
}

// Coordinates in m, or a direction.
template <class Number>
struct Vector {
    Number x, y, z;

    friend Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Vector operator*(Number factor, Vector a) { return {factor * a.x, factor * a.y, factor * a.z}; }
};

template <class Number>
inline Number dot(Vector<Number> a, Vector<Number> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Cosine and sine of an angle.
template <class Number>
struct Turn {
    Number cosine, sine;

    // A vector turned about z.
    Vector<Number> of(Vector<Number> a) const {
        return {a.x * cosine - a.y * sine, a.x * sine + a.y * cosine, a.z};
    }
};

// Terms of the series of sine and cosine about zero, which end below rounding for angles up to STEEP and
// SMALL (rad).
constexpr int STEEP_TERMS = 10, SMALL_TERMS = 7;
constexpr double STEEP = 1.2, SMALL = 0.4;

template <int Terms>
inline Turn<double> turn_by(double angle) {
    return {std::cos(angle), std::sin(angle)};
}

template <int Terms, int Width>
inline Turn<Lanes<Width>> turn_by(Lanes<Width> angle) {
    using Number = Lanes<Width>;
    static constexpr auto coefficients = [] {
        std::array<double, 2 * Terms> result{};
        double factorial = 1.0;
        for (int i = 0; i < 2 * Terms; factorial *= ++i)
            result[i] = (i / 2 % 2 == 0 ? 1.0 : -1.0) / factorial;
        return result;
    }();
    const Number square = angle * angle;
    Number cosine = Number::splat(coefficients[2 * Terms - 2]),
           sine = Number::splat(coefficients[2 * Terms - 1]);
    for (int i = 2 * Terms - 4; i >= 0; i -= 2) {
        cosine = multiply_add(cosine, square, Number::splat(coefficients[i]));
        sine = multiply_add(sine, square, Number::splat(coefficients[i + 1]));
    }
    return {cosine, angle * sine};
}

// Point of a surface, and its derivatives by the surface's two parameters.
template <class Number>
struct Frame {
    Vector<Number> point, by_first, by_second;
};

} // namespace facegear::flanks
