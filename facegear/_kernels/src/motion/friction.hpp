// Friction of flanks: forces along directions of their own, each a ratio times the elastic force of a flank.
//
// The ratio is a Fourier series in the phase. The force is the law's, and goes to zero with slope zero or
// more at the edge: it is continuous and depends on no velocity, so that friction shears no tangent and
// leaves the divergence alone. A flank whose spring and damper together only push is rubbed by its spring
// until it parts.
#pragma once

#include "motion/fourier.hpp"
#include "motion/layout.hpp"
#include "motion/products.hpp"
#include "motion/system.hpp"

namespace facegear::motion {

template <class L>
class Friction {
    using S = typename L::S;

  public:
    Friction(const System& system, Index rows)
        : flank_(system.rubbing_flank.data()),
          count_(system.rubbing()),
          terms_(system.rubbing_ratios.terms),
          series_(room_.table<L>(2 * terms_, count_)),
          ratios_(room_.table<L>(rows, count_)) {}

    Index count() const { return count_; }

    void enter(const Machine& machine, int lane) {
        if (count_) enter_series(machine.system->rubbing_ratios, 1.0, lane, series_);
    }
    void expand(Expansion<L>& expansion, Index rows) {
        if (count_) expansion.expand(series_, terms_, rows, ratios_);
    }

    // Add coefficient i of the forces, times the factor, to a row of the coordinates. elastic: forces of the
    // flanks.
    void rub(Table<L> elastic, Table<L> side, Index i, double factor, const Products<L>& products, Table<L> y,
             Index row) const {
        for (Index k = 0; k < count_; ++k) {
            const Index flank = flank_[k];
            if (positive_lanes(absolute(side.of(0, flank))) == 0) continue;
            S even = S::splat(0.0), odd = even;
            Index j = 0;
            for (; j < i; j += 2) {
                even = ratios_.of(j, k) * elastic.of(i - j, flank) + even;
                odd = ratios_.of(j + 1, k) * elastic.of(i - j - 1, flank) + odd;
            }
            if (j == i) even = ratios_.of(j, k) * elastic.of(0, flank) + even;
            products.rub(k, S::splat(factor) * (even + odd), y, row);
        }
    }

  private:
    Room room_;
    const Index* flank_;
    Index count_, terms_;
    Table<L> series_, ratios_;
};

} // namespace facegear::motion
