// Cubics in pieces at many amounts, whose coefficients are periodic series of the phase.
#pragma once

#include <cmath>

#include "tables.hpp"

namespace facegear::samples {

// Odd cubics of some kinds, whose coefficients are those at K phases.
struct Cubics {
    Table<const double> levels; // (kinds, L), amounts at which the pieces begin, rising from 0
    const double* coefficients; // (kinds, L, K, 4), of the powers of the amount since then
    Index phases;               // K

    const double* at(Index kind, Index piece, Index phase) const {
        return coefficients + 4 * (phases * (levels.columns * kind + piece) + phase);
    }
};

// Writes the cubics, or else their slopes, of contacts (M,) of some kinds at amounts (M, B, K); `periods` is
// B. Zero where nothing is pressed in.
inline void evaluate(const Cubics& cubics, List<const Index> kind, Index periods, bool slopes,
                     const double* amounts, double* values) {
    const Index pieces = cubics.levels.columns;
    for (Index m = 0; m < kind.size; ++m) {
        const double* levels = cubics.levels.row(kind[m]);
        Index piece = 0; // neighbouring samples are seldom in pieces far from each other
        for (Index b = 0; b < periods; ++b) {
            for (Index k = 0; k < cubics.phases; ++k, ++amounts, ++values) {
                const double amount = std::fabs(*amounts);
                if (!(amount > 0.0)) {
                    *values = 0.0;
                    continue;
                }
                while (piece + 1 < pieces && levels[piece + 1] <= amount) ++piece;
                while (piece > 0 && levels[piece] > amount) --piece;
                const double* c = cubics.at(kind[m], piece, k);
                const double d = amount - levels[piece];
                if (slopes) {
                    *values = c[1] + d * (2.0 * c[2] + 3.0 * d * c[3]);
                } else {
                    const double force = c[0] + d * (c[1] + d * (c[2] + d * c[3]));
                    *values = *amounts > 0.0 ? force : -force;
                }
            }
        }
    }
}

} // namespace facegear::samples
