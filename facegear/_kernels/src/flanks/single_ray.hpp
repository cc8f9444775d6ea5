// A single ray cut with one surface of the face gear: flank, fillet or a land.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "flanks/blank.hpp"
#include "flanks/closed_forms.hpp"
#include "flanks/newton.hpp"
#include "flanks/ray.hpp"

namespace facegear::flanks {

constexpr double MISSED = std::numeric_limits<double>::infinity();
constexpr double UNKNOWN = std::numeric_limits<double>::quiet_NaN();
// Rounding (m) by which a point of the flank may stand above the tip plane.
constexpr double ON_PLANE = 1e-12;
// Bisections to a start on the fillet, a few degrees from the point.
constexpr int BISECTIONS = 6;
// Cosine of a ray with the outward normal of a land that is parallel to it.
constexpr double PARALLEL = 1e-9;

// Where a ray meets a surface: the distance (m) from its start, infinite beside the surface, where on the
// surface as `Separation` in facegear/teeth/separation.py has it, and the gear radius (m).
struct Hit {
    double distance, u, v, radius;
};

struct FlankHit {
    Hit hit;
    double continued; // distance (m) to the flank continued beyond its edges
    bool converged;
};

inline double radius_of(Vector<double> point) { return std::sqrt(point.x * point.x + point.y * point.y); }

inline bool within(const Blank& blank, double radius) {
    return blank.inner <= radius && radius <= blank.outer;
}

// Whether a point of the flank, continued, lies on the flank itself.
inline bool on_flank(const Blank& blank, double radius, double roll, double height) {
    return within(blank, radius) && roll <= blank.tip_roll && height <= blank.tip_plane + ON_PLANE;
}

// By Newton's method from a point of the flank.
inline FlankHit cut_flank(const Blank& blank, const Ray& ray, double roll, double psi, double search_radius) {
    const Across<double> beside = across(ray.way);
    for (int i = 0; i < NEWTON_STEPS; ++i) {
        const Turn<double> turn = turn_by(gear_turn(blank, roll, psi)), slope = turn_by(psi);
        const auto step = newton_step(ray.start, beside, flank_frame(blank, roll, turn, slope));
        if (!is_finite(step.first, step.second)) break;
        if (step.off_squared < SEEN * SEEN) {
            const double distance = dot(step.end, ray.way);
            if (step.off_squared < NEGLIGIBLE * NEGLIGIBLE) {
                const double continued = facing(turn, slope, ray.way) < 0 ? distance : MISSED;
                const Vector<double> point = ray.start + step.end;
                const double radius = radius_of(point);
                roll -= step.first;
                psi -= step.second;
                const double length = on_flank(blank, radius, roll, point.z) ? continued : MISSED;
                return {{length, roll, psi, radius}, continued, true};
            }
            if (std::fabs(distance) > search_radius + SEEN)
                return {{MISSED, roll, psi, UNKNOWN}, MISSED, true};
        }
        const double part = allowed_part(step.first, step.second);
        roll -= part * step.first;
        psi -= part * step.second;
    }
    return {{MISSED, roll, psi, UNKNOWN}, MISSED, false};
}

// psi on the fillet's section near a height, by bisection to a few degrees.
inline double psi_at_height(const Blank& blank, double q, double height) {
    double low = blank.fillet_start, high = 0.5 * std::numbers::pi;
    for (int i = 0; i < BISECTIONS; ++i) {
        const double psi = 0.5 * (low + high);
        (fillet_height(blank, psi, q) > height ? low : high) = psi;
    }
    return 0.5 * (low + high);
}

// The fillet continued beyond its edges, no farther than `search_radius`; v is the gear radius.
inline Hit cut_continued_fillet(const Blank& blank, const Ray& ray, double psi, double q,
                                double search_radius) {
    const Across<double> beside = across(ray.way);
    for (int i = 0; i < NEWTON_STEPS; ++i) {
        const auto step = newton_step(ray.start, beside, fillet_frame(blank, psi, q));
        if (!is_finite(step.first, step.second)) break;
        const double part = allowed_part(step.first, step.second);
        psi -= part * step.first;
        q -= part * step.second;
        if (!(step.off_squared < SEEN * SEEN)) continue;
        const double distance = dot(step.end, ray.way);
        if (std::fabs(distance) > search_radius + SEEN) break;
        if (step.off_squared < NEGLIGIBLE_IN_FILLET * NEGLIGIBLE_IN_FILLET) {
            const double radius = radius_of(ray.start + step.end);
            return {std::fabs(distance) < search_radius ? distance : MISSED, psi, radius, radius};
        }
    }
    return {MISSED, psi, UNKNOWN, UNKNOWN};
}

// The distance is not a number where the fillet's edge is not found.
inline Hit cut_fillet(const Blank& blank, const Ray& ray, double search_radius) {
    const double q = radius_of(ray.start), psi = psi_at_height(blank, q, ray.start.z);
    Hit hit = cut_continued_fillet(blank, ray, psi, q, search_radius);
    if (!(hit.distance < MISSED && hit.u <= 0.5 * std::numbers::pi && within(blank, hit.radius))) {
        hit.distance = MISSED;
        return hit;
    }
    const double start = psi_at_roll(blank, hit.radius, blank.tip_roll);
    if (std::isnan(start)) {
        hit.distance = UNKNOWN;
    } else if (!(hit.u >= start)) {
        hit.distance = MISSED;
    }
    return hit;
}

// A plane between the gear's cylinders; u is the gear angle from the tooth's centre.
inline Hit cut_land(const Blank& blank, const Ray& ray, double height, double search_radius) {
    if (!(ray.way.z < -PARALLEL)) return {MISSED, UNKNOWN, UNKNOWN, UNKNOWN};
    const double distance = (height - ray.start.z) / ray.way.z;
    if (!(std::fabs(distance) < search_radius)) return {MISSED, UNKNOWN, UNKNOWN, UNKNOWN};
    const Vector<double> point = ray.start + distance * ray.way;
    const double radius = radius_of(point);
    return {within(blank, radius) ? distance : MISSED, std::atan2(point.x, point.y), radius, radius};
}

} // namespace facegear::flanks
