"""Helical and tapered pairs through the stages of poses: displaced bodies, surface, pose, stress."""

import numpy as np
import pytest
from kinds_of_teeth import public_section
from references import against, agrees
from test_other_teeth_run import COARSE, MACHINE

import facegear
from facegear.build.load import merge_values
from facegear.machine.poses.surface import RADIUS, STIFFNESS, PoseSurface
from facegear.strength.root_stress import largest_tension
from facegear.strength.root_tables import root_from_arrays

TILT = {"inertia_kg_m2": 0.3, "stiffness_n_m_per_rad": 1e7, "centre_below_pitch_plane_mm": 5.0}
PINIONS = [
    {"name": "engine", "role": "input", "angle_deg": 0},
    {"name": "tail", "role": "tail", "angle_deg": 180},
]
POSED = MACHINE["transmission"] | {
    "operating_pose": "static",
    "pinions": PINIONS,
    "torque": {"per_input_n_m": 800, "tail_share": 0.85},
}
"""A tail pinion takes off most of the power, on the back flanks of both gears."""
KINDS = {
    "P1": {"face_gear": {"outer_radius_mm": 233}, "shaper": {"tip_rounding_modules": 0.2}},
    "P2": {},
    "P3": {"shaft_angle_deg": 92},
}
"""Values in place of the public ones: fillets that a coarse mesh resolves, a lower gear that has teeth."""


@pytest.fixture(scope="module")
def gearbox_of():
    """Machines with poses, by the name of their public pair; each solves its surface once."""
    known = {}

    def gearbox(name):
        if name not in known:
            section, gears = merge_values(public_section(name), KINDS[name]), POSED["face_gear"]
            machine = POSED | {"face_gear": gears | {"tilt": TILT}} if name == "P2" else POSED
            values = {**COARSE, **MACHINE, "transmission": machine, "tooth_pair": section}
            values["contact"] = COARSE["contact"] | {"root_stress": name == "P1"}
            known[name] = facegear.load({"case": "kind", **values}, results=None)
        return known[name]

    return gearbox


@against(
    "second implementation",
    "contact of the pair assembled with these errors, through the config",
    capability="displaced_contact",
    module="facegear.pipeline.displaced_contact",
)
@pytest.mark.parametrize("name", ["P1", "P2"])
def test_loaded_contact_of_displaced_bodies_is_that_of_the_pair_assembled_so(gearbox_of, name):
    """With a pinion that is moved along its axis, for drive and back flank."""
    gearbox = gearbox_of(name)
    moved = {"x_um": 60.0, "y_um": 30.0, "z_um": 150.0}
    found = gearbox.displaced_contact(moved, mesh="engine/upper").loaded(400)
    errors = {"offset_um": 60.0, "gear_axial_um": -30.0, "pinion_axial_um": 150.0}
    keys = {f"tooth_pair.assembly.{key}": value for key, value in errors.items()}
    assembled = gearbox.with_values(keys).contact(torques=400).by_flank()
    for flank in ("drive", "back"):
        first = found[found["flank"] == flank].iloc[0]
        known = assembled[(assembled["flank"] == flank) & (assembled["gear"] == "upper")].iloc[0]
        for column in ("k_average_mean_n_per_m", "pressure_mpa", "path_radius_mm", "ste_peak_to_peak_um"):
            agrees(f"{column} of the {flank} flank", first[column], known[column], relative=1e-9)


