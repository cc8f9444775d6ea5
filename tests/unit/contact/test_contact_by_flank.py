"""Contact and root stress of both flanks of both gears where assembly errors part them."""

from dataclasses import asdict
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from contact_bodies import COARSE

import facegear
from facegear.build.plans import contact_plan
from facegear.build.tooth_pair import ToothPair, pair
from facegear.contact import analysis
from facegear.contact.analysis import STIFFNESS_COLUMNS
from facegear.contact.gear_flank import from_arrays, gear_flank, to_arrays
from facegear.pipeline.stages.contact import contents
from facegear.pipeline.stages.strength import root_contents
from facegear.quantities import BODIES
from facegear.schema.base import parse
from facegear.schema.contact import Contact
from facegear.strength.root_tables import root_from_arrays
from facegear.teeth.placement import FLANKS, GEARS, errors_at

CONTACT = {
    "torques_n_m": [600.0],
    "positions_per_pitch": 4,
    "root_stress": True,
    "sector": {"pinion_teeth": 5, "face_gear_teeth": 5},
}
ERRORS = {"offset_um": 50.0, "shaft_angle_error_deg": 0.02, "gear_axial_um": 10.0}


def with_errors(**errors):
    return {**facegear.example().values["tooth_pair"], "assembly": errors}


def contact_of(bodies, tooth_pair, every_flank=True):
    teeth, plan = pair(ToothPair.of_config(tooth_pair)), contact_plan(parse(Contact, CONTACT))
    found = analysis.contact_analysis(teeth.design, teeth.materials, [tuple(bodies)], plan, every_flank)
    return contents(found)


@pytest.fixture(scope="module")
def bodies():
    """Both bodies with gauges, condensed once: no assembly error moves their nodes."""
    teeth, (sizes, _) = pair(ToothPair.of_config(with_errors())), COARSE
    plan = contact_plan(parse(Contact, {**CONTACT, "refinement": {"profile": 3, "depth": 1}}))
    return [
        gear_flank(teeth.design, name, sizes, teeth.material(name), plan) for name in ("pinion", "face_gear")
    ]


@pytest.fixture(scope="module")
def found(bodies):
    return contact_of(bodies, with_errors(**ERRORS))


def test_every_flank_is_that_of_a_pair_assembled_with_its_own_errors(bodies, found):
    design = pair(ToothPair.of_config(with_errors(**ERRORS))).design
    message = found["by_flank"].set_index(["gear", "flank"])
    assert len(message) == 4
    for gear in GEARS:
        for flank in FLANKS:
            met = asdict(errors_at(design.assembly, gear, flank))
            own = with_errors(
                offset_um=1e6 * met["offset"],
                shaft_angle_error_deg=float(np.degrees(met["shaft_angle_error"])),
                gear_axial_um=1e6 * met["gear_axial"],
            )
            alone = contact_of(bodies, own, every_flank=False)["by_torque"]
            for name in ("k_average_mean_n_per_m", "pressure_mpa", "path_radius_mm", "ste_peak_to_peak_um"):
                assert message.loc[(gear, flank), name] == pytest.approx(alone[name][0], rel=1e-6)


def test_an_offset_parts_the_root_stress_of_both_flanks_and_each_is_given(bodies, found):
    """An offset of 50 um counted for both flanks alike, 652 and 704 MPa at 1000 N m."""
    flanks = dict(zip(BODIES, (from_arrays(to_arrays(body)) for body in bodies), strict=True))
    stress = root_contents(4 * [flanks], found["loads"], 4 * [dict.fromkeys(BODIES, 0.0)])
    message = stress["by_flank"].set_index(["gear", "flank", "body", "fillet"])["largest_mpa"]
    drive, back = (message["upper", flank, "face_gear", "loaded"] for flank in FLANKS)
    assert back > 1.03 * drive
    for (gear, flank, body, fillet), largest in message.items():
        root = root_from_arrays(stress["stress"], body, gear, flank)
        side = ("loaded", "other").index(fillet)
        assert 1e-6 * root.stress[:, :, side].max() == pytest.approx(largest, rel=0.05)
    main = stress["summary"].set_index(["body", "fillet"])["largest_mpa"]
    pd.testing.assert_series_equal(message["upper"]["drive"], main)


def test_without_errors_every_flank_costs_nothing_and_is_the_same(bodies, monkeypatch):
    solved = []

    def counted(*arguments):
        solved.append(1)
        return original(*arguments)

    original = analysis.loaded_contact
    monkeypatch.setattr(analysis, "loaded_contact", counted)
    alike = contact_of(bodies, with_errors(gear_axial_um=10.0))
    assert len(solved) == 1
    rows = [one.drop(columns=["gear", "flank"]) for _, one in alike["by_flank"].groupby(["gear", "flank"])]
    for other in rows[1:]:
        np.testing.assert_array_equal(other.to_numpy(), rows[0].to_numpy())


@pytest.mark.parametrize(("kind", "count"), [("config/helical.yaml", 3), ("config/paper.yaml", 0)])
def test_flanks_with_a_stiffness_of_their_own_are_stored_with_their_contact(kind, count):
    """Other flanks of spur teeth keep the stiffness of the upper gear's drive flank."""
    design = pair(ToothPair.of_config(facegear.load(kind).values["tooth_pair"])).design
    zeros = pd.DataFrame(np.zeros((2, len(STIFFNESS_COLUMNS))), columns=list(STIFFNESS_COLUMNS))
    tables = [zeros.assign(k_average_n_per_m=number * 1e8) for number in (1.0, 2.0, 3.0, 4.0)]
    model = SimpleNamespace(design=design)
    found = analysis.ContactAnalysis(4 * [model], [], np.array([[0, 1], [2, 3]]))
    vars(found)["ltca"] = tables
    table = found.other_flanks
    means = table.groupby(["gear", "flank"])["k_average_n_per_m"].mean().to_dict()
    every = {("upper", "back"): 2e8, ("lower", "drive"): 3e8, ("lower", "back"): 4e8}
    assert means == (every if count else {}) and len(table) == 2 * count
    assert [*table.columns] == [*STIFFNESS_COLUMNS, "gear", "flank"]
