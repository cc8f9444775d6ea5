// Influence matrix of basis functions: the approach of one by a unit force on another, both bodies together.
#pragma once

#include "contact/nodal_forces.hpp"
#include "contact/weighted_rows.hpp"

namespace facegear::contact {

// Contact surface of one gear and how it gives way.
struct Surface {
    Faces faces;              // of the elements, on the refined nodes (n)
    SparseRows interpolation; // (n, c) displacements of the refined nodes by those before refinement
    Table<const double> own;  // (n, n) m/N, symmetric: on the loaded tooth, times `scale`
    const double* others =
        nullptr;            // (2 reach + 1, c, c) m/N: on the tooth t - reach further along, times `scale`
    Index reach = 0;        // teeth on each side that a loaded tooth moves
    Index coarse_nodes = 0; // c
    double scale = 1.0;

    // Compliance for a tooth `places` further than the loaded one, not scaled.
    Table<const double> beside(Index places) const {
        return {others + (places + reach) * coarse_nodes * coarse_nodes, coarse_nodes, coarse_nodes};
    }
    bool reaches(Index places) const { return std::abs(places) <= reach; }
};

// A run of columns from `begin` up to `end`.
struct ColumnRange {
    Index begin;
    Index end;

    // The part of it in `size` columns from `start` on, counted from there; empty ranges end where they
    // begin.
    ColumnRange within(Index start, Index size) const {
        const Index first = std::clamp(begin - start, Index{0}, size);
        return {first, std::max(std::min(end - start, size), first)};
    }
};

// Adds averages on both sides of a compliance C: matrix(j, i) += scale * sum over k, l of seen(i, k) C(k, l)
// load(j, l).
struct TwoSidedAverage {
    // Columns of C that stay in the processor's cache while they are averaged.
    static constexpr Index BLOCK = 512;
    // Rows whose averages are put in columns together: they fill whole lines of the cache.
    static constexpr Index TOGETHER = 16;

    ColumnBlocks blocks;
    UsedRows rows;
    std::vector<Index> row_place;     // (e) where the columns of `seen` stand among the rows of C in use
    std::vector<Index> row_end;       // (u) columns that are needed of each of these rows
    std::vector<Index> place;         // (e) where the columns of `load` stand in the blocks
    std::vector<double> weight;       // (e) weights of `load` times the scale
    std::vector<ColumnRange> reached; // (n + 1) columns that the first 0, 1 ... n rows of `load` use
    OwnedTable half;                  // (4 b, m) C averaged by `seen`, its columns as rows
    std::vector<Vector> lines =
        std::vector<Vector>(TOGETHER * BLOCK / LANES); // rows of it, before they are turned

    // `symmetric`: `load` and `seen` are the same rows and C is symmetric; only j <= i are added then.
    void add(Table<double> matrix, Index first_row, Index first_column, double scale, SparseRows seen,
             Table<const double> compliance, SparseRows load, bool symmetric) {
        find_rows(seen, compliance.rows);
        find_columns(load, compliance.columns, scale, symmetric);
        find_row_ends(seen, load.count(), symmetric);
        average_rows(seen, compliance, load.count(), symmetric);
        average_columns(matrix, first_row, first_column, seen.count(), load, symmetric);
    }

  private:
    void find_rows(SparseRows seen, Index count) {
        const Index first = seen.pointer.front(), last = seen.pointer.back();
        const auto index = seen.index.subspan(first, last - first);
        rows.find(index, count);
        row_place.resize(index.size());
        for (std::size_t k = 0; k < index.size(); ++k) row_place[k] = rows.slot[index[k]];
    }

