"""Scuffing and micropitting stand beside the safety of every flank: the worst of its bins and meshes."""

import numpy as np
import pandas as pd
import pytest

from facegear.strength.rating_tables import with_scuffing

SPECTRUM = pd.DataFrame(
    [
        (1, "engine", "pinion", "drive", "engine/upper"),
        (1, "engine", "pinion", "back", "engine/lower"),
        (1, "upper face gear", "face_gear", "drive", "engine/upper"),
        (1, "upper face gear", "face_gear", "drive", "idler/upper"),
    ],
    columns=["bin", "body", "gear", "flank", "mesh"],
)
SAFETY = pd.DataFrame(
    {
        "body": ["engine", "engine", "upper face gear"],
        "flank": ["drive", "back", "drive"],
        "verdict": ["green", "red", "green"],
        "reason": ["", "teeth break", "tips touch"],
        "within_torques_solved": True,
    }
)


def losses(**columns):
    rows = pd.DataFrame(
        {
            "bin": [0, 1, 2, 1, 1],
            "mesh": ["engine/upper", "engine/upper", "engine/upper", "engine/lower", "idler/upper"],
            "flank": ["drive", "drive", "drive", "back", "drive"],
            "scuffing_safety": [0.2, 1.4, 1.1, 0.8, 0.9],
            "scuffing_margin_k": [-90.0, 40.0, 10.0, -22.0, -9.0],
            "smallest_film_ratio": [0.01, 0.4, 0.3, 0.2, 0.25],
            "micropitting_safety": np.nan,
            "within_torques_solved": [False, True, True, True, False],
        }
    )
    return rows.assign(**columns)


def test_a_flank_has_the_least_safety_of_its_meshes_over_the_duty_cycle():
    found = with_scuffing(SAFETY, SPECTRUM, losses()).set_index(["body", "flank"])
    assert found["scuffing_safety"].tolist() == [1.1, 0.8, 0.9]
    assert found["scuffing_margin_k"].tolist() == [10.0, -22.0, -9.0]
    assert found["smallest_film_ratio"].tolist() == [0.3, 0.2, 0.25]
    assert found["within_torques_solved"].tolist() == [True, True, False]
    assert found["micropitting_safety"].isna().all()


def test_a_contact_too_hot_for_the_oil_is_never_green_and_says_why():
    found = with_scuffing(SAFETY, SPECTRUM, losses())
    assert found["verdict"].tolist() == ["green", "red", "red"]
    assert found["reason"].tolist() == [
        "",
        "teeth break; safety against scuffing 0.80",
        "tips touch; safety against scuffing 0.90",
    ]
    thin = with_scuffing(SAFETY, SPECTRUM, losses(micropitting_safety=0.5))
    assert thin["verdict"].tolist() == ["red", "red", "red"]


def test_only_meshes_of_the_flank_count():
    far = losses().assign(scuffing_safety=[9.0, 9.0, 9.0, 9.0, 0.1])
    found = with_scuffing(SAFETY, SPECTRUM, far)["scuffing_safety"]
    assert found.tolist() == pytest.approx([9.0, 9.0, 0.1])
