// The active set of a frictionless contact: forces f >= 0 and a rotation r with
//   gap + C f - r a >= 0,   f . (gap + C f - r a) = 0,   a . f = torque,
// a the lever arms (docs/explanation/contact.md, "What is solved").
#pragma once

#include <cmath>
#include <limits>

#include "contact/cholesky.hpp"

namespace facegear::contact {

struct ContactProblem {
    Table<const double> compliance;    // (n, n) m/N, symmetric
    std::span<const double> gap;       // (n) m
    std::span<const double> lever_arm; // (n) m
    double torque = 0.0;               // N m

    Index points() const { return static_cast<Index>(gap.size()); }
};

struct SolverLimits {
    Index newton_steps = 0;
    double tolerance = 0.0; // penetration over the largest displacement
};

struct ContactSolution {
    Index steps = 0;       // of the active set, 0 without a solution
    double rotation = 0.0; // rad
    double slope = 0.0;    // rad/(N m), of the rotation over the torque while the same points touch
    double residual = 0.0; // largest relative violation of the conditions
};

// Exchanges of single points after which n points count as not solved.
inline Index exchange_steps(Index points) { return 20 * points + 100; }

// Distance (n) m of all points by forces, of which most are zero, and a rotation: gap + C f - r a.
inline void fill_distances(const ContactProblem& problem, std::span<const double> force, double rotation,
                           std::span<double> distance) {
    const Index count = problem.points();
    for (Index i = 0; i < count; ++i) distance[i] = problem.gap[i] - rotation * problem.lever_arm[i];
    for (Index j = 0; j < count; ++j) {
        if (force[j] == 0.0) continue;
        const double* column = problem.compliance.row(j);
        for (Index i = 0; i < count; ++i) distance[i] += force[j] * column[i];
    }
}

// Largest relative violation of balance, no tension, no penetration and complementarity, by the distances (n)
// m.
inline double violation(const ContactProblem& problem, std::span<const double> force, double rotation,
                        std::span<const double> distance) {
    double turned = 0.0, nearest = 0.0, touching = 0.0, balance = 0.0, deepest = 0.0;
    double pulling = force[0], pressing = force[0];
    for (Index i = 0; i < problem.points(); ++i) {
        turned = std::max(turned, std::fabs(rotation * problem.lever_arm[i]));
        balance += problem.lever_arm[i] * force[i];
        deepest = std::max(deepest, -distance[i]);
        pulling = std::min(pulling, force[i]);
        pressing = std::max(pressing, force[i]);
        if (force[i] == 0.0) continue;
        nearest = std::max(nearest, std::fabs(problem.gap[i]));
        touching = std::max(touching, std::fabs(distance[i]));
    }
    const double scale = turned + nearest;
    const double worst = std::max(std::fabs(balance - problem.torque) / problem.torque, -pulling / pressing);
    return std::max({worst, deepest / scale, touching / scale});
}

// What happens if exactly some points touch: C f = r a - gap among them, and a . f = torque.
struct TouchingPoints {
    std::vector<Index> index;    // (k)
    CholeskyFactor factor;       // of their compliance (k, k)
    std::vector<double> turning; // (k) N/rad, forces by a unit rotation
    std::vector<double> closing; // (k) N, forces that would close the gaps
    double stiffness = 0.0;      // N m/rad
    double rotation = 0.0;       // rad

    // Forces (n) N are filled in; false where the compliance is not positive definite.
    bool solve(const ContactProblem& problem, const Mask& active, std::span<double> force) {
        index.clear();
        for (Index i = 0; i < problem.points(); ++i) {
            if (active[i]) index.push_back(i);
        }
        if (!factorise(problem.compliance)) return false;
        const auto size = static_cast<Index>(index.size());
        turning.resize(size);
        closing.resize(size);
        for (Index i = 0; i < size; ++i) {
            turning[i] = problem.lever_arm[index[i]];
            closing[i] = problem.gap[index[i]];
        }
        factor.solve(turning.data(), closing.data());
        stiffness = moment(problem, turning);
        rotation = (problem.torque + moment(problem, closing)) / stiffness;
        std::fill(force.begin(), force.end(), 0.0);
        for (Index i = 0; i < size; ++i) force[index[i]] = rotation * turning[i] - closing[i];
        return true;
    }

