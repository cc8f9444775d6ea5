// Rays cut with a tooth of the face gear: the first of its surfaces that is hit.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "flanks/ray.hpp"
#include "flanks/side_by_side.hpp"
#include "flanks/single_ray.hpp"

namespace facegear::flanks {

// The numbers of the rays that come where the tooth, or its flank continued, may be.
inline std::vector<Index> rays_near_the_tooth(const Blank& blank, const Rays& rays) {
    std::vector<Index> live;
    live.reserve(static_cast<std::size_t>(rays.count()));
    const double beside = std::max(rays.search_radius, blank.module);
    const double low = std::max(blank.inner - beside, 0.0), high = blank.outer + beside;
    const double steepest = std::max(std::fabs(blank.tip.slope), std::fabs(blank.root.slope));
    for (Index i = 0; i < rays.count(); ++i) {
        const auto [start, way] = rays[i];
        const double square = start.x * start.x + start.y * start.y;
        if (!(low * low < square && square < high * high)) continue;
        if (!(std::fabs(start.x - blank.middle.at(start.y)) < blank.aside)) continue;
        const double rise = rays.search_radius * (std::fabs(way.z) + steepest), radius = std::sqrt(square);
        if (start.z - rise < blank.tip.at(radius) + ON_TIP &&
            start.z + rise > blank.root.at(radius) - blank.root_bulge)
            live.push_back(i);
    }
    return live;
}

// The sampled point of the flank that the ray passes closest, if it does so within the sample's spacing, else
// -1.
inline Index nearest_sample(const Ray& ray, double search_radius, const FlankSample& sample) {
    double least = sample.spacing * sample.spacing;
    Index nearest = -1;
    const double radius = radius_of(ray.start);
    const Index each = sample.points.rows / std::max<Index>(sample.radii.size, 1);
    for (Index row = 0; row < sample.radii.size; ++row) {
        if (std::fabs(sample.radii[row] - radius) > search_radius + sample.spacing) continue;
        for (Index k = row * each; k < (row + 1) * each; ++k) {
            const Vector<double> apart = vector_of(sample.points, k) - ray.start,
                                 normal = vector_of(sample.normals, k);
            const double along = dot(apart, ray.way), aside = dot(apart, apart) - along * along;
            if (aside < least && std::fabs(along) <= search_radius && dot(ray.way, normal) <= -0.1) {
                least = aside;
                nearest = k;
            }
        }
    }
    return nearest;
}

// Whether no point of a ray is so far in or out that it must miss the gear.
inline bool may_meet(const Blank& blank, const Ray& ray, double search_radius) {
    const Vector<double> start = ray.start;
    const double square = start.x * start.x + start.y * start.y;
    // no point of the ray is farther in or out than by this, in squares of the radius
    const double inwards = std::fabs(start.x * ray.way.x + start.y * ray.way.y);
    const double aside = 2 * search_radius * inwards + search_radius * search_radius;
    return blank.inner * blank.inner - aside < square && square < blank.outer * blank.outer + aside;
}

// A ray alone against all surfaces.
struct SingleRay {
    const Blank& blank;
    const FlankSample& sample;
    Ray ray;
    double search_radius;
    Hit hit = {MISSED, UNKNOWN, UNKNOWN, UNKNOWN};
    Part part = NONE;
    double continued = MISSED;
    int lost = 0; // surfaces close by that it could not be cut with

    bool is_hit() const { return std::fabs(hit.distance) < search_radius; }

    void meet_flank() {
        const Index nearest = nearest_sample(ray, search_radius, sample);
        if (nearest < 0) return;
        FlankHit found = from_sample(nearest);
        if (!found.converged && sample.inner[nearest]) {
            // Where the ray leaves the flank over an edge, it may pass that edge beyond the search radius.
            const Index closer = nearest_sample(ray, search_radius + sample.spacing, sample);
            if (closer != nearest) found = from_sample(closer);
            lost += !found.converged && sample.inner[closer];
        }
        if (std::fabs(found.continued) < search_radius) continued = found.continued;
        hit = found.hit;
        part = FLANK;
    }

