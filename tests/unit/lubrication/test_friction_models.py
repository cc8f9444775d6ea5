"""Friction coefficients against worked numbers of their sources and of an open gear code."""

from math import cos, pi, tan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from references import against, agrees
from spur_path import c40

from facegear.lubrication.film import shear_heating
from facegear.lubrication.friction import (
    LIMIT_SOURCES,
    BenedictKelley,
    Doleschel,
    Iso633620,
    Iso633622,
    Schlenk,
    Xu,
)
from facegear.lubrication.friction_formulas import (
    Rubbing,
    benedict_kelley,
    iso_6336_20,
    iso_6336_22,
    schlenk,
    xu,
)

ETA = 7.5644367e-3
"""Ester turbine oil of 5 mm2/s at 80 C, Pa s."""
TORQUE, WIDTH, SPEED = 215.5, 0.040, 1800 * pi / 30


def rubbing(**changes) -> Rubbing:
    values = {
        "line_load": np.array([200e3, 200e3]),
        "radius": np.array([8e-3, 8e-3]),
        "pressure": np.array([0.8e9, 0.8e9]),
        "u1": np.array([8.0, 11.0]),
        "u2": np.array([15.0, 11.0]),
        "sliding": np.array([7.0, 0.0]),
        "pitch_speed": 30.0,
        "oil_viscosity": 5e-3,
        "bulk_viscosity": 4e-3,
        "film_ratio": np.array([0.5, 3.0]),
        "ra": 0.3e-6,
        "rq": 0.5e-6,
    }
    return Rubbing(**{**values, **changes})


@against(
    "external source",
    "worked point of C40 gears by the formulas of its sources",
    capability="lubrication",
    module="facegear.lubrication.friction",
)
def test_worked_point_of_a_spur_gear_has_schlenk_s_and_xu_s_coefficient():
    u1, u2, radius, load = 1.690836214, 3.261632541, 6.666287655e-3, 79.62857985e3
    agrees(
        "coefficient of Schlenk", schlenk(load, u1 + u2, radius, ETA, 0.4e-6), 0.04114243965, relative=1e-8
    )
    agrees("coefficient of Xu", xu(656.017523e6, radius, u1, u2, ETA, 0.5e-6), 0.02763676115, relative=1e-7)


@against(
    "external source",
    "ISO/TS 6336-20 and -22 at the pitch point of C40 gears",
    capability="lubrication",
    module="facegear.lubrication.friction",
)
def test_pitch_point_of_c40_gears_has_the_coefficients_of_the_standards():
    path = c40()
    radius = path.base[0] * tan(path.angle) * path.base[1] / sum(path.base)
    rolled = 2 * SPEED * path.base[0] * tan(path.angle)
    tangential, normal = TORQUE / 36e-3 / WIDTH, TORQUE / path.base[0] / WIDTH
    at = rolled, radius, ETA, 0.4e-6
    agrees("coefficient of ISO/TS 6336-22 at 150 N/mm", iso_6336_22(150e3, *at), 0.05340898638, relative=1e-8)
    agrees("coefficient of ISO/TS 6336-22", iso_6336_22(normal, *at), 0.05405251142, relative=1e-8)
    agrees("coefficient of ISO/TS 6336-20", iso_6336_20(tangential, *at), 0.05505126344, relative=1e-8)


@against(
    "third-party program",
    "GEARpie, an open gear code: C40 gears",
    capability="lubrication",
    module="facegear.lubrication.friction",
)
def test_open_gear_code_has_the_same_schlenk_coefficient_for_c40_gears():
    """GEARpie, REPORT/C40.txt: 0.0256 with the whole load at the pitch point."""
    path = c40()
    radius = path.base[0] * tan(path.angle) * path.base[1] / sum(path.base)
    rolled = 2 * SPEED * path.base[0] / cos(path.angle) * np.sin(path.angle)
    found = schlenk(TORQUE / path.base[0] / WIDTH, rolled, radius, 49.847e-3, 0.355e-6, 0.65)
    agrees("coefficient of Schlenk", found, 0.0256018, absolute=5e-7)


