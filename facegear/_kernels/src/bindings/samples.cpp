// Passes over the samples of a motion.
#include "bindings/parts.hpp"

#include <utility>

#include <nanobind/stl/pair.h>

#include "bindings/records.hpp"
#include "samples/contact_loads.hpp"
#include "samples/piecewise_cubics.hpp"
#include "samples/tally.hpp"

namespace facegear {
namespace {

using namespace bindings;
using namespace samples;

void bound_ring_forces(Given<double, 3> displacement, Given<double, 3> speed, Given<double, 1> stiffness,
                       Given<double, 1> clearance, double lag, Given<Index, 1> body,
                       Written<double, 3> forces) {
    const Index rings = extent(body, 0), count = extent(forces, 2);
    require(extent(stiffness, 0) == rings && extent(clearance, 0) == rings,
            "stiffness and clearance must be (R,)");
    for (const auto& each : {displacement, speed}) {
        require(extent(each, 0) == rings && each.shape(1) == 2 && extent(each, 2) == count,
                "displacement and speed must be (R, 2, K)");
    }
    require(forces.shape(1) == 3, "forces must be (bodies, 3, K)");
    require_within(list_of(body), 0, extent(forces, 0) - 1, "every ring must belong to one of the bodies");
    nb::gil_scoped_release released;
    write_ring_forces({list_of(stiffness), list_of(clearance), list_of(body), lag}, displacement.data(),
                      speed.data(), count, forces.data());
}

void bound_press_in(Written<double, 3> deflections, Given<double, 2> errors, Given<double, 1> lower,
                    Given<double, 1> upper) {
    const Deflections all{deflections.data(), extent(deflections, 0), extent(deflections, 1),
                          extent(deflections, 2)};
    require(extent(errors, 0) == all.samples && extent(errors, 1) == all.contacts, "errors must be (K, M)");
    require(extent(lower, 0) == all.contacts && extent(upper, 0) == all.contacts, "both edges must be (M,)");
    nb::gil_scoped_release released;
    press_in(all, table_of(errors), list_of(lower), list_of(upper));
}

void bound_split_loads(Given<double, 2> forces, double rounding, Written<double, 2> loads) {
    require(loads.shape(0) == 2 * forces.shape(0) && loads.shape(1) == forces.shape(1),
            "loads must be (2 M, K) for forces (M, K)");
    nb::gil_scoped_release released;
    split_loads(table_of(forces), rounding, table_of(loads));
}

void bound_evaluate(Given<double, 2> levels, Given<Index, 1> kind, Given<double, 4> coefficients,
                    Given<double, 3> amounts, bool slopes, Written<double, 3> values) {
    const Index kinds = extent(levels, 0), phases = extent(amounts, 2);
    require(extent(coefficients, 0) == kinds && coefficients.shape(1) == levels.shape(1) &&
                extent(coefficients, 2) == phases && coefficients.shape(3) == 4,
            "coefficients must be (kinds, L, K, 4) for levels (kinds, L) and amounts (M, B, K)");
    require(kinds == 0 || levels.shape(1) > 0, "every kind must have a level");
    require(extent(kind, 0) == extent(amounts, 0), "every contact must have a kind");
    require_within(list_of(kind), 0, kinds - 1, "kinds must be rows of the levels");
    for (std::size_t axis = 0; axis < 3; ++axis) {
        require(values.shape(axis) == amounts.shape(axis), "values must have the shape of the amounts");
    }
    nb::gil_scoped_release released;
    evaluate({table_of(levels), coefficients.data(), phases}, list_of(kind), extent(amounts, 1), slopes,
             amounts.data(), values.data());
}

std::pair<Index, Index> bound_tally(Given<double, 2> forces, Index per_cycle, Given<Index, 1> starts,
                                    Given<Index, 1> members, nb::handle counted) {
    const Index flanks = extent(forces, 0), count = extent(forces, 1), meshes = flanks / 2;
    const Record results(counted);
    const auto mean = results.output<double, 1>("mean"), largest = results.output<double, 1>("largest");
    const auto largest_mean = results.output<double, 1>("largest_mean");
    const auto coefficients = results.output<double, 1>("coefficients");
    require(flanks % 2 == 0, "every mesh must have two flanks");
    require(per_cycle > 0 && count > 0 && count % per_cycle == 0, "samples must make whole mesh cycles");
    require(extent(mean, 0) == flanks && extent(largest, 0) == flanks && extent(largest_mean, 0) == meshes,
            "what is counted must have the shapes (F,) and (M,)");
    require(extent(starts, 0) == extent(coefficients, 0) + 1,
            "every group must have a start, and the last an end");
    require_within(list_of(starts), 0, extent(members, 0), "groups must begin among the members");
    require_within(list_of(members), 0, meshes - 1, "members must be meshes");
    nb::gil_scoped_release released;
    const Samples samples =
        tally(FlankForces(table_of(forces)), per_cycle, {list_of(starts), list_of(members)},
              {list_of(mean), list_of(largest), list_of(largest_mean), list_of(coefficients)});
    return {samples.open, samples.reversed};
}

} // namespace

void bind_samples(nb::module_ module) {
    module.def("write_ring_forces", &bound_ring_forces, nb::arg("displacement"), nb::arg("speed"),
               nb::arg("stiffness"), nb::arg("clearance"), nb::arg("lag"), nb::arg("body"),
               nb::arg("forces").noconvert());
    module.def("press_in", &bound_press_in, nb::arg("deflections").noconvert(), nb::arg("errors"),
               nb::arg("lower"), nb::arg("upper"));
    module.def("split_loads", &bound_split_loads, nb::arg("forces"), nb::arg("rounding"),
               nb::arg("loads").noconvert());
    module.def("evaluate", &bound_evaluate, nb::arg("levels"), nb::arg("kind"), nb::arg("coefficients"),
               nb::arg("amounts"), nb::arg("slopes"), nb::arg("values").noconvert());
    module.def("tally", &bound_tally, nb::arg("forces"), nb::arg("per_cycle"), nb::arg("starts"),
               nb::arg("members"), nb::arg("counted"));
}

} // namespace facegear
