// Motion of an inner ring, and the energy, force and stiffness that answer it.
#pragma once

#include "tables.hpp"

namespace facegear::bearings {

// x, y, z, tilt_x, tilt_y of the inner ring against the outer one, m and rad.
constexpr Index MOTIONS = 5;

// Energy (J), force (N, N m) and stiffness, to which rolling elements add theirs.
struct Response {
    double energy = 0.0;
    double* force;     // (5,)
    double* stiffness; // (5, 5)

    Response(double* force, double* stiffness) : force(force), stiffness(stiffness) {
        for (Index i = 0; i < MOTIONS; ++i) force[i] = 0.0;
        for (Index i = 0; i < MOTIONS * MOTIONS; ++i) stiffness[i] = 0.0;
    }
};

// First and second derivatives of an energy of two coordinates.
struct Derivatives {
    double energy = 0.0;
    double first = 0.0, second = 0.0;
    double first_first = 0.0, first_second = 0.0, second_second = 0.0;
};

// Two coordinates of a rolling element that follow the ring: rows of the Jacobian by its motions.
struct Rows {
    double first[MOTIONS], second[MOTIONS];

    double first_of(const double* motion) const { return along(first, motion); }
    double second_of(const double* motion) const { return along(second, motion); }

    // Adds the force J^T f and the stiffness J^T H J of an element.
    void add(const Derivatives& element, Response& response) const {
        response.energy += element.energy;
        for (Index i = 0; i < MOTIONS; ++i) {
            response.force[i] += first[i] * element.first + second[i] * element.second;
            const double by_first = first[i] * element.first_first + second[i] * element.first_second;
            const double by_second = first[i] * element.first_second + second[i] * element.second_second;
            for (Index j = 0; j < MOTIONS; ++j)
                response.stiffness[MOTIONS * i + j] += by_first * first[j] + by_second * second[j];
        }
    }

  private:
    static double along(const double* row, const double* motion) {
        double total = 0.0;
        for (Index i = 0; i < MOTIONS; ++i) total += row[i] * motion[i];
        return total;
    }
};

} // namespace facegear::bearings
