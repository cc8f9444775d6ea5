"""The chapter on operating poses says in numbers where contacts run and when one leaves the face."""

import numpy as np
import pandas as pd
import pytest

from facegear.build.config import resolved_values
from facegear.build.load import load_config
from facegear.report.case import case_report
from facegear.report.poses import pose_tables, pose_text

MESHES = pd.DataFrame(
    {
        "mesh": ["tail/upper", "input/lower", "idler/upper"],
        "force_n": [-5300.0, 9600.0, 0.0],
        "force_as_assembled_n": [-5490.0, 9800.0, 0.0],
        "path_mm": [272.2, 266.1, np.nan],
        "path_as_assembled_mm": [268.1, 266.0, np.nan],
        "to_inner_end_mm": [21.4, 16.0, 0.1],
        "to_outer_end_mm": [2.6, 8.0, 23.9],
        "stiffness_by_pose_percent": [-18.4, 1.6, np.nan],
        "pressure_by_pose_percent": [8.0, 0.1, np.nan],
    }
)
LEAVING = pd.DataFrame(
    {"mesh": ["tail/upper"], "load_fraction": [1.22], "end": ["outer"], "face_end_mm": [275.0]}
)
LOADS = pd.DataFrame({"load_fraction": [0.5, 1.27]})
CHECK = pd.DataFrame({"quantity": ["stiffness"], "surface": [1.0], "direct": [1.0]})


def tables(**changed):
    given = {"meshes": MESHES, "leaving": LEAVING, "loads": LOADS, "check": CHECK, **changed}
    return {f"poses_{name}": table for name, table in given.items()}


def test_the_contact_that_moves_furthest_its_margin_and_what_it_costs_are_said():
    text = pose_text(tables())
    assert "tail/upper moves furthest, from 268.1 mm as assembled to 272.2 mm" in text
    assert "tail/upper comes nearest to an end of the face: 2.6 mm are left to the outer one" in text
    assert "stiffness changes by -18.4 to +1.6 %" in text and "pressure changes by +0.1 to +8.0 %" in text
    assert "input/lower changes most, from 9,800 N to 9,600 N" in text


def test_the_load_at_which_a_contact_leaves_the_face_is_said_and_that_none_does_where_none_does():
    assert "t 122 % of the torque the contact of tail/upper leaves the face at 275 mm" in pose_text(tables())
    assert "Up to 127 % of the torque no contact leaves the face" in pose_text(tables(leaving=LEAVING[:0]))


def test_names_of_meshes_keep_their_capitals():
    """A sentence's first letter became a capital, and all others small ones."""
    text = pose_text(tables(leaving=LEAVING.assign(mesh="engine A/upper")))
    assert "At 122 % of the torque the contact of engine A/upper leaves" in text


def test_forces_that_torques_alone_decide_are_not_said_to_change():
    """One face gear: the force changed most, from 12,610 N to 12,610 N."""
    still = MESHES.assign(force_as_assembled_n=MESHES["force_n"] * (1.0 + 1e-13))
    text = pose_text(tables(meshes=still))
    assert "No mesh force changes." in text and "changes most" not in text


def test_a_contact_beyond_the_end_is_not_called_near_it():
    beyond = MESHES.assign(to_outer_end_mm=[-0.4, 8.0, 23.9])
    text = pose_text(tables(meshes=beyond))
    assert "tail/upper lies 0.4 mm beyond the outer end of the face" in text


def test_the_edges_that_loaded_patterns_reach_and_those_that_stay_free_are_said():
    distances = {
        "pattern_to_inner_end_mm": [8.2, 3.1, np.nan],
        "pattern_to_outer_end_mm": [0.0, 1.0, np.nan],
        "pattern_to_pinion_tip_mm": [0.0, 0.4, np.nan],
        "pattern_to_gear_tip_mm": [0.2, 0.4, np.nan],
    }
    given = tables(meshes=MESHES.assign(**distances))
    text = pose_text(given)
    assert "3.1 mm of the face stay free at its inner end" in text
    assert "pattern of tail/upper reaches the outer end of the face" in text
    assert "stays 0.2 mm from the tip of the gear" in text and "tip of the pinion" not in text
    whole, edges, *_ = pose_tables(given)
    assert list(edges.frame.columns) == ["mesh", *distances]
    assert not set(distances) & set(whole.frame.columns)
    stress = pd.DataFrame({"mesh": ["tail/upper"], "pressure_mpa": [900.0]})
    assert len(pose_tables({**given, "posed_stress": stress})) == len(pose_tables(given)) + 1


@pytest.mark.parametrize("known", [True, False])
def test_the_report_has_the_chapter_where_poses_were_computed(known):
    values = resolved_values(load_config("config/harmonics_only.yaml"))
    page = case_report(values, tables() if known else {}, {}, [])
    assert ("Teeth where forces put them" in page) is known
    assert (pose_text(tables()) in page) is known
    assert len(pose_tables(tables() if known else {})) == (4 if known else 0)
