// Points and directions in space, of doubles or of lanes of them.
#pragma once

#include "simd.hpp"

namespace facegear::flanks {

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
};

inline Turn<double> turn_by(double angle) { return {std::cos(angle), std::sin(angle)}; }

// Point of a surface, and its derivatives by the surface's two parameters.
template <class Number>
struct Frame {
    Vector<Number> point, by_first, by_second;
};

} // namespace facegear::flanks
