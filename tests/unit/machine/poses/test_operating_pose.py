"""A machine whose teeth stand where its own forces put them: published forces, limits, refusals."""

from dataclasses import replace
from functools import partial

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine
from references import against, agrees

import facegear
from facegear.build.machine import MachineInputs
from facegear.errors import ConfigErrors, InvalidInput
from facegear.harmonics import Harmonics
from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role, Side
from facegear.machine.poses.fixed_point import TOLERANCE, operating_pose
from facegear.machine.poses.surface import QUANTITIES, RADIUS, STIFFNESS, PoseSurface, surface_nodes
from facegear.machine.poses.tables import leaving_text, load_tables, mesh_table
from facegear.machine.statics import mean_equilibrium
from facegear.teeth.conjugate import contact_at
from facegear.teeth.design import AssemblyErrors
from validation.poses.measure import ASSEMBLIES, LOADED_CONTACT, SURFACE, TORQUE

MESHES = [
    f"{name}/{side}"
    for side in ("lower", "upper")
    for name in ("tail idler", "right idler", "right input", "left input", "left idler")
]
TODAY = [7802.2, 6107.6, 9805.7, 10450.8, 6346.7, 5491.7, 6107.6, 24171.9, 23526.9, 6346.7]
POSE_ALONE = [7774.6, 6083.7, 9763.5, 10416.5, 6321.7, 5464.1, 6083.7, 24214.1, 23561.2, 6321.7]
POSE_AND_LOAD = [7660.4, 5966.0, 9585.2, 10247.3, 6206.1, 5349.9, 5966.0, 24392.4, 23730.4, 6206.1]
"""Forces (N) of MESHES from another program that solved the contact of each mesh in every step."""
PUBLISHED = {
    "nominal": (5.28555e8, 76.7134e-6, 4.865e-6, 1188e6, 265.918e-3, 414e6),
    "offset 120 um, shaft angle 0.03 deg": (5.55319e8, -33.3540e-6, 4.268e-6, 1195e6, 264.196e-3, 342e6),
    "offset -120 um": (4.91358e8, 186.9417e-6, 5.320e-6, 1243e6, 266.900e-3, 469e6),
}
"""Stiffness, mean transmission error, its peak to peak, pressure, path, root stress of the gear; SI units."""
KEYS = (STIFFNESS, "ste_mean_m", "ste_peak_to_peak_m", "pressure_pa", RADIUS, "face_gear_root_pa")
DIGITS = (6e2, 6e-11, 6e-10, 6e5, 6e-7, 1e6)


@pytest.fixture(scope="module")
def surface():
    with np.load(SURFACE) as stored:
        return PoseSurface.of_arrays(dict(stored))


@pytest.fixture(scope="module")
def concentric():
    """The machine of config/concentric.yaml with the mean stiffness of its load."""
    values = facegear.load("config/concentric.yaml", results=None).values
    constant, none = Harmonics(np.zeros(1), np.array([4.1e8])), Harmonics(np.zeros(1), np.zeros(1))
    return replace(MachineInputs.of_config(values, constant), unloaded_error=none).build()


def plain_machine(bearing=6.5e7, torque=1328.0, **more):
    """The paper's layout with geometric meshes and no errors."""
    layout = make_layout(pinion_bearing=bearing, gear_bearing=bearing / 6.5e7 * 8.7e9, kinematics=GEOMETRIC)
    return make_machine(layout, torque=torque, tail_share=0.034, **more)


@against(
    "second implementation",
    "contact of every mesh solved anew in every step of the iteration",
    capability="operating_pose",
    module="facegear.machine.poses.fixed_point",
)
def test_forces_with_teeth_where_they_stand_are_the_published_ones(concentric, surface):
    """To less than the 0.1 % by which the published contact is known."""
    forces = np.abs(mean_equilibrium(concentric).forces[0])
    assert list(concentric.layout.mesh_names) == MESHES
    agrees("forces as assembled, N", forces, TODAY, absolute=0.06)
    solved = partial(operating_pose, concentric, surface, ideal=True)
    agrees("forces by pose alone, N", np.abs(solved(load=663.8).forces), POSE_ALONE, relative=4e-4)
    agrees("forces by pose and load, N", np.abs(solved().forces), POSE_AND_LOAD, relative=4e-4)


@against(
    "second implementation",
    "contact of a pair in given assemblies",
    capability="pose_surface",
    module="facegear.contact.analysis",
)
@pytest.mark.parametrize("assembly", PUBLISHED)
def test_loaded_contact_in_given_assemblies_is_the_published_one(assembly):
    """A measurement at default accuracy, stored by `python -m validation.poses.measure`."""
    row = pd.read_csv(LOADED_CONTACT).set_index("assembly").loc[assembly]
    for key, known, digit in zip(KEYS, PUBLISHED[assembly], DIGITS, strict=True):
        agrees(f"{key} at {TORQUE:g} N m", row[key], known, absolute=digit)


