"""Tables and arrays that the stage writes for a machine whose face gears bend."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from gear_bodies import PATCH, reference_body, spur_forces
from references import against, agrees

import facegear
from facegear.build.load import load_config
from facegear.errors import ConfigError, ConfigErrors
from facegear.parts.body_tables import COUPLINGS, mode_table
from facegear.parts.gear_body import reduced_body
from facegear.parts.reduced_body import ReducedBody
from facegear.pipeline.results.gear_bodies import GearBodiesResult
from facegear.pipeline.stages import gear_bodies as stage
from facegear.schema.base import parse
from facegear.schema.gear_body import BodySection
from facegear.studies import tooth_contact

pytestmark = pytest.mark.xdist_group("reference_body")  # solved once a process
FLEXIBLE = load_config(Path(__file__).parents[3] / "config" / "flexible.yaml")
DISC = {
    "rim": {"inner_radius_mm": 180.0, "back_mm": -12.0},
    "max_frequency_hz": 6000.0,
    "nodal_diameters": 3,
}


@pytest.fixture(scope="module")
def outcome():
    """A disc in place of every web."""
    section = FLEXIBLE.transmission
    gear = section.face_gear.model_copy(update={"body": parse(BodySection, DISC)})
    return stage.gear_bodies(
        section.model_copy(update={"face_gear": gear}), FLEXIBLE.tooth_pair, 7500.0, 20000.0
    )


def test_equal_gears_have_equal_modes_and_both_stand_in_the_tables(outcome):
    modes = outcome.content["modes"]
    lower, upper = (modes[modes["gear"] == gear].drop(columns="gear") for gear in ("lower", "upper"))
    assert len(lower) and np.array_equal(lower.to_numpy(), upper.to_numpy())
    assert (modes["frequency_hz"] <= 6000.0).all() and modes["nodal_diameters"].max() == 3
    waves = modes[modes["nodal_diameters"] > 0]
    assert (waves["forward_hz"] > waves["backward_hz"]).all()
    assert (modes["frequency_change"] < 1e-2).all()


@against(
    "second implementation",
    "Fourier elements extrapolated, hexahedra of a whole gear",
    capability="gear_bodies",
    module="facegear.parts.body_tables",
)
def test_table_has_c_b_and_q_of_every_mode_as_another_program_has_them():
    table = mode_table("upper", reference_body(), 1.0, 143, 143 / 23).groupby("nodal_diameters").first()
    c = [0, -0.0506, -0.0470, -0.0430, -0.0414, -0.0409, -0.0409]
    b = [0.826, 1.401, 3.322, 6.587, 11.180, 17.104, 24.361]
    agrees("c of the first modes", table["gyroscopic_factor"][:7], c, absolute=5e-4)
    agrees("B of the first modes", table["stiffening_factor"][:7], b, absolute=2e-3, relative=1e-3)
    couplings = table.filter(like="hub_").abs()
    agrees("Q along the axis, kg^0.5", couplings.loc[0, "hub_axial_sqrt_kg"], 3.99319, relative=5e-4)
    agrees("Q sideways, kg^0.5", couplings.loc[1, "hub_sideways_sqrt_kg"], 0.94095, relative=5e-4)
    agrees("Q of a tilt, kg^0.5 m", couplings.loc[1, "hub_tilt_sqrt_kg_m"], 0.67771, relative=5e-4)
    assert not couplings.loc[2:].to_numpy().any() and not couplings.loc[0].filter(regex="sideways|tilt").any()


def test_coefficients_through_the_door_are_the_columns_of_the_modes(outcome):
    result = GearBodiesResult(outcome.content, outcome.summary, "computed", {})
    table = result.coefficients()
    assert (
        len(table) == len(outcome.content["modes"])
        and np.isfinite(table.select_dtypes(float).to_numpy()).all()
    )
    assert list(table.columns[-4:]) == list(COUPLINGS) and (table["damping_ratio"] == 0.002).all()
    for column in table.columns[-4:]:
        assert column in GearBodiesResult.coefficients.__doc__


def test_damping_in_proportion_to_the_stiffness_rises_with_the_frequency_of_every_mode():
    body = parse(BodySection, {**DISC, "stiffness_damping_s": 3.2e-6})
    assert body.damping == (0.0, 3.2e-6) and parse(BodySection, DISC).damping == (0.002, 0.0)
    solved = reduced_body(reference_body(), PATCH, *body.damping)
    f = solved.frequency
    assert solved.damping / (4 * np.pi * f) == pytest.approx(np.pi * f * 3.2e-6, rel=1e-12)
    table = mode_table("upper", reference_body(), 1.0, 143, 143 / 23, body.damping)
    assert table["damping_ratio"].to_numpy() == pytest.approx(np.pi * f * 3.2e-6, rel=1e-12)


@pytest.mark.parametrize(
    ("given", "line"),
    [
        (
            {"stiffness_damping_s": 1e-6, "damping_ratio": 0.01},
            "stiffness_damping_s = 1e-06: must be left out where damping_ratio = 0.01 is given",
        ),
        ({"stiffness_damping_s": -1e-6}, "stiffness_damping_s = -1e-06: must be greater than or equal to 0"),
        (
            {"stiffness_damping_s": 1e-3},
            "stiffness_damping_s = 0.001: must be at most 2.65e-05: a mode of max_frequency_hz then",
        ),
    ],
)
def test_damping_that_is_given_twice_or_cannot_be_is_refused_in_one_line(given, line):
    with pytest.raises(ConfigErrors) as refused:
        parse(BodySection, {**DISC, **given})
    assert len(refused.value.lines) == 1 and line in refused.value.lines[0]


def test_gears_alike_are_solved_once(monkeypatch):
    solved = []
    monkeypatch.setattr(stage, "solve_body", lambda *given: solved.append(given) or "body")
    one = parse(BodySection, DISC)
    other = one.model_copy(update={"density_kg_per_m3": 7800.0})
    assert stage._solve_bodies({"lower": one, "upper": one}, FLEXIBLE.tooth_pair) == {
        "lower": "body",
        "upper": "body",
    }
    assert len(solved) == 1
    stage._solve_bodies({"lower": one, "upper": other}, FLEXIBLE.tooth_pair)
    assert len(solved) == 3


def test_fitted_teeth_are_those_of_the_body_that_is_solved_and_the_summary_names_them(monkeypatch):
    """In the stage and among many machines; teeth that are not fitted cost no fit."""
    solved = []

    def fit(shape, design):
        return replace(shape, layer=replace(shape.layer, hoop=0.03, shear=0.1))

    def solve(shape, *given):
        solved.append(shape.layer.hoop)
        return SimpleNamespace(section=shape)

    monkeypatch.setattr("facegear.parts.tooth_layer.fitted_teeth", fit)
    monkeypatch.setattr(stage, "solve_body", solve)
    monkeypatch.setattr(tooth_contact, "solve_body", solve)
    monkeypatch.setattr(tooth_contact, "reduced_body", lambda *given: None)
    common = parse(BodySection, DISC)
    fitted = common.model_copy(update={"teeth": "fitted"})
    bodies = {"lower": common, "upper": fitted}
    said = stage._fitted_layers(bodies, stage._solve_bodies(bodies, FLEXIBLE.tooth_pair))
    assert said == "; upper: teeth fitted, 0.5237 of the ring, 0.0300 of E and 0.1000 of G round the axis"
    for gear, section in bodies.items():
        tooth_contact._solve_body(section, FLEXIBLE.tooth_pair, gear)
    assert solved == [0.06, 0.03, 0.06, 0.03]


def test_what_modes_leave_out_between_flanks_of_one_mesh_and_of_two_are_columns_of_their_own(outcome):
    """Both from sums of cosines and sines over the orders; the first is by far the larger."""
    bodies = outcome.content["bodies"].set_index("gear")
    angles = 2 * np.pi * np.array([0, 22.5, 45.5, 97.5, 120.5]) / 143
    apart = (angles[:, None] - angles)[~np.eye(5, dtype=bool)]
    s, c = np.sin(np.radians(25.0)), np.cos(np.radians(25.0))
    for gear in ("lower", "upper"):
        left = ReducedBody.of_arrays(outcome.content["reduced"], gear).residual
        axial, around, mixed = left[:, 0, 0], left[:, 1, 1], left[:, 0, 1]
        orders = np.outer(apart, np.arange(len(left)))
        alike = np.cos(orders) @ (s**2 * axial + c**2 * around)
        across = np.cos(orders) @ (s**2 * axial - c**2 * around) + np.sin(orders) @ (2 * s * c * mixed)
        one_mesh = abs((s**2 * axial - c**2 * around).sum())
        two_meshes = max(np.abs(alike).max(), np.abs(across).max())
        found = bodies.loc[gear]
        assert found["left_out_between_flanks_m_per_n"] == pytest.approx(one_mesh, rel=1e-9)
        assert found["left_out_between_meshes_m_per_n"] == pytest.approx(two_meshes, rel=1e-9)
        own = (1.0 - found["modal_fraction"]) * found["own_compliance_m_per_n"]
        assert two_meshes < one_mesh < own


def test_own_compliance_is_the_sum_over_the_orders_along_the_line_of_action(outcome):
    compliance = outcome.content["compliance"].groupby("gear").sum()
    own = outcome.content["bodies"].set_index("gear")["own_compliance_m_per_n"]
    angle = np.radians(25.0)
    along = (
        compliance["axial_m_per_n"] * np.sin(angle) ** 2 + compliance["round_m_per_n"] * np.cos(angle) ** 2
    )
    assert own.to_numpy() == pytest.approx(along.to_numpy(), rel=1e-12)


def test_lower_gear_is_the_mirror_image_of_the_upper_one(outcome):
    """It turns the other way, so that what drives follows what drove: flanks of two meshes change places."""
    influence = outcome.content["influence"]
    keys = ["first", "first_flank", "second", "second_flank"]
    upper, lower = (influence[influence["gear"] == gear].set_index(keys) for gear in ("upper", "lower"))
    column = "compliance_m_per_n"
    for (first, one, second, other), value in upper[column].items():
        if first != second:
            assert lower.loc[(first, other, second, one), column] == pytest.approx(value, rel=1e-9, abs=1e-18)
    mixed = upper.xs(("drive", "back"), level=("first_flank", "second_flank"))[column]
    turned = upper.xs(("back", "drive"), level=("first_flank", "second_flank"))[column]
    assert np.abs(mixed - turned).max() > 1e-11


def test_mesh_harmonics_meet_waves_at_speeds_where_both_have_one_frequency(outcome):
    crossings, modes = outcome.content["crossings"], outcome.content["modes"]
    assert (
        set(crossings["wave"]) == {"standing", "forward", "backward"}
        and (crossings["speed_rpm"] <= 20000).all()
    )
    mesh = crossings["harmonic"] * 23 * crossings["speed_rpm"] / 60.0
    assert mesh.to_numpy() == pytest.approx(crossings["frequency_hz"].to_numpy(), rel=1e-12)
    keys = ["gear", "nodal_diameters", "mode"]
    both = crossings[crossings["harmonic"] == 1].merge(modes, on=keys)
    forward = both[both["wave"] == "forward"]
    assert len(forward) and np.array_equal(forward["speed_rpm_x"], forward["forward_met_rpm"])
    assert crossings["phase_factor"].between(0, 5).all()


def test_body_that_gives_more_than_the_backlash_is_named_with_both_numbers(outcome):
    softer = FLEXIBLE.transmission.model_copy(update={"backlash_um": 1.0})
    layout = stage.layout(softer, stage.ToothNumbers.of_config(FLEXIBLE.tooth_pair.model_dump()))
    bodies = outcome.content["bodies"]
    force = 1328.0 / layout.pinion_arm / 2
    gives = 1e6 * force * bodies["own_compliance_m_per_n"].max()
    said = stage._gives_way(bodies, softer, layout)
    assert said == f"; at {force:.4g} N a mesh gives {gives:.4g} um, more than its backlash of 1 um"
    enough = softer.model_copy(update={"backlash_um": 2.0 * gives})
    assert stage._gives_way(bodies, enough, layout) == ""


def test_reduced_bodies_come_back_from_their_arrays(outcome):
    arrays = outcome.content["reduced"]
    body = ReducedBody.of_arrays(arrays, "upper")
    assert body.arrays("upper") == {key: value for key, value in arrays.items() if key.startswith("upper_")}
    static = outcome.content["bodies"].set_index("gear").loc["upper"]
    own = body.residual_of_flanks(spur_forces())[0, 0]
    left = (1.0 - static["modal_fraction"]) * static["own_compliance_m_per_n"]
    assert own == pytest.approx(left, rel=1e-9)


def test_machine_of_rigid_gears_has_no_gear_bodies():
    with pytest.raises(ConfigError, match=r"transmission\.face_gear\.body = None: must be given"):
        facegear.example().gear_bodies()
