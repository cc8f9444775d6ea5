"""Helical pinions by the standard for cylindrical gears, and kinds of teeth that it does not know."""

from dataclasses import replace
from math import acos, asin, atan, cos, degrees, pi, radians, sin, sqrt, tan

import numpy as np
import pandas as pd
import pytest
from contact_bodies import STEEL, pair_design
from family_pairs import public_pair
from references import against, agrees
from root_stresses import root
from scipy.optimize import brentq
from test_rating import CARD, PRESSURE, ROOTS, request

from facegear.strength.cylindrical import (
    hertz_stress,
    overlap_ratio,
    pinion_form,
    pinion_notch,
    standard_bending,
    unknown_to_standard,
    virtual_pinion,
)
from facegear.strength.flank_contacts import normal_arms
from facegear.strength.materials import DutyBin, machine_duty
from facegear.strength.rating import rate
from facegear.strength.rating_tables import damage_table, rating_table, safety_table
from facegear.strength.root_form import contact_ratio_factor, helix_angle_factors
from facegear.strength.safety import permissible_bending
from facegear.teeth.analysis import nominal_path, section_contact_ratio, transverse_contact_ratio
from facegear.teeth.design import involute

LOAD = DutyBin(500.0, 20.0, 3.6e6)


def rack_pair(name="P1", gear_teeth=20_000, **changes):
    """Return a public pinion on a face gear as large as a rack, made by a shaper like the pinion."""
    design = public_pair(name)
    radius = 0.5 * gear_teeth * design.transverse_module
    gear = replace(
        design.face_gear, teeth=gear_teeth, inner_radius=radius - 0.0115, outer_radius=radius + 0.0115
    )
    pinion = replace(design.pinion, middle=radius)
    shaper = replace(design.shaper, teeth=pinion.teeth, tip_rounding=0.0)
    return replace(design, pinion=pinion, face_gear=gear, shaper=shaper, **changes)


def iso_by_hand(z, m, alpha, beta, b, torque):
    """Return factors and stresses of ISO 6336-2 and ISO 6336-3 (2006) in the standard's symbols, mm and N.

    Addendum 1, dedendum 1.25, rack tip radius 0.1, no shift; the wheel is a rack of addendum 1.
    """
    rho, h_f, x = 0.1, 1.25, 0.0
    beta_b = asin(sin(beta) * cos(alpha))
    alpha_t = atan(tan(alpha) / cos(beta))
    d = z * m / cos(beta)
    d_b, d_a = d * cos(alpha_t), d + 2 * m
    path = 0.5 * sqrt(d_a**2 - d_b**2) - 0.5 * d_b * tan(alpha_t) + m / sin(alpha_t)
    eps_alpha, eps_beta = path / (pi * m / cos(beta) * cos(alpha_t)), b * sin(beta) / (pi * m)
    z_n, eps_an = z / (cos(beta_b) ** 2 * cos(beta)), eps_alpha / cos(beta_b) ** 2
    e = pi / 4 * m - h_f * m * tan(alpha) - (1 - sin(alpha)) * rho * m / cos(alpha)
    g = rho - h_f + x
    h = 2 / z_n * (pi / 2 - e / m) - pi / 3
    theta = brentq(lambda t: 2 * g / z_n * tan(t) - h - t, 0.1, 1.3, xtol=1e-15, rtol=1e-14)
    s_fn = z_n * sin(pi / 3 - theta) + sqrt(3) * (g / cos(theta) - rho)
    rho_f = rho + 2 * g**2 / (cos(theta) * (z_n * cos(theta) ** 2 - 2 * g))
    d_n = m * z_n
    d_bn, d_an = d_n * cos(alpha), d_n + d_a - d
    down = pi * d * cos(beta) * cos(alpha) / z * (eps_an - 1)
    d_en = 2 * sqrt((sqrt((d_an / 2) ** 2 - (d_bn / 2) ** 2) - down) ** 2 + (d_bn / 2) ** 2)
    alpha_en = acos(d_bn / d_en)
    gamma_e = (0.5 * pi + 2 * tan(alpha) * x) / z_n + involute(alpha) - involute(alpha_en)
    alpha_fen = alpha_en - gamma_e
    h_fe = (cos(gamma_e) - sin(gamma_e) * tan(alpha_fen)) * d_en / m
    h_fe = 0.5 * (h_fe - z_n * cos(pi / 3 - theta) - (g / cos(theta) - rho))
    y_f = 6 * h_fe * cos(alpha_fen) / (s_fn**2 * cos(alpha))
    slender, q_s = s_fn / h_fe, s_fn / (2 * rho_f)
    y_s = (1.2 + 0.13 * slender) * q_s ** (1 / (1.21 + 2.3 / slender))
    y_beta = 1 - eps_beta * degrees(beta) / 120
    f_t = 2000 * torque / d
    z_h = sqrt(2 * cos(beta_b) * cos(alpha_t) / (cos(alpha_t) ** 2 * sin(alpha_t)))
    z_e = sqrt(1 / (pi * 2 * (1 - 0.3**2) / 206000))
    z_eps = sqrt((4 - eps_alpha) / 3 * (1 - eps_beta) + eps_beta / eps_alpha)
    sigma_h0 = z_h * z_e * z_eps / sqrt(cos(beta)) * sqrt(f_t / (d * b))
    m_1 = sqrt(tan(alpha_t) / (sqrt((d_a / d_b) ** 2 - 1) - 2 * pi / z))
    z_b = max(1.0, m_1 - eps_beta * (m_1 - 1)) if m_1 > 1 else 1.0
    return {
        "virtual number of teeth": z_n,
        "transverse contact ratio": eps_alpha,
        "overlap ratio": eps_beta,
        "form factor": y_f,
        "stress correction": y_s,
        "notch parameter": q_s,
        "root stress, MPa": f_t / (b * m) * y_f * y_s * y_beta,
        "contact stress of the gear, MPa": sigma_h0,
        "contact stress of the pinion, MPa": z_b * sigma_h0,
    }


