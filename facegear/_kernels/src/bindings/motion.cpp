// Motion of machines: systems, their laws, and runs over whole mesh periods.
#include "bindings/parts.hpp"

#include <memory>
#include <utility>

#include <nanobind/nanobind.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include "bindings/arrays.hpp"
#include "bindings/motion_runners.hpp"
#include "motion/roots.hpp"

namespace nb = nanobind;

namespace facegear {
namespace {

using motion::Index;

motion::FourierRows series_of(const Doubles<3>& series, const char* name) {
    motion::FourierRows rows;
    rows.kinds = static_cast<Index>(series.shape(0));
    rows.terms = static_cast<Index>(series.shape(2));
    require(series.shape(1) == 2 && rows.terms > 0, std::string(name) + " must be (kinds, 2, harmonics + 1)");
    rows.values = numbers_of<double>(series, {rows.kinds, 2, rows.terms}, name);
    return rows;
}

std::vector<Index> kinds_of(const Integers& kind, Index kinds, const char* name) {
    auto result = numbers_of<Index>(kind, {static_cast<Index>(kind.size())}, name);
    for (const Index each : result)
        require(each >= 0 && each < kinds, std::string(name) + " must be numbers of its kinds");
    return result;
}

std::shared_ptr<const motion::LinearLaw> linear_law(const Doubles<3>& fourier, const Integers& kind,
                                                    const Doubles<1>& breaks, const Doubles<3>& pieces) {
    auto law = std::make_shared<motion::LinearLaw>();
    law->fourier = series_of(fourier, "fourier");
    law->kind = kinds_of(kind, law->fourier.kinds, "kind");
    law->breaks = numbers_of<double>(breaks, {static_cast<Index>(breaks.size())}, "breaks");
    if (law->breaks.empty()) return law;
    require(law->breaks.size() > 1 && law->breaks.front() == 0.0 &&
                law->breaks.back() >= motion::tau - motion::rounding,
            "breaks must reach from 0 to 2 pi");
    for (std::size_t i = 1; i < law->breaks.size(); ++i)
        require(law->breaks[i] - law->breaks[i - 1] > 10.0 * motion::rounding, "breaks must rise");
    law->degrees = static_cast<Index>(pieces.shape(1));
    law->pieces = numbers_of<double>(
        pieces, {static_cast<Index>(law->breaks.size()) - 1, law->degrees, law->contacts()}, "pieces");
    return law;
}

std::shared_ptr<const motion::LoadDependentLaw> load_dependent_law(const Doubles<5>& table,
                                                                   const Doubles<2>& levels,
                                                                   const Integers& kind) {
    auto law = std::make_shared<motion::LoadDependentLaw>();
    law->kinds = static_cast<Index>(table.shape(0));
    law->level_count = static_cast<Index>(table.shape(1));
    law->harmonics = static_cast<Index>(table.shape(2));
    require(law->level_count > 0 && law->harmonics > 0, "a table must have levels and a mean");
    law->table = numbers_of<double>(table, {law->kinds, law->level_count, law->harmonics, 2, 4}, "table");
    law->levels = numbers_of<double>(levels, {law->kinds, law->level_count}, "levels");
    law->kind = kinds_of(kind, law->kinds, "kind");
    return law;
}

std::shared_ptr<const motion::MovingLaw> moving_law(const Doubles<5>& table, const Doubles<2>& levels,
                                                    const Integers& kind, Index first_place) {
    auto law = std::make_shared<motion::MovingLaw>();
    law->kinds = static_cast<Index>(table.shape(0));
    law->level_count = static_cast<Index>(table.shape(1));
    law->harmonics = static_cast<Index>(table.shape(2));
    require(law->level_count > 0 && law->harmonics > 0, "a table must have levels and a mean");
    law->table = numbers_of<double>(
        table, {law->kinds, law->level_count, law->harmonics, 2, motion::MovingLaw::powers}, "table");
    law->levels = numbers_of<double>(levels, {law->kinds, law->level_count}, "levels");
    law->kind = kinds_of(kind, law->kinds, "kind");
    law->first_place = first_place;
    return law;
}

std::shared_ptr<const motion::PowerLaw> power_law(const Doubles<3>& factor, double size, double exponent,
                                                  double level, Index contacts) {
    auto law = std::make_shared<motion::PowerLaw>();
    law->factor = series_of(factor, "factor");
    require(law->factor.kinds == 1, "factor must be one series");
    require(exponent > 1.0 && level > 0.0 && contacts > 0,
            "exponent must be above 1, level and contacts above 0");
    law->size = size, law->exponent = exponent, law->level = level, law->count = contacts;
    return law;
}

std::shared_ptr<const motion::System> system_of(
    const Doubles<2>& jacobian, const Doubles<1>& omega_squared, const Doubles<1>& damping,
    const Doubles<1>& weights, const Doubles<1>& mesh_damping, const Doubles<1>& lower,
    const Doubles<1>& upper, const Doubles<1>& leverage, motion::Law law, const Doubles<3>& error,
    const Integers& error_kind, const Doubles<3>& load, bool damping_when_open, bool push_only, Index pairs,
    double scale, const Doubles<1>& ring_stiffness, const Doubles<1>& ring_clearance, double ring_lag,
    const Integers& rubbing_flank, const Doubles<3>& rubbing_ratios, const Doubles<2>& rubbing_directions,
    const Doubles<3>& coupling) {
    auto s = std::make_shared<motion::System>();
    const Index n = s->n = static_cast<Index>(jacobian.shape(1)),
                m = s->m = static_cast<Index>(jacobian.shape(0));
    const Index rings = static_cast<Index>(ring_stiffness.size()),
                rubbing = static_cast<Index>(rubbing_flank.size());
    const auto* moving = std::get_if<std::shared_ptr<const motion::MovingLaw>>(&law);
    const Index places = moving != nullptr && *moving ? (*moving)->contacts() : 0;
    s->contacts = m - motion::ring_rows * rings - places;
    require(places == 0 || (*moving)->first_place == m - places, "places must be the last rows");
    require(n > 0 && m > 0 && s->contacts > 0, "a system must have coordinates and contacts");
    require(pairs >= 0 && 2 * pairs <= s->contacts, "pairs must be at most half the contacts");
    s->pairs = pairs;
    s->jacobian = numbers_of<double>(jacobian, {m, n}, "jacobian");
    s->omega_squared = numbers_of<double>(omega_squared, {n}, "omega_squared");
    s->damping = numbers_of<double>(damping, {n}, "damping");
    s->weights = numbers_of<double>(weights, {n}, "weights");
    s->mesh_damping = numbers_of<double>(mesh_damping, {m}, "mesh_damping");
    s->lower = numbers_of<double>(lower, {m}, "lower");
    s->upper = numbers_of<double>(upper, {m}, "upper");
    s->leverage = numbers_of<double>(leverage, {m}, "leverage");
    s->law = std::move(law);
    std::visit(
        [&](const auto& each) {
            require(each && each->contacts() == s->contacts, "law must be of all contacts");
        },
        s->law);
    s->error = series_of(error, "error");
    s->error_kind = kinds_of(error_kind, s->error.kinds, "error_kind");
    require(static_cast<Index>(s->error_kind.size()) == m, "error_kind has the wrong shape");
    s->load = series_of(load, "load");
    require(s->load.kinds == n, "load has the wrong shape");
    s->damping_when_open = damping_when_open;
    s->push_only = push_only;
    s->scale = scale;
    s->ring_stiffness = numbers_of<double>(ring_stiffness, {rings}, "ring_stiffness");
    s->ring_clearance = numbers_of<double>(ring_clearance, {rings}, "ring_clearance");
    s->ring_lag = ring_lag;
    s->rubbing_flank = kinds_of(rubbing_flank, s->contacts, "rubbing_flank");
    s->rubbing_ratios = series_of(rubbing_ratios, "rubbing_ratios");
    require(s->rubbing_ratios.kinds == rubbing, "rubbing_ratios has the wrong shape");
    s->rubbing_directions = numbers_of<double>(rubbing_directions, {rubbing, n}, "rubbing_directions");
    s->coupled = coupling.shape(0) > 0;
    if (s->coupled) {
        const auto all = numbers_of<double>(coupling, {4, n, n}, "coupling");
        std::vector<double>* parts[] = {&s->coupling.dampers, &s->coupling.gyroscopic,
                                        &s->coupling.circulatory, &s->coupling.centrifugal};
        for (Index i = 0; i < 4; ++i)
            parts[i]->assign(all.begin() + i * n * n, all.begin() + (i + 1) * n * n);
    }
    s->prepare();
    return s;
}

std::shared_ptr<const motion::Machine> machine_of(std::shared_ptr<const motion::System> system,
                                                  double frequency, double tolerance, double fastest) {
    require(system != nullptr, "a machine must have a system");
    return std::make_shared<motion::Machine>(
        motion::Machine{std::move(system), frequency, tolerance, fastest});
}

std::shared_ptr<motion::AnyRunner> runner_of(const std::shared_ptr<const motion::System>& system, Index order,
                                             bool many, const Doubles<1>& nodes, const Doubles<1>& weights) {
    require(system != nullptr && order >= 3 && order < 200, "order must be from 3 to 199");
    const auto places = numbers_of<double>(nodes, {static_cast<Index>(nodes.size())}, "nodes");
    const auto shares = numbers_of<double>(weights, {static_cast<Index>(nodes.size())}, "weights");
    return std::visit(
        [&](const auto& law) -> std::shared_ptr<motion::AnyRunner> {
            using LawType = std::remove_const_t<typename std::decay_t<decltype(law)>::element_type>;
            return make_runner<LawType>(system, order, many, places, shares);
        },
        system->law);
}

// Whether scratch space made for one system fits another.
bool fits(const motion::System& made_for, const motion::System& other) {
    return made_for.n == other.n && made_for.m == other.m && made_for.contacts == other.contacts &&
           made_for.pairs == other.pairs && made_for.law.index() == other.law.index() &&
           made_for.damping_when_open == other.damping_when_open && made_for.push_only == other.push_only &&
           made_for.opens == other.opens && made_for.error_kind == other.error_kind &&
           made_for.error.terms == other.error.terms && made_for.error.kinds == other.error.kinds &&
           made_for.load.terms == other.load.terms && made_for.rings() == other.rings() &&
           made_for.rubbing_flank == other.rubbing_flank &&
           made_for.rubbing_ratios.terms == other.rubbing_ratios.terms &&
           made_for.by_contact.starts == other.by_contact.starts &&
           made_for.by_contact.columns == other.by_contact.columns &&
           made_for.along.starts == other.along.starts && made_for.along.columns == other.along.columns &&
           made_for.coupled == other.coupled && made_for.coupled_rows.starts == other.coupled_rows.starts &&
           made_for.coupled_rows.columns == other.coupled_rows.columns &&
           made_for.breaks() == other.breaks() && made_for.same_law(other);
}

// Whether Ctrl-C, or another signal whose handler raises, is to end a run. Python's lock is not held before.
bool interrupted() {
    nb::gil_scoped_acquire acquired;
    return PyErr_CheckSignals() != 0;
}

std::unique_ptr<motion::Log> run(motion::AnyRunner& runner,
                                 const std::vector<std::shared_ptr<const motion::Machine>>& machines,
                                 const Doubles<3>& starts, const Integers& periods,
                                 const Doubles<4>& tangents, const Doubles<1>& longest, double begin,
                                 const Doubles<2>& drift, Index samples, Index batches, bool growth,
                                 bool fine, Index kept, Index steps, Index turns) {
    const motion::System& shape = runner.system();
    const Index count = static_cast<Index>(machines.size()), n = shape.n, m = shape.m;
    motion::Queue queue;
    queue.starts = numbers_of<double>(starts, {count, 2, n}, "starts");
    queue.periods = numbers_of<Index>(periods, {count}, "periods");
    queue.longest = numbers_of<double>(longest, {count}, "longest");
    queue.drift = numbers_of<double>(drift, {static_cast<Index>(drift.shape(0)), m}, "drift");
    queue.begin = begin;
    queue.stop = &interrupted;
    require(count > 0, "there must be a machine");
    require(static_cast<Index>(drift.shape(0)) <= runner.order(),
            "drift has more terms than the order of the steps");
    require(begin >= 0.0 && begin < motion::tau && (begin == 0.0 || samples == 0),
            "begin must be a phase from 0 to 2 pi");
    require(count == 1 || (steps == 0 && turns == 0), "steps and extrema are kept of one machine only");
    Index most = 0;
    for (Index i = 0; i < count; ++i) {
        require(machines[i] && machines[i]->system &&
                    (machines[i]->system.get() == &shape || fits(shape, *machines[i]->system)),
                "the machines must have the structure of the runner");
        require(queue.periods[i] > 0 && queue.longest[i] > 0.0,
                "periods and longest steps must be above zero");
        queue.machines.push_back(*machines[i]);
        most = std::max(most, queue.periods[i]);
    }
    const Index columns = static_cast<Index>(tangents.shape(1));
    require(samples >= 0 && batches >= 0 && batches <= most && steps >= 0 && turns >= 0 && kept >= 0,
            "counts must not be negative");
    require(!growth || columns > 0, "growth is that of a disturbance");
    const motion::Asked asked{samples, batches, columns, growth, fine || columns > 0, std::min(kept, most),
                              steps,   turns};
    auto log = std::make_unique<motion::Log>(asked, count, n, m, runner.order(), most);
    log->tangents = numbers_of<double>(tangents, {count, columns, 2, n}, "tangents");
    bool is_done = false;
    {
        nb::gil_scoped_release released;
        is_done = runner.run(queue, *log);
    }
    if (!is_done) throw nb::python_error();
    return log;
}

double first_root(const Doubles<1>& coefficients) {
    require(coefficients.size() > 1, "a polynomial must have two coefficients");
    motion::RootFinder finder(static_cast<Index>(coefficients.size()) - 1);
    std::copy_n(coefficients.data(), coefficients.size(), finder.polynomial());
    return finder.first_root();
}

nb::ndarray<nb::numpy, double> accelerations(motion::AnyRunner& runner, const motion::Machine& machine,
                                             double phase, const Doubles<2>& state) {
    const Index n = runner.system().n;
    require(machine.system && fits(runner.system(), *machine.system),
            "the machine must have the structure of the runner");
    const auto from = numbers_of<double>(state, {2, n}, "state");
    auto out = std::make_unique<std::vector<double>>(n);
    runner.accelerations(machine, phase, from.data(), out->data());
    std::vector<double>* values = out.get();
    nb::capsule owner(out.release(), [](void* kept) noexcept {
        std::unique_ptr<std::vector<double>>(static_cast<std::vector<double>*>(kept));
    });
    return {values->data(), {static_cast<std::size_t>(n)}, owner};
}

using Shape = std::initializer_list<std::size_t>;

// Bind an array of the log with its shape.
template <class Value, class ShapeOf>
void bind_array(nb::class_<motion::Log>& type, const char* name, std::vector<Value> motion::Log::* member,
                ShapeOf shape) {
    type.def_prop_ro(name, [member, shape](motion::Log& log) {
        const auto lengths = shape(log);
        return nb::ndarray<nb::numpy, Value>((log.*member).data(), lengths.size(), lengths.data(),
                                             nb::find(log));
    });
}

void bind_log(nb::module_& module) {
    using motion::Log;
    using Lengths = std::vector<std::size_t>;
    nb::class_<Log> type(module, "Log");
    type.def_ro("periods", &Log::longest);
    const auto counts = [](auto... numbers) { return Lengths{static_cast<std::size_t>(numbers)...}; };
    const auto summed = [](const Log& log) { return log.asked.batches > 0 ? log.machines : 0; };
    bind_array(type, "ends", &Log::ends,
               [=](const Log& l) { return counts(l.machines, l.asked.kept, 2, l.n); });
    bind_array(type, "samples", &Log::samples,
               [=](const Log& l) { return counts(l.machines, l.longest * l.asked.per_period, l.n); });
    bind_array(type, "tangents", &Log::tangents,
               [=](const Log& l) { return counts(l.machines, l.asked.columns, 2, l.n); });
    bind_array(type, "growth", &Log::growth,
               [=](const Log& l) { return counts(l.asked.growth ? l.machines : 0, l.longest); });
    bind_array(type, "divergence", &Log::divergence, [=](const Log& l) { return counts(l.machines); });
    bind_array(type, "fractions", &Log::fractions,
               [=](const Log& l) { return counts(l.fractions.empty() ? 0 : l.machines, 3, l.m); });
    bind_array(type, "origin", &Log::origin, [=](const Log& l) { return counts(summed(l), l.n); });
    bind_array(type, "level", &Log::level, [=](const Log& l) { return counts(summed(l), l.m); });
    bind_array(type, "coordinates", &Log::coordinates,
               [=](const Log& l) { return counts(summed(l), l.asked.batches, l.n); });
    bind_array(type, "products", &Log::products,
               [=](const Log& l) { return counts(summed(l), l.asked.batches, l.n, l.n); });
    bind_array(type, "deflections", &Log::deflections,
               [=](const Log& l) { return counts(summed(l), l.asked.batches, l.m); });
    bind_array(type, "squared", &Log::squared,
               [=](const Log& l) { return counts(summed(l), l.asked.batches, l.m); });
    bind_array(type, "forces", &Log::forces, [=](const Log& l) { return counts(summed(l), 2, l.m); });
    bind_array(type, "minimum", &Log::minimum, [=](const Log& l) { return counts(summed(l), l.m); });
    bind_array(type, "maximum", &Log::maximum, [=](const Log& l) { return counts(summed(l), l.m); });
    bind_array(type, "pull", &Log::pull, [=](const Log& l) { return counts(summed(l), l.m); });
    bind_array(type, "steps", &Log::taken, [=](const Log& l) { return counts(l.machines); });
    bind_array(type, "status", &Log::status, [=](const Log& l) { return counts(l.machines); });
    bind_array(type, "step_starts", &Log::step_starts, [=](const Log& l) { return counts(l.asked.steps); });
    bind_array(type, "step_lengths", &Log::step_lengths, [=](const Log& l) { return counts(l.asked.steps); });
    bind_array(type, "step_coordinates", &Log::step_coordinates,
               [=](const Log& l) { return counts(l.asked.steps, l.order + 1, l.n); });
    bind_array(type, "step_deflections", &Log::step_deflections,
               [=](const Log& l) { return counts(l.asked.steps, l.order + 1, l.m); });
    bind_array(type, "step_states", &Log::step_states,
               [=](const Log& l) { return counts(l.asked.steps, l.m); });
    bind_array(type, "turning_points", &Log::turning_points,
               [=](const Log& l) { return counts(l.m, 2, l.asked.turns); });
    bind_array(type, "turning_counts", &Log::turning_counts,
               [=](const Log& l) { return counts(l.asked.turns > 0 ? l.m : 0, 2); });
}

} // namespace

void bind_motion(nb::module_ module) {
    using namespace nb::literals;
    module.attr("ABREAST") = abreast;
    module.attr("RING_ROWS") = motion::ring_rows;
    module.attr("MAX_STEPS") = motion::max_steps;
    nb::class_<motion::LinearLaw>(module, "LinearLaw");
    nb::class_<motion::LoadDependentLaw>(module, "LoadDependentLaw");
    nb::class_<motion::PowerLaw>(module, "PowerLaw");
    nb::class_<motion::MovingLaw>(module, "MovingLaw");
    nb::class_<motion::System>(module, "System")
        .def("fits", [](const motion::System& one, const motion::System& other) { return fits(one, other); });
    nb::class_<motion::Machine>(module, "Machine");
    nb::class_<motion::AnyRunner>(module, "Runner").def_prop_ro("order", &motion::AnyRunner::order);
    bind_log(module);
    module.def("linear_law", &linear_law, "fourier"_a, "kind"_a, "breaks"_a, "pieces"_a);
    module.def("load_dependent_law", &load_dependent_law, "table"_a, "levels"_a, "kind"_a);
    module.def("moving_law", &moving_law, "table"_a, "levels"_a, "kind"_a, "first_place"_a);
    module.def("power_law", &power_law, "factor"_a, "size"_a, "exponent"_a, "level"_a, "contacts"_a);
    module.def("system", &system_of, nb::kw_only(), "jacobian"_a, "omega_squared"_a, "damping"_a, "weights"_a,
               "mesh_damping"_a, "lower"_a, "upper"_a, "leverage"_a, "law"_a, "error"_a, "error_kind"_a,
               "load"_a, "damping_when_open"_a, "push_only"_a, "pairs"_a, "scale"_a, "ring_stiffness"_a,
               "ring_clearance"_a, "ring_lag"_a, "rubbing_flank"_a, "rubbing_ratios"_a,
               "rubbing_directions"_a, "coupling"_a);
    module.def("machine", &machine_of, "system"_a, "frequency"_a, "tolerance"_a, "fastest"_a);
    module.def("runner", &runner_of, "system"_a, "order"_a, "many"_a, "nodes"_a, "weights"_a);
    module.def("run", &run, "runner"_a, "machines"_a, nb::kw_only(), "starts"_a, "periods"_a, "tangents"_a,
               "longest"_a, "begin"_a, "drift"_a, "samples"_a, "batches"_a, "growth"_a, "fine"_a, "kept"_a,
               "steps"_a, "turns"_a);
    module.def("accelerations", &accelerations, "runner"_a, "machine"_a, "phase"_a, "state"_a);
    module.def("first_root", &first_root, "coefficients"_a);
}

} // namespace facegear
