// Rays cut with the face gear's flank by Newton's method, many side by side.
//
// A ray alone waits for every product of its own steps. Here LANES of them step together. Each lane takes
// neighbouring rays in turn, each from where the one before met the flank.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "flanks/closed_forms.hpp"
#include "flanks/newton.hpp"
#include "flanks/ray.hpp"
#include "flanks/single_ray.hpp"
#include "tables.hpp"

namespace facegear::flanks {

constexpr int WIDTH = 4, GROUPS = 4, LANES = WIDTH * GROUPS;
// Rays that a lane takes in turn.
constexpr Index NEIGHBOURS = 64;
// Lanes that the others do not wait for: they go on beside the next rays.
constexpr int LATE = 4;
// Distance (rad) between points of neighbouring rays, in roll and psi together, up to which one starts at the
// other.
constexpr double NEAR = 0.05;
// Roll and psi (rad) of lanes without a ray.
constexpr double ANYWHERE = 0.4;

using Four = Lanes<WIDTH>;

// What WIDTH lanes keep of their rays.
struct LaneGroup {
    Vector<Four> start, way;
    Across<Four> beside;
    Four roll, psi;        // of a point of the flank
    FlankPoint<Four> at;   // there
    NewtonStep<Four> step; // from there
    Four next_roll, next_psi;
    Four length;            // where the step leads along the ray, m
    Four has_ray, is_going; // 1 or 0
};

// The rays of one lane: the one under way, -1 for none, the range of those to come, steps taken, and whether
// the one before met the flank.
struct Queue {
    Index ray = -1, next = 0, last = 0;
    int steps = 0;
    bool met_before = false;
};

class SideBySide {
  public:
    // known (n,): marked where Newton's method finds a hit or a miss.
    SideBySide(const Blank& blank, const Rays& rays, const Hits& hits, bool* known)
        : blank(blank), rays(rays), hits(hits), known(known) {
        for (int k = 0; k < LANES; ++k) {
            set_ray(k, {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}});
            group_of(k).has_ray.set(k % WIDTH, 0.0);
            send_anywhere(k);
        }
        for (LaneGroup& group : groups) take_newton_step(group);
    }

    // Cuts those of the rays that `live` numbers. Where one misses, nothing is written.
    void cut(List<const Index> live) {
        const Index together = std::min(NEIGHBOURS, (live.size + LANES - 1) / LANES);
        Index begun = 0, left = live.size;
        while (left > 0) {
            for (int k = 0; k < LANES; ++k) take_next_ray(k, live, together, begun);
            for (LaneGroup& group : groups) step_from_last(group);
            for (int k = 0; k < LANES; ++k) {
                if (queues[k].ray >= 0 && queues[k].steps == 0) start(k);
            }
            step_until_few_are_left();
            for (int k = 0; k < LANES; ++k) left -= finish(k);
        }
    }

  private:
    const Blank& blank;
    const Rays& rays;
    const Hits& hits;
    bool* known;
    std::array<LaneGroup, GROUPS> groups;
    std::array<Queue, LANES> queues;

    LaneGroup& group_of(int k) { return groups[k / WIDTH]; }

    void set_ray(int k, const Ray& ray) {
        LaneGroup& group = group_of(k);
        const Across<double> beside = across(ray.way);
        set(group.start, k, ray.start);
        set(group.way, k, ray.way);
        group.beside.x.set(k % WIDTH, beside.x);
        group.beside.z.set(k % WIDTH, beside.z);
        set(group.beside.second, k, beside.second);
    }

    static void set(Vector<Four>& all, int k, Vector<double> one) {
        all.x.set(k % WIDTH, one.x);
        all.y.set(k % WIDTH, one.y);
        all.z.set(k % WIDTH, one.z);
    }

    void go_on_from(int k, double roll, double psi) {
        group_of(k).next_roll.set(k % WIDTH, roll);
        group_of(k).next_psi.set(k % WIDTH, psi);
    }

    void send_anywhere(int k) { go_on_from(k, ANYWHERE, ANYWHERE); }

    // Gives a free lane its next ray.
    void take_next_ray(int k, List<const Index> live, Index together, Index& begun) {
        Queue& queue = queues[k];
        if (queue.ray >= 0) return;
        if (queue.next == queue.last && begun < live.size) {
            queue.next = begun;
            begun = queue.last = std::min(begun + together, live.size);
            queue.met_before = false;
        }
        if (queue.next == queue.last) return;
        queue.ray = live[queue.next++];
        set_ray(k, rays[queue.ray]);
        group_of(k).has_ray.set(k % WIDTH, 1.0);
    }

    // Newton's step from the frame that the ray before has met.
    static void step_from_last(LaneGroup& group) {
        group.step = newton_step(group.start, group.beside, group.at.frame);
    }

    void start(int k) {
        const LaneGroup& group = group_of(k);
        const int at = k % WIDTH;
        const double first = group.step.first[at], second = group.step.second[at];
        if (queues[k].met_before && std::fabs(first) + std::fabs(second) < NEAR) {
            go_on_from(k, group.roll[at] - first, group.psi[at] - second);
        } else {
            queues[k].met_before = false;
            start_at_height(k);
        }
    }

