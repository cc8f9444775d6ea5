// Rolling bearings: energy, force, stiffness and loads at many motions.
#include "bindings/parts.hpp"

#include "bearings/balls.hpp"
#include "bearings/ring.hpp"
#include "bearings/rollers.hpp"
#include "bindings/records.hpp"

namespace facegear {
namespace {

using namespace bindings;
using namespace bearings;

// Fields of a `BallSprings` of facegear/bearings/elements.py, checked.
class GivenBalls {
  public:
    explicit GivenBalls(const Record& given)
        : cosine(given.array<double, 1>("cosine")), sine(given.array<double, 1>("sine")), numbers(given) {
        require(extent(cosine, 0) == extent(sine, 0), "every ball must have a cosine and a sine");
    }

    Balls bearing() const {
        return {list_of(cosine),
                list_of(sine),
                numbers.number("arm"),
                numbers.number("height"),
                numbers.number("rest_radial"),
                numbers.number("rest_axial"),
                numbers.number("inner_length"),
                numbers.number("outer_length"),
                numbers.number("inner_stiffness"),
                numbers.number("outer_stiffness"),
                numbers.number("stiffness"),
                numbers.number("centrifugal"),
                numbers.number("free_energy")};
    }

  private:
    Given<double, 1> cosine, sine;
    Record numbers;
};

// Fields of a `RollerSprings` of facegear/bearings/elements.py, checked.
class GivenRollers {
  public:
    explicit GivenRollers(const Record& given)
        : cosine(given.array<double, 1>("cosine")),
          sine(given.array<double, 1>("sine")),
          positions(given.array<double, 1>("positions")),
          drops(given.array<double, 1>("drops")),
          numbers(given) {
        require(extent(cosine, 0) == extent(sine, 0), "every roller must have a cosine and a sine");
        require(extent(positions, 0) == extent(drops, 0) && extent(positions, 0) > 0,
                "every slice must have a position and a drop, and a roller a slice");
    }

    Rollers bearing() const {
        return {list_of(cosine),
                list_of(sine),
                list_of(positions),
                list_of(drops),
                numbers.number("radius"),
                numbers.number("normal_radial"),
                numbers.number("normal_axial"),
                numbers.number("direction"),
                numbers.number("clearance"),
                numbers.number("stiffness"),
                numbers.number("centrifugal"),
                numbers.number("free_position"),
                numbers.number("free_energy")};
    }

  private:
    Given<double, 1> cosine, sine, positions, drops;
    Record numbers;
};

template <class GivenBearing>
Index bound_respond(nb::handle record, Given<double, 2> motion, Written<double, 1> energy,
                    Written<double, 2> force, Written<double, 3> stiffness) {
    const GivenBearing given((Record(record)));
    const auto bearing = given.bearing();
    const Index count = extent(motion, 0);
    require(extent(motion, 1) == MOTIONS, "motions must be (K, 5)");
    require(extent(energy, 0) == count && extent(force, 0) == count && extent(force, 1) == MOTIONS &&
                extent(stiffness, 0) == count && extent(stiffness, 1) == MOTIONS &&
                extent(stiffness, 2) == MOTIONS,
            "energy, force and stiffness must be (K,), (K, 5) and (K, 5, 5)");
    nb::gil_scoped_release released;
    Index lost = 0;
    for (Index k = 0; k < count; ++k) {
        Response response(force.data() + MOTIONS * k, stiffness.data() + MOTIONS * MOTIONS * k);
        lost += respond(bearing, motion.data() + MOTIONS * k, response);
        energy.data()[k] = response.energy;
    }
    return lost;
}

Index bound_ball_loads(nb::handle record, Given<double, 2> motion, Written<double, 3> loads) {
    const GivenBalls given((Record(record)));
    const Balls bearing = given.bearing();
    require(extent(motion, 1) == MOTIONS, "motions must be (K, 5)");
    require(extent(loads, 0) == extent(motion, 0) && extent(loads, 1) == bearing.cosine.size &&
                extent(loads, 2) == 4,
            "loads must be (K, Z, 4)");
    nb::gil_scoped_release released;
    Index lost = 0;
    for (Index k = 0; k < extent(motion, 0); ++k)
        lost += write_loads(bearing, motion.data() + MOTIONS * k, loads.data() + 4 * bearing.cosine.size * k);
    return lost;
}

Index bound_roller_loads(nb::handle record, Given<double, 2> motion, Written<double, 4> loads) {
    const GivenRollers given((Record(record)));
    const Rollers bearing = given.bearing();
    const Index size = 2 * bearing.cosine.size * bearing.positions.size;
    require(extent(motion, 1) == MOTIONS, "motions must be (K, 5)");
    require(extent(loads, 0) == extent(motion, 0) && extent(loads, 1) == bearing.cosine.size &&
                extent(loads, 2) == bearing.positions.size && extent(loads, 3) == 2,
            "loads must be (K, Z, n, 2)");
    nb::gil_scoped_release released;
    Index lost = 0;
    for (Index k = 0; k < extent(motion, 0); ++k)
        lost += write_loads(bearing, motion.data() + MOTIONS * k, loads.data() + size * k);
    return lost;
}

template <class GivenBearing>
void bind_respond(nb::module_ module, const char* name) {
    module.def(name, &bound_respond<GivenBearing>, nb::arg("bearing"), nb::arg("motion"),
               nb::arg("energy").noconvert(), nb::arg("force").noconvert(), nb::arg("stiffness").noconvert());
}

} // namespace

void bind_bearings(nb::module_ module) {
    bind_respond<GivenBalls>(module, "respond_balls");
    bind_respond<GivenRollers>(module, "respond_rollers");
    module.def("write_ball_loads", &bound_ball_loads, nb::arg("bearing"), nb::arg("motion"),
               nb::arg("loads").noconvert());
    module.def("write_roller_loads", &bound_roller_loads, nb::arg("bearing"), nb::arg("motion"),
               nb::arg("loads").noconvert());
}

} // namespace facegear