@against(
    "second implementation",
    "contact of a pair in given assemblies",
    capability="pose_surface",
    module="facegear.machine.poses.surface",
)
@pytest.mark.parametrize("assembly", ["nominal", "offset -120 um"])
def test_between_its_nodes_the_surface_is_the_contact_there(surface, assembly):
    errors = ASSEMBLIES[assembly]
    path = contact_at(surface.pair, errors).y
    assert np.abs(surface.nodes.paths - path).min() > 4e-4
    known = dict(zip(KEYS, PUBLISHED[assembly], strict=True))
    for key, relative in ((STIFFNESS, 5e-3), ("pressure_pa", 1e-2), ("ste_peak_to_peak_m", 3e-2)):
        agrees(key, surface.at(key, TORQUE, path, 0.0), known[key], relative=relative)
    agrees(RADIUS, surface.at(RADIUS, TORQUE, path, 0.0), known[RADIUS], absolute=1e-4)


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 6), st.integers(0, 4))
def test_at_its_nodes_the_surface_is_what_was_solved_there(surface, path, torque):
    nodes = surface.nodes
    for name, values in surface.values.items():
        at = surface.at(name, nodes.torques[torque], nodes.paths[path], 0.0)
        assert at == pytest.approx(values[0, path, torque], rel=1e-9)
    assert set(surface.values) == set(QUANTITIES)


@pytest.mark.parametrize("order", [2, 3])
def test_splines_over_nodes_left_out_miss_a_cubic_in_nothing(surface, order):
    """Nodes that are left out are known exactly where the quantity is a polynomial in both coordinates."""
    logs = np.log(surface.nodes.torques / 100.0)
    along = (surface.nodes.paths[:, None] - 0.268) / 0.01
    values = {STIFFNESS: np.exp(20.0 + along**order - 0.1 * logs)[None]}
    for missed in replace(surface, values=values).left_out(STIFFNESS).values():
        assert np.abs(missed).max() < 1e-9


def test_stiff_bearings_leave_the_forces_as_assembled_and_their_effect_falls_in_proportion(surface):
    effects = []
    for factor in (1e3, 1e4):
        machine = plain_machine(6.5e7 * factor, torque=1000.0, backlash=0.0)
        before = mean_equilibrium(machine).forces[0]
        after = operating_pose(machine, surface, load=surface.reference_torque).forces
        effects.append(np.abs(after - before).max() / np.abs(before).max())
    assert effects[1] < 1e-4
    assert effects[0] / effects[1] == pytest.approx(10.0, rel=0.02)


def test_a_converged_pose_gives_its_own_forces_again(surface):
    machine = plain_machine()
    result = operating_pose(machine, surface)
    assert result.change < TOLERANCE and result.steps <= 6
    again = mean_equilibrium(result.machine).forces[0]
    np.testing.assert_allclose(result.forces, again, rtol=1e-7)
    assert np.abs(result.forces / mean_equilibrium(machine).forces[0] - 1.0).max() > 5e-3


def test_what_the_exact_contact_closes_beyond_first_order_is_the_square_of_the_motion_across(surface):
    """The law's argument grows by eta squared over 2 h sin a0, and inputs, which move along it, have none."""
    result = operating_pose(plain_machine(), surface)
    pair, layout = surface.pair, result.machine.layout
    angle, meshes = pair.pressure_angle, len(layout.meshes)
    offset = np.where(result.forces < 0.0, -result.poses.offset, result.poses.offset)
    across = offset * np.sin(angle) + result.poses.gear_axial * np.cos(angle)
    second = across**2 / (2.0 * pair.shaper_lift * np.sin(angle))
    drive, back = np.split(result.flank_closure, 2)
    closing = np.where(result.forces < 0.0, back, drive)
    inputs = np.array([layout.pinions[i].role is Role.INPUT for i, _ in layout.meshes])
    assert closing[inputs].max() < 1e-7 and closing[~inputs].min() > 0.7e-6
    np.testing.assert_allclose(closing, second, rtol=0.06, atol=1e-9)
    assert closing.size == meshes


def test_a_position_error_of_a_pinion_is_a_pose_as_well(surface):
    """Bearings so stiff that nothing else moves."""
    machine = plain_machine(6.5e11, torque=1000.0)
    shifted = perfect(machine.layout)
    shifted.position[1] = (-60e-6, 20e-6)
    result = operating_pose(replace(machine, imperfections=shifted), surface, load=500.0)
    upper = machine.layout.mesh_index(1, Side.UPPER)
    lower = machine.layout.mesh_index(1, Side.LOWER)
    for mesh, side in ((upper, 1.0), (lower, -1.0)):
        assert result.poses.offset[mesh] == pytest.approx(-side * 60e-6, abs=2e-8)
        assert result.poses.gear_axial[mesh] == pytest.approx(-side * 20e-6, abs=2e-8)


