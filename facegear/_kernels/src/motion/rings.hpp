// Bearings with radial clearance: a body's x and y inside a ring, exact in two dimensions.
//
//     F = k (1 - c / r) (x, y) beyond the clearance c, none inside, and the bearing's damping beta dF/dt
//
// Each ring has three rows among the contacts, none with a force of its own: x, y, and (r^2 - c^2) / (2 c),
// near the rim the way beyond it, whose zeros are the switches. Powers of series follow from the recurrence
// of f g' = p f' g for g = f^p.
#pragma once

#include "motion/functions.hpp"
#include "motion/layout.hpp"
#include "motion/system.hpp"

namespace facegear::motion {

constexpr Index ring_rows = 3;

template <class L>
class Rings {
    using V = typename L::V;
    using S = typename L::S;

  public:
    Rings(const System& system, Index rows) : count_(system.rings()), first_(system.contacts) {
        for (Table<L>* each : {&stiffness_, &clearance_, &reciprocal_}) *each = room_.table<L>(1, count_);
        for (Table<L>* each : {&x_, &y_, &dx_, &dy_, &square_, &inverse_, &cube_, &force_x_, &force_y_,
                               &product_, &slope_xx_, &slope_xy_, &slope_yy_})
            *each = room_.table<L>(rows, count_);
    }

    Index count() const { return count_; }

    void enter(const Machine& machine, int lane) {
        const double w = machine.frequency;
        for (Index r = 0; r < count_; ++r) {
            stiffness_.one(0, r, lane) = machine.system->ring_stiffness[r] / (w * w);
            clearance_.one(0, r, lane) = machine.system->ring_clearance[r];
        }
        lag_.set(lane, machine.system->ring_lag * w);
    }

    // Coefficient i of every ring's third row, and of its force where that is pressed.
    void expand(Table<L> deflection, Table<L> active, Index i) {
        gather(deflection, i, x_, y_);
        for (Index b = 0; b < x_.width; ++b) square_.put(i, b, product(x_, x_, i, b) + product(y_, y_, i, b));
        for (Index r = 0; r < count_; ++r) {
            const S square = square_.of(i, r), clearance = clearance_.of(0, r), half = S::splat(0.5);
            const S inside = i == 0 ? half * clearance : S::splat(0.0);
            deflection.set(i, rim(r), half * square / clearance - inside);
            if (i == 0)
                reciprocal_.set(0, r,
                                where_positive(active.of(0, rim(r)), S::splat(1.0) / square, S::splat(0.0)));
        }
        power(i, -0.5, inverse_);
        for (Index b = 0; b < x_.width; ++b) {
            const V k = stiffness_.at(0, b), c = clearance_.at(0, b);
            force_x_.put(i, b, k * (x_.at(i, b) - c * product(x_, inverse_, i, b))); // k (1 - c / r) x
            force_y_.put(i, b, k * (y_.at(i, b) - c * product(y_, inverse_, i, b)));
        }
    }

    // Put coefficient i of the forces, spring and damping, times the factor into `force`.
    void push(Table<L> active, Index i, double factor, Table<L> force) const {
        const S lag = lag_ * S::splat(static_cast<double>(i + 1));
        for (Index r = 0; r < count_; ++r) {
            const S pressed = S::splat(factor) * active.of(0, rim(r));
            force.set(0, across(r), pressed * (force_x_.of(i, r) + lag * force_x_.of(i + 1, r)));
            force.set(0, across(r) + 1, pressed * (force_y_.of(i, r) + lag * force_y_.of(i + 1, r)));
        }
    }

    // All coefficients of dF/dq: k (1 - c / r) + k c x x / r^3 and so on, xx, xy, yy.
    void expand_slopes(Index order) {
        if (count_ == 0) return;
        for (Index i = 0; i <= order; ++i) power(i, -1.5, cube_);
        expand_slope(order, x_, x_, 1.0, slope_xx_);
        expand_slope(order, x_, y_, 0.0, slope_xy_);
        expand_slope(order, y_, y_, 1.0, slope_yy_);
    }

    // Coefficient i of the change of every ring's force with a disturbance's deflection, into the forces.
    void expand_disturbed(Table<L> deflection, Index i) {
        gather(deflection, i, dx_, dy_);
        for (Index b = 0; b < x_.width; ++b) {
            force_x_.put(i, b, product(slope_xx_, dx_, i, b) + product(slope_xy_, dy_, i, b));
            force_y_.put(i, b, product(slope_xy_, dx_, i, b) + product(slope_yy_, dy_, i, b));
        }
    }

    // Integral over a step of the damping of all rings that are pressed: their part of the divergence.
    S trace(Table<L> active, Table<L> leverage, Index order, S length) const {
        S total = S::splat(0.0);
        for (Index r = 0; r < count_; ++r) {
            S power = lag_ * active.of(0, rim(r));
            for (Index i = 0; i <= order; ++i) {
                power = power * length;
                const S along = leverage.of(0, across(r)) * slope_xx_.of(i, r) +
                                leverage.of(0, across(r) + 1) * slope_yy_.of(i, r);
                total = total + power * S::splat(1.0 / static_cast<double>(i + 1)) * along;
            }
        }
        return total;
    }

    Index across(Index r) const { return first_ + ring_rows * r; }
    Index rim(Index r) const { return across(r) + 2; }
    S lag() const { return lag_; }
    S stiffness(Index r) const { return stiffness_.of(0, r); }

  private:
    void gather(Table<L> deflection, Index i, Table<L> x, Table<L> y) const {
        for (Index r = 0; r < count_; ++r) {
            x.set(i, r, deflection.of(i, across(r)));
            y.set(i, r, deflection.of(i, across(r) + 1));
        }
    }

    // Coefficient i of r^2 to a power (-1/2 or -3/2), the ones before it known; zeros where no ring is
    // pressed.
    void power(Index i, double exponent, Table<L> out) const {
        for (Index b = 0; b < out.width; ++b) {
            const V reciprocal = reciprocal_.at(0, b);
            if (i == 0) {
                const V root = square_root(reciprocal);
                out.put(0, b, exponent == -0.5 ? root : reciprocal * root);
                continue;
            }
            V total = V::splat(0.0);
            for (Index j = 1; j <= i; ++j) {
                const double weight =
                    (exponent * static_cast<double>(j) - static_cast<double>(i - j)) / static_cast<double>(i);
                total = V::splat(weight) * square_.at(j, b) * out.at(i - j, b) + total;
            }
            out.put(i, b, total * reciprocal);
        }
    }

    // k (same (1 - c / r) + c one two / r^3) into out.
    void expand_slope(Index order, Table<L> one, Table<L> two, double same, Table<L> out) {
        for (Index b = 0; b < out.width; ++b) {
            for (Index i = 0; i <= order; ++i) {
                product_.put(i, b, product(one, two, i, b));
                const V turned = product(product_, cube_, i, b) - V::splat(same) * inverse_.at(i, b);
                const V whole = V::splat(i == 0 ? same : 0.0);
                out.put(i, b, stiffness_.at(0, b) * (whole + clearance_.at(0, b) * turned));
            }
        }
    }

    Room room_;
    Index count_, first_;
    S lag_ = S::splat(0.0);
    Table<L> stiffness_, clearance_, reciprocal_;
    Table<L> x_, y_, dx_, dy_, square_, inverse_, cube_, force_x_, force_y_, product_;
    Table<L> slope_xx_, slope_xy_, slope_yy_;
};

} // namespace facegear::motion