    // One step of iterative refinement of the forces (n) N and the rotation.
    void refine(const ContactProblem& problem, std::span<double> force, std::span<double> distance) {
        fill_distances(problem, force, rotation, distance);
        const auto size = static_cast<Index>(index.size());
        std::vector<double>& change = closing;
        unused.assign(size, 0.0);
        double missing = problem.torque;
        for (Index i = 0; i < size; ++i) {
            change[i] = distance[index[i]];
            missing -= problem.lever_arm[index[i]] * force[index[i]];
        }
        factor.solve(change.data(), unused.data());
        const double turn = (missing + moment(problem, change)) / stiffness;
        for (Index i = 0; i < size; ++i) force[index[i]] += turn * turning[i] - change[i];
        rotation += turn;
    }

  private:
    std::vector<double> unused;

    bool factorise(Table<const double> compliance) {
        const auto size = static_cast<Index>(index.size());
        factor.resize(size);
        for (Index i = 0; i < size; ++i) {
            const double* row = compliance.row(index[i]);
            double* to = factor.upper.row(i);
            for (Index j = i; j < size; ++j) to[j] = row[index[j]];
        }
        return factor.factorise();
    }

    double moment(const ContactProblem& problem, const std::vector<double>& part) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < part.size(); ++i) sum += problem.lever_arm[index[i]] * part[i];
        return sum;
    }
};

// Solves contact problems one after the other in the same memory.
struct ActiveSetSolver {
    std::vector<double> force;  // (n) N of the last solution
    std::vector<double> change; // (n) N/(N m) of its forces with the torque, while the same points touch

    // Newton's method from the points `start` (n) that touch, and where that fails an exchange of one at a
    // time.
    ContactSolution solve(const ContactProblem& problem, const Mask& start, const SolverLimits& limits) {
        const Index count = problem.points();
        force.assign(count, 0.0);
        change.assign(count, 0.0);
        distance.resize(count);
        active = start;
        if (!drives(problem, active)) guess_first(problem);
        const ContactSolution solution = newton(problem, limits);
        if (solution.steps > 0) return solution;
        return exchange(problem, limits);
    }

  private:
    static constexpr double INFINITE = std::numeric_limits<double>::infinity();
    // A force this small a part of the largest has come to zero in an exchange.
    static constexpr double RELEASED = 1e-14;

    TouchingPoints touching;
    std::vector<double> distance; // (n) m
    std::vector<double> target;   // (n) N
    std::vector<double> turns;    // (n) rad that close each gap
    Mask active, following;       // (n)
    std::vector<Mask> earlier;    // sets of the steps before

    static bool drives(const ContactProblem& problem, const Mask& points) {
        for (Index i = 0; i < problem.points(); ++i) {
            if (points[i] && problem.lever_arm[i] > 0.0) return true;
        }
        return false;
    }

    void fill_turns(const ContactProblem& problem) {
        turns.assign(problem.points(), INFINITE);
        for (Index i = 0; i < problem.points(); ++i) {
            if (problem.lever_arm[i] > 0.0) turns[i] = problem.gap[i] / problem.lever_arm[i];
        }
    }

    // Begin with the quarter of the points whose gaps close first.
    void guess_first(const ContactProblem& problem) {
        fill_turns(problem);
        target = turns;
        const auto driving = static_cast<Index>(
            std::count_if(turns.begin(), turns.end(), [](double turn) { return turn < INFINITE; }));
        const auto last = target.begin() + std::max(driving - 1, Index{0}) / 4;
        std::nth_element(target.begin(), last, target.end());
        for (Index i = 0; i < problem.points(); ++i) active[i] = turns[i] <= *last;
    }

    // Displacement of which a penetration is a rounding error: the largest by the rotation and the widest gap
    // closed.
    double scale(const ContactProblem& problem) const {
        double turned = 0.0, nearest = 0.0;
        for (Index i = 0; i < problem.points(); ++i) {
            turned = std::max(turned, std::fabs(touching.rotation * problem.lever_arm[i]));
            if (active[i]) nearest = std::max(nearest, std::fabs(problem.gap[i]));
        }
        return turned + nearest;
    }