def test_a_contact_that_leaves_the_face_is_named_with_the_load(concentric, surface):
    """The tail idler's at 1.2 times the nominal torque; the others' later than the surface reaches."""
    loads, leaving = load_tables(concentric, surface)
    assert leaving["mesh"].to_list() == ["tail idler/upper"]
    fraction = leaving["load_fraction"].item()
    assert fraction == pytest.approx(1.2, abs=0.05)
    where = f"at {100 * fraction:.0f} % of the torque the contact of tail idler/upper leaves the face"
    assert leaving_text(leaving) == f"{where} at 275 mm"
    assert loads["load_fraction"].max() < 1.5


def test_pressure_and_root_stress_of_the_idlers_grow_by_the_sizes_that_are_known(concentric, surface):
    """At 1328 N m an input: stiffness at 663.8 N m -9 to -14 %, root stress of the gear +18 to +26 %.

    Known of forces along the ideal normals, by which inputs move along them alone.
    """
    result = operating_pose(concentric, surface, ideal=True)
    table = mesh_table(concentric, surface, result, mean_equilibrium(concentric).forces[0])
    table = table.set_index("mesh")
    idlers, inputs = (table[table.index.str.contains(role)] for role in ("idler", "input"))
    assert idlers["unloaded_path_mm"].between(271.5, 274.0).all()
    at_one_load = operating_pose(concentric, surface, load=663.8, ideal=True).factor
    at_one_load = at_one_load[table.index.str.contains("idler")]
    assert at_one_load.min() - 1.0 > -0.145 and at_one_load.max() - 1.0 < -0.085
    assert idlers["pressure_by_pose_percent"].between(2.0, 12.0).all()
    assert idlers["face_gear_root_by_pose_percent"].between(15.0, 40.0).all()
    assert inputs["stiffness_by_pose_percent"].abs().max() < 1.0
    assert (idlers["to_outer_end_mm"] + idlers["unloaded_path_mm"]).to_numpy() == pytest.approx(275.0)


def test_a_pose_outside_the_surface_is_refused_with_mesh_and_value(surface):
    with pytest.raises(InvalidInput, match=r"path of the contact of mesh .*idler/.*nothing is extrapolated"):
        operating_pose(plain_machine(3e7), surface)
    with pytest.raises(InvalidInput, match=r"torque of mesh .*input/upper = .*nothing is extrapolated"):
        operating_pose(plain_machine(torque=2400.0), surface)
    with pytest.raises(InvalidInput, match="error of the shaft angle of mesh one/upper"):
        surface.require("one/upper", 100.0, 0.268, 1e-3)


def test_flanks_that_touch_along_lines_have_no_surface(surface):
    lines = replace(surface.pair, shaper_lift=0.0)
    with pytest.raises(InvalidInput, match="teeth of the shaper"):
        surface_nodes(lines, AssemblyErrors(), 1000.0, tilting=False)


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"transmission.operating_pose": "moving"}, "transmission.operating_pose"),
        (
            {"transmission.operating_pose": "static", "transmission.mesh_kinematics": "printed"},
            "transmission.*printed",
        ),
        (
            {"transmission.operating_pose": "static", "mesh_stiffness.source": "harmonics"},
            "mesh_stiffness|operating_pose",
        ),
        (
            {"transmission.face_gear.tilt": {"centre_below_pitch_plane_mm": 5.0}},
            "transmission.face_gear.tilt.inertia_kg_m2",
        ),
    ],
)
def test_what_has_no_poses_is_refused_with_the_key(changes, line):
    with pytest.raises(ConfigErrors, match=line):
        facegear.example().with_values(changes)


def test_an_answer_of_the_door_is_the_fixed_point_and_its_surface_is_near_contact_at_the_pose():
    """On the coarse machine; without poses nothing of its answers changes."""
    gearbox = facegear.example().with_values({"transmission.operating_pose": "static"})
    answer = gearbox.operating_pose()
    table = answer.table().set_index("mesh")
    running = gearbox.statics().table().set_index("mesh")["force_n"]
    at_rest = facegear.example().statics().table().set_index("mesh")["force_n"]
    np.testing.assert_allclose(running, table["force_n"], rtol=1e-6)
    np.testing.assert_allclose(at_rest, table["force_as_assembled_n"], rtol=1e-12)
    assert np.abs(running / at_rest - 1.0).max() > 1e-3
    check = answer.check().set_index("quantity")["surface_error_percent"].abs()
    assert check[STIFFNESS] < 1.0 and check["pressure_pa"] < 2.0 and check[RADIUS] < 0.05
    assert facegear.example().values["transmission"]["operating_pose"] == "none"


def test_a_lower_gear_meets_an_error_of_the_shaft_angle_from_the_other_side():
    """Its surface was that of the upper gear, at whose angle alone contact was solved: it was refused."""
    changes = {"transmission.operating_pose": "static", "tooth_pair.assembly.shaft_angle_error_deg": 0.01}
    gearbox = facegear.example().with_values(changes)
    table = gearbox.operating_pose().table().set_index("mesh")
    for mesh, angle in table["shaft_angle_error_deg"].items():
        assert angle == pytest.approx(0.01 if mesh.endswith("upper") else -0.01)
