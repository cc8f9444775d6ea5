// Contact: what kernels are given is checked here once, so that they can trust shapes and indices.
#include "bindings/parts.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <string>

#include "contact/elimination.hpp"
#include "contact/position.hpp"

namespace nb = nanobind;

namespace facegear {
namespace {

using contact::Index;
using contact::SparseRows;
using contact::Table;

template <class Value, int Dimensions>
using Array = nb::ndarray<Value, nb::ndim<Dimensions>, nb::c_contig, nb::device::cpu>;
using Numbers = Array<const double, 1>;
using NumberTable = Array<const double, 2>;
using Integers = Array<const Index, 1>;
using IntegerTable = Array<const Index, 2>;
using Marks = Array<const bool, 1>;
using MarkTable = Array<const bool, 2>;
using ColumnTable = nb::ndarray<double, nb::ndim<2>, nb::f_contig, nb::device::cpu>;

// Numbers of teeth whose differences are far from the largest integer.
constexpr Index MOST_TEETH = 1000000;

void require(bool holds, const char* otherwise) {
    if (!holds) throw nb::value_error(otherwise);
}

template <class Value>
std::span<const Value> view(const Array<const Value, 1>& array) {
    return {array.data(), array.size()};
}

template <class Value>
Table<const Value> view(const Array<const Value, 2>& array) {
    return {array.data(), static_cast<Index>(array.shape(0)), static_cast<Index>(array.shape(1))};
}

template <class Value>
void require_below(const Value* values, std::size_t count, Index end, const char* otherwise) {
    for (std::size_t i = 0; i < count; ++i) require(values[i] >= 0 && values[i] < end, otherwise);
}

void require_finite(std::span<const double> values, const char* otherwise) {
    for (const double value : values) require(std::isfinite(value), otherwise);
}

// A rising list that begins with 0 and ends with `end`.
void require_ends(std::span<const Index> ends, Index end, const char* otherwise) {
    require(
        !ends.empty() && ends.front() == 0 && ends.back() == end && std::is_sorted(ends.begin(), ends.end()),
        otherwise);
}

// Sparse rows over `columns` columns.
SparseRows sparse_rows(const Integers& pointer, const Integers& index, const Numbers& weight, Index columns) {
    require(index.size() == weight.size(), "each entry of sparse rows has an index and a weight");
    require_ends(view(pointer), static_cast<Index>(index.size()),
                 "pointers of sparse rows rise from 0 to their entries");
    require_below(index.data(), index.size(), columns, "an index of sparse rows is out of range");
    return {view(pointer), view(index), view(weight)};
}

// An array that owns the memory of a list.
template <class Value, class Stored>
nb::object owned(std::vector<Stored> values, std::initializer_list<std::size_t> shape) {
    static_assert(sizeof(Value) == sizeof(Stored));
    auto held = std::make_unique<std::vector<Stored>>(std::move(values));
    void* data = held->data();
    nb::capsule owner(held.get(), [](void* list) noexcept {
        std::unique_ptr<std::vector<Stored>>(static_cast<std::vector<Stored>*>(list));
    });
    held.release();
    return nb::cast(nb::ndarray<nb::numpy, Value>(static_cast<Value*>(data), shape, owner));
}

template <class Value>
nb::object owned(std::vector<Value> values) {
    const std::size_t size = values.size();
    return owned<Value>(std::move(values), {size});
}

nb::object owned_marks(contact::Mask values) {
    const std::size_t size = values.size();
    return owned<bool>(std::move(values), {size});
}

nb::object owned_table(const contact::OwnedTable& values) {
    const Table<const double> table = values.view();
    return owned<double>(std::vector<double>(table.data, table.data + table.rows * table.columns),
                         {static_cast<std::size_t>(table.rows), static_cast<std::size_t>(table.columns)});
}

// Points that face the other gear; the arrays are kept.
struct BoundPoints {
    Numbers gap, lever_arm;
    NumberTable pinion, gear;
    IntegerTable function;
    NumberTable value;
    Numbers area;
    Integers starts, teeth;

