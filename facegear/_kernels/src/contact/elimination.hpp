// Assembly of fronts in the elimination of sparse matrices (Duff and Reid 1983); lower triangles alone.
#pragma once

#include "contact/arrays.hpp"

namespace facegear::contact {

// A table whose columns are contiguous.
struct ColumnTable {
    double* data = nullptr;
    Index rows = 0;
    Index columns = 0;

    double& operator()(Index row, Index column) const { return data[row + column * rows]; }
    double* column(Index number) const { return data + number * rows; }
};

// A front: p unknowns that are eliminated, and m that it is coupled to.
struct Front {
    ColumnTable pivots; // (p, p)
    ColumnTable below;  // (m, p)
    ColumnTable update; // (m, m) what remains for the fronts after it

    void add(Index row, Index column, double value) const {
        const Index size = pivots.rows;
        if (column >= size) {
            update(row - size, column - size) += value;
        } else if (row >= size) {
            below(row - size, column) += value;
        } else {
            pivots(row, column) += value;
        }
    }
};

// Add element matrices (k, a, a). Row `rows(e, a)` of `unknowns` says by which unknowns, with which weights,
// each row of matrix e moves; `place` says where in the front an unknown stands.
inline void add_elements(Table<const double> matrices, Table<const Index> rows, SparseRows unknowns,
                         std::span<const Index> place, const Front& front) {
    for (Index element = 0; element < rows.rows; ++element) {
        const double* matrix = matrices.row(element);
        for (Index a = 0; a < rows.columns; ++a) {
            const Index moved = rows(element, a);
            for (Index p = unknowns.pointer[moved]; p < unknowns.pointer[moved + 1]; ++p) {
                const Index column = place[unknowns.index[p]];
                for (Index b = 0; b < rows.columns; ++b) {
                    const double entry = unknowns.weight[p] * matrix[a * rows.columns + b];
                    const Index other = rows(element, b);
                    for (Index q = unknowns.pointer[other]; q < unknowns.pointer[other + 1]; ++q) {
                        const Index row = place[unknowns.index[q]];
                        if (row >= column) front.add(row, column, entry * unknowns.weight[q]);
                    }
                }
            }
        }
    }
}

// Add the lower triangle of an earlier front's update (c, c) to the places (c), rising, of its unknowns.
inline void extend_add(ColumnTable added, std::span<const Index> place, const Front& front) {
    const Index size = front.pivots.rows, count = added.rows;
    const Index inside = std::lower_bound(place.begin(), place.end(), size) - place.begin();
    for (Index j = 0; j < inside; ++j) {
        const double* values = added.column(j);
        double* pivots = front.pivots.column(place[j]);
        double* below = front.below.column(place[j]);
        for (Index i = j; i < inside; ++i) pivots[place[i]] += values[i];
        for (Index i = inside; i < count; ++i) below[place[i] - size] += values[i];
    }
    for (Index j = inside; j < count; ++j) {
        const double* values = added.column(j);
        double* update = front.update.column(place[j] - size);
        for (Index i = j; i < count; ++i) update[place[i] - size] += values[i];
    }
}

} // namespace facegear::contact
