"""Contact and closing of a pair whose bodies stand displaced, through the front door."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from references import against, agrees

import facegear
from facegear.build.machine_layout import layout
from facegear.build.tooth_numbers import ToothNumbers
from facegear.build.tooth_pair import pair_design
from facegear.errors import FacegearError, NotConverged
from facegear.machine.linear_model import lumped_model

CENTRE = {"inertia_kg_m2": 0.3, "stiffness_n_m_per_rad": 1e7, "centre_below_pitch_plane_mm": 1.875}
"""The gears tilt 45 mm above the pinions' axes."""
MACHINE = facegear.example().with_values(
    {"tooth_pair.pinion.thinning_um": 100.0, "transmission.face_gear.tilt": CENTRE}
)
DESIGN = pair_design(MACHINE.config.tooth_pair)
LAYOUT = layout(MACHINE.config.transmission, ToothNumbers.of_config(MACHINE.values["tooth_pair"]))
LINEAR = lumped_model(LAYOUT)
AT = np.radians(30.0)
PINION = {"x_um": 80.0, "y_um": -50.0, "tilt_x_deg": 0.010, "tilt_y_deg": -0.006}
PUBLISHED = {
    "upper": (91.552571, 71.009790, 0.00803542, -17.1232, -17.111118, 140.755496),
    "lower": (-98.774889, -71.010566, -0.00803542, -20.2092, -77.806095, -41.469026),
}
"""Offset, axial shift (um), error of the shaft angle (deg), shift outwards, transmission errors of drive and
back flank with all turns (um), of PINION and a gear that moves (20, -10, 30) um and tilts (0.004, -0.003) deg
about a point 45 mm from the axis of a pinion at 30 deg. Both bodies were moved rigidly and their contact was
searched to 1e-13 m."""


def seen_at_zero(x, y):
    """A vector of the gears at an azimuth of 30 deg, turned so that a pinion at azimuth 0 sees the same."""
    return x * np.cos(AT) + y * np.sin(AT), -(x * np.sin(AT) - y * np.cos(AT))


@against(
    "second implementation",
    "both bodies displaced rigidly, contact searched at 1e-13 m",
    capability="displaced_contact",
    module="facegear.machine.poses.displaced_pair",
)
@pytest.mark.parametrize("side", ["upper", "lower"])
def test_two_displaced_bodies_meet_and_close_as_rigid_displacement_has_it(side):
    moved, tilted = seen_at_zero(20.0, -10.0), seen_at_zero(0.004, -0.003)
    gear = {"x_um": moved[0], "y_um": moved[1], "z_um": 30.0}
    gear |= {"tilt_x_deg": tilted[0], "tilt_y_deg": tilted[1]}
    table = MACHINE.displaced_contact(PINION, gear, f"tail idler/{side}").table().set_index("flank")
    drive, back, published = table.loc["drive"], table.loc["back"], PUBLISHED[side]
    agrees("offset, um", drive["offset_um"], published[0], absolute=6e-7)
    agrees("axial shift, um", drive["gear_axial_um"], published[1], absolute=6e-7)
    agrees("error of the shaft angle, deg", drive["shaft_angle_error_deg"], published[2], absolute=6e-9)
    agrees("shift outwards, um", drive["outward_um"], published[3], absolute=6e-5)
    agrees("approach of the drive flank, um", drive["approach_um"], published[4] + 50.0, absolute=6e-7)
    agrees("approach of the back flank, um", back["approach_um"], 50.0 - published[5], absolute=6e-7)
    assert back["offset_um"] == -drive["offset_um"] and drive["backlash_um"] == back["backlash_um"]
    agrees("backlash, um", drive["backlash_um"], published[5] - published[4], absolute=1.2e-6)


@against(
    "second implementation",
    "unloaded contact of published poses, searched on displaced bodies",
    capability="displaced_contact",
    module="facegear.machine.poses.displaced_pair",
)
def test_an_offset_with_a_leaning_pinion_has_the_published_contact_on_both_flanks():
    """The outer end of a pinion that leans about x comes away from the upper gear."""
    found = MACHINE.displaced_contact({"x_um": 120.0, "tilt_x_deg": 0.03}, mesh="tail idler/upper").table()
    agrees("path, mm", found["unloaded_path_mm"], [264.388284, 269.136890], absolute=1e-6)
    agrees("pressure angle, deg", found["pressure_angle_deg"], [23.213899, 25.468187], absolute=1e-6)
    agrees("backlash, um", found["backlash_um"], 101.152071, absolute=1e-6)


@settings(max_examples=25, deadline=None)
@given(
    st.lists(st.floats(-1.0, 1.0), min_size=10, max_size=10),
    st.sampled_from(["tail idler/lower", "right input/upper", "left idler/lower", "left idler/upper"]),
)
def test_deflections_of_displaced_bodies_are_those_of_the_machine_s_own_flanks(parts, mesh):
    pinion = {"x_um": 50 * parts[0], "y_um": 50 * parts[1], "z_um": 50 * parts[2], "theta_deg": parts[3]}
    gear = {"x_um": 50 * parts[4], "y_um": 50 * parts[5], "z_um": 50 * parts[6], "theta_deg": parts[7]}
    gear |= {"tilt_x_deg": 0.01 * parts[8], "tilt_y_deg": 0.01 * parts[9]}
    moved, name = np.zeros(LINEAR.size), mesh.split("/")
    for body, given_parts in ((name[0], pinion), (f"{name[1]} face gear", gear)):
        for key, value in given_parts.items():
            letter = key.rsplit("_", 1)[0]
            unit = 1e-6 if "um" in key else np.radians(1.0)
            moved[LINEAR.labels.index(f"{body}:{letter}")] = unit * value
    number = LAYOUT.mesh_names.index(mesh)
    drive, back = (LINEAR.rows @ moved)[[number, number + len(LAYOUT.mesh_names)]]
    found = MACHINE.displaced_contact(pinion, gear, mesh).table()["deflection_um"]
    assert found.to_numpy() == pytest.approx(1e6 * np.array([drive, back]), rel=1e-9, abs=1e-9)