    void meet_the_rest() {
        const double reach = search_radius * (std::fabs(ray.way.z) + std::fabs(blank.tip.slope));
        const double radius = radius_of(ray.start);
        if (!is_hit() && ray.start.z - reach < blank.tip.at(radius) + blank.fillet_top) {
            hit = cut_fillet(blank, ray, search_radius);
            part = FILLET;
        }
        if (!is_hit()) meet_tip_land();
        if (!is_hit()) meet_root_land(radius);
    }

  private:
    FlankHit from_sample(Index k) const {
        return cut_flank(blank, ray, sample.rolls[k], sample.psis[k], search_radius);
    }

    void meet_tip_land() {
        hit = cut_land(blank, ray, search_radius,
                       [&](double radius) { return Rise{blank.tip.at(radius), blank.tip.slope}; });
        part = TIP_LAND;
        if (!is_hit()) return;
        const double from_middle =
            2 * hit.u - blank.flank.guess.edge_at(hit.radius) + blank.back.guess.edge_at(hit.radius);
        if (!(from_middle > 0 ? is_within_edge(blank.flank, hit.u) : is_within_edge(blank.back, -hit.u)))
            hit.distance = MISSED;
    }

    // Whether a place of the tip land is within the edge of a side.
    bool is_within_edge(const Side& side, double angle) {
        const double guess = side.guess.edge_at(hit.radius);
        if (std::fabs(angle - guess) > side.guess.edge_error) return angle < guess;
        const double edge = tip_edge_angle(side, blank.tip, hit.radius);
        lost += std::isnan(edge);
        return angle <= edge;
    }

    void meet_root_land(double start_radius) {
        const double reach = search_radius * (std::fabs(ray.way.z) + std::fabs(blank.root.slope));
        hit.distance = MISSED;
        if (!(ray.start.z - reach < blank.root.at(start_radius) + blank.root_bulge)) return;
        hit = cut_land(blank, ray, search_radius, [&](double radius) {
            const RootEdge edge = root_edge(blank.flank, radius);
            return Rise{edge.height, edge.slope};
        });
        part = ROOT_LAND;
        if (!is_hit()) return;
        const double first = root_edge(blank.flank, hit.radius).angle,
                     last = blank.pitch - root_edge(blank.back, hit.radius).angle;
        if (!(first <= hit.u && hit.u <= last)) hit.distance = MISSED;
    }
};

// Writes what rays hit; returns how many rays close to a surface could not be cut with it.
inline Index cut_rays(const Blank& blank, const FlankSample& sample, const Rays& rays, const Hits& hits) {
    const Index count = rays.count();
    for (double* unknown : {hits.u, hits.v, hits.radius}) std::fill_n(unknown, count, UNKNOWN);
    for (double* missed : {hits.gap, hits.continued}) std::fill_n(missed, count, MISSED);
    std::fill_n(hits.part, count, NONE);
    const auto known = std::make_unique<bool[]>(static_cast<std::size_t>(count));
    const std::vector<Index> live = rays_near_the_tooth(blank, rays);
    SideBySide(blank, rays, hits, known.get()).cut({live.data(), static_cast<Index>(live.size())});
    Index lost = 0;
    for (const Index i : live) {
        if (std::fabs(hits.gap[i]) < rays.search_radius) {
            hits.part[i] = FLANK;
            continue;
        }
        SingleRay single{blank, sample, rays[i], rays.search_radius};
        if (!known[i]) single.meet_flank();
        if (single.continued < MISSED) hits.continued[i] = single.continued;
        if (may_meet(blank, single.ray, rays.search_radius)) single.meet_the_rest();
        lost += single.lost;
        if (!single.is_hit()) continue;
        hits.gap[i] = single.hit.distance;
        hits.part[i] = single.part;
        hits.u[i] = single.hit.u;
        hits.v[i] = single.hit.v;
        hits.radius[i] = single.hit.radius;
    }
    return lost;
}

} // namespace facegear::flanks
