// Approach of basis functions by the forces on others, without the influence of each on each.
#pragma once

#include "contact/influence.hpp"

namespace facegear::contact {

// Rows of a list that are asked for, and for how many of the load cases each, from the first on.
struct WantedRows {
    std::vector<Index> row;   // (k), rising
    std::vector<Index> cases; // (k)

    void clear() {
        row.clear();
        cases.clear();
    }
    void push_back(Index number, Index count) {
        row.push_back(number);
        cases.push_back(count);
    }
};

// Moves nodes by nodal forces: displacement (u, t) += sum over loaded nodes l of C(l, node u) force (l, t).
struct NodalDisplacement {
    // Load cases that are summed together; more are summed in turns.
    static constexpr Index CASES = 6;

    // Add the displacements of `nodes` (u), rising, by rows of nodal forces times `forces` (t, m of the
    // rows). A loaded node stands in a row of the compliance, whose neighbours are read together.
    void add(std::span<const Index> nodes, Table<const double> compliance, SparseRows rows,
             Table<const double> forces, Index first_force, OwnedTable& displacement) {
        load_nodes(rows, forces, first_force, compliance.rows);
        blocks.begin_with(compliance.columns);
        blocks.mark(nodes);
        blocks.make();
        const Index cases = forces.rows;
        sums.assign(blocks.blocks() * cases, Vector::splat(0.0));
        for (Index first = 0; first < loaded.count(); first += TOGETHER) {
            const Index last = std::min(first + TOGETHER, loaded.count());
            loaded.copy(compliance, first, last, blocks.begin);
            for (Index t = 0; t < cases; t += CASES) sum_cases(first, t, std::min(CASES, cases - t));
        }
        for (std::size_t u = 0; u < nodes.size(); ++u) {
            const Index place = blocks.slot[nodes[u]];
            const Vector* sum = sums.data() + place / LANES * cases;
            for (Index t = 0; t < cases; ++t) displacement(static_cast<Index>(u), t) += sum[t][place % LANES];
        }
    }

  private:
    // Rows of the compliance that are summed together: their used columns stay in the processor's first
    // cache.
    static constexpr Index TOGETHER = 8;

    ColumnBlocks blocks;
    UsedRows loaded;          // rows of the loaded nodes (l)
    OwnedTable pushed;        // (l, t) N
    std::vector<Vector> sums; // (b, t) displacements of the blocks' columns

    void load_nodes(SparseRows rows, Table<const double> forces, Index first_force, Index nodes) {
        loaded.slot.assign(nodes, -1);
        for (Index i = 0; i < rows.count(); ++i) {
            for (Index t = 0; t < forces.rows; ++t) {
                if (forces(t, first_force + i) == 0.0) continue;
                for (const Index node : rows.columns(i)) loaded.slot[node] = 0;
                break;
            }
        }
        loaded.number_rows();
        pushed.reset(loaded.count(), forces.rows);
        for (Index i = 0; i < rows.count(); ++i) {
            const auto columns = rows.columns(i);
            const auto weights = rows.weights(i);
            for (Index t = 0; t < forces.rows; ++t) {
                const double force = forces(t, first_force + i);
                if (force == 0.0) continue;
                for (std::size_t k = 0; k < columns.size(); ++k)
                    pushed(loaded.slot[columns[k]], t) += weights[k] * force;
            }
        }
    }

    void sum_cases(Index first, Index t, Index count) {
        switch (count) {
            case 1:
                return sum_all<1, 8>(first, t);
            case 2:
                return sum_all<2, 4>(first, t);
            case 3:
                return sum_all<3, 4>(first, t);
            case 4:
                return sum_all<4, 2>(first, t);
            case 5:
                return sum_all<5, 2>(first, t);
            default:
                return sum_all<CASES, 2>(first, t);
        }
    }

    template <int Cases, int Width>
    void sum_all(Index first, Index t) {
        Index block = 0;
        for (; block + Width <= blocks.blocks(); block += Width) sum_blocks<Cases, Width>(first, t, block);
        for (; block < blocks.blocks(); ++block) sum_blocks<Cases, 1>(first, t, block);
    }

