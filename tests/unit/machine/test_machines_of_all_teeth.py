"""Machines with given stiffness and any teeth, from a config to statics, motion and refusals."""

import numpy as np
import pytest
from wrench_machines import random_machine

import facegear
from facegear.errors import FacegearError
from facegear.sharing.sensitivity import STEP, _changes

KINDS = {
    "helical": {"helix_angle_deg": 15.0},
    "tapered": {"taper_angle_deg": 4.0},
    "offset": {"offset_mm": 15.0},
    "angled": {"shaft_angle_deg": 97.0},
    "asymmetric": {"pressure_angle_deg": {"drive": 25.0, "coast": 21.0}},
}
MACHINE = {
    "transmission.mesh_kinematics": "geometric",
    "transmission.pinion.base_radius_mm": None,
    "transmission.face_gear.mesh_radius_mm": None,
    "transmission.pinion.bearing_stiffness_n_per_m.z": 2e8,
}


def load_machine(kind, **changes):
    pair = {f"tooth_pair.{key}": value for key, value in KINDS[kind].items()}
    return facegear.load("config/harmonics_only.yaml").with_values({**MACHINE, **pair, **changes})


@pytest.mark.parametrize("kind", KINDS)
def test_torques_of_all_meshes_balance_whatever_the_teeth(kind):
    gearbox = load_machine(kind)
    table = gearbox.statics().table().set_index("mesh")
    torques = table["pinion_torque_n_m"]
    by_pinion = torques.groupby(lambda mesh: mesh.split("/")[0]).sum()
    given = {"right input": 1327.6, "left input": 1327.6, "right idler": 0.0, "left idler": 0.0}
    for pinion, torque in given.items():
        assert by_pinion[pinion] == pytest.approx(torque, abs=1e-6)
    # The lower gear has no torque of its own.
    assert torques[torques.index.str.endswith("lower")].sum() == pytest.approx(0.0, abs=1e-6)


def test_unlike_flanks_have_arms_of_their_own():
    table = load_machine("asymmetric").statics().table().set_index("flank")
    radius = 3.75e-3 * 23 / 2
    for flank, angle in (("drive", 25.0), ("back", 21.0)):
        rows = table.loc[flank]
        arm = rows["pinion_torque_n_m"] / rows["force_n"]
        np.testing.assert_allclose(arm, radius * np.cos(np.radians(angle)), rtol=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_machines_of_all_teeth_vibrate_and_share_their_load(kind):
    gearbox = load_machine(kind)
    assert gearbox.modes().table()["frequency_hz"].iloc[1] > 100.0
    response = gearbox.response().table()
    assert response["periodic"].all() and (response["speed_rpm"] == 7500.0).all()


def test_helical_pinions_without_an_axial_bearing_are_refused():
    with pytest.raises(FacegearError, match=r"pinion\.bearing_stiffness_n_per_m\.z = 0.*: must be positive"):
        load_machine("helical", **{"transmission.pinion.bearing_stiffness_n_per_m.z": 0.0}).statics()


def test_printed_kinematics_refuse_helical_teeth_by_their_key():
    changes = {"transmission.mesh_kinematics": "printed", "transmission.face_gear.mesh_radius_mm": 262.5}
    with pytest.raises(FacegearError, match=r"transmission\.mesh_kinematics = .*: must be geometric, where"):
        load_machine("helical", **changes).statics()


@pytest.mark.parametrize("pinion", ["right input", "right idler"])
def test_a_helical_pinion_set_outwards_has_only_turned_and_a_tapered_one_has_other_gaps(pinion):
    place = {"transmission.single_pinions": {pinion: {"position_um": {"z": 1000.0}}}}
    for kind, least in (("helical", 0.0), ("tapered", 100.0)):
        moved, still = (load_machine(kind, **changes).statics().table()["force_n"] for changes in (place, {}))
        apart = np.abs(moved - still).max()
        assert apart > least if pinion == "right idler" and least else apart < 1e-6 * still.max()


def test_sensitivities_name_the_axial_places_of_pinions_with_other_teeth():
    machine, _ = random_machine(np.random.default_rng([61, 0]))
    names = [name for name, *_ in _changes(machine)]
    pinions = [pinion.name for pinion in machine.layout.pinions]
    assert [name for name in names if name.startswith("position z")] == [f"position z {p}" for p in pinions]
    low, high = next((low, high) for name, low, high, _ in _changes(machine) if name == "position z p0")
    moved = high.imperfections.outwards - low.imperfections.outwards
    assert moved[0] == pytest.approx(2 * STEP) and not moved[1:].any()


def gear_alone(gear, sign, **pair):
    """Return a machine with three pinions on one gear, their angles times `sign`."""
    roles = {"first": ("input", 0.0), "second": ("input", 130.0), "tail": ("tail", 215.0)}
    pinions = [{"name": name, "role": role, "angle_deg": sign * at} for name, (role, at) in roles.items()]
    kind = {"helix_angle_deg": 10.0, "taper_angle_deg": 3.0, "pressure_angle_deg": {"drive": 25, "coast": 21}}
    values = {f"tooth_pair.{key}": value for key, value in {**kind, **pair}.items()}
    machine = {"transmission.face_gears": [gear], "transmission.pinions": pinions}
    return facegear.load("config/harmonics_only.yaml").with_values({**MACHINE, **machine, **values})


def test_a_lower_gear_alone_is_the_upper_one_of_the_opposite_offset_turned_over():
    """A refusal of such a gear with bodies of teeth tells the user to write the upper one."""
    lower = gear_alone("lower", 1.0, offset_mm=15.0, shaft_angle_deg=97.0)
    upper = gear_alone("upper", -1.0, offset_mm=-15.0, shaft_angle_deg=83.0)
    for result, column in (("statics", "force_n"), ("modes", "frequency_hz"), ("response", "value")):
        here, there = (getattr(gearbox, result)().table()[column] for gearbox in (lower, upper))
        np.testing.assert_allclose(there, here, rtol=1e-9, atol=1e-9 * here.abs().max())