    BoundPoints(Numbers gap, Numbers lever_arm, NumberTable pinion, NumberTable gear, IntegerTable function,
                NumberTable value, Numbers area, Integers starts, Integers teeth)
        : gap(gap),
          lever_arm(lever_arm),
          pinion(pinion),
          gear(gear),
          function(function),
          value(value),
          area(area),
          starts(starts),
          teeth(teeth) {
        const std::size_t count = gap.size();
        require(lever_arm.size() == count && area.size() == count && pinion.shape(0) == count &&
                    gear.shape(0) == count && function.shape(0) == count && value.shape(0) == count,
                "arrays of points must have the same length");
        require(pinion.shape(1) == 2 && gear.shape(1) == 2, "points have two lattice coordinates");
        require(function.shape(1) == value.shape(1), "each function at a point has a value");
        require(starts.size() == teeth.size() + 1,
                "there is a first point for each pair of teeth and an end");
        require_ends(facegear::view(starts), static_cast<Index>(count),
                     "first points rise from 0 to the number of points");
        for (const Index tooth : facegear::view(teeth)) {
            require(tooth >= -MOST_TEETH && tooth <= MOST_TEETH, "a tooth's number is out of range");
        }
    }

    contact::FacingPoints view() const {
        return {facegear::view(gap),  facegear::view(lever_arm), facegear::view(pinion),
                facegear::view(gear), facegear::view(function),  facegear::view(value),
                facegear::view(area), facegear::view(starts),    facegear::view(teeth)};
    }
};

// All basis functions of a pair; the array is kept.
struct BoundCover {
    Numbers min_area;
    contact::Cover cover;

    BoundCover(Numbers min_area, Index first, std::pair<Index, Index> shape,
               std::pair<double, double> flank_ends)
        : min_area(min_area),
          cover{facegear::view(min_area), first, shape.first, shape.second, flank_ends.first,
                flank_ends.second} {
        require(first >= 0 && first <= static_cast<Index>(min_area.size()),
                "the first node's function is out of range");
        require(shape.first > 0 && shape.second > 0 && shape.first < MOST_TEETH && shape.second < MOST_TEETH,
                "a lattice has rows and columns");
    }

    void require_functions(const contact::FacingPoints& points) const {
        require_below(points.function.data,
                      static_cast<std::size_t>(points.function.rows * points.function.columns),
                      static_cast<Index>(min_area.size()), "a basis function's number is out of range");
    }
};

// Contact surface of a gear; the arrays are kept.
struct BoundSurface {
    IntegerTable steps;
    Integers pointer, index;
    Numbers weight;
    NumberTable own;
    Array<const double, 3> others;
    contact::Surface surface;

    BoundSurface(std::pair<Index, Index> shape, IntegerTable steps, Integers pointer, Integers index,
                 Numbers weight, NumberTable own, Array<const double, 3> others, double scale)
        : steps(steps), pointer(pointer), index(index), weight(weight), own(own), others(others) {
        const auto [rows, columns] = shape;
        const auto coarse = static_cast<Index>(others.shape(1));
        require(steps.shape(1) == 2 && (steps.shape(0) == 4 || steps.shape(0) == 9),
                "a face has 4 or 9 nodes");
        const Index size = steps.shape(0) == 4 ? 1 : 2;
        require_below(steps.data(), steps.size(), size + 1, "a node of a face is out of range");
        require(rows > size && columns > size && rows < MOST_TEETH && columns < MOST_TEETH &&
                    (rows - 1) % size == 0 && (columns - 1) % size == 0,
                "a lattice consists of whole faces");
        require(own.shape(0) == own.shape(1) && static_cast<Index>(own.shape(0)) == rows * columns,
                "the compliance of a tooth has a row and a column for each refined node");
        require(others.shape(0) % 2 == 1 && others.shape(2) == others.shape(1) && coarse >= contact::LANES,
                "the compliance of neighbours has a square block for each tooth");
        surface.faces = {rows, columns, facegear::view(steps), size};
        surface.interpolation = sparse_rows(pointer, index, weight, coarse);
        require(surface.interpolation.count() == rows * columns,
                "there is an interpolation for each refined node");
        surface.own = facegear::view(own);
        surface.others = others.data();
        surface.reach = static_cast<Index>(others.shape(0)) / 2;
        surface.coarse_nodes = coarse;
        surface.scale = scale;
    }
};

// Memory for the positions of a pair. Calls from several threads wait for each other.
struct BoundSolver {
    BoundCover cover;
    BoundSurface pinion, gear;
    contact::PositionSolver solver;
    std::mutex busy;

    BoundSolver(BoundCover given_cover, BoundSurface given_pinion, BoundSurface given_gear, bool coupled,
                Index newton_steps, double tolerance)
        : cover(given_cover), pinion(given_pinion), gear(given_gear) {
        require(cover.cover.rows == pinion.surface.faces.rows &&
                    cover.cover.columns == pinion.surface.faces.columns,
                "the cover and the pinion's surface have one lattice");
        require(newton_steps >= 0 && newton_steps <= 10000, "the number of Newton steps is out of range");
        solver.cover = cover.cover;
        solver.surfaces[0] = pinion.surface;
        solver.surfaces[1] = gear.surface;
        solver.coupled = coupled;
        solver.limits = {newton_steps, tolerance};
    }

