// Rays from the pinion cut with the face gear's tooth.
#include "bindings/parts.hpp"

#include <algorithm>
#include <array>

#include "flanks/placed.hpp"
#include "flanks/rays.hpp"

#include "bindings/records.hpp"

namespace facegear {
namespace {

using namespace bindings;
using namespace flanks;

template <std::size_t Size>
std::array<double, Size> numbers_of(const Record& given, const char* field) {
    const auto numbers = given.array<double, 1>(field);
    require(numbers.size() == Size,
            "polynomials and tables of guesses must have as many numbers as they need");
    std::array<double, Size> result;
    std::copy_n(numbers.data(), Size, result.begin());
    return result;
}

Side side_of(const Record& given) {
    const Record shaper = given.record("shaper"), guess = given.record("guess");
    return {
        {
            .base = shaper.number("base"),
            .ratio = shaper.number("ratio"),
            .phase = shaper.number("phase"),
            .sine = shaper.number("sine"),
            .middle = shaper.number("middle"),
            .lift = shaper.number("lift"),
            .offset = shaper.number("offset"),
            .shaft_sine = shaper.number("shaft_sine"),
            .shaft_cosine = shaper.number("shaft_cosine"),
            .taper = shaper.number("taper"),
            .tip_centre = shaper.number("tip_centre"),
            .tip_rounding = shaper.number("tip_rounding"),
        },
        {
            .radius = guess.number("radius"),
            .depth = guess.number("depth"),
            .roll = numbers_of<6>(guess, "roll"),
            .psi = numbers_of<6>(guess, "psi"),
            .edge = numbers_of<3>(guess, "edge"),
            .edge_error = guess.number("edge_error"),
            .fillet = numbers_of<FILLET_HEIGHTS>(guess, "fillet"),
        },
    };
}

Line line_of(const Record& given) { return {given.number("height"), given.number("slope")}; }

Blank blank_of(const Record& given) {
    return {
        .flank = side_of(given.record("flank")),
        .back = side_of(given.record("back")),
        .inner = given.number("inner"),
        .outer = given.number("outer"),
        .tip = line_of(given.record("tip")),
        .root = line_of(given.record("root")),
        .root_bulge = given.number("root_bulge"),
        .pitch = given.number("pitch"),
        .module = given.number("module"),
        .middle = line_of(given.record("middle")),
        .aside = given.number("aside"),
        .fillet_top = given.number("fillet_top"),
    };
}

Index bound_cut_rays(nb::handle blank, nb::handle sample, Given<double, 2> starts, Given<double, 2> ways,
                     double search_radius, Written<double, 2> found, Written<std::int8_t, 1> part) {
    const Record of_sample(sample);
    const auto points = of_sample.array<double, 2>("points"), normals = of_sample.array<double, 2>("normals");
    const auto rolls = of_sample.array<double, 1>("rolls"), psis = of_sample.array<double, 1>("psis");
    const auto inner = of_sample.array<bool, 1>("inner");
    const auto radii = of_sample.array<double, 1>("radii");
    const Index count = extent(starts, 0), sampled = extent(points, 0);
    require(starts.shape(1) == 3 && ways.shape(1) == 3 && extent(ways, 0) == count,
            "starts and ways of rays must have one shape (n, 3)");
    require(found.shape(0) == 5 && extent(found, 1) == count && extent(part, 0) == count,
            "what is found of n rays must have the shapes (5, n) and (n,)");
    require(points.shape(1) == 3 && normals.shape(1) == 3 && extent(normals, 0) == sampled &&
                extent(rolls, 0) == sampled && extent(psis, 0) == sampled && extent(inner, 0) == sampled,
            "fields of a sample must have the shapes (m, 3) and (m,)");
    require(sampled == 0 ? radii.size() == 0 : radii.size() > 0 && sampled % extent(radii, 0) == 0,
            "a sample must have as many points at each of its radii");
    const Blank numbers = blank_of(Record(blank));
    const FlankSample points_of_flank{table_of(points), table_of(normals), list_of(rolls),
                                      list_of(psis),    list_of(inner),    of_sample.number("spacing"),
                                      list_of(radii)};
    const Table<double> rows = table_of(found);
    const Hits hits{rows.row(0), rows.row(1), rows.row(2), rows.row(3), rows.row(4), part.data()};
    nb::gil_scoped_release released;
    return cut_rays(numbers, points_of_flank, {table_of(starts), table_of(ways), search_radius}, hits);
}

void bound_place(Given<double, 3> matrix, Given<double, 2> shift, Given<Index, 1> motion,
                 Given<Index, 1> point, Given<double, 2> points, Given<double, 2> normals,
                 Written<double, 2> starts, Written<double, 2> ways) {
    const Index motions = extent(shift, 0), count = extent(motion, 0);
    require(
        extent(matrix, 0) == motions && matrix.shape(1) == 3 && matrix.shape(2) == 3 && shift.shape(1) == 3,
        "motions must have the shapes (p, 3, 3) and (p, 3)");
    require(points.shape(1) == 3 && normals.shape(1) == 3 && points.shape(0) == normals.shape(0),
            "points and normals must have one shape (m, 3)");
    require(extent(point, 0) == count && extent(starts, 0) == count && extent(ways, 0) == count &&
                starts.shape(1) == 3 && ways.shape(1) == 3,
            "what is moved must have the shapes (n,) and (n, 3)");
    require_within(list_of(motion), 0, motions - 1, "motions must be chosen among the given ones");
    require_within(list_of(point), 0, extent(points, 0) - 1, "points must be chosen among the given ones");
    nb::gil_scoped_release released;
    place({matrix.data(), table_of(shift)}, {list_of(motion), list_of(point)}, table_of(points),
          table_of(normals), table_of(starts), table_of(ways));
}

} // namespace

void bind_flanks(nb::module_ module) {
    module.def("cut_rays", &bound_cut_rays, nb::arg("blank"), nb::arg("sample"), nb::arg("starts"),
               nb::arg("ways"), nb::arg("search_radius"), nb::arg("found").noconvert(),
               nb::arg("part").noconvert());
    module.def("place", &bound_place, nb::arg("matrix"), nb::arg("shift"), nb::arg("motion"),
               nb::arg("point"), nb::arg("points"), nb::arg("normals"), nb::arg("starts").noconvert(),
               nb::arg("ways").noconvert());
}

} // namespace facegear
