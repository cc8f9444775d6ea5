// Disturbances of the motion: moved over a step by the same recurrence, with the slopes of the forces.
//
// A single one goes in the vectors that the motion itself uses. Many of one machine go in blocks, side by
// side along the innermost axis: then every entry of G is read once for all of them, and those that are zero
// are left out. With rings or friction they go one by one.
#pragma once

#include <algorithm>
#include <cmath>

#include "motion/parting.hpp"
#include "motion/taylor.hpp"
#include "motion/work.hpp"

namespace facegear::motion {

// Disturbances: rows 2 j and 2 j + 1 are displacement and velocity of number j.
template <class L>
struct Tangents {
    Table<L> table;
    Index columns = 0;
};

// Saltation: where the mesh damping starts or stops the velocity part shears by G^T (c- - c+) G.
//
// The law alone gives none, since its force is continuous at every level (Leine and Nijmeijer 2004). Neither
// do flanks that part where a contact only pushes: their force was zero before.
template <class L, class Law>
void switch_tangents(Work<L, Law>& w, Tangents<L> tangents) {
    using S = typename L::S;
    const S none = S::splat(0.0);
    for (Index r = 0; r < w.rings.count(); ++r) {
        // Where a ring starts or ends to press only the damping along r jumps.
        const Index x = w.rings.across(r), rim = w.rings.rim(r);
        S change = w.active.of(0, rim) - w.was_acting.of(0, rim);
        change = where_positive(w.fresh, none, change);
        if (positive_lanes(absolute(change)) == 0) continue;
        const S across = w.deflection.of(0, x), up = w.deflection.of(0, x + 1);
        S damping = change * w.rings.lag() * w.rings.stiffness(r) / (across * across + up * up);
        damping = where_positive(absolute(change), damping, none);
        for (Index j = 0; j < tangents.columns; ++j) {
            const S along = across * w.products.dot(x, tangents.table, 2 * j) +
                            up * w.products.dot(x + 1, tangents.table, 2 * j);
            w.products.add_row(x, -(damping * along * across), tangents.table, 2 * j + 1);
            w.products.add_row(x + 1, -(damping * along * up), tangents.table, 2 * j + 1);
        }
    }
    for (Index contact = 0; contact < w.shape->contacts; ++contact) {
        S now = w.acting.of(0, contact);
        if (w.shape->push_only) now = w.mesh_damping.of(0, contact) * absolute(w.side.of(0, contact));
        S jump = w.was_acting.of(0, contact) - now;
        if (w.shape->push_only) jump = smaller(jump, none);
        jump = where_positive(w.fresh, none, jump);
        if (positive_lanes(absolute(jump)) == 0) continue;
        for (Index j = 0; j < tangents.columns; ++j) {
            const S along = jump * w.products.dot(contact, tangents.table, 2 * j);
            w.products.add_row(contact, along, tangents.table, 2 * j + 1);
        }
    }
}

// Remember what acts in this step for the next.
template <class L, class Law>
void keep_acting(Work<L, Law>& w) {
    for (Index b = 0; b < blocks_of<L>(w.shape->contacts); ++b)
        w.was_acting.put(0, b, shearing_damping(w, b));
    for (Index row = w.shape->contacts; row < w.m; ++row) w.was_acting.set(0, row, w.active.of(0, row));
}

// The steps, or so much less of them that the last terms of a curved law's slopes turn a disturbance by no
// more than the tolerance. The motion alone says nothing of them where its force is small.
template <class L, class Law>
void shorten_for_tangents(Work<L, Law>& w) {
    using V = typename L::V;
    using S = typename L::S;
    if (!Law::curved) return;
    const V none = V::splat(0.0);
    for (Index i = w.order - 1; i <= w.order; ++i) {
        V size = none;
        for (Index b = 0; b < blocks_of<L>(w.shape->contacts); ++b) {
            const V own = w.leverage.at(0, b) * absolute(w.law.slope().at(i, w.touching.block_of(b)));
            size = larger(size, where_positive(w.active.at(0, b), own, none));
        }
        S whole = Products<L>::largest(size) * S::splat(1.0 / static_cast<double>((i + 1) * (i + 2)));
        whole = larger(whole, S::splat(smallest_size));
        const S power = logarithm(w.tolerance / whole) * S::splat(1.0 / static_cast<double>(i + 2));
        w.length = smaller(w.length, exponential(smaller(larger(power, S::splat(-600.0)), S::splat(600.0))));
    }
}

// Terms that disturbances of one machine need over a step: most steps end at a switch, below the longest. The
// fastest disturbance's last term is then below a tenth of what the longest step leaves it.
template <class L, class Law>
Index order_needed(const Work<L, Law>& w) {
    if (L::machines > 1 || Law::curved) return w.order;
    const double reach = w.length[0] * w.fastest[0], goal = std::min(10.0 * w.tolerance[0], 1e-3);
    double term = 0.5 * reach * reach;
    for (Index i = 2; i < w.order; ++i) {
        if (term < goal) return i;
        term *= reach / static_cast<double>(i + 1);
    }
    return w.order;
}

template <class L, class Law>
void move_tangent(Work<L, Law>& w, Index order, Table<L> table, Index column) {
    for (Index row = 0; row < 2; ++row) {
        for (Index b = 0; b < w.turn.width; ++b) w.turn.put(row, b, table.at(2 * column + row, b));
        w.products.deflect(w.turn, row, nullptr, w.turned);
    }
    recurrence(w, 0, order - 1, w.turn, w.turned, true);
    move_ahead(w.turn, order, w.length, table, 2 * column, 2 * column + 1);
}

// Disturbances of one machine side by side: a vector holds the same entity of several of them.
template <int W>
class Block {
    using V = Lanes<W>;
    static constexpr int vectors = 3; // as many as the registers hold with what they are multiplied by
    static constexpr Index width = vectors * W;