@against(
    "external source",
    "ISO 6336-2:2006 and ISO 6336-3:2006, formulas for helical gears worked out by hand",
    capability="rating",
    module="facegear.strength.cylindrical",
)
@pytest.mark.parametrize("beta", [0.0, 6.0, 15.0, -15.0, 25.0])
def test_a_helical_pinion_on_a_rack_is_rated_as_the_standard_rates_it(beta):
    """The standard's own helical gears: teeth, contact ratios, form factors and stresses of both failures."""
    design, torque = rack_pair(helix_angle=radians(beta)), 500.0
    ratio = transverse_contact_ratio(design)
    form, hertz = pinion_form(design, ratio), hertz_stress(design, ratio, request())
    found = {
        "virtual number of teeth": virtual_pinion(design).teeth,
        "transverse contact ratio": ratio,
        "overlap ratio": overlap_ratio(design),
        "form factor": form.form_factor,
        "stress correction": form.stress_correction,
        "notch parameter": pinion_notch(design),
        "root stress, MPa": 1e-6 * standard_bending(design, form)(torque),
        "contact stress of the gear, MPa": 1e-6 * hertz["face_gear"](torque),
        "contact stress of the pinion, MPa": 1e-6 * hertz["pinion"](torque),
    }
    part = design.pinion
    expected = iso_by_hand(
        part.teeth, 1e3 * design.module, design.pressure_angle, abs(radians(beta)), 23.0, torque
    )
    for name, value in expected.items():
        agrees(name, found[name], value, relative=1e-11, absolute=1e-12)
    assert (STEEL.young_modulus, STEEL.poisson_ratio) == (CARD.young_modulus, CARD.poisson_ratio)


def test_the_virtual_gear_of_a_helical_pinion_is_the_spur_gear_of_its_number_of_teeth():
    """At this helix 18 teeth stand for 24, whose spur pinion has the same root."""
    design = replace(rack_pair(), pressure_angle=radians(20.0))
    design = replace(design, pinion=replace(design.pinion, teeth=18, middle=None))

    def helical(beta):
        return replace(design, helix_angle=beta)

    beta = brentq(lambda angle: virtual_pinion(helical(angle)).teeth - 24.0, 0.1, 0.9, xtol=1e-15)
    spur = replace(design, helix_angle=0.0, pinion=replace(design.pinion, teeth=24))
    ratio = 1.5
    virtual_ratio = ratio / helical(beta).family.pinion_flanks[0].cosine ** 2
    forms = pinion_form(helical(beta), ratio), pinion_form(spur, virtual_ratio)
    for name in ("chord", "lever_arm", "fillet_radius", "load_angle", "form_factor", "stress_correction"):
        assert getattr(forms[0], name) == pytest.approx(getattr(forms[1], name), rel=1e-12)


