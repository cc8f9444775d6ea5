// Static equilibrium of machines, for every law of a contact.
#include "bindings/parts.hpp"

#include "bindings/records.hpp"
#include "statics/laws.hpp"
#include "statics/settle.hpp"
#include "statics/springs.hpp"

namespace facegear {
namespace {

using namespace bindings;
using namespace statics;

// Arrays of a `Springs` of facegear/machine/block_statics.py, checked.
class GivenSprings {
  public:
    explicit GivenSprings(const Record& given)
        : jacobian(given.array<double, 2>("jacobian")),
          pinion_bearing(given.array<double, 2>("pinion_bearing")),
          clearance(given.array<double, 1>("clearance")),
          core_value(given.array<double, 1>("core_value")),
          loads(given.array<double, 1>("loads")),
          pinion(given.array<Index, 1>("pinion")),
          gear(given.array<Index, 1>("gear")),
          core_row(given.array<Index, 1>("core_row")),
          core_column(given.array<Index, 1>("core_column")) {
        check();
    }

    Springs springs() const {
        return {table_of(jacobian),       list_of(pinion),     list_of(gear),
                table_of(pinion_bearing), list_of(clearance),  list_of(core_row),
                list_of(core_column),     list_of(core_value), list_of(loads)};
    }

  private:
    Given<double, 2> jacobian, pinion_bearing;
    Given<double, 1> clearance, core_value, loads;
    Given<Index, 1> pinion, gear, core_row, core_column;

    void check() const {
        const Index flanks = extent(jacobian, 0), width = extent(jacobian, 1) - 3;
        const Index first = 3 * extent(pinion_bearing, 0), size = extent(loads, 0),
                    entries = extent(core_value, 0);
        require(width >= 0, "the Jacobian must be (F, 3 + w)");
        require(extent(pinion, 0) == flanks && extent(gear, 0) == flanks,
                "every flank must have a pinion and a gear");
        require(pinion_bearing.shape(1) == 3 && extent(clearance, 0) == extent(pinion_bearing, 0),
                "bearings must be (P, 3) and clearances (P,)");
        require(size >= first, "every pinion must have three unknowns");
        require(extent(core_row, 0) == entries && extent(core_column, 0) == entries,
                "every entry of the core must have a row and a column");
        require_within(list_of(pinion), 0, first - 3, "pinions must be among the unknowns");
        for (const Index at : list_of(pinion))
            require(at % 3 == 0, "pinions must begin at every third unknown");
        require_within(list_of(gear), first, size - width, "gears must be among the unknowns of the core");
        require_within(list_of(core_column), 0, size - first - 1,
                       "the core must be among the other unknowns");
        for (Index e = 0; e < entries; ++e) {
            require(0 <= core_row(e) && core_row(e) <= core_column(e), "the core must be an upper triangle");
        }
    }
};

class GivenLinearLaw {
  public:
    explicit GivenLinearLaw(const Record& given) : stiffness(given.array<double, 2>("stiffness")) {}

    LinearLaw law() const { return {table_of(stiffness)}; }

  private:
    Given<double, 2> stiffness;
};

class GivenLoadDependentLaw {
  public:
    explicit GivenLoadDependentLaw(const Record& given)
        : stiffness(given.array<double, 2>("stiffness")),
          cosine(given.array<double, 2>("cosine")),
          sine(given.array<double, 2>("sine")),
          levels(given.array<double, 2>("levels")),
          table(given.array<double, 5>("table")),
          kind(given.array<Index, 1>("kind")) {
        const bool is_of_phases =
            cosine.shape(0) == stiffness.shape(0) && sine.shape(0) == stiffness.shape(0);
        require(is_of_phases && cosine.shape(1) == sine.shape(1),
                "cosines and sines must be (K, harmonics + 1)");
        require(table.shape(0) == levels.shape(0) && table.shape(1) == levels.shape(1) &&
                    table.shape(2) == cosine.shape(1) && table.shape(3) == 2 && table.shape(4) == 4,
                "the table must be (kinds, levels, harmonics + 1, 2, 4)");
        require(levels.shape(1) > 0 && kind.shape(0) == stiffness.shape(1),
                "every contact must have a kind and a level");
        require_within(list_of(kind), 0, extent(levels, 0) - 1, "kinds must be rows of the table");
    }

    LoadDependentLaw law() const {
        return {table_of(stiffness), table_of(cosine), table_of(sine),
                table.data(),        table_of(levels), list_of(kind)};
    }

  private:
    Given<double, 2> stiffness, cosine, sine, levels;
    Given<double, 5> table;
    Given<Index, 1> kind;
};

template <class GivenLaw>
void bound_settle(nb::handle springs, nb::handle law, Given<double, 2> gap, double tolerance,
                  Given<double, 1> start, Written<double, 2> displacements, Written<double, 2> forces,
                  Written<double, 1> residuals) {
    const GivenSprings given((Record(springs)));
    const GivenLaw given_law((Record(law)));
    const Springs machine = given.springs();
    const auto held = given_law.law();
    const Index positions = extent(gap, 0);
    require(held.stiffness.rows == positions && held.stiffness.columns == machine.flanks() &&
                extent(gap, 1) == machine.flanks(),
            "the law and the gaps must be those of all flanks at every position");
    require(extent(start, 0) == machine.unknowns(), "the start must have all unknowns");
    require(extent(displacements, 0) == positions && extent(displacements, 1) == machine.unknowns() &&
                extent(forces, 0) == positions && extent(forces, 1) == machine.flanks() &&
                extent(residuals, 0) == positions,
            "what is found must have the shapes (K, n), (K, F) and (K,)");
    nb::gil_scoped_release released;
    settle_all(machine, held, table_of(gap), tolerance, start.data(),
               {table_of(displacements), table_of(forces), list_of(residuals)});
}

template <class GivenLaw>
void bind_settle(nb::module_ module, const char* name) {
    module.def(name, &bound_settle<GivenLaw>, nb::arg("springs"), nb::arg("law"), nb::arg("gap"),
               nb::arg("tolerance"), nb::arg("start"), nb::arg("displacements").noconvert(),
               nb::arg("forces").noconvert(), nb::arg("residuals").noconvert());
}

} // namespace

void bind_statics(nb::module_ module) {
    bind_settle<GivenLinearLaw>(module, "settle_linear");
    bind_settle<GivenLoadDependentLaw>(module, "settle_load_dependent");
}

} // namespace facegear
