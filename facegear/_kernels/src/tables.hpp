// Views of arrays that belong to the caller: rows one after the other, nothing allocated, nothing checked.
#pragma once

#include <cstdint>

namespace facegear {

using Index = std::int64_t;

// A table (rows, columns).
template <class Value>
struct Table {
    Value* data;
    Index rows;
    Index columns;

    Value& operator()(Index row, Index column) const { return data[row * columns + column]; }
    Value* row(Index number) const { return data + number * columns; }
};

// A list of `size` values.
template <class Value>
struct List {
    Value* data;
    Index size;

    Value& operator[](Index number) const { return data[number]; }
    Value* begin() const { return data; }
    Value* end() const { return data + size; }
};

} // namespace facegear
