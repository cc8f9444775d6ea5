// Newton's method for the point in which a ray meets a surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "flanks/vectors.hpp"

namespace facegear::flanks {

constexpr int NEWTON_STEPS = 16;
constexpr double LARGEST_STEP = 0.2; // of either parameter, rad
// Distance (m) of a ray from the point reached on the flank whose square over the flank's radii of curvature
// is below rounding: Newton's next step is exact, and its end is known without looking.
constexpr double NEGLIGIBLE = 1e-9;
// The same on the fillet, whose radii are smaller.
constexpr double NEGLIGIBLE_IN_FILLET = 1e-10;
// Distance (m) of a ray from the point reached from which on the ray's length is known as well as that.
constexpr double SEEN = 1e-5;

// Two unit directions across a ray; the first has no y.
template <class Number>
struct Across {
    Number x, z;
    Vector<Number> second;

    Number along_first(Vector<Number> a) const { return x * a.x + z * a.z; }
    Number along_second(Vector<Number> a) const { return dot(second, a); }
};

inline Across<double> across(Vector<double> way) {
    const double length = std::sqrt(way.x * way.x + way.z * way.z);
    const double x = way.z / length, z = -way.x / length;
    return {x, z, {way.y * z, way.z * x - way.x * z, -way.y * x}};
}

// What to take off both parameters, the square of the distance (m) of the frame's point from the ray, and
// where the step leads, from the ray's start. Not finite where there is no step.
template <class Number>
struct NewtonStep {
    Number first, second, off_squared;
    Vector<Number> end;
};

template <class Number>
inline NewtonStep<Number> newton_step(Vector<Number> start, const Across<Number>& beside,
                                      const Frame<Number>& frame) {
    const Vector<Number> apart = frame.point - start;
    const Number r1 = beside.along_first(apart), r2 = beside.along_second(apart);
    const Number a1 = beside.along_first(frame.by_first), a2 = beside.along_second(frame.by_first);
    const Number b1 = beside.along_first(frame.by_second), b2 = beside.along_second(frame.by_second);
    const Number inverse = alike<Number>(1.0) / (a1 * b2 - a2 * b1);
    const Number first = (r1 * b2 - r2 * b1) * inverse, second = (a1 * r2 - a2 * r1) * inverse;
    return {first, second, r1 * r1 + r2 * r2, apart - first * frame.by_first - second * frame.by_second};
}

// Factor that keeps a step of both parameters within LARGEST_STEP.
inline double allowed_part(double first, double second) {
    return LARGEST_STEP / std::max({std::fabs(first), std::fabs(second), LARGEST_STEP});
}

inline bool is_finite(double first, double second) {
    return std::fabs(first) + std::fabs(second) < std::numeric_limits<double>::infinity();
}

} // namespace facegear::flanks
