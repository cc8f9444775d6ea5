// Products with the matrices of a system, the one part of the recurrence that differs between the layouts.
//
// One machine: dense and padded, vectors run over contacts or coordinates. Machines side by side: sparse,
// entry by entry. Where coordinates are coupled beside the meshes (gears that bend), one machine takes dense
// blocks: modes of a body are felt by that body's flanks alone and couple with those of their own order only.
#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

#include "motion/layout.hpp"
#include "motion/same_sparse.hpp"
#include "motion/system.hpp"

namespace facegear::motion {

template <class L>
class Products;

// Dense blocks of the mesh Jacobian: coordinates next to each other, and the rows that touch them.
struct Blocks {
    std::vector<Index> starts{0}, rows; // of block b: rows[starts[b]] to rows[starts[b + 1]]
    std::vector<Index> first, last;     // its coordinates, in vectors
    std::vector<Index> tiles{0},
        columns; // the rows in vector k touch coordinates in vectors columns[tiles[k]] and on
};

// A block is continued by the next vector of coordinates if that brings no more vectors of zeros into it.
constexpr Index block_zeros = 8;

// touches[row * width + vector]: whether a row touches a vector of coordinates.
inline Blocks blocks_from(const std::vector<char>& touches, Index rows, Index width, int lanes) {
    Blocks result;
    const auto zeros = [&](Index begin, Index end) {
        Index count = 0;
        for (Index row = 0; row < rows; ++row) {
            Index own = 0;
            for (Index c = begin; c < end; ++c) own += touches[row * width + c];
            count += own ? end - begin - own : 0;
        }
        return count;
    };
    Index begin = 0;
    for (Index k = 1; k <= width; ++k) {
        if (k < width && zeros(begin, k + 1) - zeros(begin, k) <= block_zeros) continue;
        result.first.push_back(begin);
        result.last.push_back(k);
        for (Index row = 0; row < rows; ++row) {
            bool any = false;
            for (Index c = begin; c < k; ++c) any = any || touches[row * width + c];
            if (any) result.rows.push_back(row);
        }
        result.starts.push_back(static_cast<Index>(result.rows.size()));
        begin = k;
    }
    for (Index top = 0; top < rows; top += lanes) {
        for (Index c = 0; c < width; ++c) {
            bool any = false;
            for (Index row = top; row < std::min(top + lanes, rows); ++row)
                any = any || touches[row * width + c];
            if (any) result.columns.push_back(c);
        }
        result.tiles.push_back(static_cast<Index>(result.columns.size()));
    }
    return result;
}

// A vector joins a band if that brings at most one strip of zeros for this many columns into it.
constexpr Index band_zeros = 4;

// Vectors of coordinates next to each other that are coupled with the same columns: each factor is read once
// for all of them, and their sums do not wait for each other.
struct RowBand {
    static constexpr int most = 4; // as many as the registers hold with their sums

    Index first, vectors;
    Index columns, count; // in the list of columns
    Index strips;         // of W rows and one column, column by column
};

template <int W>
class Products<Coordinates<W>> {
    using L = Coordinates<W>;
    using V = Lanes<W>;
    using S = Lanes<1>;

  public:
    explicit Products(const System& system)
        : n_(system.n),
          m_(system.m),
          contacts_(system.contacts),
          by_coordinate_(room_.table<L>(system.n, system.m)),
          by_contact_(room_.table<L>(blocks_of<L>(system.m) * W, system.n)),
          along_(room_.table<L>(system.rubbing(), system.n)),
          coupled_(system.coupled) {
        if (coupled_) find_blocks(system);
    }

    void enter(const Machine& machine, int) {
        const System& system = *machine.system;
        for (Index row = 0; row < m_; ++row)
            for (Index k = 0; k < n_; ++k)
                by_contact_.one(row, k, 0) = by_coordinate_.one(k, row, 0) = system.jacobian[row * n_ + k];
        for (Index row = 0; row < system.rubbing(); ++row)
            for (Index k = 0; k < n_; ++k) along_.one(row, k, 0) = system.rubbing_directions[row * n_ + k];
        for (const RowBand& band : bands_) {
            double* strip = strips_ + band.strips * W;
            for (Index at = 0; at < band.count; ++at) {
                const Index column = band_columns_[band.columns + at];
                for (Index k = band.first * W; k < (band.first + band.vectors) * W; ++k)
                    *strip++ = k >= n_       ? 0.0
                               : column < n_ ? system.by_velocity(k, column, machine.frequency)
                                             : system.by_displacement(k, column - n_, machine.frequency);
            }
        }
    }

