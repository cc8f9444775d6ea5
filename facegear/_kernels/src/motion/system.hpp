// What is integrated: unit-mass oscillators coupled by meshes with clearance (docs/explanation/dynamics.md).
//
//     y'' + damping y' + omega_squared y + coupling + G^T F = load(s),   F = law(s, x) + c d',   d = G y -
//     e(s)
//
// with x = d - upper above `upper`, d - lower below `lower`, zero between (Kahraman and Singh 1990).
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "motion/fourier.hpp"
#include "motion/laws/all.hpp"
#include "motion/layout.hpp"

namespace facegear::motion {

// Entries of row i stand from starts[i] to starts[i + 1].
struct Sparse {
    std::vector<Index> starts{0}, columns;
    std::vector<double> values;
};

// Entries of a matrix below this part of its largest are zeros that rounding has left.
constexpr double matrix_rounding = 1e-15;

inline double largest_entry(const std::vector<double>& matrix) {
    double largest = 0.0;
    for (double value : matrix) largest = std::max(largest, std::fabs(value));
    return largest;
}

// A matrix (rows, columns) without zeros but for rounding.
inline Sparse sparse_of(const std::vector<double>& matrix, Index rows, Index columns) {
    const double kept = matrix_rounding * largest_entry(matrix);
    Sparse result;
    for (Index i = 0; i < rows; ++i) {
        for (Index j = 0; j < columns; ++j) {
            const double value = matrix[i * columns + j];
            if (!(std::fabs(value) > kept)) continue;
            result.columns.push_back(j);
            result.values.push_back(value);
        }
        result.starts.push_back(static_cast<Index>(result.columns.size()));
    }
    return result;
}

// Forces (D + W G) y' + (W N + W^2 P) y that couple coordinates beside the meshes, at a mesh frequency W; (n,
// n) each.
struct Coupling {
    std::vector<double> dampers, gyroscopic, circulatory, centrifugal;
};

// A system with its frequencies in rad/s and forces in N over mass; n coordinates, m rows of contacts and
// rings.
struct System {
    Index n = 0, m = 0;
    Index contacts =
        0; // rows that are meshes or flanks; three for each ring follow: x, y, and the way past the rim; then
           // the places of the contacts in the mesh cycle where a law has them move, rad
    Index pairs = 0; // meshes whose two flanks stand at j and j + pairs; 0 where every mesh stands for itself
    bool damping_when_open = true, push_only = false;
    double scale = 1.0;                                  // the length that tolerances mean, m
    std::vector<double> jacobian;                        // (m, n) derivatives of the deflections
    std::vector<double> omega_squared, damping, weights; // (n,) 1/s^2, 1/s, largest deflection by a unit
    std::vector<double> mesh_damping, lower, upper,
        leverage;                  // (m,) edges in m; sum of squares of a row of jacobian
    FourierRows error, load;       // of the kinds of contact, and of the coordinates
    std::vector<Index> error_kind; // (m,)
    std::vector<double> ring_stiffness, ring_clearance; // of bearings with clearance
    double ring_lag = 0.0;                              // damping over stiffness, s
    std::vector<Index> rubbing_flank;                   // of each force of friction
    FourierRows rubbing_ratios;
    std::vector<double> rubbing_directions; // (forces of friction, n)
    bool coupled = false;
    Coupling coupling;
    Law law;

    Sparse by_contact, along; // jacobian and rubbing_directions without zeros
    Sparse by_coordinate;     // jacobian, coordinate by coordinate, with the rows as columns
    std::vector<Index> entry; // which entry of by_contact each of by_coordinate is
    Sparse coupled_rows; // columns 0 .. n - 1 by velocity, n .. 2 n - 1 by displacement; values are not used
    bool opens = false;  // whether a contact may open

    Index rings() const { return static_cast<Index>(ring_stiffness.size()); }
    Index rubbing() const { return static_cast<Index>(rubbing_flank.size()); }
    Index harmonics() const {
        const Index of_law = std::visit([](const auto& each) { return each->terms(); }, law);
        return std::max({of_law, error.terms, load.terms, rubbing() ? rubbing_ratios.terms : Index{1}});
    }
    const std::vector<double>& breaks() const {
        return std::visit([](const auto& each) -> const std::vector<double>& { return each->breaks; }, law);
    }

    // Whether the laws share their sizes, and kinds of contact.
    bool same_law(const System& other) const {
        return std::visit(
            [&](const auto& own) {
                const auto* its = std::get_if<std::decay_t<decltype(own)>>(&other.law);
                return its != nullptr && own->alike(**its);
            },
            law);
    }

    // Find the patterns of the matrices, once all numbers are set.
    void prepare() {
        by_contact = sparse_of(jacobian, m, n);
        along = sparse_of(rubbing_directions, rubbing(), n);
        by_coordinate = Sparse{};
        entry.clear();
        std::vector<std::vector<std::pair<Index, Index>>> touching(n); // rows and entries of each coordinate
        for (Index row = 0; row < m; ++row)
            for (Index e = by_contact.starts[row]; e < by_contact.starts[row + 1]; ++e)
                touching[by_contact.columns[e]].emplace_back(row, e);
        for (const auto& of_coordinate : touching) {
            for (const auto& [row, e] : of_coordinate) {
                by_coordinate.columns.push_back(row);
                by_coordinate.values.push_back(by_contact.values[e]);
                entry.push_back(e);
            }
            by_coordinate.starts.push_back(static_cast<Index>(entry.size()));
        }
        opens = false;
        for (Index i = 0; i < m; ++i) opens = opens || lower[i] < upper[i];
        if (coupled) find_coupled();
    }

    double by_velocity(Index row, Index column, double w) const {
        return coupling.dampers[row * n + column] / w + coupling.gyroscopic[row * n + column];
    }
    double by_displacement(Index row, Index column, double w) const {
        return coupling.circulatory[row * n + column] / w + coupling.centrifugal[row * n + column];
    }

  private:
    void find_coupled() {
        std::vector<double> size(2 * n * n, 0.0);
        const std::vector<double>* parts[] = {&coupling.dampers, &coupling.gyroscopic, &coupling.circulatory,
                                              &coupling.centrifugal};
        for (int part = 0; part < 4; ++part) {
            const double kept = matrix_rounding * largest_entry(*parts[part]);
            for (Index i = 0; i < n * n; ++i)
                if (std::fabs((*parts[part])[i]) > kept) size[i / n * 2 * n + (part / 2) * n + i % n] = 1.0;
        }
        coupled_rows = sparse_of(size, n, 2 * n);
    }
};

// A system at a mesh frequency w (rad/s). Time is counted as mesh phase s = w t.
struct Machine {
    std::shared_ptr<const System> system;
    double frequency = 1.0;
    double tolerance = 1e-6; // local error of a step over the length scale
    double fastest = 1.0;    // bound of the angular frequency over w
};

} // namespace facegear::motion
