// Root stress of a tooth on its way through the mesh, superposed from the readings of unit forces.
#pragma once

#include "tables.hpp"

namespace facegear::strength {

// Forces on the nodes of loaded teeth at the positions of a passage, tooth by tooth and position by position:
// those of row r on nodes[starts[r]] to nodes[starts[r + 1] - 1], N.
struct Forces {
    List<const Index> starts, nodes;
    List<const double> force;
    List<const Index> teeth; // numbers of the loaded teeth
    Index positions;
};

// Stress of unit forces, Pa/N: (2 d + 1, 2, a, b, c) by the number of teeth from the loaded one to that which
// is read, fillet, gauges down the fillet, planes along the face and nodes.
struct Readings {
    const double* stress;
    Index reach, gauges, planes, nodes; // d, a, b, c

    // Of the first gauge and the first node; gauges follow each other by `stride`.
    const double* at(Index apart, Index fillet, Index plane) const {
        return stress + (((apart * 2 + fillet) * gauges) * planes + plane) * nodes;
    }
    Index stride() const { return planes * nodes; }
};

// Where stress is read: a tooth, counted from the one before the first loaded, a position, and a plane, those
// of the second fillet after those of the first.
struct Place {
    Index tooth, position, plane;
};

// Writes the stress (gauges,) down the fillet at a place; compression is positive in the readings.
inline void superpose(const Forces& forces, const Readings& readings, Place place, double* stress) {
    for (Index gauge = 0; gauge < readings.gauges; ++gauge) stress[gauge] = 0.0;
    const Index tooth = forces.teeth[0] - 1 + place.tooth;
    for (Index loaded = 0; loaded < forces.teeth.size; ++loaded) {
        const Index apart = tooth - forces.teeth[loaded] + readings.reach;
        if (apart < 0 || apart > 2 * readings.reach) continue;
        const Index row = loaded * forces.positions + place.position;
        const double* read = readings.at(apart, place.plane / readings.planes, place.plane % readings.planes);
        for (Index entry = forces.starts[row]; entry < forces.starts[row + 1]; ++entry) {
            const double* at_node = read + forces.nodes[entry];
            for (Index gauge = 0; gauge < readings.gauges; ++gauge) {
                stress[gauge] -= forces.force[entry] * at_node[gauge * readings.stride()];
            }
        }
    }
}

} // namespace facegear::strength
