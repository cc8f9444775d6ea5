from dataclasses import replace
from math import radians

import pytest
from hypothesis import given
from hypothesis import strategies as st

import facegear
from facegear.build.plans import contact_plan
from facegear.contact.gear_flank import gear_flank
from facegear.contact.options import ContactOptions, ContactPlan, Refinement, Sector
from facegear.contact.resolution import (
    PLANES,
    along_the_ellipse,
    check_fillet,
    check_resolution,
    ellipse_half_length,
    half_width,
)
from facegear.errors import ConfigErrors, InvalidInput
from facegear.pipeline.needs import stage_needs
from facegear.schema.base import parse
from facegear.schema.contact import Contact
from facegear.teeth.design import FaceGearGeometry, Material, PairDesign, PinionGeometry, Shaper
from facegear.teeth.flank_shapes import Relief
from facegear.teeth.mesh_sizes import MeshSizes, named_sizes, thin_fillet

STEEL = Material(206e9, 0.3)
M = 3.75e-3
DESIGN = PairDesign(
    M,
    radians(25),
    PinionGeometry(23, 0.030, M, 1.25 * M, 0.1 * M, 0.025),
    FaceGearGeometry(143, 0.250, 0.275, M, 0.012),
    Shaper(26, 1.25 * M),
)


def plan(torque=600.0, cuts=Refinement(4, 1, 2), sector=Sector()):  # noqa: B008
    return ContactPlan((torque,), 8, cuts, sector, ContactOptions())


def test_defaults_are_full_rings_with_everything_in_contact():
    made = contact_plan(parse(Contact, {}))
    assert made.sector == Sector()
    assert made.options == ContactOptions(fillet=True, is_coupled=True, edges=True)


@pytest.mark.parametrize(
    "values",
    [{"torques_n_m": [600, 100]}, {"torques_n_m": []}, {"torques_n_m": [-1]}, {"positions_per_pitch": 2}],
)
def test_impossible_loads_and_positions_are_refused(values):
    with pytest.raises(ConfigErrors):
        parse(Contact, values)


def test_strip_widens_with_the_root_of_the_load():
    narrow, wide = (half_width(DESIGN, (STEEL, STEEL), torque) for torque in (100.0, 400.0))
    assert wide == pytest.approx(2 * narrow)
    assert 1e-4 < narrow < 2e-4


def test_mesh_that_cannot_see_the_strip_is_refused_with_the_size_that_can():
    check_resolution(DESIGN, (STEEL, STEEL), named_sizes("coarse", M), plan())
    with pytest.raises(InvalidInput, match="must be at most"):
        check_resolution(DESIGN, (STEEL, STEEL), MeshSizes(6e-3, 6e-3, 6e-3), plan(cuts=Refinement()))


def accepted(*torques):
    try:
        sizes = MeshSizes(1.5e-3, 6e-3, 4e-3)
        check_resolution(DESIGN, (STEEL, STEEL), sizes, replace(plan(), torques=torques))
    except InvalidInput:
        return False
    return True


@given(torques=st.lists(st.floats(20.0, 2000.0), min_size=1, max_size=5, unique=True))
def test_a_torque_is_resolved_or_refused_whatever_others_stand_beside_it(torques):
    """A torque was refused alone and passed beside a larger one."""
    assert accepted(*sorted(torques)) == all(accepted(torque) for torque in torques)


def test_a_torque_that_is_too_small_for_the_mesh_is_named_with_the_smallest_that_is_not():
    with pytest.raises(
        InvalidInput, match=r"or torques of the contact analysis at least .* at 40 N m"
    ) as refused:
        sizes = MeshSizes(1.5e-3, 6e-3, 4e-3)
        check_resolution(DESIGN, (STEEL, STEEL), sizes, replace(plan(), torques=(40.0, 1000.0)))
    enough = float(refused.value.requirement.split("at least ")[1].split(":")[0])
    assert not accepted(0.99 * enough) and accepted(1.01 * enough)


def test_mesh_too_coarse_for_the_sharpest_fillet_is_refused_where_its_stress_is_asked_for():
    sizes = named_sizes("coarse", M)
    check_fillet(DESIGN, sizes, plan())
    check_fillet(DESIGN, thin_fillet(sizes, "coarse"), replace(plan(), root_stress=True))
    with pytest.raises(InvalidInput, match=r"0\.75 mm below the fillets': must be at most 0\.442 mm"):
        check_fillet(DESIGN, sizes, replace(plan(), root_stress=True))


def test_sector_larger_than_the_gear_is_refused():
    with pytest.raises(InvalidInput, match="at most 23"):
        gear_flank(
            DESIGN, "pinion", MeshSizes(1.5e-3, 6e-3, 3e-3), STEEL, plan(sector=Sector(pinion_teeth=25))
        )


@given(amount=st.floats(0.0, 180.0), length=st.floats(12.0, 20.0), torque=st.floats(100.0, 2000.0))
def test_cuts_along_the_face_follow_the_contact_ellipse_of_a_crowned_pinion(amount, length, torque):
    """However heavy the crowning and light the load, its half-length holds four planes of nodes."""
    crowned = replace(DESIGN.pinion, lead_crowning=Relief(1e-6 * amount, 0.0, 1e-3 * length))
    design, sizes = replace(DESIGN, pinion=crowned), named_sizes("coarse", M)
    made = along_the_ellipse(design, (STEEL, STEEL), sizes, plan(torque))
    apart = sizes.width / 2 / made.refinement.width
    half = ellipse_half_length(design, (STEEL, STEEL), torque)
    assert apart <= half / PLANES * (1 + 1e-6)
    assert made.refinement.width == 1 or 2 * apart > half / PLANES * (1 - 1e-6)


def test_an_ellipse_too_short_for_any_cuts_is_refused_with_the_mesh_that_holds_it():
    crowned = replace(DESIGN.pinion, lead_crowning=Relief(180e-6, 0.0, 15e-3))
    design, sizes = replace(DESIGN, pinion=crowned), MeshSizes(0.75e-3, 6e-3, 3e-3)
    with pytest.raises(InvalidInput, match=r"mm along the face.* must be at most .* mm: at 0\.01 N m"):
        along_the_ellipse(design, (STEEL, STEEL), sizes, plan(0.01))


def test_a_crowned_pair_is_cut_along_its_face_and_a_plain_one_keeps_its_compliance():
    machine = facegear.example().with_values({"mesh.resolution": "coarse"})
    crowning = {"amount_um": 150, "start_mm": 0, "length_mm": 15}
    crowned = machine.with_values({"tooth_pair.pinion.lead_crowning": crowning})
    widths = [
        stage_needs("compliance", one.values)["contact"]["refinement"]["width"] for one in (machine, crowned)
    ]
    assert widths[0] == 1 < widths[1]