    // `Cases` load cases from `t` on of `Width` neighbouring blocks are summed in registers, over the copied
    // rows.
    template <int Cases, int Width>
    void sum_blocks(Index first, Index t, Index block) {
        Vector sum[Width][Cases];
        for (int w = 0; w < Width; ++w) {
            for (int c = 0; c < Cases; ++c) sum[w][c] = sums[(block + w) * pushed.columns + t + c];
        }
        for (Index row = 0; row < loaded.values.rows; ++row) {
            const double* values = loaded.values.row(row) + LANES * block;
            const double* force = pushed.row(first + row) + t;
            for (int c = 0; c < Cases; ++c) {
                const Vector factor = Vector::splat(force[c]);
                for (int w = 0; w < Width; ++w) {
                    sum[w][c] = multiply_add(factor, Vector::load(values + LANES * w), sum[w][c]);
                }
            }
        }
        for (int w = 0; w < Width; ++w) {
            for (int c = 0; c < Cases; ++c) sums[(block + w) * pushed.columns + t + c] = sum[w][c];
        }
    }
};

// Approach of basis functions by forces on others, pair by pair.
struct Approach {
    // Fill in the approach (k, t) m of the wanted functions, of which those of pair p are ends[p] up to
    // ends[p + 1], in the cases wanted of each; 0 in the others. `every`: nodal forces of all functions on
    // both refined surfaces; `force` (t, m) N on the functions of `pushing`.
    void fill(const WantedRows& wanted, std::span<const Index> ends, const SparseRowList (&every)[2],
              const Surface (&surfaces)[2], std::span<const Index> teeth, const FunctionForces& pushing,
              Table<const double> force, bool coupled, OwnedTable& total) {
        total.reset(static_cast<Index>(wanted.row.size()), force.rows);
        for (Index pair = 0; pair < static_cast<Index>(teeth.size()); ++pair) {
            for (int side = 0; side < 2 && ends[pair] < ends[pair + 1]; ++side) {
                const Surface& body = surfaces[side];
                const std::span<const Index> rows(wanted.row.data() + ends[pair],
                                                  wanted.row.data() + ends[pair + 1]);
                const std::span<const Index> cases(wanted.cases.data() + ends[pair],
                                                   wanted.cases.data() + ends[pair + 1]);
                find_nodes(every[side], rows, cases, body.faces.nodes(), nodes);
                moved.reset(static_cast<Index>(nodes.wanted.row.size()), force.rows);
                if (pushing.any(pair)) {
                    nodal.add(nodes.wanted.row, body.own, pushing.refined_of(side, pair), force,
                              pushing.ends[pair], moved);
                }
                if (coupled) add_others(body, side, pair, teeth, pushing, force);
                average(every[side], rows, cases, nodes.slot, moved, body.scale, total.row(ends[pair]));
            }
        }
    }

  private:
    struct Nodes {
        WantedRows wanted;
        std::vector<Index> slot; // (n) number of each node among the wanted ones, -1 of the others
    };

    Nodes nodes, coarse;
    OwnedTable moved, beside;
    NodalDisplacement nodal;

    // Nodes of some rows, each for as many cases as any of its rows.
    static void find_nodes(SparseRows rows, std::span<const Index> which, std::span<const Index> cases,
                           Index count, Nodes& found) {
        found.slot.assign(count, 0);
        for (std::size_t i = 0; i < which.size(); ++i) {
            for (const Index node : rows.columns(which[i]))
                found.slot[node] = std::max(found.slot[node], cases[i]);
        }
        found.wanted.clear();
        for (Index node = 0; node < count; ++node) {
            const Index wanted = found.slot[node];
            found.slot[node] = wanted > 0 ? static_cast<Index>(found.wanted.row.size()) : -1;
            if (wanted > 0) found.wanted.push_back(node, wanted);
        }
    }

    // Displacements of refined nodes by forces on other teeth: they are smooth, and read before refinement.
    void add_others(const Surface& body, int side, Index pair, std::span<const Index> teeth,
                    const FunctionForces& pushing, Table<const double> force) {
        find_nodes(body.interpolation, nodes.wanted.row, nodes.wanted.cases, body.coarse_nodes, coarse);
        beside.reset(static_cast<Index>(coarse.wanted.row.size()), force.rows);
        for (Index other = 0; other < static_cast<Index>(teeth.size()); ++other) {
            // what teeth do to each other is symmetric: this block has a row for each loaded node
            const Index places = teeth[other] - teeth[pair];
            if (other == pair || !pushing.any(other) || !body.reaches(places)) continue;
            nodal.add(coarse.wanted.row, body.beside(places), pushing.coarse_of(side, other), force,
                      pushing.ends[other], beside);
        }
        average(body.interpolation, nodes.wanted.row, nodes.wanted.cases, coarse.slot, beside, 1.0,
                moved.row(0));
    }

    // Add to the first cases[i] columns of total (k, t) the averages by some rows of displacements (u, t) of
    // nodes.
    static void average(SparseRows rows, std::span<const Index> which, std::span<const Index> cases,
                        const std::vector<Index>& slot, OwnedTable& displacement, double scale,
                        double* total) {
        for (std::size_t i = 0; i < which.size(); ++i) {
            double* sums = total + static_cast<Index>(i) * displacement.columns;
            const auto columns = rows.columns(which[i]);
            const auto weights = rows.weights(which[i]);
            for (std::size_t k = 0; k < columns.size(); ++k) {
                const double* values = displacement.row(slot[columns[k]]);
                for (Index t = 0; t < cases[i]; ++t) sums[t] += scale * weights[k] * values[t];
            }
        }
    }
};

} // namespace facegear::contact