def test_helix_factors_end_where_the_standard_ends_them():
    assert helix_angle_factors(0.0, 0.7) == (1.0, 1.0)
    assert helix_angle_factors(radians(-24.0), 1.7) == pytest.approx((0.8, cos(radians(24.0)) ** -0.5))
    assert helix_angle_factors(radians(40.0), 0.5)[0] == pytest.approx(1.0 - 0.5 * 0.25)
    assert contact_ratio_factor(1.6) == sqrt(0.8)
    assert contact_ratio_factor(1.6, 1.0) == contact_ratio_factor(1.6, 2.3) == pytest.approx(sqrt(1 / 1.6))


@pytest.mark.parametrize("name", ["P1", "P4"])
def test_transverse_contact_ratio_is_that_of_the_path_without_its_way_along_the_face(name):
    design = public_pair(name)
    cosine = design.family.pinion_flanks[0].cosine
    assert transverse_contact_ratio(design) == pytest.approx(
        nominal_path(design).contact_ratio * cosine**2, rel=1e-12
    )
    spur = pair_design()
    assert transverse_contact_ratio(spur) == section_contact_ratio(spur)


@pytest.mark.parametrize(
    ("name", "kinds"),
    [
        ("P1", ""),
        ("P2", "tapered teeth"),
        ("P3", "two pressure angles and another shaft angle than 90 degrees"),
        ("P4", "a pinion with offset"),
    ],
)
def test_kinds_that_the_standard_does_not_know_are_rated_by_contact_alone_and_say_so(name, kinds):
    design = public_pair(name)
    assert unknown_to_standard(design) == kinds
    found = rate(design, ROOTS, PRESSURE, request(LOAD))
    by_standard = {"ISO 6336-3", "ISO 6336-2"} if not kinds else set()
    assert {one.method for one in found} == {"finite elements", "contact analysis"} | by_standard
    table = safety_table(found, PRESSURE)
    assert table[["bending_safety", "pitting_safety"]].notna().all(axis=None)
    assert table["standard_pitting_safety"].isna().all() == bool(kinds)
    reason = f"not compared with ISO 6336, which does not know {kinds}"
    assert table["caveat"].str.contains(reason).all() == bool(kinds)
    for one in (rating_table(found, PRESSURE, ROOTS), damage_table(found, (LOAD,), PRESSURE)):
        assert len(one) == len(found)


def test_pitting_that_nothing_can_rate_leaves_the_flank_undecided():
    """Edges carry all load, where pressure has no limit, and the standard has no form for tapered teeth."""
    bare = replace(PRESSURE, pressure=np.full(2, np.nan), error=np.full(2, np.nan))
    for level, verdict in ((300e6, "undecided"), (1500e6, "red")):
        roots = dict.fromkeys(ROOTS, root(level))
        table = safety_table(rate(public_pair("P2"), roots, bare, request(LOAD)), bare)
        assert set(table["verdict"]) == {verdict}
        assert table["reason"].str.contains("pitting: not rated, as edges carry all load").all()


@pytest.mark.parametrize("kind", ["taper_angle", "helix_angle"])
def test_strength_of_a_kind_goes_to_that_of_spur_teeth_in_proportion(kind):
    spur = replace(public_pair("P2"), taper_angle=0.0)
    body = request().bodies["pinion"]

    def values(size):
        design = replace(spur, **{kind: size})
        notch = pinion_notch(design)
        return np.array([notch, permissible_bending(design, body, notch, 0.0), normal_arms(design)["back"]])

    limit = values(0.0)
    changes = [np.abs(values(size) / limit - 1.0) for size in (1e-2, 1e-4)]
    assert (changes[0] < 1e-2).all() and (changes[1] <= 0.011 * changes[0] + 1e-13).all()


def test_each_flank_of_a_machine_has_the_torque_of_its_own_arm():
    """Forces of coast flanks were multiplied by the arm of drive flanks, 3.6 % less at 25 and 20 degrees."""
    design = public_pair("P3")
    arms = normal_arms(design)
    assert arms["back"] / arms["drive"] == pytest.approx(cos(radians(20)) / cos(radians(25)), rel=1e-12)
    columns = ["bin", "body", "gear", "flank", "mesh", "fraction", "force_n"]
    loads = {"drive": 9e3, "back": 5e3}
    rows = [(1, "a", "pinion", flank, "a/upper", 1.0, force) for flank, force in loads.items()]
    duties = {one.flank: one for one in machine_duty(pd.DataFrame(rows, columns=columns), [LOAD], 0.2, arms)}
    assert duties["back"].torque == pytest.approx([5e3 * arms["back"]])
    assert duties["back"].opposite == pytest.approx([9e3 * arms["drive"]])
    assert duties["drive"].opposite == pytest.approx([5e3 * arms["back"]])