    // A row of the deflections, G y - e; of a disturbance G y.
    void deflect(Table<L> y, Index row, const Series<L>* error, Table<L> deflection) const {
        if (by_tiles_) {
            deflect_by_tiles(y, row, error, deflection);
            return;
        }
        for (Index b = 0; b < deflection.width; ++b)
            deflection.put(row, b, error ? -error->at(row, b) : V::splat(0.0));
        accumulate(by_coordinate_, n_, y.row(row), deflection.row(row), deflection.width);
    }

    // List the rows of every block that may hold a force: contacts that act, and all rows of rings.
    void find_pressing(Table<L> active, Table<L> acting) {
        if (!coupled_) return;
        Index count = 0;
        for (std::size_t block = 0; block < blocks_.first.size(); ++block) {
            for (Index at = blocks_.starts[block]; at < blocks_.starts[block + 1]; ++at) {
                const Index row = blocks_.rows[at];
                if (row >= contacts_ || active.data[row] != 0.0 || acting.data[row] != 0.0)
                    pressing_[count++] = row;
            }
            pressing_starts_[block + 1] = count;
        }
    }

    // Add G^T force to a row of the coordinates.
    void push(Table<L> force, Table<L> y, Index row) const {
        if (!coupled_) {
            accumulate(by_contact_, m_, force.data, y.row(row), y.width);
            return;
        }
        for (std::size_t block = 0; block < blocks_.first.size(); ++block) {
            const Index* rows = pressing_.data() + pressing_starts_[block];
            const Index count = pressing_starts_[block + 1] - pressing_starts_[block],
                        last = blocks_.last[block];
            Index b = blocks_.first[block];
            for (; b + 4 < last; b += 3) push_columns<3>(rows, count, force.data, y.row(row), b);
            switch (last - b) {
                case 4:
                    push_columns<4>(rows, count, force.data, y.row(row), b);
                    break;
                case 3:
                    push_columns<3>(rows, count, force.data, y.row(row), b);
                    break;
                case 2:
                    push_columns<2>(rows, count, force.data, y.row(row), b);
                    break;
                default:
                    push_columns<1>(rows, count, force.data, y.row(row), b);
            }
        }
    }

    // Add what couples coordinates beside the meshes to row i + 2 of y from the two rows before it.
    void couple(Table<L> y, Index i) {
        if (!coupled_) return;
        const V by_rate = V::splat(-1.0 / static_cast<double>(i + 2));
        const V by_place = V::splat(-1.0 / static_cast<double>((i + 1) * (i + 2)));
        double* rates = factors_;
        double* places = factors_ + n_; // strips are numbered by the n coordinates twice
        for (Index b = 0; b < y.width; ++b) (by_place * y.at(i, b)).store(places + b * W);
        store_rates(y, i + 1, by_rate, rates);
        for (const RowBand& band : bands_) {
            double* out = y.row(i + 2) + band.first * W;
            switch (band.vectors) {
                case 1:
                    couple_band<1>(band, out);
                    break;
                case 2:
                    couple_band<2>(band, out);
                    break;
                case 3:
                    couple_band<3>(band, out);
                    break;
                default:
                    couple_band<RowBand::most>(band, out);
            }
        }
    }

    // Add forces of friction along their directions to a row of the coordinates.
    void rub(Index force, S size, Table<L> y, Index row) const {
        for (Index b = 0; b < y.width; ++b) y.add(row, b, V::splat(size[0]) * along_.at(force, b));
    }

