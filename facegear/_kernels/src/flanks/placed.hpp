// Points and normals of the pinion where it stands against the gear.
#pragma once

#include "flanks/vectors.hpp"
#include "tables.hpp"

namespace facegear::flanks {

// Motions of a rigid body: a point x becomes `matrix` x + `shift` (m).
struct Motions {
    const double* matrix;      // (p, 3, 3)
    Table<const double> shift; // (p, 3)

    // A component of the point, the shift left out.
    double turned(Index motion, Index component, const double* vector) const {
        const double* row = matrix + 9 * motion + 3 * component;
        return row[0] * vector[0] + row[1] * vector[1] + row[2] * vector[2];
    }
};

// Which of points and directions (m, 3) are moved, and by which motion each, (n,).
struct Choice {
    List<const Index> motion, point;
};

// Writes points and directions (n, 3) after their motion.
inline void place(const Motions& motions, const Choice& choice, Table<const double> points,
                  Table<const double> normals, Table<double> starts, Table<double> ways) {
    for (Index ray = 0; ray < choice.motion.size; ++ray) {
        const Index motion = choice.motion[ray], point = choice.point[ray];
        for (Index i = 0; i < 3; ++i) {
            starts(ray, i) = motions.shift(motion, i) + motions.turned(motion, i, points.row(point));
            ways(ray, i) = motions.turned(motion, i, normals.row(point));
        }
    }
}

} // namespace facegear::flanks