  public:
    static constexpr Index count = width;

    Block(Index rows, Index n, Index m)
        : n_(n),
          m_(m),
          y_(room_.numbers(rows * n * width)),
          deflection_(room_.numbers(rows * m * width)),
          force_(room_.numbers(m * width)) {}

    // Move up to `count` disturbances from number `first` on.
    template <class L, class Law>
    void move(Work<L, Law>& w, Index order, Tangents<L> tangents, Index first) {
        const System& system = *w.entered[0].system;
        if (system.coupled) take_coupling(w.entered[0]);
        const Index own = std::min(count, tangents.columns - first);
        for (Index row = 0; row < 2; ++row) {
            for (Index k = 0; k < n_; ++k)
                for (Index j = 0; j < count; ++j)
                    y_[(row * n_ + k) * width + j] =
                        j < own ? tangents.table.one(2 * (first + j) + row, k, 0) : 0.0;
            deflect(system.by_contact, row);
        }
        for (Index i = 0; i < order - 1; ++i) {
            push(w, i);
            expand(w, system, i);
            deflect(system.by_contact, i + 2);
        }
        evaluate(order, w.length[0]);
        for (Index row = 0; row < 2; ++row)
            for (Index k = 0; k < n_; ++k)
                for (Index j = 0; j < own; ++j)
                    tangents.table.one(2 * (first + j) + row, k, 0) = y_[(row * n_ + k) * width + j];
    }

  private:
    // Take the coupling at the frequency of a machine, which changes between two runs alone.
    void take_coupling(const Machine& machine) {
        if (entered_.system == machine.system && entered_.frequency == machine.frequency) return;
        entered_ = machine;
        const System& system = *machine.system;
        coupling_ = system.coupled_rows;
        for (Index k = 0; k < n_; ++k)
            for (Index e = coupling_.starts[k]; e < coupling_.starts[k + 1]; ++e) {
                const Index column = coupling_.columns[e];
                coupling_.values[e] = column < n_ ? system.by_velocity(k, column, machine.frequency)
                                                  : system.by_displacement(k, column - n_, machine.frequency);
            }
    }

    void deflect(const Sparse& matrix, Index row) {
        for (Index contact = 0; contact < m_; ++contact) {
            Sums<V, vectors> sums;
            sums.clear();
            for (Index e = matrix.starts[contact]; e < matrix.starts[contact + 1]; ++e)
                sums.add_even(y_ + (row * n_ + matrix.columns[e]) * width, V::splat(matrix.values[e]));
            sums.store(deflection_ + (row * m_ + contact) * width);
        }
    }

    // Coefficient i of every contact's force, with the factor of the coordinates' next one.
    template <class L, class Law>
    void push(Work<L, Law>& w, Index i) {
        const Series<L> slope = w.law.slope();
        for (Index contact = 0; contact < m_; ++contact) {
            Sums<V, vectors> sums;
            sums.clear();
            sums.add_odd(deflection_ + ((i + 1) * m_ + contact) * width,
                         V::splat(w.acting.one(0, contact, 0) * static_cast<double>(i + 1)));
            if (w.active.one(0, contact, 0) != 0.0) {
                const Index block = contact / (L::lanes / L::machines),
                            lane = contact % (L::lanes / L::machines);
                const double* values = slope.begin(block) + lane;
                for (Index j = i; j >= 0; --j)
                    sums.add_even(deflection_ + ((i - j) * m_ + contact) * width,
                                  V::splat(values[j * slope.table.stride()]));
            }
            sums.store(force_ + contact * width, V::splat(-1.0 / static_cast<double>((i + 1) * (i + 2))));
        }
    }

