// Tables and sparse rows: views of memory that others own, and lists that grow while they are filled.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace facegear::contact {

using Index = std::int64_t;
using Mask = std::vector<std::uint8_t>; // 1 where marked

// A table in memory, row by row.
template <class Value>
struct Table {
    Value* data = nullptr;
    Index rows = 0;
    Index columns = 0;

    Value& operator()(Index row, Index column) const { return data[row * columns + column]; }
    Value* row(Index number) const { return data + number * columns; }
};

// Row i takes the columns `index` by `weight`, from pointer[i] to pointer[i + 1].
struct SparseRows {
    std::span<const Index> pointer; // (m + 1)
    std::span<const Index> index;   // (e)
    std::span<const double> weight; // (e)

    Index count() const { return static_cast<Index>(pointer.size()) - 1; }
    std::span<const Index> columns(Index row) const { return index.subspan(pointer[row], size(row)); }
    std::span<const double> weights(Index row) const { return weight.subspan(pointer[row], size(row)); }
    Index size(Index row) const { return pointer[row + 1] - pointer[row]; }
    // Rows from `first` up to `last`; they share the columns and weights.
    SparseRows part(Index first, Index last) const {
        return {pointer.subspan(first, last + 1 - first), index, weight};
    }
};

// Sparse rows with memory of their own, which is kept when they are filled anew.
struct SparseRowList {
    std::vector<Index> pointer{0};
    std::vector<Index> index;
    std::vector<double> weight;

    void clear() {
        pointer.assign(1, 0);
        index.clear();
        weight.clear();
    }
    void end_row() { pointer.push_back(static_cast<Index>(index.size())); }
    void append(SparseRows rows, Index row) {
        const auto columns = rows.columns(row);
        const auto weights = rows.weights(row);
        index.insert(index.end(), columns.begin(), columns.end());
        weight.insert(weight.end(), weights.begin(), weights.end());
        end_row();
    }
    operator SparseRows() const { return {pointer, index, weight}; }
};

// A table with memory of its own, which is kept when its size changes.
struct OwnedTable {
    std::vector<double> values;
    Index rows = 0;
    Index columns = 0;

    void resize(Index row_count, Index column_count) {
        rows = row_count;
        columns = column_count;
        if (const auto size = static_cast<std::size_t>(rows * columns); values.size() < size)
            values.resize(size);
    }
    void reset(Index row_count, Index column_count) {
        resize(row_count, column_count);
        std::fill_n(values.begin(), rows * columns, 0.0);
    }
    double& operator()(Index row, Index column) { return values[row * columns + column]; }
    double* row(Index number) { return values.data() + number * columns; }
    Table<double> view() { return {values.data(), rows, columns}; }
    Table<const double> view() const { return {values.data(), rows, columns}; }
};

} // namespace facegear::contact
