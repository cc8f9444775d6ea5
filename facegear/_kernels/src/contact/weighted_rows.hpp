// Weighted sums of a matrix's rows, the products that most of a contact's time goes to.
#pragma once

#include "contact/arrays.hpp"
#include "simd.hpp"

namespace facegear::contact {

using Vector = Lanes<4>;
constexpr Index LANES = 4;

// Blocks of four neighbouring columns that hold all columns in use, so that they are read together.
struct ColumnBlocks {
    std::vector<Index> begin; // (b) first column of each block, rising
    std::vector<Index>
        slot;  // (columns) place of a column among the 4 b columns of the blocks, -1 if not in use
    Mask used; // (columns)

    void begin_with(Index columns) { used.assign(columns, 0); }
    void mark(std::span<const Index> columns) {
        for (const Index column : columns) used[column] = 1;
    }
    // Blocks of the marked columns; the matrix has four columns or more.
    void make() {
        const auto count = static_cast<Index>(used.size());
        begin.clear();
        slot.assign(count, -1);
        for (Index column = 0; column < count; ++column) {
            if (!used[column]) continue;
            if (begin.empty() || column >= begin.back() + LANES)
                begin.push_back(std::min(column, count - LANES));
            slot[column] = LANES * (static_cast<Index>(begin.size()) - 1) + column - begin.back();
        }
    }
    Index blocks() const { return static_cast<Index>(begin.size()); }
};

// Rows in use, copied one behind the other: rows of a large matrix each lie on a page of memory of their own,
// and finding pages takes longer than the sums.
struct UsedRows {
    std::vector<Index> row;  // (u) rows in use, rising
    std::vector<Index> slot; // (rows) number of each row among these, -1 if not in use
    OwnedTable values;       // (u, columns) a part of their columns

    void find(std::span<const Index> rows, Index count) {
        slot.assign(count, -1);
        for (const Index each : rows) slot[each] = 0;
        number_rows();
    }
    // The same where the rows in use are marked by 0 in `slot` already.
    void number_rows() {
        row.clear();
        for (std::size_t each = 0; each < slot.size(); ++each) {
            if (slot[each] < 0) continue;
            slot[each] = static_cast<Index>(row.size());
            row.push_back(static_cast<Index>(each));
        }
    }
    Index count() const { return static_cast<Index>(row.size()); }

    // Copy blocks of columns that begin at `begin` of the rows from `first` up to `last`.
    void copy(Table<const double> matrix, Index first, Index last, std::span<const Index> begin) {
        values.resize(last - first, LANES * static_cast<Index>(begin.size()));
        for (Index each = first; each < last; ++each)
            copy_row(matrix.row(row[each]), begin, values.row(each - first));
    }
    static void copy_row(const double* from, std::span<const Index> begin, double* to) {
        for (const Index column : begin) {
            Vector::load(from + column).store(to);
            to += LANES;
        }
    }
};

// sums[v] += weight[k] * row[k] of a table, from `column` on, for `Count` vectors of four columns.
template <int Count>
inline void sum_rows(Table<const double> table, std::span<const Index> row, std::span<const double> weight,
                     Index column, Vector* sums) {
    Vector sum[Count];
    for (int v = 0; v < Count; ++v) sum[v] = sums[v];
    for (std::size_t k = 0; k < row.size(); ++k) {
        const double* values = table.row(row[k]) + column;
        const Vector factor = Vector::splat(weight[k]);
        for (int v = 0; v < Count; ++v)
            sum[v] = multiply_add(factor, Vector::load(values + LANES * v), sum[v]);
    }
    for (int v = 0; v < Count; ++v) sums[v] = sum[v];
}

// The same for any number of vectors.
inline void sum_rows(Table<const double> table, std::span<const Index> row, std::span<const double> weight,
                     Index column, Vector* sums, Index count) {
    Index v = 0;
    for (; v + 8 <= count; v += 8) sum_rows<8>(table, row, weight, column + LANES * v, sums + v);
    for (; v + 4 <= count; v += 4) sum_rows<4>(table, row, weight, column + LANES * v, sums + v);
    for (; v < count; ++v) sum_rows<1>(table, row, weight, column + LANES * v, sums + v);
}

} // namespace facegear::contact
