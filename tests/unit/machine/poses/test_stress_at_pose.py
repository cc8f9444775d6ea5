"""Stress, rating and contact pattern of a machine whose meshes stand where its own forces put them."""

import numpy as np
import pandas as pd
import pytest
from references import against, agrees
from test_operating_pose import MESHES, POSE_AND_LOAD

import facegear
from facegear.build.machine import MachineInputs
from facegear.build.tooth_pair import pair_design
from facegear.machine.poses.surface import PoseSurface
from facegear.machine.poses.tables import MARGINS, margin_text
from facegear.pipeline.stages.duty import duty_poses
from facegear.pipeline.stages.strength import rating
from facegear.schema.strength import Strength
from facegear.strength.flank_contacts import flank_contacts
from facegear.strength.posed_contacts import ROOTS, ContactPose, solved_contacts, stress_ratio
from facegear.teeth.conjugate import contact_at
from validation.poses.measure import SURFACE

FEW = {
    "transmission.operating_pose": "static",
    "mesh_stiffness.mesh_law": "constant_load",
    "contact.positions_per_pitch": 4,
    "contact.root_stress": True,
    "strength.duty": [
        {"torque_n_m": 663.8, "speed_rpm": 7500, "hours": 100},
        {"torque_n_m": 330.0, "speed_rpm": 7500, "hours": 100},
    ],
}
"""Few positions of the coarse machine; its own load, and half of it."""


@pytest.fixture(scope="module")
def gearbox():
    return facegear.example().with_values(FEW)


@pytest.fixture(scope="module")
def by_mesh(gearbox):
    return gearbox._chain.part("posed_stress", "by_mesh").set_index("mesh")


@pytest.fixture(scope="module")
def surface(gearbox):
    return PoseSurface.of_arrays(gearbox._chain.part("pose_surface", "surface"))


@against(
    "second implementation",
    "contact of every mesh solved anew in every step of the iteration",
    capability="duty_poses",
    module="facegear.machine.poses.fixed_point",
)
def test_in_a_bin_with_the_machine_s_own_load_its_meshes_carry_the_published_forces():
    """Published without the second order of the closing, and along the ideal normal."""
    values = facegear.load("config/concentric.yaml", results=None).values
    numbers = {"order": 0, "sin_n_per_m": 0.0, "cos_n_per_m": 4.1e8, "amplitude_n_per_m": 4.1e8}
    harmonics = pd.DataFrame([{**numbers, "e_sin_um": 0.0, "e_cos_um": 0.0}])
    with np.load(SURFACE) as stored:
        arrays = dict(stored)
    duty = [{"torque_n_m": torque, "speed_rpm": 7500.0, "hours": 1.0} for torque in (663.8, 332.0)]
    outcome = duty_poses(
        arrays,
        MachineInputs.of_config(values, harmonics),
        Strength.of_config({**values["strength"], "duty": duty}),
    )
    table = outcome.content["duty_poses"]
    forces = table.groupby(["bin", "mesh"])["force_n"].max()
    agrees("forces of a bin, N", forces.loc[1][MESHES], POSE_AND_LOAD, relative=4e-3)
    carrying = table[table["force_n"] > 0.0].set_index(["bin", "mesh"])["unloaded_path_mm"]
    rest = 1e3 * contact_at(PoseSurface.of_arrays(arrays).pair, PoseSurface.of_arrays(arrays).nominal).y
    idlers = [name for name in MESHES if "idler" in name]
    halved = (carrying.loc[2][idlers] - rest) / (carrying.loc[1][idlers] - rest)
    assert halved.between(0.4, 0.65).all()


def test_contact_solved_at_the_pose_of_a_mesh_changes_stress_as_the_surface_says(gearbox, by_mesh, surface):
    """Between its nodes, at the torques of the contact analysis: to what it misses of nodes left out."""
    stated = gearbox._chain.part("pose_surface", "errors").groupby("quantity")["largest"].max()
    given = gearbox._chain.arguments("rating")
    assembled = flank_contacts(given["stress"], given["by_flank"])["upper", "drive"]
    solved = solved_contacts(given["posed_contacts"], given["posed_by_torque"])
    rest = ContactPose(contact_at(surface.pair, surface.nominal).y, 0.0)
    for mesh in ("left idler/upper", "tail idler/lower"):
        number = given["posed_by_torque"].set_index("mesh")["contact"][mesh].iloc[0]
        there = ContactPose(1e-3 * by_mesh.loc[mesh, "unloaded_path_mm"], 0.0)
        for body in ("pinion", "face_gear"):
            for torque in (300.0, 600.0, 1000.0):
                direct = solved[number].tension[body](torque) / assembled.tension[body](torque)
                said = stress_ratio(surface, ROOTS[body], rest, there)(np.array([torque]))[0]
                assert direct == pytest.approx(said, rel=stated[ROOTS[body]])
    idlers = by_mesh[by_mesh.index.str.contains("idler")]
    grown = idlers["face_gear_root_mpa"] / idlers["face_gear_root_as_assembled_mpa"] - 1.0
    assert grown.between(0.1, 0.4).all()


