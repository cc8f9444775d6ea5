// Sparse matrices of machines side by side, with entries in the same places.
//
// A sum waits for each of its additions: so rows are added up in bundles of up to four.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "motion/layout.hpp"
#include "motion/system.hpp"

namespace facegear::motion {

// Rows that are added up at once: some groups of `count` rows. Rows of a group have entries in the same
// columns, and what those are multiplied by is read once. Rows of all groups have as many entries.
struct Bundle {
    Index rows[4] = {}; // times the lanes, as the columns
    int groups = 0, count = 0;
    Index length = 0;             // entries in each row
    Index columns = 0, value = 0; // first of groups, and of groups * count, for each entry of a row
};

// Sums of a bundle: of Groups groups of Count rows. Own: which of its group a row is.
// (Spelled out one by one, as compilers keep arrays of vectors in memory.)
template <class V, int Groups, int Count, int Own = 0>
struct RowSums {
    static constexpr bool last = Own + 1 == Count;
    V sum;
    RowSums<V, last ? Groups - 1 : Groups, Count, last ? 0 : Own + 1> rest;

    void begin(const double* from, const Index* rows) {
        sum = V::load(from + rows[0]);
        rest.begin(from, rows + 1);
    }
    // Add an entry of each row, multiplied by the vectors of the columns; the rows of a group share theirs.
    template <class Value>
    void add(const double* vectors, const Index* columns, Value value, Index at) {
        add_shared(vectors, columns, value, at, V::load(vectors + *columns));
    }
    template <class Value>
    void add_shared(const double* vectors, const Index* columns, Value value, Index at, V vector) {
        sum = value(at) * vector + sum;
        if constexpr (last)
            rest.add(vectors, columns + 1, value, at + 1);
        else
            rest.add_shared(vectors, columns, value, at + 1, vector);
    }
    void store(double* to, const Index* rows) const {
        sum.store(to + rows[0]);
        rest.store(to, rows + 1);
    }
};
template <class V, int Count>
struct RowSums<V, 0, Count, 0> {
    void begin(const double*, const Index*) {}
    template <class Value>
    void add(const double*, const Index*, Value, Index) {}
    void store(double*, const Index*) const {}
};

template <int W>
class SameSparse {
    using L = Machines<W>;
    using V = Lanes<W>;
    using Group = std::vector<Index>; // up to three rows with entries in the same columns

  public:
    // order: which of the values that enter each entry of the pattern is.
    SameSparse(const Sparse& pattern, const std::vector<Index>& order) {
        std::vector<Group> groups = groups_of(pattern);
        const auto shape = [&](const Group& group) {
            return std::pair(group.size(), pattern.starts[group[0] + 1] - pattern.starts[group[0]]);
        };
        std::sort(groups.begin(), groups.end(), [&](const Group& one, const Group& other) {
            return std::pair(shape(one), one[0]) < std::pair(shape(other), other[0]);
        });
        for (auto first = groups.begin(); first != groups.end();) {
            const auto rest = groups.end() - first;
            auto at_once = std::min<decltype(rest)>(4 / static_cast<int>(first->size()), rest);
            while (at_once == 3 || shape(first[at_once - 1]) != shape(*first)) --at_once;
            add_bundle(pattern, order, &*first, static_cast<int>(at_once));
            first += at_once;
        }
        each_ = room_.table<L>(1, static_cast<Index>(entries_.size()));
        first_.resize(entries_.size());
    }

    // Take the values of the matrix of a machine.
    void enter(const std::vector<double>& values, int lane) {
        shared_ = true;
        for (std::size_t e = 0; e < entries_.size(); ++e) {
            const Index at = static_cast<Index>(e);
            each_.one(0, at, lane) = values[entries_[e]];
            first_[e] = each_.one(0, at, 0);
            for (int other = 0; other < W; ++other) shared_ = shared_ && each_.one(0, at, other) == first_[e];
        }
    }

    // Add the matrices times vectors. Machines mostly share their values: one number for all is read sooner,
    // and leaves the cache to the motion.
    void add_product(const double* vectors, double* out) const {
        if (shared_)
            add_bundles([&](Index at) { return V::splat(first_[at]); }, vectors, out);
        else
            add_bundles([&](Index at) { return each_.at(0, at); }, vectors, out);
    }

  private:
    static std::vector<Group> groups_of(const Sparse& pattern) {
        const Index rows = static_cast<Index>(pattern.starts.size()) - 1;
        const auto columns_of = [&](Index row) {
            const auto begin = pattern.columns.begin();
            return std::vector<Index>(begin + pattern.starts[row], begin + pattern.starts[row + 1]);
        };
        std::vector<Group> groups;
        std::vector<char> taken(rows, 0);
        for (Index row = 0; row < rows; ++row) {
            if (taken[row]) continue;
            Group& group = groups.emplace_back();
            for (Index other = row; other < rows && group.size() < 3; ++other) {
                if (taken[other] || columns_of(other) != columns_of(row)) continue;
                group.push_back(other);
                taken[other] = 1;
            }
        }
        return groups;
    }

    void add_bundle(const Sparse& pattern, const std::vector<Index>& order, const Group* groups, int count) {
        Bundle bundle;
        bundle.groups = count;
        bundle.count = static_cast<int>(groups->size());
        bundle.length = pattern.starts[groups->front() + 1] - pattern.starts[groups->front()];
        bundle.columns = static_cast<Index>(columns_.size());
        bundle.value = static_cast<Index>(entries_.size());
        Index* row = bundle.rows;
        for (const Group* group = groups; group != groups + count; ++group)
            for (const Index each : *group) *row++ = each * W;
        for (Index i = 0; i < bundle.length; ++i) {
            for (const Group* group = groups; group != groups + count; ++group) {
                columns_.push_back(pattern.columns[pattern.starts[group->front()] + i] * W);
                for (const Index each : *group) entries_.push_back(order[pattern.starts[each] + i]);
            }
        }
        bundles_.push_back(bundle);
    }

    template <class Value>
    void add_bundles(Value value, const double* vectors, double* out) const {
        for (const Bundle& bundle : bundles_) {
            switch (4 * bundle.groups + bundle.count) {
                case 4 * 4 + 1:
                    multiply<4, 1>(bundle, value, vectors, out);
                    break;
                case 4 * 2 + 2:
                    multiply<2, 2>(bundle, value, vectors, out);
                    break;
                case 4 * 2 + 1:
                    multiply<2, 1>(bundle, value, vectors, out);
                    break;
                case 4 * 1 + 3:
                    multiply<1, 3>(bundle, value, vectors, out);
                    break;
                case 4 * 1 + 2:
                    multiply<1, 2>(bundle, value, vectors, out);
                    break;
                default:
                    multiply<1, 1>(bundle, value, vectors, out);
            }
        }
    }
    template <int Groups, int Count, class Value>
    [[gnu::always_inline]] void multiply(const Bundle& bundle, Value value, const double* vectors,
                                         double* out) const {
        RowSums<V, Groups, Count> sums;
        sums.begin(out, bundle.rows);
        const Index* columns = columns_.data() + bundle.columns;
        Index at = bundle.value;
        for (Index i = 0; i < bundle.length; ++i, columns += Groups, at += Groups * Count)
            sums.add(vectors, columns, value, at);
        sums.store(out, bundle.rows);
    }

    Room room_;
    std::vector<Bundle> bundles_;
    std::vector<Index> columns_, entries_; // entries: which of the values that enter each value is
    Table<L> each_;                        // values of each machine
    std::vector<double> first_;            // and of the first alone
    bool shared_ = false;                  // whether those of all machines are the same
};

} // namespace facegear::motion
