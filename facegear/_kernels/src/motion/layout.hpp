// How numbers of machines lie in vectors: the one place where one machine and many side by side differ in
// kind.
//
// A machine has entities of several kinds: coordinates, contacts, bearings with clearance. `Coordinates<W>`
// holds one machine, with W of its entities in a vector; `Machines<W>` holds W machines, with one entity of
// each in a vector. Tables are [row][block][lane], a row for each power of the phase. Code that goes block by
// block does not ask which layout it has; neither does code that goes entity by entity, with one number for
// each machine (`S`).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "simd.hpp"

namespace facegear::motion {

using Index = std::int64_t;

// One machine: lanes are entities.
template <int Width>
struct Coordinates {
    static constexpr int lanes = Width, machines = 1;
    using V = Lanes<Width>;
    using S = Lanes<1>;
    static V every(S value) { return V::splat(value[0]); }
};

// Width machines side by side: lanes are machines.
template <int Width>
struct Machines {
    static constexpr int lanes = Width, machines = Width;
    using V = Lanes<Width>;
    using S = V;
    static V every(S value) { return value; }
};

// Vectors that hold so many entities.
template <class L>
constexpr Index blocks_of(Index entities) {
    return (entities * L::machines + L::lanes - 1) / L::lanes;
}

// Which entity a lane of a block holds, and of which machine.
template <class L>
constexpr Index entity_of(Index block, int lane) {
    return (block * L::lanes + lane) / L::machines;
}
template <class L>
constexpr int machine_of(int lane) {
    return lane % L::machines;
}

// Rows of blocks.
template <class L>
struct Table {
    using V = typename L::V;
    using S = typename L::S;
    double* data = nullptr;
    Index width = 0; // blocks in a row

    Index stride() const { return width * L::lanes; }
    double* row(Index number) const { return data + number * stride(); }
    double* begin(Index block) const { return data + block * L::lanes; }
    V at(Index number, Index block) const { return V::load(row(number) + block * L::lanes); }
    void put(Index number, Index block, V value) const { value.store(row(number) + block * L::lanes); }
    void add(Index number, Index block, V value) const { put(number, block, at(number, block) + value); }
    // Of an entity, one for each machine.
    S of(Index number, Index entity) const { return S::load(row(number) + entity * L::machines); }
    void set(Index number, Index entity, S value) const { value.store(row(number) + entity * L::machines); }
    V spread(Index number, Index entity) const { return L::every(of(number, entity)); }
    double& one(Index number, Index entity, int machine) const {
        return row(number)[entity * L::machines + machine];
    }
};

// Count vectors side by side, each added up in two sums: one alone would wait for each of its additions.
// (Spelled out one by one, as compilers keep arrays of vectors in memory.)
template <class V, int Count>
struct Sums {
    static constexpr int lanes = sizeof(V) / sizeof(double);
    V even, odd;
    Sums<V, Count - 1> rest;

    void begin(const double* from) {
        even = V::load(from);
        odd = V::splat(0.0);
        rest.begin(from + lanes);
    }
    void clear() {
        even = odd = V::splat(0.0);
        rest.clear();
    }
    void add_even(const double* vectors, V factor) {
        even = V::load(vectors) * factor + even;
        rest.add_even(vectors + lanes, factor);
    }
    void add_odd(const double* vectors, V factor) {
        odd = V::load(vectors) * factor + odd;
        rest.add_odd(vectors + lanes, factor);
    }
    void store(double* to, V factor) const {
        ((even + odd) * factor).store(to);
        rest.store(to + lanes, factor);
    }
    void store(double* to) const {
        (even + odd).store(to);
        rest.store(to + lanes);
    }
};
template <class V>
struct Sums<V, 0> {
    void begin(const double*) {}
    void clear() {}
    void add_even(const double*, V) {}
    void add_odd(const double*, V) {}
    void store(double*, V) const {}
    void store(double*) const {}
};

// A row of a table, read by a map from blocks to columns where there is one.
template <class L>
struct Series {
    Table<L> table;
    const Index* column = nullptr;
    double* begin(Index block) const { return table.begin(column ? column[block] : block); }
    typename L::V at(Index row, Index block) const { return V::load(begin(block) + row * table.stride()); }
    using V = typename L::V;
};

// Coefficient i of the product of two series that begin at `first` and `second`, in two sums.
template <class L>
[[gnu::always_inline]] inline typename L::V product(const double* first, Index first_stride,
                                                    const double* second, Index second_stride, Index i) {
    using V = typename L::V;
    V even = V::splat(0.0), odd = even;
    const double* f = first + i * first_stride; // the newest rows come last: the others do not wait for them
    const double* g = second;
    for (Index j = i; j > 0; j -= 2) {
        even = V::load(f) * V::load(g) + even;
        odd = V::load(f - first_stride) * V::load(g + second_stride) + odd;
        f -= 2 * first_stride;
        g += 2 * second_stride;
    }
    if (i % 2 == 0) even = V::load(f) * V::load(g) + even;
    return even + odd;
}
template <class L>
[[gnu::always_inline]] inline typename L::V product(Series<L> first, Table<L> second, Index i, Index block) {
    return product<L>(first.begin(block), first.table.stride(), second.begin(block), second.stride(), i);
}
template <class L>
[[gnu::always_inline]] inline typename L::V product(Table<L> first, Table<L> second, Index i, Index block) {
    return product<L>(first.begin(block), first.stride(), second.begin(block), second.stride(), i);
}

// Value of a series in a block at a step ahead.
template <class L>
[[gnu::always_inline]] inline typename L::V value_ahead(Table<L> series, Index order, typename L::V step,
                                                        Index block) {
    typename L::V total = series.at(order, block);
    for (Index i = order - 1; i >= 0; --i) total = total * step + series.at(i, block);
    return total;
}

// Memory of tables, zero at first, each from the start of a cache line on.
class Room {
  public:
    double* numbers(Index count) {
        parts_.emplace_back(static_cast<std::size_t>(count) + line);
        double* begin = parts_.back().data();
        const auto over = reinterpret_cast<std::uintptr_t>(begin) / sizeof(double) % line;
        return begin + (line - over) % line;
    }
    template <class L>
    Table<L> table(Index rows, Index entities) {
        const Index width = blocks_of<L>(entities);
        return {numbers(rows * width * L::lanes), width};
    }

  private:
    static constexpr std::size_t line = 8;
    std::vector<std::vector<double>> parts_;
};

} // namespace facegear::motion