def test_a_rating_takes_the_stress_of_each_mesh_where_its_bin_puts_it(gearbox, by_mesh, surface):
    """One idler alone, under its own load and half of it."""
    mesh, chain, values = "left idler/upper", gearbox._chain, gearbox.values
    given = chain.arguments("rating")
    base = pair_design(gearbox.config.tooth_pair).pinion_base_radius
    own = by_mesh.loc[mesh, "torque_n_m"]
    spectrum = pd.DataFrame(
        [
            (number, "upper face gear", "face_gear", "drive", mesh, 1.0, torque / base)
            for number, torque in ((1, own), (2, 0.5 * own))
        ],
        columns=["bin", "body", "gear", "flank", "mesh", "fraction", "force_n"],
    )
    given |= {
        "duty_spectrum": spectrum,
        "tooth_pair": gearbox.config.tooth_pair,
        "strength": Strength.of_config({**values["strength"], "load_factors": "machine"}),
    }
    damage = (
        rating(**given).content["damage"].set_index(["failure", "method", "bin"])["stress_mpa"].sort_index()
    )
    stands = given["duty_poses"].set_index(["bin", "mesh", "flank"])["unloaded_path_mm"]
    ends = [ContactPose(1e-3 * stands[number, mesh, "drive"], 0.0) for number in (1, 2)]
    for failure, method, quantity, column in (
        ("bending", "finite elements", "face_gear_root_pa", "face_gear_root_mpa"),
        ("pitting", "contact analysis", "pressure_pa", "pressure_mpa"),
    ):
        found, torques = damage[failure, method], np.array([own, 0.5 * own])
        assert found[1] == pytest.approx(by_mesh.loc[mesh, column], rel=2e-3)
        moved = stress_ratio(surface, quantity, *ends)(torques)[1]
        assert moved < 0.99
        contact = chain.part("posed_stress", "by_torque")
        assert contact["mesh"].nunique() == len(by_mesh)
        assert found[2] < moved * 1.01 * found[1] and found[2] > 0.4 * found[1]


def test_patterns_that_run_outwards_come_nearer_to_the_outer_end(gearbox):
    """Every distance lies within the face or the tooth, and the limits of cutting lie beyond the ends."""
    table = gearbox.operating_pose().table().set_index("mesh")
    margins = table[list(MARGINS)]
    assert (margins >= 0.0).all(axis=None)
    assert (margins["pattern_to_inner_end_mm"] + margins["pattern_to_outer_end_mm"] < 25.0).all()
    assert (margins["pattern_to_undercut_mm"] > margins["pattern_to_inner_end_mm"]).all()
    assert (margins["pattern_to_pointing_mm"] > margins["pattern_to_outer_end_mm"]).all()
    assert (margins[["pattern_to_pinion_tip_mm", "pattern_to_gear_tip_mm"]] < 8.5).all(axis=None)
    outward = table["unloaded_path_mm"].idxmax(), table["unloaded_path_mm"].idxmin()
    nearer, further = (margins.loc[name, "pattern_to_outer_end_mm"] for name in outward)
    assert nearer <= further
    assert margin_text(gearbox.operating_pose().table())


def test_edges_that_the_same_meshes_reach_are_named_together():
    """Patterns of helical teeth reach every edge, which made four sentences of one."""
    meshes = pd.DataFrame({"mesh": ["first/upper", "second/upper"], **dict.fromkeys(MARGINS, 0.0)})
    meshes["pattern_to_gear_tip_mm"] = [0.0, 1.0]
    ends = "the inner end of the face, the outer end of the face, the pinion's tip in every mesh"
    tip = "the gear's tip in first/upper"
    assert margin_text(meshes) == f"the pattern reaches {ends}; the pattern reaches {tip}"