@against(
    "second implementation",
    "contact solved at the pose of the mesh that changes most",
    capability="pose_surface operating_pose",
    module="facegear.machine.poses.fixed_point",
)
@pytest.mark.parametrize("name", KINDS)
def test_an_operating_pose_is_the_machine_s_own_and_its_surface_is_contact_there(gearbox_of, name):
    """On coarse meshes, within what the surface says that it misses."""
    gearbox = gearbox_of(name)
    answer = gearbox.operating_pose()
    table, running = answer.table().set_index("mesh"), gearbox.statics().table().set_index("mesh")
    np.testing.assert_allclose(running["force_n"], table["force_n"], rtol=1e-6)
    assert (table["flank"] == "back").tolist() == [False, True, False, True]
    check = answer.check().set_index("quantity")
    for quantity, relative in ((STIFFNESS, 1e-2), (RADIUS, 2e-3), ("tangential_force_n", 1e-3)):
        agrees(quantity, check["surface"][quantity], check["direct"][quantity], relative=relative)
    for quantity in ("axial_force_n", "overturning_moment_n_m"):
        agrees(quantity, check["surface"][quantity], check["direct"][quantity], relative=2e-2)


@pytest.mark.parametrize("name", KINDS)
def test_each_flank_has_the_surface_of_its_own_teeth(gearbox_of, name):
    """Two of a helix, one of a taper, four where the axes lean, too."""
    surface = PoseSurface.of_arrays(gearbox_of(name)._chain.part("pose_surface", "surface"))
    again = PoseSurface.of_arrays(surface.arrays)
    assert len(surface.further) == {"P1": 1, "P2": 0, "P3": 3}[name]
    assert again.flank_numbers == surface.flank_numbers
    for gear in ("upper", "lower"):
        for flank in ("drive", "back"):
            own, stored = (one.of_flank(gear, flank) for one in (surface, again))
            assert own.pair == stored.pair and own.nominal == stored.nominal
            np.testing.assert_array_equal(own.values[STIFFNESS], stored.values[STIFFNESS])
    sines = [surface.of_flank("upper", flank).pair.base_helix_sine for flank in ("drive", "back")]
    assert (sines[0] == -sines[1]) == (name != "P2")


@pytest.mark.parametrize("mesh", ["engine/upper", "tail/lower"])
def test_stress_at_the_pose_is_that_of_the_displaced_pair_on_the_flank_that_carries(gearbox_of, mesh):
    gearbox, gear = gearbox_of("P1"), mesh.split("/")[1]
    stress = gearbox._chain.part("posed_stress", "by_mesh").set_index("mesh").loc[mesh]
    row = gearbox.operating_pose().table().set_index("mesh").loc[mesh]
    errors = {
        "offset_um": row["offset_um"] if gear == "upper" else -row["offset_um"],
        "gear_axial_um": row["gear_axial_um"],
        "pinion_axial_um": row["outward_um"],
    }
    keys = {f"tooth_pair.assembly.{key}": value for key, value in errors.items()}
    torque = float(row["torque_n_m"])
    posed = gearbox.with_values(keys | {"contact.torques_n_m": [300.0, torque, 600.0]})
    direct = posed.contact().by_flank().set_index(["gear", "flank"]).loc[(gear, row["flank"])].iloc[1]
    assert stress["pressure_mpa"] == pytest.approx(direct["pressure_mpa"], rel=1e-6)
    arrays = posed._chain.part("root_stress", "stress")
    for body in ("pinion", "face_gear"):
        known = largest_tension(root_from_arrays(arrays, body, gear, row["flank"]))(torque)
        assert stress[f"{body}_root_mpa"] == pytest.approx(1e-6 * known, rel=1e-6)


def test_poses_of_a_duty_cycle_follow_the_load_of_each_bin(gearbox_of):
    duty = [{"torque_n_m": torque, "speed_rpm": 6000, "hours": 10} for torque in (400.0, 200.0)]
    strength = facegear.example().values["strength"] | {"duty": duty}
    gearbox = gearbox_of("P1").with_values({"strength": strength})
    table = gearbox._chain.part("duty_poses", "duty_poses")
    own = gearbox.operating_pose().table().set_index("mesh")["unloaded_path_mm"]
    carrying = table[table["force_n"] > 0.0].set_index(["bin", "mesh"])["unloaded_path_mm"]
    np.testing.assert_allclose(carrying.loc[1][own.index], own, rtol=1e-9)
    assert (carrying.loc[2] - carrying.loc[1]).abs().max() > 0.05