    // Coefficient i + 2 of every coordinate from those before it and the forces.
    template <class L, class Law>
    void expand(Work<L, Law>& w, const System& system, Index i) {
        const Sparse& matrix = system.by_coordinate;
        const double factor = -1.0 / static_cast<double>((i + 1) * (i + 2));
        for (Index k = 0; k < n_; ++k) {
            Sums<V, vectors> sums;
            sums.clear();
            sums.add_even(y_ + (i * n_ + k) * width, V::splat(factor * w.omega_squared.one(0, k, 0)));
            sums.add_odd(y_ + ((i + 1) * n_ + k) * width,
                         V::splat(factor * static_cast<double>(i + 1) * w.damping.one(0, k, 0)));
            for (Index e = matrix.starts[k]; e < matrix.starts[k + 1]; ++e)
                sums.add_even(force_ + matrix.columns[e] * width, V::splat(matrix.values[e]));
            if (system.coupled) couple(sums, k, i);
            sums.store(y_ + ((i + 2) * n_ + k) * width);
        }
    }

    // Add what couples coordinate k with others beside the meshes, from the two rows before.
    void couple(Sums<V, vectors>& sums, Index k, Index i) const {
        const double by_rate = -1.0 / static_cast<double>(i + 2);
        const double by_place = -1.0 / static_cast<double>((i + 1) * (i + 2));
        for (Index e = coupling_.starts[k]; e < coupling_.starts[k + 1]; ++e) {
            const Index column = coupling_.columns[e];
            const bool is_rate = column < n_;
            const double* of_column = y_ + (is_rate ? (i + 1) * n_ + column : i * n_ + column - n_) * width;
            sums.add_odd(of_column, V::splat((is_rate ? by_rate : by_place) * coupling_.values[e]));
        }
    }

    void evaluate(Index order, double step) {
        const V ahead = V::splat(step);
        const Index stride = n_ * width;
        for (Index at = 0; at < stride; at += W) {
            V value = V::load(y_ + order * stride + at), slope = V::splat(0.0);
            for (Index i = order - 1; i >= 0; --i) {
                slope = slope * ahead + value;
                value = value * ahead + V::load(y_ + i * stride + at);
            }
            value.store(y_ + at);
            slope.store(y_ + stride + at);
        }
    }

    Room room_;
    Index n_, m_;
    double* y_;
    double* deflection_;
    double* force_;
    Machine entered_;
    Sparse coupling_; // as System::coupled_rows, with values
};

// Move disturbances over the steps whose polynomials `w` holds. block: null where they go one by one.
template <class L, class Law>
void move_tangents(Work<L, Law>& w, Tangents<L> tangents, Block<L::lanes>* block) {
    const bool plain = w.rings.count() == 0 && w.friction.count() == 0 && !Law::moves;
    const Index order = plain && !w.shape->coupled ? order_needed(w) : w.order;
    if (block != nullptr && plain && tangents.columns > 1) {
        for (Index first = 0; first < tangents.columns; first += Block<L::lanes>::count)
            block->move(w, order, tangents, first);
        return;
    }
    for (Index column = 0; column < tangents.columns; ++column)
        move_tangent(w, order, tangents.table, column);
}

// Minus the integral over the step of the damping that acts: of the divergence of the flow.
template <class L, class Law>
typename L::S divergence(const Work<L, Law>& w) {
    using V = typename L::V;
    V own = V::splat(0.0), contacts = own;
    for (Index b = 0; b < w.damping.width; ++b) own = own + w.damping.at(0, b);
    for (Index b = 0; b < w.acting.width; ++b) contacts = w.acting.at(0, b) * w.leverage.at(0, b) + contacts;
    const typename L::S sum = Products<L>::sum(own) + Products<L>::sum(contacts);
    return -(w.length * sum + w.rings.trace(w.active, w.leverage, w.order, w.length));
}

// Length of a disturbance of one machine, which is divided by it.
template <class L, class Law>
double shorten(const Work<L, Law>& w, Table<L> tangents, int machine) {
    double total = 0.0;
    for (Index row = 0; row < 2; ++row)
        for (Index k = 0; k < w.n; ++k) {
            const double along = w.weights.one(0, k, machine) * tangents.one(row, k, machine);
            total += along * along;
        }
    const double length = std::sqrt(total);
    for (Index row = 0; row < 2; ++row)
        for (Index k = 0; k < w.n; ++k) tangents.one(row, k, machine) /= length;
    return length;
}

} // namespace facegear::motion