def test_closing_beyond_the_deflection_falls_four_times_as_displacements_are_halved():
    whole = np.array([1.0, 0.5, 0.25])
    closing = [
        MACHINE.displaced_contact({key: size * value for key, value in PINION.items()}).table()["closing_um"]
        for size in whole
    ]
    assert np.abs(closing[0]).max() > 0.1
    for larger, smaller in ((closing[0], closing[1]), (closing[1], closing[2])):
        assert (larger / smaller).to_numpy() == pytest.approx(4.0, rel=2e-2)


def test_flanks_with_modifications_close_by_what_their_searched_contact_has_more():
    """Crowned flanks, at the place of their contact; both bodies moved together close nothing."""
    crowned = MACHINE.with_values(
        {"tooth_pair.face_gear.modifications.lead_crowning": {"amount_um": 20.0, "length_mm": 12.5}}
    )
    still = crowned.displaced_contact().table()
    assert still["approach_um"].abs().max() == 0.0 and still["pressure_angle_deg"].isna().all()
    together = crowned.displaced_contact({"x_um": 60.0, "y_um": 30.0}, {"x_um": 60.0, "z_um": 30.0}).table()
    assert together["approach_um"].abs().max() < 1e-4
    along = crowned.displaced_contact({"x_um": 30.0}, mesh="tail idler/upper").table()
    plain = MACHINE.displaced_contact({"x_um": 30.0}, mesh="tail idler/upper").table()
    assert along["deflection_um"].to_list() == plain["deflection_um"].to_list()
    assert 0.01 < (along["closing_um"] - plain["closing_um"]).abs().max() < 2.0


def test_turned_bodies_close_by_the_arc_of_their_base_circles():
    ahead = MACHINE.displaced_contact({"theta_deg": 0.01}, {"theta_deg": -0.002}, "tail idler/upper").table()
    arc = 1e6 * np.radians([0.01, 0.002]) @ [DESIGN.pinion_base_radius, DESIGN.gear_base_radius]
    assert ahead["approach_um"].to_numpy() == pytest.approx([arc, -arc], rel=1e-12)
    assert ahead["unloaded_path_mm"].to_numpy() == pytest.approx(1e3 * DESIGN.gear_pitch_radius)


@against(
    "second implementation",
    "contact of the pair assembled with these errors, through the config",
    capability="displaced_contact",
    module="facegear.pipeline.displaced_contact",
)
def test_loaded_contact_is_that_of_the_pair_assembled_so_and_a_mirror_exchanges_flanks():
    coarse = facegear.example().with_values({"contact.positions_per_pitch": 4})
    found = coarse.displaced_contact({"x_um": 120.0}, mesh="tail idler/upper").loaded(600)
    mirror = coarse.displaced_contact({"x_um": -120.0}, mesh="tail idler/upper").loaded([600])
    assembled = coarse.with_values({"tooth_pair.assembly.offset_um": 120.0}).contact(torques=600).by_torque()
    numbers = [name for name in assembled.columns if name in found.columns]
    assert len(numbers) > 10
    drive, back = (found[found["flank"] == flank][numbers].to_numpy(float)[0] for flank in ("drive", "back"))
    other = mirror[mirror["flank"] == "drive"][numbers].to_numpy(float)[0]
    first = assembled[numbers].to_numpy(float)[0]
    agrees("columns of the drive flank", drive, first, relative=1e-9, absolute=1e-12)
    agrees("columns of the back flank, in the mirror", back, other, relative=1e-9, absolute=1e-12)
    stiffness = numbers.index("k_average_mean_n_per_m")
    assert abs(drive[stiffness] / back[stiffness] - 1.0) > 0.01


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ({"pinion": {"x_mm": 1}}, "key of the displacement pinion = 'x_mm': must be one of x_um, y_um"),
        ({"pinion": {"x_um": "1"}}, "pinion.x_um = '1': must be a number from -5000 to 5000"),
        ({"face_gear": {"tilt_x_deg": 3}}, "face_gear.tilt_x_deg = 3: must be a number from -2 to 2"),
        ({"face_gear": {"z_um": float("nan")}}, "face_gear.z_um = nan: must be a number from"),
        ({"mesh": "upper"}, "mesh = 'upper': must be one of tail idler/lower, right idler/lower"),
        ({"position": 2}, "position = 2: must be from 0 to 1"),
    ],
)
def test_what_is_no_displacement_is_refused_in_one_line(given, line):
    with pytest.raises(FacegearError) as refused:
        MACHINE.displaced_contact(**given)
    assert str(refused.value).startswith(line) and "\n" not in str(refused.value)


def test_flanks_that_do_not_face_each_other_are_said_so():
    with pytest.raises(NotConverged, match="no flanks face each other"):
        MACHINE.displaced_contact({"tilt_x_deg": 2.0}, {"tilt_x_deg": -2.0}, "tail idler/upper")
