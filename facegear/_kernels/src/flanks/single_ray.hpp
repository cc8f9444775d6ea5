// A single ray cut with one surface of the face gear: flank, fillet or a land.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "flanks/blank.hpp"
#include "flanks/closed_forms.hpp"
#include "flanks/fillet.hpp"
#include "flanks/newton.hpp"
#include "flanks/ray.hpp"

namespace facegear::flanks {

constexpr double MISSED = std::numeric_limits<double>::infinity();
// Rounding (m) by which a point of the flank may stand above the tip.
constexpr double ON_TIP = 1e-12;
// Cosine of a ray with the outward normal of a land that is parallel to it.
constexpr double PARALLEL = 1e-9;
// Steps to where a ray meets a land, which is nearly straight, and a length (m) below rounding.
constexpr int LAND_STEPS = 12;
constexpr double ROUNDING = 1e-15;

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

// Whether a point of the flank, continued, lies on the flank itself; `place` is that of its normal's foot.
inline bool on_flank(const Blank& blank, double radius, double roll, double height, double place) {
    return within(blank, radius) && is_before_end(blank.flank, roll, place) &&
           height <= blank.tip.at(radius) + ON_TIP;
}

// By Newton's method from a point of the flank.
inline FlankHit cut_flank(const Blank& blank, const Ray& ray, double roll, double psi, double search_radius) {
    const Across<double> beside = across(ray.way);
    for (int i = 0; i < NEWTON_STEPS; ++i) {
        const FlankPoint<double> at = flank_point(blank.flank, roll, psi);
        const auto step = newton_step(ray.start, beside, at.frame);
        if (!is_finite(step.first, step.second)) break;
        if (step.off_squared < SEEN * SEEN) {
            const double distance = dot(step.end, ray.way);
            if (step.off_squared < NEGLIGIBLE * NEGLIGIBLE) {
                const double continued = facing(blank.flank, at.frame, ray.way) < 0 ? distance : MISSED;
                const Vector<double> point = ray.start + step.end;
                const double radius = radius_of(point), place = at.place - step.second * at.place_slope;
                roll -= step.first;
                psi -= step.second;
                const double length = on_flank(blank, radius, roll, point.z, place) ? continued : MISSED;
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

// Angle of the normal on the fillet, nearly, at a depth below the tip.
inline double angle_at_depth(const Side& side, double y, double depth) {
    const auto& depths = side.guess.fillet;
    const auto above = std::lower_bound(depths.begin() + 1, depths.end() - 1, depth) - 1;
    const double part = std::clamp((depth - above[0]) / (above[1] - above[0]), 0.0, 1.0);
    const double steps = static_cast<double>(above - depths.begin()) + part;
    return last_angle(side, y) * steps / (FILLET_HEIGHTS - 1);
}

// The fillet; u is the slope psi of its normal, v the gear radius.
inline Hit cut_fillet(const Blank& blank, const Ray& ray, double search_radius) {
    const Side& side = blank.flank;
    const Across<double> beside = across(ray.way);
    const double start_radius = radius_of(ray.start);
    double y = tip_place(side.shaper, start_radius);
    double angle = angle_at_depth(side, y, blank.tip.at(start_radius) - ray.start.z);
    for (int i = 0; i < NEWTON_STEPS; ++i) {
        const FilletPoint at = fillet_point(side, y, angle);
        const auto step = newton_step(ray.start, beside, at.frame);
        if (!is_finite(step.first, step.second)) break;
        const double part = allowed_part(step.first, step.second);
        y -= part * step.first;
        angle -= part * step.second;
        if (!(step.off_squared < SEEN * SEEN)) continue;
        const double distance = dot(step.end, ray.way);
        if (std::fabs(distance) > search_radius + SEEN) break;
        if (step.off_squared < NEGLIGIBLE_IN_FILLET * NEGLIGIBLE_IN_FILLET) {
            const double radius = radius_of(ray.start + step.end);
            const double psi = at.psi - step.first * at.psi_y - step.second * at.psi_angle;
            const bool is_hit = std::fabs(distance) < search_radius && within(blank, radius) &&
                                0.0 <= angle && angle <= last_angle(side, y);
            return {is_hit ? distance : MISSED, psi, radius, radius};
        }
    }
    return {MISSED, UNKNOWN, UNKNOWN, UNKNOWN};
}

// Height of a land at a gear radius, and its growth.
struct Rise {
    double height, slope;
};

// A surface about the gear's axis, between the gear's cylinders; u is the gear angle from the tooth's centre.
template <class Meridian>
inline Hit cut_land(const Blank& blank, const Ray& ray, double search_radius, Meridian meridian) {
    const Hit no_hit{MISSED, UNKNOWN, UNKNOWN, UNKNOWN};
    double distance = 0.0;
    for (int i = 0; i < LAND_STEPS; ++i) {
        const Vector<double> point = ray.start + distance * ray.way;
        const double radius = radius_of(point);
        const Rise rise = meridian(radius);
        const double outwards = (point.x * ray.way.x + point.y * ray.way.y) / radius;
        const double fall = ray.way.z - rise.slope * outwards;
        if (!(fall < -PARALLEL)) return no_hit;
        const double step = (rise.height - point.z) / fall;
        distance += step;
        if (!(std::fabs(distance) < search_radius)) return no_hit;
        if (std::fabs(step) < ROUNDING)
            return {within(blank, radius) ? distance : MISSED, std::atan2(point.x, point.y), radius, radius};
    }
    return no_hit;
}

} // namespace facegear::flanks