    // A row of G times a row of the coordinates.
    S dot(Index contact, Table<L> y, Index row) const {
        V total = V::splat(0.0);
        for (Index b = 0; b < y.width; ++b) total = by_contact_.at(contact, b) * y.at(row, b) + total;
        return sum(total);
    }
    // Add a row of G times a number to a row of the coordinates.
    void add_row(Index contact, S factor, Table<L> y, Index row) const {
        for (Index b = 0; b < y.width; ++b) y.add(row, b, V::splat(factor[0]) * by_contact_.at(contact, b));
    }

    static S sum(V lanes) {
        double total = 0.0;
        for (int i = 0; i < W; ++i) total += lanes[i];
        return S::splat(total);
    }
    static S largest(V lanes) {
        double found = lanes[0];
        for (int i = 1; i < W; ++i) found = lanes[i] > found ? lanes[i] : found;
        return S::splat(found);
    }

  private:
    // Add the first `rows` rows of a matrix times factors to `width` vectors.
    static void accumulate(Table<L> matrix, Index rows, const double* factors, double* out, Index width) {
        Index b = 0;
        for (; b + 5 < width; b += 3) add_columns<3>(matrix, rows, factors, out, b);
        switch (width - b) {
            case 5:
                return add_columns<5>(matrix, rows, factors, out, b);
            case 4:
                return add_columns<4>(matrix, rows, factors, out, b);
            case 3:
                return add_columns<3>(matrix, rows, factors, out, b);
            case 2:
                return add_columns<2>(matrix, rows, factors, out, b);
            case 1:
                return add_columns<1>(matrix, rows, factors, out, b);
            default:
                return;
        }
    }

    // Count vectors at a time share each factor that is read.
    template <int Count>
    static void add_columns(Table<L> matrix, Index rows, const double* factors, double* out, Index b) {
        Sums<V, Count> sums;
        sums.begin(out + b * W);
        const Index stride = matrix.stride();
        const double* at = matrix.begin(b);
        Index row = 0;
        for (; row + 1 < rows; row += 2, at += 2 * stride) {
            sums.add_even(at, V::splat(factors[row]));
            sums.add_odd(at + stride, V::splat(factors[row + 1]));
        }
        if (row < rows) sums.add_even(at, V::splat(factors[row]));
        sums.store(out + b * W);
    }

    template <int Count>
    void push_columns(const Index* rows, Index count, const double* force, double* out, Index b) const {
        Sums<V, Count> sums;
        sums.begin(out + b * W);
        const Index stride = by_contact_.stride();
        const double* matrix = by_contact_.begin(b);
        Index at = 0;
        for (; at + 1 < count; at += 2) {
            sums.add_even(matrix + rows[at] * stride, V::splat(force[rows[at]]));
            sums.add_odd(matrix + rows[at + 1] * stride, V::splat(force[rows[at + 1]]));
        }
        if (at < count) sums.add_even(matrix + rows[at] * stride, V::splat(force[rows[at]]));
        sums.store(out + b * W);
    }

    template <int Count>
    void couple_band(const RowBand& band, double* out) const {
        Sums<V, Count> sums;
        sums.begin(out);
        const Index* columns = band_columns_.data() + band.columns;
        const double* strip = strips_ + band.strips * W;
        Index at = 0;
        for (; at + 1 < band.count; at += 2, strip += 2 * Count * W) {
            sums.add_even(strip, V::splat(factors_[columns[at]]));
            sums.add_odd(strip + Count * W, V::splat(factors_[columns[at + 1]]));
        }
        if (at < band.count) sums.add_even(strip, V::splat(factors_[columns[at]]));
        sums.store(out);
    }

    void deflect_by_tiles(Table<L> y, Index row, const Series<L>* error, Table<L> deflection) const {
        if constexpr (W == 4) {
            for (Index k = 0; k < deflection.width; ++k) {
                V first = V::splat(0.0), second = first, third = first, fourth = first;
                for (Index tile = blocks_.tiles[k]; tile < blocks_.tiles[k + 1]; ++tile) {
                    const Index c = blocks_.columns[tile];
                    const V factor = y.at(row, c);
                    first = by_contact_.at(4 * k, c) * factor + first;
                    second = by_contact_.at(4 * k + 1, c) * factor + second;
                    third = by_contact_.at(4 * k + 2, c) * factor + third;
                    fourth = by_contact_.at(4 * k + 3, c) * factor + fourth;
                }
                const V total = lane_sums(first, second, third, fourth);
                deflection.put(row, k, error ? total - error->at(row, k) : total);
            }
        }
    }