    ContactSolution finish(const ContactProblem& problem, Index steps) {
        for (std::size_t i = 0; i < touching.index.size(); ++i) {
            change[touching.index[i]] = touching.turning[i] / touching.stiffness;
        }
        // The factor of an ill-conditioned matrix loses digits, which corrections by the true distances
        // restore.
        touching.refine(problem, force, distance);
        touching.refine(problem, force, distance);
        fill_distances(problem, force, touching.rotation, distance);
        const double residual = violation(problem, force, touching.rotation, distance);
        return {steps, touching.rotation, 1.0 / touching.stiffness, residual};
    }

    // Primal-dual active set, a semismooth Newton method (Hintermueller et al. 2003).
    ContactSolution newton(const ContactProblem& problem, const SolverLimits& limits) {
        earlier.clear();
        for (Index step = 1; step <= limits.newton_steps; ++step) {
            if (!touching.solve(problem, active, force)) return {};
            fill_distances(problem, force, touching.rotation, distance);
            // A penetration of rounding size must not bring a point in: it would leave in the next step.
            const double edge = -limits.tolerance * scale(problem);
            following.resize(active.size());
            for (Index i = 0; i < problem.points(); ++i) {
                following[i] = active[i] ? force[i] > 0.0 : distance[i] < edge;
            }
            if (following == active) return finish(problem, step);
            // A set that comes again would come for ever; the exchange cannot cycle and takes over.
            if (std::find(earlier.begin(), earlier.end(), following) != earlier.end()) return {};
            if (!drives(problem, following)) return {};
            earlier.push_back(following);
            active = following;
        }
        return {};
    }

    // Forces without tension that carry the torque: those of the last set, or one where the gap closes first.
    void press_feasibly(const ContactProblem& problem) {
        double carried = 0.0;
        for (Index i = 0; i < problem.points(); ++i) {
            force[i] = std::max(force[i], 0.0);
            carried += problem.lever_arm[i] * force[i];
        }
        if (carried > 0.0) {
            for (double& each : force) each *= problem.torque / carried;
            return;
        }
        fill_turns(problem);
        const auto first = std::min_element(turns.begin(), turns.end()) - turns.begin();
        std::fill(force.begin(), force.end(), 0.0);
        force[first] = problem.torque / problem.lever_arm[first];
    }

    // One point at a time from feasible forces. The energy falls at every step, so that no set comes twice.
    ContactSolution exchange(const ContactProblem& problem, const SolverLimits& limits) {
        press_feasibly(problem);
        for (std::size_t i = 0; i < force.size(); ++i) active[i] = force[i] > 0.0;
        target.resize(force.size());
        for (Index step = 0; step < exchange_steps(problem.points()); ++step) {
            if (!touching.solve(problem, active, target)) return {};
            // Points are released before one is added: only feasible forces lower the energy.
            if (release(target)) continue;
            force = target;
            fill_distances(problem, force, touching.rotation, distance);
            const Index worst = deepest(problem);
            if (worst < 0 || distance[worst] >= -limits.tolerance * scale(problem)) {
                return finish(problem, limits.newton_steps + step);
            }
            active[worst] = 1;
        }
        return {};
    }

    // Go towards forces with tension as far as none pulls, and release the points whose forces vanish there.
    bool release(const std::vector<double>& wanted) {
        double fraction = INFINITE, largest = 0.0;
        for (const Index i : touching.index) {
            if (wanted[i] <= 0.0) fraction = std::min(fraction, force[i] / (force[i] - wanted[i]));
        }
        if (!(fraction < INFINITE)) return false;
        for (std::size_t i = 0; i < force.size(); ++i) {
            force[i] += fraction * (wanted[i] - force[i]);
            largest = std::max(largest, force[i]);
        }
        for (const Index i : touching.index) {
            if (wanted[i] <= 0.0 && force[i] <= RELEASED * largest) active[i] = 0;
        }
        return true;
    }

    // The point that stands deepest among those that do not touch, -1 where all touch.
    Index deepest(const ContactProblem& problem) const {
        Index worst = -1;
        for (Index i = 0; i < problem.points(); ++i) {
            if (!active[i] && (worst < 0 || distance[i] < distance[worst])) worst = i;
        }
        return worst;
    }
};

} // namespace facegear::contact