    void find_columns(SparseRows load, Index columns, double scale, bool symmetric) {
        const Index first = load.pointer.front(), last = load.pointer.back();
        const auto index = load.index.subspan(first, last - first);
        blocks.begin_with(columns);
        blocks.mark(index);
        blocks.make();
        place.resize(index.size());
        weight.resize(index.size());
        for (std::size_t k = 0; k < index.size(); ++k) {
            place[k] = blocks.slot[index[k]];
            weight[k] = scale * load.weight[first + static_cast<Index>(k)];
        }
        const Index width = LANES * blocks.blocks();
        reached.assign(load.count() + 1, {0, width});
        if (!symmetric) return;
        reached[0] = {width, 0};
        for (Index j = 0; j < load.count(); ++j) {
            reached[j + 1] = reached[j];
            for (Index k = load.pointer[j] - first; k < load.pointer[j + 1] - first; ++k) {
                reached[j + 1].begin = std::min(reached[j + 1].begin, place[k]);
                reached[j + 1].end = std::max(reached[j + 1].end, place[k] + 1);
            }
        }
    }

    // Columns that row i of `seen` needs: in a symmetric product those of the rows up to itself alone.
    ColumnRange range_of(Index group, Index loads, bool symmetric) const {
        return reached[symmetric ? std::min(group + TOGETHER, loads) : loads];
    }

    void find_row_ends(SparseRows seen, Index loads, bool symmetric) {
        row_end.assign(rows.count(), 0);
        const Index offset = seen.pointer.front();
        for (Index group = 0; group < seen.count(); group += TOGETHER) {
            const Index end = range_of(group, loads, symmetric).end;
            const Index last = seen.pointer[std::min(group + TOGETHER, seen.count())];
            for (Index k = seen.pointer[group]; k < last; ++k) {
                Index& needed = row_end[row_place[k - offset]];
                needed = std::max(needed, end);
            }
        }
    }

    // Copy what is needed of `size` columns of the blocks from `start` on.
    void copy_rows(Table<const double> compliance, Index start, Index size) {
        rows.values.resize(rows.count(), size);
        for (Index each = 0; each < rows.count(); ++each) {
            const Index needed = std::clamp(row_end[each] - start, Index{0}, size);
            const auto begin =
                std::span<const Index>(blocks.begin).subspan(start / LANES, (needed + LANES - 1) / LANES);
            UsedRows::copy_row(compliance.row(rows.row[each]), begin, rows.values.row(each));
        }
    }

    void average_rows(SparseRows seen, Table<const double> compliance, Index loads, bool symmetric) {
        const Index width = LANES * blocks.blocks();
        half.resize(width, seen.count() + TOGETHER);
        for (Index start = 0; start < width; start += BLOCK) {
            const Index size = std::min(BLOCK, width - start);
            copy_rows(compliance, start, size);
            for (Index group = 0; group < seen.count(); group += TOGETHER) {
                average_group(seen, start, group, range_of(group, loads, symmetric).within(start, size));
            }
        }
    }

    void average_group(SparseRows seen, Index start, Index group, ColumnRange range) {
        const OwnedTable& values = rows.values;
        const Index first = range.begin / LANES, last = (range.end + LANES - 1) / LANES;
        const Index count = std::min(TOGETHER, seen.count() - group);
        for (Index i = 0; i < count; ++i) {
            Vector* line = lines.data() + i * BLOCK / LANES;
            std::fill(line + first, line + last, Vector::splat(0.0));
            const Index begin = seen.pointer[group + i] - seen.pointer.front();
            const std::span<const Index> used(row_place.data() + begin,
                                              static_cast<std::size_t>(seen.size(group + i)));
            sum_rows(values.view(), used, seen.weights(group + i), LANES * first, line + first, last - first);
        }
        for (Index v = first; v < last; ++v) {
            for (Index i = 0; i < count; ++i) {
                const Vector sums = lines[i * BLOCK / LANES + v];
                double* column = half.row(start + LANES * v) + group + i;
                for (int lane = 0; lane < LANES; ++lane) column[lane * half.columns] = sums[lane];
            }
        }
    }