    // The n rates, without the padding behind them, where the n displacements follow.
    void store_rates(Table<L> y, Index row, V factor, double* rates) const {
        Index b = 0;
        for (; (b + 1) * W <= n_; ++b) (factor * y.at(row, b)).store(rates + b * W);
        for (Index k = b * W; k < n_; ++k) rates[k] = factor[0] * y.row(row)[k];
    }

    void find_blocks(const System& system) {
        const Index width = by_contact_.width, vectors = by_coordinate_.width;
        std::vector<char> touches(vectors * W * width, 0);
        for (Index row = 0; row < m_; ++row)
            for (Index e = system.by_contact.starts[row]; e < system.by_contact.starts[row + 1]; ++e)
                touches[row * width + system.by_contact.columns[e] / W] = 1;
        blocks_ = blocks_from(touches, vectors * W, width, W);
        // Tiles save what is zero; without zeros the sums over coordinates are faster.
        by_tiles_ = W == 4 && static_cast<Index>(blocks_.columns.size()) < vectors * width;
        pressing_.resize(blocks_.rows.size());
        pressing_starts_.resize(blocks_.starts.size());
        for (Index k = 0; k < width; ++k) {
            std::vector<char> kept(2 * n_, 0);
            for (Index row = k * W; row < std::min((k + 1) * W, n_); ++row)
                for (Index e = system.coupled_rows.starts[row]; e < system.coupled_rows.starts[row + 1]; ++e)
                    kept[system.coupled_rows.columns[e]] = 1;
            std::vector<Index> columns;
            for (Index column = 0; column < 2 * n_; ++column)
                if (kept[column]) columns.push_back(column);
            add_to_bands(k, columns);
        }
        Index strips = 0;
        for (RowBand& band : bands_) {
            band.strips = strips;
            strips += band.vectors * band.count;
        }
        strips_ = room_.numbers(strips * W);
        factors_ = room_.numbers(2 * n_ + W);
    }

    // Append vector k to the last band where that brings few zeros into it and has room, else to a new one.
    void add_to_bands(Index k, const std::vector<Index>& columns) {
        if (columns.empty()) return;
        const auto own = static_cast<Index>(columns.size());
        if (!bands_.empty() && bands_.back().first + bands_.back().vectors == k &&
            bands_.back().vectors < RowBand::most) {
            RowBand& last = bands_.back();
            std::vector<Index> both;
            std::set_union(band_columns_.begin() + last.columns, band_columns_.end(), columns.begin(),
                           columns.end(), std::back_inserter(both));
            const auto count = static_cast<Index>(both.size());
            if (band_zeros * ((last.vectors + 1) * count - last.vectors * last.count - own) <= count) {
                band_columns_.resize(last.columns);
                band_columns_.insert(band_columns_.end(), both.begin(), both.end());
                last.count = count;
                ++last.vectors;
                return;
            }
        }
        bands_.push_back({k, 1, static_cast<Index>(band_columns_.size()), own, 0});
        band_columns_.insert(band_columns_.end(), columns.begin(), columns.end());
    }

    Room room_;
    Index n_, m_, contacts_;
    Table<L> by_coordinate_, by_contact_, along_;
    bool coupled_, by_tiles_ = false;
    Blocks blocks_;
    std::vector<Index> pressing_, pressing_starts_;
    std::vector<RowBand> bands_;
    std::vector<Index> band_columns_;
    double* strips_ = nullptr;
    double* factors_ = nullptr;
};

template <int W>
class Products<Machines<W>> {
    using L = Machines<W>;
    using V = Lanes<W>;

