// Contact of all pairs of teeth at a position under all torques: what may touch, the strip that is expected
// to, its influence and solution, and the check of the rest.
//
// A force on one basis function moves all others away from the other gear, so that only functions whose gap a
// rigid rotation would close can touch. Most of those do not: the bodies give way around the strip that does.
// The influence matrix of the strip alone is many times cheaper, and one product shows whether the rest stays
// clear.
#pragma once

#include "contact/active_set.hpp"
#include "contact/approach.hpp"
#include "contact/basis_functions.hpp"

namespace facegear::contact {

// Where contact is sought at first (facegear/contact/position_solver.py).
struct SearchStrip {
    double gap = 0.0;         // least gap of a column of functions, over the rigid approach of the limit
    double width = 0.0;       // by how much others in it exceed that gap, over what it is below the limit
    double wider = 0.0;       // factor on the width where contact is missed beside the strip
    double begin = 0.0;       // the first guess: turn over the limit
    double begin_width = 0.0; // and width
    Table<const bool>
        near; // (p, nodes) functions that belong to the strip in any case; (0, 0) if none is known
};

// Contact under torques (t), the largest first. Without a solution under one of them its steps are 0.
struct PositionContact {
    std::vector<double> rotation, slope, residual; // (t) as in ContactSolution
    std::vector<Index> steps;                      // (t)
    Index candidates = 0;                          // functions that a rotation by the limit closes
    Index forward = 0;                             // of these, how many can carry the torque
    Index strip_size = 0;                          // among how many functions the solution is
    double overlap = 0.0; // rad, rotation that would part the teeth where they stand in each other
    // Functions (m) that are loaded by any torque, and their forces.
    std::vector<Index> pair, node;
    std::vector<double> lever_arm;
    Mask fillet;
    std::vector<double> force;       // (t, m) N
    std::vector<double> on_nodes[2]; // (t, p, c) N on the nodes of pinion and gear before refinement
};

// Solves positions one after the other in the same memory.
struct PositionSolver {
    Cover cover;
    Surface surfaces[2]; // pinion, gear
    bool coupled = true; // whether a loaded tooth moves its neighbours
    SolverLimits limits;

    // Contact of functions that a rotation by `limit` (rad) closes. If the first torque turns the pinion
    // further, only its rotation is of use.
    PositionContact solve(const FacingPoints& points, std::span<const double> torques, double limit,
                          const SearchStrip& strip) {
        find_candidates(points, limit);
        PositionContact result = begin_result(torques);
        expect(strip, limit, points.pairs());
        bool unsolved = result.forward > 0;
        strip_functions.clear();
        force.reset(static_cast<Index>(torques.size()), 0);
        // The strip is a guess. If functions beside it would penetrate, it is solved again with these and a
        // wider strip around them. No function leaves the strip, so that the loop ends at the latest with all
        // of them.
        for (double width = strip.width; unsolved; width *= strip.wider) {
            choose_strip(points);
            fill_influence(strip_forces, points.teeth, surfaces, coupled, two_sided, matrix);
            // Beyond the limit candidates are missing, so that a larger limit is tried before any check.
            if (!solve_strip(torques, limit, strip, result)) break;
            unsolved = check_others(points, strip, limit, width * strip.wider, result);
        }
        fill_loaded_functions(result);
        fill_nodal_forces(points, result);
        return result;
    }

    // Influence matrix (m, m) m/N of all functions that a rotation by `limit` (rad) closes.
    void fill_whole_influence(const FacingPoints& points, double limit) {
        find_candidates(points, limit);
        in_strip.assign(functions.count(), 1);
        choose_strip(points);
        fill_influence(strip_forces, points.teeth, surfaces, coupled, two_sided, matrix);
    }

    // The same functions' approach (m, t) m by forces (t, m) N, in the first cases[i] columns.
    // False where there is not a number of cases for each function.
    bool fill_whole_approach(const FacingPoints& points, double limit, Table<const double> forces,
                             std::span<const Index> cases) {
        find_candidates(points, limit);
        if (static_cast<Index>(cases.size()) != functions.count()) return false;
        in_strip.assign(functions.count(), 1);
        choose_strip(points);
        others.clear();
        for (Index i = 0; i < functions.count(); ++i) {
            if (cases[i] > 0) others.push_back(i, cases[i]);
        }
        count_pairs(others.row, points.pairs(), other_ends);
        approach.fill(others, other_ends, every, surfaces, points.teeth, strip_forces, forces, coupled,
                      moved);
        return true;
    }

    BasisFunctions functions; // that may touch
    OwnedTable matrix;        // influence of the strip's functions
    OwnedTable moved;         // approach of the others
    WantedRows others;        // functions beside the strip that the rotation would close

