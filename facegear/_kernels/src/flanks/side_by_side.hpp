// Rays cut with the face gear's flank by Newton's method, many side by side.
//
// A ray alone waits for every product of its own steps. Here LANES of them step together. Each lane takes
// neighbouring rays in turn, each from where the one before met the flank.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

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
    Across<Four> beside;   // as long as the part of the way across y
    Four roll, psi;        // of a point of the flank
    FlankPoint<Four> at;   // there
    NewtonStep<Four> step; // from there
    Four next_roll, next_psi;
    Four length;            // where the step leads along the ray, m
    Four facing;            // cosine of the ray with the flank's normal, times a length
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
        take_newton_steps();
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
        set(group_of(k).start, k, ray.start);
        set(group_of(k).way, k, ray.way);
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
        const Vector<Four> way = group.way;
        group.beside = {way.z, -way.x, {-(way.x * way.y), way.x * way.x + way.z * way.z, -(way.y * way.z)}};
        const NewtonStep<Four> step = newton_step(group.start, group.beside, group.at.frame);
        group.step.first = step.first;
        group.step.second = step.second;
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
            take_newton_steps();
            for (const LaneGroup& group : groups) count = count + group.has_ray * group.is_going;
            going = count[0] + count[1] + count[2] + count[3];
        }
        for (Queue& queue : queues) queue.steps += taken;
    }

    // The flank's points where all lanes go on, and Newton's steps from there, no longer than allowed. Groups
    // take each part of it together, so that none waits for its own series.
    void take_newton_steps() {
        const Side& side = blank.flank;
        std::array<Turn<Four>, GROUPS> slopes, turns;
        std::array<Generated<Four>, GROUPS> from;
        std::array<Four, GROUPS> angles;
        for (int i = 0; i < GROUPS; ++i) slopes[i] = turn_by<STEEP_TERMS>(groups[i].next_psi);
        for (int i = 0; i < GROUPS; ++i) {
            const Four roll = groups[i].next_roll;
            from[i] = generated(side, Four::splat(side.across) * roll, slopes[i]);
            angles[i] = gear_turn(side, roll, groups[i].next_psi, from[i].place);
        }
        for (int i = 0; i < GROUPS; ++i) turns[i] = turn_by<SMALL_TERMS>(angles[i]);
        for (int i = 0; i < GROUPS; ++i)
            step_from(groups[i], turned_point(side, slopes[i], from[i], angles[i], turns[i]));
    }

    void step_from(LaneGroup& group, const FlankPoint<Four>& at) const {
        const Four roll = group.next_roll, psi = group.next_psi;
        const NewtonStep<Four> step = newton_step(group.start, group.beside, at.frame);
        const Four most = Four::splat(LARGEST_STEP), least = Four::splat(-LARGEST_STEP);
        group.roll = roll;
        group.psi = psi;
        group.at = at;
        group.step = step;
        group.next_roll = roll - larger(smaller(step.first, most), least);
        group.next_psi = psi - larger(smaller(step.second, most), least);
        group.length = dot(step.end, group.way);
        group.facing = facing(blank.flank, at.frame, group.way);
        group.is_going = is_going(group);
    }

    // 1 where rays neither have met the flank nor are seen to miss it, and can go on, else 0.
    Four is_going(const LaneGroup& group) const {
        const Four off = group.step.off_squared, level = group.beside.second.y;
        const Four no = Four::splat(0.0), yes = Four::splat(1.0);
        const Four is_far =
            where_positive(absolute(group.length) - Four::splat(rays.search_radius + SEEN), no, yes);
        const Four size = absolute(group.step.first) + absolute(group.step.second);
        const Four is_open = where_positive(Four::splat(SEEN * SEEN) * level - off, is_far, yes);
        const Four is_apart = where_positive(Four::splat(NEGLIGIBLE * NEGLIGIBLE) * level - off, no, is_open);
        return where_positive(Four::splat(MISSED) - size, is_apart, no);
    }

    bool is_seen_to_miss(int k) const {
        return std::fabs(groups[k / WIDTH].length[k % WIDTH]) > rays.search_radius + SEEN &&
               is_off_by_less(k, SEEN);
    }

    // Whether a lane's ray is less than a distance (m) off the point of the flank.
    bool is_off_by_less(int k, double distance) const {
        const LaneGroup& group = groups[k / WIDTH];
        const int at = k % WIDTH;
        return group.step.off_squared[at] < distance * distance * group.beside.second.y[at];
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
        const bool is_small = std::fabs(psi) < STEEP && std::fabs(group.at.turn[at]) < SMALL;
        const bool met = is_off_by_less(k, NEGLIGIBLE) && is_small;
        const bool hit = met && group.facing[at] < 0 && std::fabs(group.length[at]) < rays.search_radius;
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

    void write(int k, double roll, double psi, double place) {
        const LaneGroup& group = group_of(k);
        const int at = k % WIDTH;
        const Index ray = queues[k].ray;
        const Vector<Four>&start = group.start, &end = group.step.end;
        const Vector<double> point{start.x[at] + end.x[at], start.y[at] + end.y[at], start.z[at] + end.z[at]};
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
