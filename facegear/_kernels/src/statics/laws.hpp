// The laws of a contact at K phases of the mesh period, as statics asks for them
// (docs/explanation/mesh_law.md).
//
// A law is a struct with `stiffness` (K, contacts), bounds of the slopes in N/m, and a function at(phase,
// contact, amount > 0) that returns force and slope. A new law gets a struct here and a line in
// bindings/statics.cpp.
#pragma once

#include "tables.hpp"

namespace facegear::statics {

// N, and its derivative by the amount pressed in, N/m.
struct ForceAndSlope {
    double force, slope;
};

// F = k(phase) x.
struct LinearLaw {
    Table<const double> stiffness; // (K, contacts), N/m

    ForceAndSlope at(Index phase, Index contact, double amount) const {
        const double k = stiffness(phase, contact);
        return {k * amount, k};
    }
};

// F is a cubic of the amount between two levels, whose coefficients are Fourier series of the phase.
struct LoadDependentLaw {
    Table<const double> stiffness;    // (K, contacts), N/m
    Table<const double> cosine, sine; // (K, harmonics + 1) of the phases
    const double* table; // (kinds, levels, harmonics + 1, 2, 4): sine part first, by powers of the amount
    Table<const double> levels; // (kinds, levels) at which the cubics begin, m, rising
    List<const Index> kind;     // (contacts,)

    ForceAndSlope at(Index phase, Index contact, double amount) const {
        const Index own = kind[contact], piece = piece_of(own, amount);
        const Index harmonics = cosine.columns;
        const double* series = table + 8 * harmonics * (own * levels.columns + piece);
        double c[4] = {0.0, 0.0, 0.0, 0.0};
        for (Index j = 0; j < harmonics; ++j) {
            const double sin = sine(phase, j), cos = cosine(phase, j);
            for (Index power = 0; power < 4; ++power)
                c[power] += series[8 * j + power] * sin + series[8 * j + 4 + power] * cos;
        }
        const double d = amount - levels(own, piece);
        return {c[0] + d * (c[1] + d * (c[2] + d * c[3])), c[1] + d * (2.0 * c[2] + 3.0 * d * c[3])};
    }

  private:
    // The last level that an amount has reached, by bisection.
    Index piece_of(Index own, double amount) const {
        Index low = 0, high = levels.columns;
        while (high - low > 1) {
            const Index middle = (low + high) / 2;
            (levels(own, middle) <= amount ? low : high) = middle;
        }
        return low;
    }
};

} // namespace facegear::statics