  private:
    GapClosing closing;
    NodalSpreading spreading;
    SparseRowList every[2];     // nodal forces of all functions on both refined surfaces
    std::vector<double> turn;   // (n) rad that closes each function's gap
    std::vector<double> column; // (n) rad, the least of it in the function's column across the profile
    std::vector<double> of_column;
    Mask in_strip;                      // (n)
    std::vector<Index> strip_functions; // (m) numbers of the strip's functions
    FunctionForces strip_forces;
    TwoSidedAverage two_sided;
    ActiveSetSolver active_set;
    Approach approach;
    OwnedTable force; // (t, m) N on the strip's functions
    std::vector<Index> other_ends;
    std::vector<double> strip_gap, strip_arm;
    Mask start;

    void find_candidates(const FacingPoints& points, double limit) {
        closing.find(points, cover, limit, functions);
        spreading.spread(functions.average, points.pinion, surfaces[0].faces, every[0]);
        spreading.spread(functions.average, points.gear, surfaces[1].faces, every[1]);
    }

    PositionContact begin_result(std::span<const double> torques) const {
        PositionContact result;
        result.rotation.assign(torques.size(), 0.0);
        result.slope = result.residual = result.rotation;
        result.steps.assign(torques.size(), 0);
        result.candidates = functions.count();
        for (Index i = 0; i < functions.count(); ++i) {
            const double arm = functions.lever_arm[i];
            if (!(arm > 0.0)) continue;
            ++result.forward;
            result.overlap = std::max(result.overlap, -functions.gap[i] / arm);
        }
        return result;
    }

    void fill_turns(Index pairs) {
        constexpr double infinite = std::numeric_limits<double>::infinity();
        turn.assign(functions.count(), infinite);
        column.resize(functions.count());
        of_column.assign(pairs * cover.columns, infinite);
        for (Index i = 0; i < functions.count(); ++i) {
            // Rotation opens functions without a positive lever arm: no rotation closes them.
            if (!(functions.lever_arm[i] > 0.0)) continue;
            turn[i] = functions.gap[i] / functions.lever_arm[i];
            double& least = of_column[column_of(i)];
            least = std::min(least, turn[i]);
        }
        for (Index i = 0; i < functions.count(); ++i) column[i] = of_column[column_of(i)];
    }

    Index column_of(Index i) const {
        return functions.pair[i] * cover.columns + functions.node[i] % cover.columns;
    }

    // The lesser a column's least turn, the wider the strip is in it.
    bool expected(Index i, double least_turn, double width) const {
        return turn[i] - column[i] < width * (least_turn - column[i]);
    }

    // Mark the strip; all functions where none of it can carry a torque.
    void expect(const SearchStrip& strip, double limit, Index pairs) {
        fill_turns(pairs);
        in_strip.assign(functions.count(), 0);
        bool drives = false;
        for (Index i = 0; i < functions.count(); ++i) {
            const bool known = strip.near.rows > 0 && strip.near(functions.pair[i], functions.node[i]);
            in_strip[i] = known || expected(i, strip.gap * limit, strip.width);
            drives = drives || (in_strip[i] && functions.lever_arm[i] > 0.0);
        }
        // A strip in which no lever arm is positive cannot carry a torque: it would have no equilibrium.
        if (!drives) in_strip.assign(functions.count(), 1);
    }

    // Ends (p + 1) of the functions of each pair among some of them, 0 first.
    void count_pairs(std::span<const Index> which, Index pairs, std::vector<Index>& ends) const {
        ends.assign(pairs + 1, 0);
        for (const Index i : which) ++ends[functions.pair[i] + 1];
        for (Index pair = 0; pair < pairs; ++pair) ends[pair + 1] += ends[pair];
    }

    void choose_strip(const FacingPoints& points) {
        strip_functions.clear();
        strip_gap.clear();
        strip_arm.clear();
        for (SparseRowList& rows : strip_forces.refined) rows.clear();
        for (Index i = 0; i < functions.count(); ++i) {
            if (!in_strip[i]) continue;
            strip_functions.push_back(i);
            strip_gap.push_back(functions.gap[i]);
            strip_arm.push_back(functions.lever_arm[i]);
            for (int side = 0; side < 2; ++side) strip_forces.refined[side].append(every[side], i);
        }
        count_pairs(strip_functions, points.pairs(), strip_forces.ends);
        for (int side = 0; side < 2; ++side) {
            const Surface& body = surfaces[side];
            spreading.compose(strip_forces.refined[side], body.interpolation, body.coarse_nodes,
                              strip_forces.coarse[side]);
        }
    }

