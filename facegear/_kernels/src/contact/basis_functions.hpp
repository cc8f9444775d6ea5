// Basis functions of the pressure over points that face the other gear, and which of them a rotation closes.
#pragma once

#include <cmath>

#include "contact/arrays.hpp"

namespace facegear::contact {

// Points (q) of the pinion that may face a tooth of the gear, pair of teeth by pair of teeth.
struct FacingPoints {
    std::span<const double> gap;       // (q) m, not finite where nothing is opposite
    std::span<const double> lever_arm; // (q) m
    Table<const double> pinion;        // (q, 2) refined lattice coordinates on the pinion
    Table<const double> gear;          // (q, 2) on the gear, not finite where nothing is opposite
    Table<const Index> function;       // (q, 4) basis functions that are not zero at a point
    Table<const double> value;         // (q, 4) their values there
    std::span<const double> area;      // (q) m2 (m in an edge's node distances) that a point stands for
    std::span<const Index> starts;     // (p + 1) first point of each pair
    std::span<const Index> teeth;      // (p) number of each pair

    Index pairs() const { return static_cast<Index>(teeth.size()); }
    bool face(Index q) const {
        return std::isfinite(gap[q] + pinion(q, 0) + pinion(q, 1) + gear(q, 0) + gear(q, 1));
    }
};

// All basis functions of a pair of teeth: those of the gear's tip edge, of the pinion's lattice, of its tip
// edge.
struct Cover {
    std::span<const double> min_area; // (n) m2: with less of it opposite a tooth, a function is left out
    Index first = 0;                  // number of the function of the lattice's first node
    Index rows = 0;                   // nodes of the refined lattice across the profile
    Index columns = 0;                // nodes along the width
    double pinion_flank_end = 0.0;    // refined row beyond which the pinion's fillet begins
    double gear_flank_end = 0.0;      // the same of the gear
};

// Basis functions (m) that may touch, pair by pair.
struct BasisFunctions {
    std::vector<Index> pair;       // (m) row in the teeth of FacingPoints
    std::vector<Index> node;       // (m) lattice node, of an edge function the nearest
    std::vector<double> gap;       // (m) m, mean over the function
    std::vector<double> lever_arm; // (m) m, mean over the function
    Mask fillet;                   // (m) whether most of it lies on a fillet of either gear
    SparseRowList average;         // (m, q) weights of the points in a mean over the function

    Index count() const { return static_cast<Index>(pair.size()); }
    void clear() {
        pair.clear();
        node.clear();
        gap.clear();
        lever_arm.clear();
        fillet.clear();
        average.clear();
    }
};

// What is summed over the points of one basis function, by area.
struct FunctionSums {
    double covered = 0.0;   // m2
    double gap = 0.0;       // m3
    double lever_arm = 0.0; // m3
    double fillet = 0.0;    // m2
    Index points = 0;
    Index slot = -1; // where its next point is put, -1 if it does not close
};

// Difference of weights that count as equal where the heaviest point of a function is looked for.
constexpr double EQUAL_WEIGHTS = 1e-12;

inline Index nearest_node(const BasisFunctions& functions, Index row, Table<const double> at,
                          const Cover& cover) {
    const SparseRows average = functions.average;
    const auto points = average.columns(row);
    const auto weights = average.weights(row);
    std::size_t best = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        if (weights[k] > weights[best] + EQUAL_WEIGHTS) best = k;
    }
    const double* place = at.row(points[best]);
    const double last_row = static_cast<double>(cover.rows - 1),
                 last_column = static_cast<double>(cover.columns - 1);
    const auto across = static_cast<Index>(std::clamp(std::rint(place[0]), 0.0, last_row));
    const auto along = static_cast<Index>(std::clamp(std::rint(place[1]), 0.0, last_column));
    return across * cover.columns + along;
}

// Finds the basis functions whose mean gap a rotation of the pinion closes.
struct GapClosing {
    std::vector<FunctionSums> sums; // (p n)
    Mask facing;                    // (q)

    // Fill in the functions with gap < limit * lever arm, `limit` in rad.
    void find(const FacingPoints& points, const Cover& cover, double limit, BasisFunctions& found) {
        sum_up(points, cover);
        choose(points, cover, limit, found);
        list_points(points, cover, found);
        const Index nodes = cover.rows * cover.columns;
        for (Index i = 0; i < found.count(); ++i) {
            if (found.node[i] < 0 || found.node[i] >= nodes)
                found.node[i] = nearest_node(found, i, points.pinion, cover);
        }
    }

  private:
    void sum_up(const FacingPoints& points, const Cover& cover) {
        const auto size = static_cast<Index>(cover.min_area.size());
        sums.assign(points.pairs() * size, {});
        facing.assign(points.gap.size(), 0);
        for (Index pair = 0; pair < points.pairs(); ++pair) {
            for (Index q = points.starts[pair]; q < points.starts[pair + 1]; ++q) {
                facing[q] = points.face(q);
                if (!facing[q]) continue;
                const bool fillet =
                    points.pinion(q, 0) > cover.pinion_flank_end || points.gear(q, 0) > cover.gear_flank_end;
                for (Index k = 0; k < points.function.columns; ++k) {
                    const double part = points.value(q, k) * points.area[q];
                    if (points.value(q, k) == 0.0) continue;
                    FunctionSums& sum = sums[pair * size + points.function(q, k)];
                    sum.covered += part;
                    sum.gap += part * points.gap[q];
                    sum.lever_arm += part * points.lever_arm[q];
                    sum.fillet += fillet ? part : 0.0;
                    ++sum.points;
                }
            }
        }
    }

    void choose(const FacingPoints& points, const Cover& cover, double limit, BasisFunctions& found) {
        const auto size = static_cast<Index>(cover.min_area.size());
        found.clear();
        Index filled = 0;
        for (Index number = 0; number < points.pairs() * size; ++number) {
            FunctionSums& sum = sums[number];
            if (!(sum.covered > cover.min_area[number % size])) continue;
            const double gap = sum.gap / sum.covered, lever_arm = sum.lever_arm / sum.covered;
            if (!(gap < limit * lever_arm)) continue;
            found.pair.push_back(number / size);
            found.node.push_back(number % size - cover.first);
            found.gap.push_back(gap);
            found.lever_arm.push_back(lever_arm);
            found.fillet.push_back(sum.fillet > 0.5 * sum.covered);
            sum.slot = filled;
            filled += sum.points;
            found.average.pointer.push_back(filled);
        }
        found.average.index.resize(filled);
        found.average.weight.resize(filled);
    }

    void list_points(const FacingPoints& points, const Cover& cover, BasisFunctions& found) {
        const auto size = static_cast<Index>(cover.min_area.size());
        for (Index pair = 0; pair < points.pairs(); ++pair) {
            for (Index q = points.starts[pair]; q < points.starts[pair + 1]; ++q) {
                for (Index k = 0; k < (facing[q] ? points.function.columns : 0); ++k) {
                    FunctionSums& sum = sums[pair * size + points.function(q, k)];
                    if (points.value(q, k) == 0.0 || sum.slot < 0) continue;
                    found.average.index[sum.slot] = q;
                    found.average.weight[sum.slot] = points.value(q, k) * points.area[q] / sum.covered;
                    ++sum.slot;
                }
            }
        }
    }
};

} // namespace facegear::contact
