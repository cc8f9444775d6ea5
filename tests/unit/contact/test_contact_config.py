from dataclasses import replace
from math import radians

import pytest
from hypothesis import given
from hypothesis import strategies as st

from facegear.config.base import parse
from facegear.config.contact import Contact, contact_plan
from facegear.contact.options import ContactOptions, ContactPlan, Refinement, Sector
from facegear.contact.pair import gear_flank
from facegear.contact.resolution import check_fillet, check_resolution, half_width
from facegear.errors import ConfigError, ConfigErrors
from facegear.geometry.design import FaceGear, Material, PairDesign, Pinion, Shaper
from facegear.mesh.sizes import MeshSizes, named_sizes, thin_fillet

STEEL = Material(206e9, 0.3)
M = 3.75e-3
DESIGN = PairDesign(
    M,
    radians(25),
    Pinion(23, 0.030, M, 1.25 * M, 0.1 * M, 0.025),
    FaceGear(143, 0.250, 0.275, M, 0.012),
    Shaper(26, 1.25 * M),
)


def plan(torque=600.0, cuts=Refinement(4, 1, 2), sector=Sector()):  # noqa: B008
    return ContactPlan((torque,), 8, cuts, sector, ContactOptions())


def test_defaults_are_full_rings_with_everything_in_contact():
    made = contact_plan(parse(Contact, {}))
    assert made.sector == Sector()
    assert made.options == ContactOptions(fillet=True, coupled=True, edges=True)


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
    with pytest.raises(ConfigError, match="must be at most"):
        check_resolution(DESIGN, (STEEL, STEEL), MeshSizes(6e-3, 6e-3, 6e-3), plan(cuts=Refinement()))


def accepted(*torques):
    try:
        sizes = MeshSizes(1.5e-3, 6e-3, 4e-3)
        check_resolution(DESIGN, (STEEL, STEEL), sizes, replace(plan(), torques=torques))
    except ConfigError:
        return False
    return True


@given(torques=st.lists(st.floats(20.0, 2000.0), min_size=1, max_size=5, unique=True))
def test_a_torque_is_resolved_or_refused_whatever_others_stand_beside_it(torques):
    """A torque was refused alone and passed beside a larger one."""
    assert accepted(*sorted(torques)) == all(accepted(torque) for torque in torques)


def test_a_torque_that_is_too_small_for_the_mesh_is_named_with_the_smallest_that_is_not():
    with pytest.raises(ConfigError, match=r"at 40 N m.* or contact\.torques_n_m at least ") as refused:
        sizes = MeshSizes(1.5e-3, 6e-3, 4e-3)
        check_resolution(DESIGN, (STEEL, STEEL), sizes, replace(plan(), torques=(40.0, 1000.0)))
    enough = float(refused.value.allowed.split("at least ")[1])
    assert not accepted(0.99 * enough) and accepted(1.01 * enough)


def test_mesh_too_coarse_for_the_sharpest_fillet_is_refused_where_its_stress_is_asked_for():
    sizes = named_sizes("coarse", M)
    check_fillet(DESIGN, sizes, plan())
    check_fillet(DESIGN, thin_fillet(sizes, "coarse"), replace(plan(), root_stress=True))
    with pytest.raises(ConfigError, match=r"0.75 mm below the fillets.*at most 0.442 mm"):
        check_fillet(DESIGN, sizes, replace(plan(), root_stress=True))


def test_sector_larger_than_the_gear_is_refused():
    with pytest.raises(ConfigError, match="at most 23"):
        gear_flank(
            DESIGN, "pinion", MeshSizes(1.5e-3, 6e-3, 3e-3), STEEL, plan(sector=Sector(pinion_teeth=25))
        )
