// Root stress superposed from readings.
#include "bindings/parts.hpp"

#include "strength/superposed.hpp"

#include "bindings/records.hpp"

namespace facegear {
namespace {

using namespace bindings;
using namespace strength;

void bound_superpose(Given<Index, 1> starts, Given<Index, 1> nodes, Given<double, 1> force,
                     Given<Index, 1> teeth, Given<double, 5> readings, Given<Index, 2> places,
                     Written<double, 2> stress) {
    const Index rows = extent(starts, 0) - 1, loaded = extent(teeth, 0), count = extent(places, 0);
    const Readings read{readings.data(), extent(readings, 0) / 2, extent(readings, 2), extent(readings, 3),
                        extent(readings, 4)};
    require(rows > 0 && loaded > 0 && rows % loaded == 0, "every loaded tooth must have as many positions");
    require(extent(nodes, 0) == extent(force, 0), "every force must have a node");
    require(readings.shape(0) % 2 == 1 && readings.shape(1) == 2, "readings must be (2 d + 1, 2, a, b, c)");
    require(places.shape(1) == 3, "places must be (n, 3)");
    require(extent(stress, 0) == count && extent(stress, 1) == read.gauges, "stress must be (n, a)");
    require(starts(0) == 0 && starts(static_cast<std::size_t>(rows)) == extent(nodes, 0),
            "rows must hold all forces");
    for (Index row = 0; row < rows; ++row)
        require(starts(row) <= starts(row + 1), "rows must follow each other");
    require_within(list_of(nodes), 0, read.nodes - 1, "nodes must be those of the readings");
    const Table<const Index> given = table_of(places);
    const Index positions = rows / loaded;
    for (Index i = 0; i < count; ++i) {
        require(0 <= given(i, 1) && given(i, 1) < positions, "positions must be those of the forces");
        require(0 <= given(i, 2) && given(i, 2) < 2 * read.planes, "planes must be those of both fillets");
    }
    const Forces forces{list_of(starts), list_of(nodes), list_of(force), list_of(teeth), positions};
    nb::gil_scoped_release released;
    for (Index i = 0; i < count; ++i) {
        superpose(forces, read, {given(i, 0), given(i, 1), given(i, 2)}, table_of(stress).row(i));
    }
}

} // namespace

void bind_strength(nb::module_ module) {
    module.def("superpose", &bound_superpose, nb::arg("starts"), nb::arg("nodes"), nb::arg("force"),
               nb::arg("teeth"), nb::arg("readings"), nb::arg("places"), nb::arg("stress").noconvert());
}

} // namespace facegear
