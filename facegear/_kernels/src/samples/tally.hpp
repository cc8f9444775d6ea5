// What is counted of the loads of all flanks over a motion, in one pass over its samples.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "tables.hpp"

namespace facegear::samples {

// Group g has the meshes members[starts[g]] to members[starts[g + 1] - 1], which share a load.
struct Groups {
    List<const Index> starts; // (G + 1,)
    List<const Index> members;

    Index count() const { return starts.size - 1; }
};

// Fields of a `Tally` in facegear/sharing/quantities.py: of F = 2 M flanks, drive flanks first, and of G
// groups.
struct Counted {
    List<double> mean, largest; // (F,), N
    List<double> largest_mean;  // (M,), N
    List<double> coefficients;  // (G,)
};

// Samples at which one of the meshes that share a load carries nothing, and at which a mesh is loaded on the
// flank that carries less on average.
struct Samples {
    Index open = 0, reversed = 0;
};

// Forces (F, K), none negative, N.
class FlankForces {
  public:
    explicit FlankForces(Table<const double> forces) : forces(forces) {}

    Index flanks() const { return forces.rows; }
    Index meshes() const { return forces.rows / 2; }
    Index count() const { return forces.columns; }
    double of_flank(Index flank, Index sample) const { return forces(flank, sample); }
    // Load of a mesh: that of its more heavily loaded flank.
    double of_mesh(Index mesh, Index sample) const {
        return std::max(forces(mesh, sample), forces(mesh + meshes(), sample));
    }

  private:
    Table<const double> forces;
};

inline void count_flanks(const FlankForces& forces, const Counted& counted) {
    for (Index f = 0; f < forces.flanks(); ++f) {
        double total = 0.0, largest = 0.0;
        for (Index k = 0; k < forces.count(); ++k) {
            total += forces.of_flank(f, k);
            largest = std::max(largest, forces.of_flank(f, k));
        }
        counted.mean[f] = total / static_cast<double>(forces.count());
        counted.largest[f] = largest;
    }
}

// Largest mean load of a mesh over its mesh cycles of `per_cycle` samples.
inline void count_cycles(const FlankForces& forces, Index per_cycle, const Counted& counted) {
    for (Index m = 0; m < forces.meshes(); ++m) {
        double largest = 0.0;
        for (Index begin = 0; begin < forces.count(); begin += per_cycle) {
            double total = 0.0;
            for (Index k = begin; k < begin + per_cycle; ++k) total += forces.of_mesh(m, k);
            largest = std::max(largest, total / static_cast<double>(per_cycle));
        }
        counted.largest_mean[m] = largest;
    }
}

// Load of the meshes of a group at one sample.
struct GroupLoad {
    double total = 0.0, heaviest = 0.0;
    bool has_unloaded = false;
};

inline GroupLoad group_load(const FlankForces& forces, const Groups& groups, Index group, Index sample) {
    GroupLoad result;
    for (Index at = groups.starts[group]; at < groups.starts[group + 1]; ++at) {
        const double load = forces.of_mesh(groups.members[at], sample);
        result.has_unloaded = result.has_unloaded || load == 0.0;
        result.total += load;
        result.heaviest = std::max(result.heaviest, load);
    }
    return result;
}

// Mean over time of the largest load of a group over its mean, not a number where nothing is ever loaded;
// returns the number of samples at which a mesh of a group carries nothing.
inline Index count_groups(const FlankForces& forces, const Groups& groups, const Counted& counted) {
    std::vector<double> loaded(static_cast<std::size_t>(groups.count()));
    std::fill(counted.coefficients.begin(), counted.coefficients.end(), 0.0);
    Index open = 0;
    for (Index k = 0; k < forces.count(); ++k) {
        bool is_open = false;
        for (Index g = 0; g < groups.count(); ++g) {
            const GroupLoad load = group_load(forces, groups, g, k);
            is_open = is_open || load.has_unloaded;
            if (!(load.total > 0.0)) continue;
            const double paths = static_cast<double>(groups.starts[g + 1] - groups.starts[g]);
            counted.coefficients[g] += std::min(std::max(paths * load.heaviest / load.total, 1.0), paths);
            loaded[g] += 1.0;
        }
        open += is_open;
    }
    for (Index g = 0; g < groups.count(); ++g) {
        counted.coefficients[g] =
            loaded[g] > 0.0 ? counted.coefficients[g] / loaded[g] : std::numeric_limits<double>::quiet_NaN();
    }
    return open;
}

// Number of samples at which a mesh is loaded on its idle flank, the one that carries less on average.
inline Index count_reversed(const FlankForces& forces, const Counted& counted) {
    const Index meshes = forces.meshes();
    std::vector<char> is_reversed(static_cast<std::size_t>(forces.count()));
    for (Index m = 0; m < meshes; ++m) {
        const Index idle = counted.mean[m + meshes] > counted.mean[m] ? m : m + meshes;
        for (Index k = 0; k < forces.count(); ++k) is_reversed[k] |= forces.of_flank(idle, k) > 0.0;
    }
    return std::count(is_reversed.begin(), is_reversed.end(), 1);
}

inline Samples tally(const FlankForces& forces, Index per_cycle, const Groups& groups,
                     const Counted& counted) {
    count_flanks(forces, counted);
    count_cycles(forces, per_cycle, counted);
    return {count_groups(forces, groups, counted), count_reversed(forces, counted)};
}

} // namespace facegear::samples