    // Solve the strip under all torques; false where one has no solution or the first turns the pinion beyond
    // the limit.
    bool solve_strip(std::span<const double> torques, double limit, const SearchStrip& strip,
                     PositionContact& result) {
        const auto count = static_cast<Index>(strip_functions.size());
        force.reset(static_cast<Index>(torques.size()), count);
        start.resize(count);
        for (Index i = 0; i < count; ++i)
            start[i] = expected(strip_functions[i], strip.begin * limit, strip.begin_width);
        const OwnedTable& influence = matrix;
        ContactProblem problem{influence.view(), strip_gap, strip_arm, 0.0};
        // From the largest torque down: its contact is widest, and each solution is a good first guess of the
        // next.
        for (std::size_t t = 0; t < torques.size(); ++t) {
            problem.torque = torques[t];
            const ContactSolution solution = active_set.solve(problem, start, limits);
            result.steps[t] = solution.steps;
            result.rotation[t] = solution.rotation;
            result.slope[t] = solution.slope;
            result.residual[t] = solution.residual;
            std::copy_n(active_set.force.begin(), count, force.row(static_cast<Index>(t)));
            // The first torque turns furthest; if the limit holds for it, it holds for all.
            if (solution.steps == 0 || result.rotation[0] > limit) return false;
            // the next torque begins with the points that would still press if the same ones touched
            const double following = torques[std::min(t + 1, torques.size() - 1)] - torques[t];
            for (Index i = 0; i < count; ++i)
                start[i] = active_set.force[i] + following * active_set.change[i] > 0.0;
        }
        return true;
    }

    // Check the functions beside the strip; those that would penetrate join it, with a wider strip around
    // them. Whether there are any.
    bool check_others(const FacingPoints& points, const SearchStrip& strip, double limit, double wider,
                      PositionContact& result) {
        const auto count = static_cast<Index>(result.rotation.size());
        others.clear();
        double longest = 0.0;
        for (Index i = 0; i < functions.count(); ++i) {
            longest = std::max(longest, std::fabs(functions.lever_arm[i]));
            // A body gives way but never comes nearer: a gap that the rotation alone leaves open stays open,
            // and its approach is not computed.
            Index cases = 0; // up to the last torque whose rotation would close the gap
            for (Index t = 0; t < (in_strip[i] ? 0 : count); ++t) {
                if (functions.gap[i] < result.rotation[t] * functions.lever_arm[i]) cases = t + 1;
            }
            if (cases > 0) others.push_back(i, cases);
        }
        if (others.row.empty()) return false;
        count_pairs(others.row, points.pairs(), other_ends);
        const OwnedTable& pushing = force;
        approach.fill(others, other_ends, every, surfaces, points.teeth, strip_forces, pushing.view(),
                      coupled, moved);
        bool missed = false;
        for (std::size_t k = 0; k < others.row.size(); ++k) {
            const Index i = others.row[k];
            double deepest = 0.0;
            for (Index t = 0; t < others.cases[k]; ++t) {
                const double rotation = result.rotation[t];
                const double distance =
                    functions.gap[i] + moved(static_cast<Index>(k), t) - rotation * functions.lever_arm[i];
                const double part = -distance / (std::fabs(rotation) * longest);
                deepest = std::max(deepest, part);
                result.residual[t] = std::max(result.residual[t], part);
            }
            in_strip[i] = deepest > limits.tolerance;
            missed = missed || in_strip[i];
        }
        // A missed function shows that the strip is too narrow there; its neighbours join at once, as each
        // would be missed in the next round.
        for (const Index i : others.row) {
            if (missed && expected(i, strip.gap * limit, wider)) in_strip[i] = 1;
        }
        return missed;
    }

    // What the loaded functions are, with their forces.
    void fill_loaded_functions(PositionContact& result) const {
        const Index torques = force.rows, count = force.columns;
        const Table<const double> forces = force.view();
        result.strip_size = count;
        std::vector<Index> loaded;
        for (Index i = 0; i < count; ++i) {
            for (Index t = 0; t < torques; ++t) {
                if (!(forces(t, i) > 0.0)) continue;
                loaded.push_back(i);
                break;
            }
        }
        for (const Index i : loaded) {
            const Index number = strip_functions[i];
            result.pair.push_back(functions.pair[number]);
            result.node.push_back(functions.node[number]);
            result.lever_arm.push_back(functions.lever_arm[number]);
            result.fillet.push_back(functions.fillet[number]);
        }
        for (Index t = 0; t < torques; ++t) {
            for (const Index i : loaded) result.force.push_back(forces(t, i));
        }
    }

    // Forces on the nodes before refinement.
    void fill_nodal_forces(const FacingPoints& points, PositionContact& result) const {
        const Index torques = force.rows, count = force.columns;
        const Table<const double> forces = force.view();
        for (int side = 0; side < 2; ++side) {
            const Index nodes = surfaces[side].coarse_nodes, pairs = points.pairs();
            result.on_nodes[side].assign(torques * pairs * nodes, 0.0);
            for (Index pair = 0; count > 0 && pair < pairs; ++pair) {
                const SparseRows rows = strip_forces.coarse_of(side, pair);
                for (Index i = 0; i < rows.count(); ++i) {
                    const auto columns = rows.columns(i);
                    const auto weights = rows.weights(i);
                    for (Index t = 0; t < torques; ++t) {
                        const double pushed = forces(t, strip_forces.ends[pair] + i);
                        if (pushed == 0.0) continue;
                        double* total = result.on_nodes[side].data() + (t * pairs + pair) * nodes;
                        for (std::size_t k = 0; k < columns.size(); ++k)
                            total[columns[k]] += weights[k] * pushed;
                    }
                }
            }
        }
    }
};

} // namespace facegear::contact
