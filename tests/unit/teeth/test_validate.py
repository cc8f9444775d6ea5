"""Impossible designs are refused by the key that breaks them; random pairs are valid or refused."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from facegear.errors import GeometryError
from facegear.teeth.clearance import pinion_outline
from facegear.teeth.design import FaceGearGeometry, PairDesign, PinionGeometry, Shaper
from facegear.teeth.flank_shapes import GearModifications, Relief
from facegear.teeth.limits import face_range, radius_limits
from facegear.teeth.mesh_quality import scaled_jacobians
from facegear.teeth.mesh_sizes import named_sizes
from facegear.teeth.pinion import removed_depth
from facegear.teeth.tooth_mesh import gear_tooth, pinion_tooth
from facegear.teeth.unloaded_contact import unloaded_contact
from facegear.teeth.validate import MAX_RELIEF, check

GEAR, MADE = "face_gear__modifications", "face_gear.modifications"


def changed(design, **changes):
    """Replace parts' fields given as part__field."""
    for name, value in changes.items():
        part, field = name.split("__")
        design = replace(design, **{part: replace(getattr(design, part), **{field: value})})
    return design


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"face_gear__inner_radius": 0.245}, "face_gear.inner_radius_mm"),
        ({"face_gear__outer_radius": 0.302}, "face_gear.outer_radius_mm"),
        ({"face_gear__outer_radius": 0.2501}, "face_gear.outer_radius_mm"),
        ({"face_gear__addendum": 4.7e-3}, "face_gear.addendum_modules"),
        ({"face_gear__rim_thickness": 1e-3}, "face_gear.rim_thickness_mm"),
        ({"shaper__teeth": 22}, "shaper.teeth"),
        ({"shaper__teeth": 27}, "shaper.teeth"),
        ({"shaper__addendum": 3e-3}, "shaper.addendum_modules"),
        ({"shaper__addendum": 6.5e-3}, "shaper.addendum_modules"),
        ({"pinion__rack_tip_radius": 2e-3}, "pinion.rack_tip_radius_modules"),
        ({"pinion__profile_shift": -4e-3}, "pinion.profile_shift_modules"),
        ({"pinion__bore_radius": 0.038}, "pinion.bore_radius_mm"),
        ({"pinion__addendum": 6.5e-3, "shaper__addendum": 6.6e-3}, "pinion.addendum_modules"),
        ({"pinion__tip_chamfer": 3e-3}, "pinion.tip_chamfer_mm"),
        ({"pinion__tip_relief": Relief(1e-5, 0.0, 0.0)}, "pinion.tip_relief.length_mm"),
        ({"pinion__root_relief": Relief(1e-5, 0.01, 0.02)}, "pinion.root_relief.length_mm"),
        ({"pinion__lead_crowning": Relief(20e-6, 0.0, 1e-3)}, "pinion.lead_crowning.length_mm"),
        ({GEAR: GearModifications(tip_relief=Relief(1e-3, 0.0, 1e-3))}, f"{MADE}.tip_relief.amount_um"),
        ({GEAR: GearModifications(root_relief=Relief(1e-5, 0.0, 0.0))}, f"{MADE}.root_relief.length_mm"),
        ({GEAR: GearModifications(end_relief=Relief(1e-5, 8e-3, 8e-3))}, f"{MADE}.end_relief.length_mm"),
        ({GEAR: GearModifications(lead_crowning=Relief(1e-5, 0.0, 1e-3))}, f"{MADE}.lead_crowning.length_mm"),
        ({GEAR: GearModifications(bias=-1e-3)}, f"{MADE}.bias_um"),
    ],
)
def test_impossible_designs_name_the_key(pair, change, key):
    with pytest.raises(GeometryError) as refused:
        check(changed(pair(26), **change))
    assert refused.value.quantity == key
    assert "\n" not in str(refused.value)