  public:
    explicit Products(const System& system)
        : system_(&system),
          of_contacts_(system.by_contact, numbers(system.by_contact)),
          of_coordinates_(system.by_coordinate, system.entry),
          coupling_(system.coupled_rows, numbers(system.coupled_rows)),
          felt_(room_.table<L>(1, 2 * system.n)),
          along_(room_.table<L>(1, static_cast<Index>(system.along.columns.size()))),
          values_(room_.table<L>(1, static_cast<Index>(system.by_contact.columns.size()))) {}

    void enter(const Machine& machine, int lane) {
        const System& system = *machine.system;
        const std::vector<double>& jacobian = system.by_contact.values;
        for (std::size_t e = 0; e < jacobian.size(); ++e)
            values_.one(0, static_cast<Index>(e), lane) = jacobian[e];
        of_contacts_.enter(jacobian, lane);
        of_coordinates_.enter(jacobian, lane);
        for (std::size_t e = 0; e < system.along.values.size(); ++e)
            along_.one(0, static_cast<Index>(e), lane) = system.along.values[e];
        if (!system.coupled) return;
        std::vector<double> coupling;
        for (Index k = 0; k < system.n; ++k)
            for (Index e = system.coupled_rows.starts[k]; e < system.coupled_rows.starts[k + 1]; ++e) {
                const Index column = system.coupled_rows.columns[e];
                coupling.push_back(column < system.n
                                       ? system.by_velocity(k, column, machine.frequency)
                                       : system.by_displacement(k, column - system.n, machine.frequency));
            }
        coupling_.enter(coupling, lane);
    }

    void deflect(Table<L> y, Index row, const Series<L>* error, Table<L> deflection) const {
        for (Index contact = 0; contact < deflection.width; ++contact)
            deflection.put(row, contact, error ? -error->at(row, contact) : V::splat(0.0));
        of_contacts_.add_product(y.row(row), deflection.row(row));
    }

    void find_pressing(Table<L>, Table<L>) {}

    void push(Table<L> force, Table<L> y, Index row) const {
        of_coordinates_.add_product(force.data, y.row(row));
    }

    void couple(Table<L> y, Index i) const {
        if (!system_->coupled) return;
        const Index n = system_->n;
        const V by_rate = V::splat(-1.0 / static_cast<double>(i + 2));
        const V by_place = V::splat(-1.0 / static_cast<double>((i + 1) * (i + 2)));
        for (Index k = 0; k < n; ++k) felt_.put(0, k, by_rate * y.at(i + 1, k));
        for (Index k = 0; k < n; ++k) felt_.put(0, n + k, by_place * y.at(i, k));
        coupling_.add_product(felt_.data, y.row(i + 2));
    }

    void rub(Index force, V size, Table<L> y, Index row) const {
        const Sparse& rows = system_->along;
        for (Index e = rows.starts[force]; e < rows.starts[force + 1]; ++e)
            y.add(row, rows.columns[e], size * along_.at(0, e));
    }

    V dot(Index contact, Table<L> y, Index row) const {
        const Sparse& rows = system_->by_contact;
        V total = V::splat(0.0);
        for (Index e = rows.starts[contact]; e < rows.starts[contact + 1]; ++e)
            total = values_.at(0, e) * y.at(row, rows.columns[e]) + total;
        return total;
    }
    void add_row(Index contact, V factor, Table<L> y, Index row) const {
        const Sparse& rows = system_->by_contact;
        for (Index e = rows.starts[contact]; e < rows.starts[contact + 1]; ++e)
            y.add(row, rows.columns[e], factor * values_.at(0, e));
    }

    static V sum(V lanes) { return lanes; }
    static V largest(V lanes) { return lanes; }

  private:
    static std::vector<Index> numbers(const Sparse& matrix) {
        std::vector<Index> all(matrix.columns.size());
        for (std::size_t e = 0; e < all.size(); ++e) all[e] = static_cast<Index>(e);
        return all;
    }

    Room room_;
    const System* system_;
    SameSparse<W> of_contacts_, of_coordinates_, coupling_;
    Table<L> felt_; // velocities and displacements with their factors, by which the coupling is multiplied
    Table<L> along_;
    Table<L> values_; // of the Jacobian, entry by entry
};

} // namespace facegear::motion