@against(
    "external source",
    "Benedict and Kelley's formula",
    capability="lubrication",
    module="facegear.lubrication.friction",
)
def test_benedict_and_kelley_s_logarithm_is_cut_on_the_pitch_line_and_says_so():
    model, at = BenedictKelley(), rubbing()
    assert np.isfinite(model.coefficient(at)).all()
    (within,) = model.within(at).values()
    assert within.tolist() == [True, False]
    agrees(
        "coefficient of Benedict and Kelley",
        benedict_kelley(1e5, 20.0, 5.0, 4e-3, 1.2e-6),
        3 * 0.0127 * np.log10(29660 * 100 / (4 * 5 * 400)),
        relative=1e-12,
    )


def test_ranges_name_the_places_outside_them():
    slow = rubbing(line_load=np.array([100e3, 200e3]), pitch_speed=60.0)
    message = Schlenk().within(slow)
    assert message["line load at least 150 N/mm"].tolist() == [False, True]
    assert message["pitch line velocity at most 50 m/s"].tolist() == [False, False]
    assert not Iso633620().within(slow)["pitch line velocity at most 50 m/s"].any()
    fast = rubbing(u1=np.array([1.0, 8.0]), u2=np.array([4.0, 9.0]))
    assert Xu().within(fast)["slide to roll ratio at most 1"].tolist() == [False, True]


@pytest.mark.parametrize("model", [Schlenk(), Iso633620(), Iso633622(), Xu(), BenedictKelley()])
def test_every_limit_of_a_friction_model_names_its_source(model):
    named = {limit for name, limit in LIMIT_SOURCES if name == model.name}
    assert set(model.within(rubbing())) == named


def test_solid_and_fluid_friction_share_the_load_by_the_film():
    model = Doleschel(0.1, 0.2, -0.05, 0.03, 0.1, -0.1, 0.05)
    at = rubbing(u1=np.array([8.0, 8.0]), u2=np.array([15.0, 15.0]))
    mixed, fluid = model.coefficient(at)
    alone = 0.03 * 0.8**0.1 * 23.0**-0.1 * 5.0**0.05
    assert fluid == pytest.approx(alone, rel=1e-12)
    solid = 0.1 * 0.8**0.2 * 23.0**-0.05
    assert mixed == pytest.approx(0.75**2 * solid + (1 - 0.75**2) * alone, rel=1e-12)


@given(st.floats(1e4, 1e6), st.floats(1.0, 60.0), st.floats(2e-3, 3e-2), st.floats(1e-3, 0.1))
def test_coefficients_of_the_standards_rise_with_load_and_fall_with_speed_and_viscosity(w, v, rho, eta):
    for model in (schlenk, iso_6336_20, iso_6336_22):
        base = model(w, v, rho, eta, 0.4e-6)
        assert model(1.1 * w, v, rho, eta, 0.4e-6) > base
        assert model(w, 1.1 * v, rho, eta, 0.4e-6) < base
        assert model(w, v, rho, 1.1 * eta, 0.4e-6) < base


@pytest.mark.parametrize(
    "model",
    [Schlenk(), Iso633622(), Iso633620(), BenedictKelley(), Xu(), Doleschel(*[0.08, 0.2, -0.1] * 2, 0.1)],
)
def test_oil_that_is_dragged_backwards_rubs_as_forwards(model):
    """Beside its root a gear may run backwards, faster than the pinion runs: the sum had no power then."""
    ahead = {"u1": np.array([4.0, 3.0]), "u2": np.array([-7.0, -9.0])}
    back = {name: -value for name, value in ahead.items()}
    found = model.coefficient(rubbing(**ahead))
    assert (found > 0.0).all()
    assert model.coefficient(rubbing(**back)).tolist() == found.tolist()


def test_inlet_shear_of_oil_that_is_dragged_backwards_is_that_forwards():
    wet = ETA, 0.03, 0.14, 450e9
    assert shear_heating(0.6e9, -4.0, 7.0, *wet) == shear_heating(0.6e9, 4.0, -7.0, *wet)