@settings(max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(amount=st.floats(1e-6, 180e-6), start=st.floats(0.0, 0.0124), length=st.floats(1e-4, 0.02))
def test_an_accepted_crowning_takes_no_more_off_the_ends_of_the_face_than_the_largest_relief(
    pair, amount, start, length
):
    """A length of 1 mm took 3125 um off; what a refusal names is accepted."""
    design = changed(pair(26), pinion__lead_crowning=Relief(amount, start, length))
    end = design.mean_radius + design.pinion.width / 2
    try:
        check(design)
    except GeometryError as error:
        assert error.quantity == "pinion.lead_crowning.length_mm"
        least = float(str(error.requirement).split("at least ")[1].split(":")[0])
        assert least > 1e3 * length
        design = changed(design, pinion__lead_crowning=Relief(amount, start, 1.001e-3 * least))
        check(design)
    taken = removed_depth(design, design.pinion_tip_roll, end)
    assert taken <= MAX_RELIEF * design.module * (1 + 1e-9)


@pytest.mark.parametrize(
    ("middle", "taper", "line"),
    [
        (
            -0.26,
            0.0,
            "pinion.middle_mm = -260.0: must be more than 15.000: the pinion reaches the gear's axis",
        ),
        (0.264, -15.0, "undercut at the outer end; a taper_angle_deg nearer to 0 helps"),
    ],
)
def test_a_pinion_out_of_place_or_with_too_much_taper_names_what_helps(pair, middle, taper, line):
    """The pinion's width was asked to be less than -520 mm, and a smaller taper, which was the mistake."""
    design = replace(changed(pair(26), pinion__middle=middle), taper_angle=radians(taper))
    with pytest.raises(GeometryError) as refused:
        check(design)
    assert line in str(refused.value)


def test_a_gear_outside_its_limits_is_reported_both(pair):
    with pytest.raises(GeometryError, match=r"between 245\.800 \(undercut\) and 293\.208 \("):
        check(changed(pair(26), face_gear__inner_radius=0.24))


@pytest.mark.parametrize("rounding", [0.0, 0.03, 0.1])
@pytest.mark.parametrize("shaper_addendum", [1.05, 1.15, 1.25])
def test_the_range_of_a_refusal_is_the_range_that_is_accepted(pair, shaper_addendum, rounding):
    """Two ranges that contradict each other were told: well below one radius, and up to a larger one."""
    design = changed(pair(26, tip_rounding=rounding), shaper__addendum=shaper_addendum * 3.75e-3)
    message = face_range(design, radius_limits(design))
    step = 1e-6
    fits = changed(
        design, face_gear__inner_radius=message.inner + step, face_gear__outer_radius=message.outer - step
    )
    assert check(changed(fits, pinion__width=message.outer - message.inner))
    for change in (
        {"face_gear__outer_radius": message.outer + step},
        {"face_gear__inner_radius": message.inner - step},
    ):
        with pytest.raises(GeometryError, match=r"between .* and ") as refused:
            check(changed(fits, **change))
        assert str(message) in str(refused.value)


@st.composite
def designs(draw):
    def number(low, high):
        return draw(st.floats(low, high, allow_nan=False))

    m = 1e-3 * number(0.5, 10)
    n1, n2 = draw(st.integers(17, 40)), draw(st.integers(70, 200))
    angle = radians(number(18, 30))
    inner = m * n2 * np.cos(angle) / 2 * (1 + number(0.005, 0.1))
    width = m * number(0.6, 10)
    dedendum, shift = number(1.15, 1.4), draw(st.sampled_from([0.0, 0.2, 0.4, -0.1]))
    pinion = PinionGeometry(
        teeth=n1,
        width=width * number(0.8, 1.3),
        addendum=m * number(0.8, 1.05),
        dedendum=m * dedendum,
        rack_tip_radius=m * number(0.0, 0.2),
        bore_radius=m * (n1 / 2 - dedendum + shift) * number(0.2, 0.95),
        profile_shift=m * shift,
        thinning=m * number(0, 0.03),
    )
    gear = FaceGearGeometry(n2, inner, inner + width, m * number(0.8, 1.05), m * number(0.4, 4))
    rounding = m * draw(st.sampled_from([0.0, 0.05, 0.1, 0.15]))
    shaper = Shaper(n1 + draw(st.integers(0, 3)), m * number(1.05, 1.3), rounding)
    return PairDesign(m, angle, pinion, gear, shaper)


@settings(max_examples=100, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
@given(designs())
def test_random_pairs_are_valid_or_refused(design):
    try:
        limits = check(design)
    except GeometryError as refused:
        assert refused.quantity.split(".")[0] in ("pinion", "face_gear", "shaper")
        return
    assert limits.inner <= design.face_gear.inner_radius < design.face_gear.outer_radius <= limits.outer
    outline = pinion_outline(design, 200)
    angle = np.arctan2(outline.points[:, 0], outline.points[:, 1])
    assert np.all(np.diff(np.hypot(*outline.points.T)) < 1e-12)
    assert np.all((angle >= 0) & (angle <= np.pi / design.pinion.teeth + 1e-12))
    for build in (pinion_tooth, gear_tooth):
        mesh = build(design, named_sizes("coarse", design.module))
        assert scaled_jacobians(mesh.nodes, mesh.hexes).min() > 0
    contact = unloaded_contact(design, [0.0])
    assert np.isfinite(contact.transmission_error).all()
