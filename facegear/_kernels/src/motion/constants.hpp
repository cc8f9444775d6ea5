// Numbers by which contacts, steps and runs are judged. Lengths are in length scales, times in rad of mesh
// phase.
#pragma once

#include <limits>

#include "motion/layout.hpp"

namespace facegear::motion {

constexpr double tau = 6.283185307179586476925286766559;
constexpr double infinity = std::numeric_limits<double>::infinity();

// A deflection this close to an edge stands on it; so does one that crosses it within the time: s itself is
// not known better.
constexpr double edge_width = 2e-14, edge_time = 1e-14;
// Shortest time between two switches of one mesh that is followed.
constexpr double shortest = 1e-10;
// How far ahead a mesh that stands on an edge is looked at, and the rate (per rad) that rounding explains.
constexpr double latest = 1e-4, still = 1e-14;
// A force this small beside its spring's and its damper's part counts as zero: its rate decides what follows.
constexpr double no_force = 1e-10;
// A step that ends this close to the end of a period, or to a break of the law, ends there.
constexpr double rounding = 1e-13;
// How often contact states are guessed at the start of a step, and the coefficients of the forces that
// decide.
constexpr int max_guesses = 4;
constexpr Index deciding = 3;
constexpr Index max_steps = 2000000;
// Amplitude over the length scale from which on a motion counts as grown beyond all bounds: its rounding is
// some 1e-4 length scales there, and every further decade would cost a tenth more steps without end.
constexpr double largest_amplitude = 1e12;

} // namespace facegear::motion