    // Near the flank's point at the radius and the height of the ray's start.
    void start_at_height(int k) {
        const LaneGroup& group = group_of(k);
        const Guess& guess = blank.flank.guess;
        const int at = k % WIDTH;
        const double x = group.start.x[at], y = group.start.y[at], z = group.start.z[at];
        const double radius = std::clamp(std::sqrt(x * x + y * y), blank.inner, blank.outer);
        const double along = radius - guess.radius;
        const double down = std::clamp(blank.tip.at(radius) - z, 0.0, guess.depth);
        go_on_from(k, Guess::at(guess.roll, along, down), Guess::at(guess.psi, along, down));
    }

    void step_until_few_are_left() {
        int longest = 0;
        for (const Queue& queue : queues) longest = std::max(longest, queue.steps);
        int taken = 0;
        double going = LANES;
        while (going > LATE && longest + taken < NEWTON_STEPS) {
            ++taken;
            Four count = Four::splat(0.0);
            for (LaneGroup& group : groups) {
                take_newton_step(group);
                count = count + group.has_ray * group.is_going;
            }
            going = count[0] + count[1] + count[2] + count[3];
        }
        for (Queue& queue : queues) queue.steps += taken;
    }

    // The flank's frames where all lanes go on, and Newton's steps from there, no longer than allowed.
    void take_newton_step(LaneGroup& group) const {
        const Four roll = group.next_roll, psi = group.next_psi;
        group.at = flank_point(blank.flank, roll, psi);
        const NewtonStep<Four> step = newton_step(group.start, group.beside, group.at.frame);
        const Four limit = Four::splat(LARGEST_STEP);
        const Four part = limit / larger(larger(absolute(step.first), absolute(step.second)), limit);
        group.roll = roll;
        group.psi = psi;
        group.step = step;
        group.next_roll = roll - part * step.first;
        group.next_psi = psi - part * step.second;
        group.length = dot(step.end, group.way);
        group.is_going = is_going(group);
    }

    // 1 where rays neither have met the flank nor are seen to miss it, and can go on, else 0.
    Four is_going(const LaneGroup& group) const {
        const Four off = group.step.off_squared, no = Four::splat(0.0), yes = Four::splat(1.0);
        const Four is_far =
            where_positive(absolute(group.length) - Four::splat(rays.search_radius + SEEN), no, yes);
        const Four size = absolute(group.step.first) + absolute(group.step.second);
        const Four is_open = where_positive(Four::splat(SEEN * SEEN) - off, is_far, yes);
        const Four is_apart = where_positive(Four::splat(NEGLIGIBLE * NEGLIGIBLE) - off, no, is_open);
        return where_positive(Four::splat(MISSED) - size, is_apart, no);
    }

    bool is_seen_to_miss(int k) const {
        const LaneGroup& group = groups[k / WIDTH];
        const bool is_far = std::fabs(group.length[k % WIDTH]) > rays.search_radius + SEEN;
        return is_far && group.step.off_squared[k % WIDTH] < SEEN * SEEN;
    }

    // Whether a lane's ray is done with: what was found is written. A ray that started where the one before
    // met the flank and did not meet it starts anew.
    bool finish(int k) {
        Queue& queue = queues[k];
        if (queue.ray < 0) {
            queue.steps = 0;
            return false;
        }
        if (queue.steps < NEWTON_STEPS && group_of(k).is_going[k % WIDTH] > 0.0) return false;
        const LaneGroup& group = group_of(k);
        const int at = k % WIDTH;
        const double roll = group.roll[at] - group.step.first[at],
                     psi = group.psi[at] - group.step.second[at];
        const double place = group.at.place[at] - group.step.second[at] * group.at.place_slope[at];
        // for larger angles the series are no cosine and sine
        const bool is_small = std::fabs(psi) < 0.5 * std::numbers::pi &&
                              std::fabs(gear_turn(blank.flank, roll, psi, place)) < SMALL;
        const bool met = group.step.off_squared[at] < NEGLIGIBLE * NEGLIGIBLE && is_small;
        const bool hit =
            met && std::fabs(group.length[at]) < rays.search_radius && faces_the_tooth(group, at);
        if (hit) {
            write(k, roll, psi, place);
        } else {
            send_anywhere(k);
        }
        const bool is_done = hit || !queue.met_before;
        if (is_done) {
            known[queue.ray] = met || is_seen_to_miss(k);
            queue.ray = -1;
            group_of(k).has_ray.set(at, 0.0);
        }
        queue.met_before = hit;
        queue.steps = 0;
        return is_done;
    }

    // Whether a lane's ray comes from outside.
    bool faces_the_tooth(const LaneGroup& group, int at) const {
        const auto one = [&](const Vector<Four>& all) {
            return Vector<double>{all.x[at], all.y[at], all.z[at]};
        };
        const Frame<Four>& frame = group.at.frame;
        return facing(blank.flank, {one(frame.point), one(frame.by_first), {}}, one(group.way)) < 0;
    }

    void write(int k, double roll, double psi, double place) {
        const LaneGroup& group = group_of(k);
        const int at = k % WIDTH;
        const Index ray = queues[k].ray;
        const Vector<Four> points = group.start + group.step.end;
        const Vector<double> point{points.x[at], points.y[at], points.z[at]};
        const double radius = radius_of(point);
        hits.continued[ray] = group.length[at];
        if (!on_flank(blank, radius, roll, point.z, place)) return;
        hits.gap[ray] = group.length[at];
        hits.u[ray] = roll;
        hits.v[ray] = psi;
        hits.radius[ray] = radius;
    }
};

} // namespace facegear::flanks