    void average_columns(Table<double> matrix, Index first_row, Index first_column, Index count,
                         SparseRows load, bool symmetric) {
        const Index offset = load.pointer.front();
        for (Index start = 0; start < count; start += BLOCK) {
            const Index end = std::min(start + BLOCK, count);
            for (Index j = 0; j < (symmetric ? std::min(end, load.count()) : load.count()); ++j) {
                const Index begin = load.pointer[j] - offset, size = load.size(j);
                const Index from = symmetric ? std::max(j, start) : start;
                add_rows({place.data() + begin, static_cast<std::size_t>(size)},
                         {weight.data() + begin, static_cast<std::size_t>(size)}, from, end,
                         matrix.row(first_row + j) + first_column);
            }
        }
    }

    // out[i] += weight[k] * half(row[k], i), from i = `from` up to `end`.
    void add_rows(std::span<const Index> row, std::span<const double> factor, Index from, Index end,
                  double* out) {
        Vector sums[BLOCK / LANES];
        const Index whole = (end - from) / LANES;
        for (Index v = 0; v < whole; ++v) sums[v] = Vector::load(out + from + LANES * v);
        const OwnedTable& values = half;
        sum_rows(values.view(), row, factor, from, sums, whole);
        for (Index v = 0; v < whole; ++v) sums[v].store(out + from + LANES * v);
        for (Index i = from + LANES * whole; i < end; ++i) {
            for (std::size_t k = 0; k < row.size(); ++k) out[i] += factor[k] * half(row[k], i);
        }
    }
};

// Fill in what is below the diagonal of a square by what is above it, tile by tile.
inline void mirror(Table<double> matrix) {
    constexpr Index TILE = 16;
    for (Index above = 0; above < matrix.rows; above += TILE) {
        for (Index beside = above; beside < matrix.rows; beside += TILE) {
            for (Index i = above; i < std::min(above + TILE, matrix.rows); ++i) {
                for (Index j = std::max(beside, i + 1); j < std::min(beside + TILE, matrix.rows); ++j) {
                    matrix(j, i) = matrix(i, j);
                }
            }
        }
    }
}

// Forces of basis functions on the nodes of both surfaces, refined and before refinement; of pair p the
// functions from ends[p] up to ends[p + 1].
struct FunctionForces {
    std::vector<Index> ends;  // (p + 1)
    SparseRowList refined[2]; // pinion, gear
    SparseRowList coarse[2];

    SparseRows refined_of(int side, Index pair) const {
        return SparseRows(refined[side]).part(ends[pair], ends[pair + 1]);
    }
    SparseRows coarse_of(int side, Index pair) const {
        return SparseRows(coarse[side]).part(ends[pair], ends[pair + 1]);
    }
    bool any(Index pair) const { return ends[pair + 1] > ends[pair]; }
};

// Fill in the influence matrix (m, m) m/N of basis functions of pairs `teeth`; uncoupled, teeth move alone.
inline void fill_influence(const FunctionForces& forces, std::span<const Index> teeth,
                           const Surface (&surfaces)[2], bool coupled, TwoSidedAverage& average,
                           OwnedTable& matrix) {
    matrix.reset(forces.ends.back(), forces.ends.back());
    const auto pairs = static_cast<Index>(teeth.size());
    for (Index i = 0; i < pairs; ++i) {
        for (int side = 0; side < 2; ++side) {
            const Surface& body = surfaces[side];
            for (Index j = 0; coupled && j < i; ++j) {
                const Index places = teeth[i] - teeth[j];
                if (!body.reaches(places) || !forces.any(i) || !forces.any(j)) continue;
                average.add(matrix.view(), forces.ends[j], forces.ends[i], body.scale,
                            forces.coarse_of(side, i), body.beside(places), forces.coarse_of(side, j), false);
            }
            const SparseRows own = forces.refined_of(side, i);
            if (forces.any(i)) {
                average.add(matrix.view(), forces.ends[i], forces.ends[i], body.scale, own, body.own, own,
                            true);
            }
        }
    }
    mirror(matrix.view());
}

} // namespace facegear::contact