    nb::dict solve(const BoundPoints& given, Numbers torques, double limit, double gap, double width,
                   double wider, double begin, double begin_width, MarkTable near) {
        const contact::FacingPoints points = given.view();
        cover.require_functions(points);
        require(torques.size() > 0, "there must be a torque");
        require_finite(view(torques), "torques must be finite");
        for (const double torque : view(torques)) require(torque > 0.0, "torques must be positive");
        require(wider > 1.0, "a strip must be widened by more than 1");
        const bool known = near.size() > 0;
        require(!known || (near.shape(0) == given.teeth.size() &&
                           static_cast<Index>(near.shape(1)) == solver.cover.rows * solver.cover.columns),
                "known contact marks the nodes of each pair");
        const contact::SearchStrip strip{gap,   width,       wider,
                                         begin, begin_width, known ? view(near) : Table<const bool>{}};
        contact::PositionContact found;
        {
            nb::gil_scoped_release released;
            const std::lock_guard lock(busy);
            found = solver.solve(points, view(torques), limit, strip);
        }
        return answer(std::move(found), torques.size(), given.teeth.size());
    }

    nb::dict answer(contact::PositionContact found, std::size_t torques, std::size_t pairs) const {
        const std::size_t loaded = found.pair.size();
        nb::dict result;
        result["rotation"] = owned(std::move(found.rotation));
        result["slope"] = owned(std::move(found.slope));
        result["residual"] = owned(std::move(found.residual));
        result["steps"] = owned(std::move(found.steps));
        result["candidates"] = found.candidates;
        result["forward"] = found.forward;
        result["strip_size"] = found.strip_size;
        result["overlap"] = found.overlap;
        result["pair"] = owned(std::move(found.pair));
        result["node"] = owned(std::move(found.node));
        result["lever_arm"] = owned(std::move(found.lever_arm));
        result["fillet"] = owned_marks(std::move(found.fillet));
        result["force"] = owned<double>(std::move(found.force), {torques, loaded});
        const char* names[] = {"on_pinion", "on_gear"};
        for (int side = 0; side < 2; ++side) {
            const auto nodes = static_cast<std::size_t>(solver.surfaces[side].coarse_nodes);
            result[names[side]] = owned<double>(std::move(found.on_nodes[side]), {torques, pairs, nodes});
        }
        return result;
    }

    nb::object influence(const BoundPoints& given, double limit) {
        const contact::FacingPoints points = given.view();
        cover.require_functions(points);
        const std::lock_guard lock(busy);
        solver.fill_whole_influence(points, limit);
        return owned_table(solver.matrix);
    }

