"""Causes that act on the teeth: each sample is the machine that a config with its values describes."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from contact_bodies import STEEL, pair_design

import facegear
from facegear.contact.gear_flank import from_arrays, gear_flank, to_arrays
from facegear.contact.options import ContactOptions, ContactPlan, Refinement, Sector
from facegear.errors import ConfigErrors
from facegear.pipeline.arguments import sampled_contact
from facegear.pipeline.needs import stage_needs
from facegear.pipeline.stage import Case
from facegear.pipeline.stages.studies import chunk_of
from facegear.studies import tooth_contact as in_contact
from facegear.studies.machines import stored_flanks
from facegear.studies.sampled_machine import SampledMachine
from facegear.teeth.mesh_sizes import MeshSizes

pytestmark = pytest.mark.xdist_group("notebooks")  # the example's compliance is computed once a process
CROWNING = "tooth_pair.pinion.lead_crowning.amount_um"
OFFSET = "tooth_pair.assembly.offset_um"
YOUNG = "tooth_pair.material.young_modulus_gpa"
CONSTANT = {"mesh_stiffness.mesh_law": "constant_load"}


def cause(name, key, *values):
    return {"name": name, "shape": "choice", "values": values, "moves": {key: 1.0}, "source": "drawing"}


def machine(*causes, length_mm=10.0, **section):
    """The example, crowned over its whole face by nothing to start from."""
    given = {"causes": causes, "samples": 4, "chunk_samples": 4, "hunting_cycles": 1, **section}
    length = {"tooth_pair.pinion.lead_crowning.length_mm": length_mm}
    return facegear.example().with_values({**CONSTANT, **length, "tolerances": given})


LONG = 30.0
"""Length of a crowning, mm, whose contact ellipse needs no finer cuts than the pair without it."""
BOTH = (cause("crowning", CROWNING, 0.0, 12.0), cause("offset", OFFSET, -15.0, 15.0))


@pytest.fixture(scope="module")
def found():
    return machine(*BOTH, length_mm=LONG).tolerances().samples()


def test_a_sample_is_the_machine_of_a_config_with_its_values(found):
    row = found[(found["crowning"] == 12.0) & (found["offset"] == 15.0)].iloc[0]
    still = cause("still", "dynamics.speed_rpm", 0.0)
    changes = {CROWNING: 12.0, OFFSET: 15.0, "transmission.backlash_um": None}
    alone = machine(still, length_mm=LONG, tooth_contact=True).with_values(changes)
    expected = alone.tolerances(1).samples().iloc[0]
    names = [name for name in expected.index if name not in ("sample", "still", "error")]
    assert {"pressure_mpa", "root_stress_pinion_mpa", "te_peak_to_peak_um", "bearing_mass"} <= set(names)
    # the nominal backlash is rounded to 1e-6 um where a config leaves it to the teeth
    np.testing.assert_allclose(row[names].astype(float), expected[names].astype(float), rtol=1e-7)
    table = alone.contact().by_torque()
    minimum, maximum = table["ste_peak_to_peak_um"].min(), table["ste_peak_to_peak_um"].max()
    assert minimum < row["te_peak_to_peak_um"] < maximum


def test_no_compliance_is_computed_for_a_sample_and_pairs_that_are_alike_are_solved_once(monkeypatch):
    """The nominal pair first, once: it says where the contact of the others is sought."""
    gearbox = machine(*BOTH, cause("young", YOUNG, -6.0), cause("speed", "dynamics.speed_rpm", 0.0, 100.0))
    solved = []
    monkeypatch.setattr(in_contact, "gear_flanks", lambda *_: pytest.fail("compliance"))
    analysis = in_contact.contact_analysis
    monkeypatch.setattr(
        in_contact,
        "contact_analysis",
        lambda *given, **more: solved.append(given[1]) or analysis(*given, **more),
    )
    table = gearbox.tolerances().samples()
    assert (table["error"] == "").all()
    pairs = table[["crowning", "offset"]].drop_duplicates()
    nominal, *varied = ({material.young_modulus for material in pair} for pair in solved)
    assert nominal == {206e9}
    assert varied == [{200e9}] * len(pairs)


def test_displacements_go_with_young_s_modulus_and_stress_in_the_fillets_does_not():
    plan = ContactPlan(
        *((100.0,), 4, Refinement(), Sector(5, 5), ContactOptions()), element="hex27", root_stress=True
    )
    sizes = MeshSizes(2e-3, 9e-3, 4e-3)
    steel, soft = (
        gear_flank(pair_design(), "pinion", sizes, replace(STEEL, young_modulus=young), plan)
        for young in (STEEL.young_modulus, STEEL.young_modulus / 3.0)
    )
    scaled, expectation = to_arrays(steel.softer(3.0)), to_arrays(soft)
    for name in ("own_m_per_n", "others_m_per_n", "readings_pa_per_n"):
        expected, got = expectation[name], scaled[name]
        np.testing.assert_allclose(got, expected, rtol=1e-6, atol=1e-9 * np.abs(expected).max())


def test_what_the_assembly_adds_to_the_backlash_counts_for_every_mesh():
    own = {"transmission.single_meshes": {"tail idler/upper": {"backlash_um": 90.0}}}
    gearbox = machine(cause("shim", "tooth_pair.assembly.gear_axial_um", 20.0)).with_values(own)
    needs = stage_needs("tolerances_chunk", gearbox.values)
    flanks = stored_flanks(gearbox._chain.arguments("tolerances_chunk")["flanks"])
    mesh = in_contact.meshes_in_contact(needs["pair"], flanks, ["upper", "lower"])
    shifted = {**needs["pair"]["tooth_pair"]}
    shifted["assembly"] = {**shifted["assembly"], "gear_axial_um": 20.0}
    machine_section = mesh(shifted).in_machine(needs["transmission"])
    added = machine_section["backlash_um"] - 100.0
    # both flanks open by the normal part of the shift; how far depends a little on where they are nearest
    assert added == pytest.approx(2.0 * 20.0 * np.sin(np.radians(25.0)), rel=0.02)
    assert machine_section["single_meshes"]["tail idler/upper"]["backlash_um"] == pytest.approx(90.0 + added)


def test_teeth_that_cannot_be_built_are_rows_with_their_error():
    found = machine(cause("crowning", CROWNING, -5.0, 5.0)).tolerances().samples()
    failed = found["error"] != ""
    assert failed.any() and not failed.all()
    assert (found.loc[failed, "crowning"] == -5.0).all()
    assert found.loc[failed, "error"].str.contains("lead_crowning.amount_um").all()


def test_contact_is_asked_for_only_where_something_of_it_is_wanted():
    speed = cause("speed", "dynamics.speed_rpm", 0.0)
    assert not sampled_contact(Case(machine(speed).values))
    assert sampled_contact(Case(machine(speed, tooth_contact=True).values))
    assert sampled_contact(Case(machine(BOTH[0]).values))
    assert stage_needs("tolerances_chunk", machine(speed).values)["pair"] is None


@pytest.mark.parametrize(
    ("key", "line"),
    [
        ("tooth_pair.module_mm", "a number of transmission"),
        ("tooth_pair.material.poisson_ratio", "a number of transmission"),
        ("tooth_pair.pinion.tip_relief.amount_nm", "nominal value is a number"),
        ("tooth_pair.pinion.material.young_modulus_gpa", "nominal value is a number"),
    ],
)
def test_a_key_of_the_teeth_that_would_need_other_bodies_is_refused(key, line):
    with pytest.raises(ConfigErrors, match=line) as caught:
        machine(cause("teeth", key, 1.0))
    assert len(str(caught.value).splitlines()) == 1


def test_given_harmonics_have_no_contact_to_vary():
    start = facegear.load("config/harmonics_only.yaml", results=None)
    section = {"causes": [cause("speed", "dynamics.speed_rpm", 0.0)], "tooth_contact": True}
    with pytest.raises(ConfigErrors, match=r"mesh_stiffness\.source = .harmonics."):
        start.with_values({"tolerances": section})


def test_samples_with_contacts_of_their_own_do_not_depend_on_their_chunk(found):
    sampled = SampledMachine.of_stage(**machine(*BOTH)._chain.arguments("tolerances_chunk"))
    last = chunk_of(sampled, "samples", 3, 3).content["chunk"]
    pd.testing.assert_frame_equal(last, found.iloc[3:].reset_index(drop=True), check_exact=True)


def searched(**section):
    """The example with a search over crowning and bearings."""
    given = {
        "variables": [
            {"name": "crowning", "limits": [0.0, 12.0], "sets": [CROWNING], "steps": 3},
            {
                "name": "bearings",
                "limits": [4e7, 2e8],
                "scale": "log",
                "sets": ["transmission.pinion.bearing_stiffness_n_per_m.x"],
            },
        ],
        "objectives": [
            {"name": "te", "largest_of": ["te_peak_to_peak"]},
            {"name": "pressure", "largest_of": ["pressure"]},
            {"name": "bearing", "largest_of": ["bearing_mass"]},
        ],
        "population": 4,
        "generations": 2,
        "hunting_cycles": 1,
        "seeds": [1],
        **section,
    }
    length = {"tooth_pair.pinion.lead_crowning.length_mm": 10.0}
    return facegear.example().with_values({**CONSTANT, **length, "search": given})


def test_a_search_over_teeth_weighs_error_against_pressure(monkeypatch):
    monkeypatch.setattr(in_contact, "gear_flanks", lambda *_: pytest.fail("compliance"))
    found = searched().search()
    designs = found.designs()
    assert (designs["error"] != "").sum() == 0 and designs["crowning"].nunique() > 1
    uncrowned = designs.loc[designs["crowning"].idxmin()]
    crowned = designs.loc[designs["crowning"].idxmax()]
    assert crowned["pressure"] > uncrowned["pressure"], "crowning takes the ends off the line of contact"
    assert {"te_searched", "root_stress_pinion_mpa"} <= set(found.winners().columns)


@pytest.mark.parametrize("key", ["pinion_teeth", "pinion.width_mm"])
def test_a_variable_that_changes_a_body_has_it_condensed_anew_and_once(monkeypatch, key):
    limits = [23, 24] if key == "pinion_teeth" else [30, 31]
    variable = {"name": "body", "limits": limits, "steps": 2, "sets": [f"tooth_pair.{key}"]}
    asked = []
    given = facegear.example()._chain.arguments("contact")
    nominal = {body: from_arrays(given[body]) for body in ("pinion", "face_gear")}

    def made(design, body, *_):
        asked.append((body, design.pinion.teeth, design.pinion.width))
        return [nominal[body]]

    monkeypatch.setattr(in_contact, "gear_flanks", made)
    sizes = {"variables": [variable], "population": 4, "generations": 1}
    objectives = [{"name": "pressure", "largest_of": ["pressure"]}]
    designs = searched(objectives=objectives, **sizes).search().designs()
    assert designs["body"].nunique() == 2 and (designs["error"] == "").all()
    assert max(map(asked.count, asked)) <= 2, "once for the island, once for the winners"
    assert all(isinstance(teeth, int) for _, teeth, _ in asked)
