"""Designs that differ in their unloaded gaps alone share bodies and compliance."""

from dataclasses import fields, replace

import numpy as np
import pytest
from contact_bodies import STEEL, pair_design

import facegear
from facegear.contact.gear_flank import BUILDERS
from facegear.contact.teeth import elastic_tooth
from facegear.pipeline.needs import shared_sources, stage_needs
from facegear.pipeline.outcome import Outcome
from facegear.pipeline.results.store import Store
from facegear.pipeline.stages import contact as contact_stage
from facegear.pipeline.stages import tooth_bodies as compliance_stage
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.flank_shapes import Relief
from facegear.teeth.mesh_sizes import MeshSizes

RELIEF = {"amount_um": 10, "start_mm": 0, "length_mm": 1}
GAPS = {
    "tooth_pair.assembly": {"offset_um": 20, "shaft_angle_error_deg": 0.01, "gear_axial_um": 30},
    "tooth_pair.pinion.tip_relief": RELIEF,
    "tooth_pair.pinion.root_relief": RELIEF,
    "tooth_pair.pinion.lead_crowning": {**RELIEF, "length_mm": 20},
    "tooth_pair.face_gear.flanks": {
        "grids": [
            {
                "flank": "left",
                "face_mm": [250, 275],
                "profile_mm": [0, 5],
                "deviation_um": [[0, 1], [2, 3]],
            }
        ]
    },
}


@pytest.mark.parametrize("body", ["pinion", "face_gear"])
def test_assembly_errors_and_modifications_move_no_node_of_the_bodies(body):
    nominal = pair_design()
    relief = Relief(1e-5, 0.0, 1e-3)
    teeth = replace(nominal.pinion, tip_relief=relief, root_relief=relief, lead_crowning=relief)
    changed = replace(nominal, pinion=teeth, assembly=AssemblyErrors(2e-5, 2e-4, 3e-5))
    meshes = [BUILDERS[body](design, MeshSizes(1.5e-3, 3.2e-3, 3e-3)) for design in (nominal, changed)]
    np.testing.assert_array_equal(meshes[0].nodes, meshes[1].nodes)
    designs = zip((nominal, changed), meshes, strict=True)
    sides = [elastic_tooth(design, mesh, STEEL)[1] for design, mesh in designs]
    for field in fields(sides[0]):
        np.testing.assert_array_equal(getattr(sides[0], field.name), getattr(sides[1], field.name))


def test_cases_that_differ_in_gaps_alone_share_one_compliance_but_no_contact():
    nominal = facegear.example()
    cases = {"nominal": nominal.values, "gaps": nominal.with_values({**GAPS, **wide()}).values}
    cases["thick"] = nominal.with_values({"tooth_pair.pinion.width_mm": 18}).values
    assert shared_sources(cases, "compliance") == {"nominal": "nominal", "gaps": "nominal", "thick": "thick"}
    assert shared_sources(cases, "contact") == {name: name for name in cases}


def test_what_is_left_out_for_the_compliance_stays_in_the_needs_of_the_contact():
    changed = facegear.example().with_values({**GAPS, **wide()})
    needs = {rule: stage_needs(rule, changed.values)["tooth_pair"] for rule in ("compliance", "contact")}
    assert "assembly" not in needs["compliance"] and "tip_relief" not in needs["compliance"]["pinion"]
    assert needs["contact"]["assembly"]["offset_um"] == 20


def test_another_torque_or_position_factorises_no_body_again(monkeypatch):
    """Both bodies were factorised again for every list of torques."""
    made = []
    monkeypatch.setattr(
        compliance_stage, "compliance", lambda body, **_: made.append(body) or Outcome({"arrays": {}}, "")
    )
    monkeypatch.setattr(contact_stage, "contact", lambda *_, **given: Outcome(given["contact"], ""))
    machine = replace(facegear.example(), store=Store()).with_values({"strength": None})
    first = machine.contact(torques=[1000], positions=4)
    assert sorted(made) == ["face_gear", "pinion"]
    assert machine.contact(torques=[700, 900], positions=5).content != first.content
    machine.with_values({"contact.edge_contact": False}).contact()
    assert len(made) == 2
    machine.with_values({"contact.refinement.depth": 2}).contact()
    assert len(made) == 4


def wide():
    """Teeth of the example are thin enough already for these errors; only the machine's backlash is given."""
    return {"transmission.backlash_um": 100}