    nb::object approach(const BoundPoints& given, double limit, NumberTable forces, Integers cases) {
        const contact::FacingPoints points = given.view();
        cover.require_functions(points);
        require(forces.shape(1) == cases.size(), "there is a number of cases for each force");
        require_below(cases.data(), cases.size(), static_cast<Index>(forces.shape(0)) + 1,
                      "a case is out of range");
        const std::lock_guard lock(busy);
        require(solver.fill_whole_approach(points, limit, view(forces), view(cases)),
                "there is a force for each basis function");
        return owned_table(solver.moved);
    }
};

nb::dict find_functions(const BoundPoints& given, const BoundCover& cover, double limit) {
    const contact::FacingPoints points = given.view();
    cover.require_functions(points);
    contact::BasisFunctions found;
    {
        nb::gil_scoped_release released;
        contact::GapClosing closing;
        closing.find(points, cover.cover, limit, found);
    }
    nb::dict result;
    result["pair"] = owned(std::move(found.pair));
    result["node"] = owned(std::move(found.node));
    result["gap"] = owned(std::move(found.gap));
    result["lever_arm"] = owned(std::move(found.lever_arm));
    result["fillet"] = owned_marks(std::move(found.fillet));
    result["average"] =
        nb::make_tuple(owned(std::move(found.average.pointer)), owned(std::move(found.average.index)),
                       owned(std::move(found.average.weight)));
    return result;
}

// Averages (n, m) of a compliance by rows on both sides; the lower triangle is left out where it is
// `symmetric`.
nb::object two_sided_average(NumberTable compliance, Integers seen_pointer, Integers seen_index,
                             Numbers seen_weight, Integers load_pointer, Integers load_index,
                             Numbers load_weight, bool symmetric) {
    require(compliance.shape(1) >= static_cast<std::size_t>(contact::LANES),
            "a compliance has four columns or more");
    require(!symmetric || compliance.shape(0) == compliance.shape(1), "a symmetric compliance is square");
    const SparseRows seen =
        sparse_rows(seen_pointer, seen_index, seen_weight, static_cast<Index>(compliance.shape(0)));
    const SparseRows load =
        sparse_rows(load_pointer, load_index, load_weight, static_cast<Index>(compliance.shape(1)));
    require(!symmetric || seen.count() == load.count(),
            "a symmetric average has the same rows on both sides");
    contact::OwnedTable matrix;
    matrix.reset(load.count(), seen.count());
    {
        nb::gil_scoped_release released;
        contact::TwoSidedAverage().add(matrix.view(), 0, 0, 1.0, seen, view(compliance), load, symmetric);
    }
    return owned_table(matrix);
}

nb::dict solve_active_set(NumberTable compliance, Numbers gap, Numbers lever_arm, double torque, Marks start,
                          Index newton_steps, double tolerance) {
    const std::size_t count = gap.size();
    require(count > 0 && lever_arm.size() == count && start.size() == count && compliance.shape(0) == count &&
                compliance.shape(1) == count,
            "compliance, gaps, lever arms and start must have the same length, at least 1");
    require_finite(view(gap), "gaps must be finite");
    require_finite(view(lever_arm), "lever arms must be finite");
    require(std::isfinite(torque) && torque > 0.0, "the torque must be positive");
    require(newton_steps >= 0 && newton_steps <= 10000, "the number of Newton steps is out of range");
    contact::ActiveSetSolver solver;
    contact::ContactSolution solution;
    {
        nb::gil_scoped_release released;
        const contact::Mask begin(start.data(), start.data() + count);
        const contact::ContactProblem problem{view(compliance), view(gap), view(lever_arm), torque};
        solution = solver.solve(problem, begin, {newton_steps, tolerance});
    }
    nb::dict result;
    result["steps"] = solution.steps;
    result["force"] = owned(std::move(solver.force));
    result["force_change"] = owned(std::move(solver.change));
    result["rotation"] = solution.rotation;
    result["slope"] = solution.slope;
    result["residual"] = solution.residual;
    return result;
}

contact::ColumnTable view(const ColumnTable& array) {
    return {array.data(), static_cast<Index>(array.shape(0)), static_cast<Index>(array.shape(1))};
}

contact::Front front_of(const ColumnTable& pivots, const ColumnTable& below, const ColumnTable& update) {
    require(pivots.shape(0) == pivots.shape(1) && below.shape(1) == pivots.shape(1) &&
                update.shape(0) == update.shape(1) && update.shape(0) == below.shape(0),
            "the parts of a front do not fit each other");
    return {view(pivots), view(below), view(update)};
}

void add_elements(Array<const double, 3> matrices, IntegerTable rows, Integers pointer, Integers index,
                  Numbers weight, Integers place, ColumnTable pivots, ColumnTable below, ColumnTable update) {
    const contact::Front front = front_of(pivots, below, update);
    const std::size_t size = rows.shape(1);
    require(matrices.shape(0) == rows.shape(0) && (rows.size() == 0 || matrices.shape(1) == size) &&
                matrices.shape(2) == matrices.shape(1),
            "each element matrix has a row for each of its unknowns");
    const Index end = front.pivots.rows + front.update.rows;
    const SparseRows unknowns{view(pointer), view(index), view(weight)};
    require(pointer.size() > 0 && index.size() == weight.size(),
            "each entry of sparse rows has an index and a weight");
    require_below(rows.data(), rows.size(), unknowns.count(), "a row of an element is out of range");
    for (const Index row : std::span(rows.data(), rows.size())) {
        const Index first = unknowns.pointer[row], last = unknowns.pointer[row + 1];
        require(first >= 0 && first <= last && last <= static_cast<Index>(index.size()),
                "pointers of sparse rows rise from 0 to their entries");
        for (Index k = first; k < last; ++k) {
            const Index unknown = unknowns.index[k];
            require(unknown >= 0 && unknown < static_cast<Index>(place.size()) &&
                        place.data()[unknown] >= 0 && place.data()[unknown] < end,
                    "an unknown of an element has no place in the front");
        }
    }
    const Table<const double> table{matrices.data(), static_cast<Index>(matrices.shape(0)),
                                    static_cast<Index>(size * size)};
    nb::gil_scoped_release released;
    contact::add_elements(table, view(rows), unknowns, view(place), front);
}

void extend_add(ColumnTable added, Integers place, ColumnTable pivots, ColumnTable below,
                ColumnTable update) {
    const contact::Front front = front_of(pivots, below, update);
    require(added.shape(0) == added.shape(1) && added.shape(0) == place.size(),
            "each row of an update has a place");
    require_below(place.data(), place.size(), front.pivots.rows + front.update.rows,
                  "a place is not in the front");
    require(std::is_sorted(place.data(), place.data() + place.size()), "places must rise");
    nb::gil_scoped_release released;
    contact::extend_add(view(added), view(place), front);
}

Index exchange_steps_of(Index points) {
    if (points < 0 || points > std::numeric_limits<std::int32_t>::max()) {
        throw nb::value_error("points must be a number of points");
    }
    return contact::exchange_steps(points);
}

} // namespace

void bind_contact(nb::module_ module) {
    nb::class_<BoundPoints>(module, "FacingPoints")
        .def(nb::init<Numbers, Numbers, NumberTable, NumberTable, IntegerTable, NumberTable, Numbers,
                      Integers, Integers>(),
             nb::arg("gap").noconvert(), nb::arg("lever_arm").noconvert(), nb::arg("pinion").noconvert(),
             nb::arg("gear").noconvert(), nb::arg("function").noconvert(), nb::arg("value").noconvert(),
             nb::arg("area").noconvert(), nb::arg("starts").noconvert(), nb::arg("teeth").noconvert());
    nb::class_<BoundCover>(module, "Cover")
        .def(nb::init<Numbers, Index, std::pair<Index, Index>, std::pair<double, double>>(),
             nb::arg("min_area").noconvert(), nb::arg("first"), nb::arg("shape"), nb::arg("flank_ends"));
    nb::class_<BoundSurface>(module, "Surface")
        .def(nb::init<std::pair<Index, Index>, IntegerTable, Integers, Integers, Numbers, NumberTable,
                      Array<const double, 3>, double>(),
             nb::arg("shape"), nb::arg("steps").noconvert(), nb::arg("pointer").noconvert(),
             nb::arg("index").noconvert(), nb::arg("weight").noconvert(), nb::arg("own").noconvert(),
             nb::arg("others").noconvert(), nb::arg("scale"));
    nb::class_<BoundSolver>(module, "PositionSolver")
        .def(nb::init<BoundCover, BoundSurface, BoundSurface, bool, Index, double>(), nb::arg("cover"),
             nb::arg("pinion"), nb::arg("gear"), nb::arg("coupled"), nb::arg("newton_steps"),
             nb::arg("tolerance"))
        .def("solve", &BoundSolver::solve, nb::arg("points"), nb::arg("torques").noconvert(),
             nb::arg("limit"), nb::arg("gap"), nb::arg("width"), nb::arg("wider"), nb::arg("begin"),
             nb::arg("begin_width"), nb::arg("near").noconvert())
        .def("influence", &BoundSolver::influence, nb::arg("points"), nb::arg("limit"))
        .def("approach", &BoundSolver::approach, nb::arg("points"), nb::arg("limit"),
             nb::arg("forces").noconvert(), nb::arg("cases").noconvert());
    module.def("find_functions", &find_functions, nb::arg("points"), nb::arg("cover"), nb::arg("limit"));
    module.def("two_sided_average", &two_sided_average, nb::arg("compliance").noconvert(),
               nb::arg("seen_pointer").noconvert(), nb::arg("seen_index").noconvert(),
               nb::arg("seen_weight").noconvert(), nb::arg("load_pointer").noconvert(),
               nb::arg("load_index").noconvert(), nb::arg("load_weight").noconvert(), nb::arg("symmetric"));
    module.def("solve_active_set", &solve_active_set, nb::arg("compliance").noconvert(),
               nb::arg("gap").noconvert(), nb::arg("lever_arm").noconvert(), nb::arg("torque"),
               nb::arg("start").noconvert(), nb::arg("newton_steps"), nb::arg("tolerance"));
    module.def("exchange_steps", &exchange_steps_of, nb::arg("points"));
    module.def("add_elements", &add_elements, nb::arg("matrices").noconvert(), nb::arg("rows").noconvert(),
               nb::arg("pointer").noconvert(), nb::arg("index").noconvert(), nb::arg("weight").noconvert(),
               nb::arg("place").noconvert(), nb::arg("pivots").noconvert(), nb::arg("below").noconvert(),
               nb::arg("update").noconvert());
    module.def("extend_add", &extend_add, nb::arg("added").noconvert(), nb::arg("place").noconvert(),
               nb::arg("pivots").noconvert(), nb::arg("below").noconvert(), nb::arg("update").noconvert());
}

} // namespace facegear
