// Rays, and what they hit.
#pragma once

#include <cstdint>

#include "flanks/vectors.hpp"
#include "tables.hpp"

namespace facegear::flanks {

// A point and a unit direction.
struct Ray {
    Vector<double> start, way;
};

inline Vector<double> vector_of(Table<const double> vectors, Index number) {
    const double* row = vectors.row(number);
    return {row[0], row[1], row[2]};
}

// Rays (n, 3) from points (m) along unit directions, looked along for `search_radius` (m).
struct Rays {
    Table<const double> starts, ways;
    double search_radius;

    Index count() const { return starts.rows; }
    Ray operator[](Index number) const { return {vector_of(starts, number), vector_of(ways, number)}; }
};

enum Part : std::int8_t { NONE, FLANK, FILLET, TIP_LAND, ROOT_LAND };

// What rays (n,) hit, as `Separation` in facegear/teeth/separation.py has it.
struct Hits {
    double *gap, *u, *v, *continued, *radius;
    std::int8_t* part;
};

} // namespace facegear::flanks
