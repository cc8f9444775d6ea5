"""Oils: viscosity over temperature against published values, and what follows from it."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oils import NAMES, oil
from references import against, agrees

from facegear.errors import FacegearError

ESTER = oil()


@against(
    "external source",
    "ASTM D341 and the oil's data sheet",
    capability="lubrication",
    module="facegear.lubrication.oil",
)
def test_ester_turbine_oil_has_the_viscosities_of_astm_d341():
    agrees(
        "constants of ASTM D341", [ESTER.intercept, ESTER.slope], [9.3125865871, 3.6665030529], absolute=1e-9
    )
    agrees(
        "kinematic viscosity, mm2/s",
        ESTER.kinematic_viscosity([40, 80, 100, 120]) * 1e6,
        [27.6, 7.896071712, 5.1, 3.569933275],
        relative=1e-9,
    )
    agrees("dynamic viscosity, Pa s", float(ESTER.viscosity(80.0)), 7.5644367e-3, relative=1e-8)


@against(
    "external source",
    "pressure coefficient of the oil's source",
    capability="lubrication",
    module="facegear.lubrication.oil",
)
def test_ester_turbine_oil_has_the_pressure_coefficient_of_its_source():
    agrees(
        "pressure coefficient, 1/GPa",
        ESTER.pressure_coefficient_at([40, 100, 150]) * 1e9,
        [14.4, 11.0, 9.6],
        absolute=0.05,
    )
    agrees(
        "pressure coefficient at 80 C, 1/Pa",
        float(ESTER.pressure_coefficient_at(80.0)),
        11.76317092e-9,
        relative=1e-8,
    )


@pytest.mark.parametrize("name", NAMES)
def test_every_oil_of_the_package_thins_as_it_warms_and_stiffens_less_under_pressure(name):
    known = oil(name)
    warm = np.linspace(0.0, known.flash_point, 30)
    for values in (known.viscosity(warm), known.density_at(warm), known.pressure_coefficient_at(warm)):
        assert (np.diff(values) < 0).all()
    assert (known.conductivity_of(warm) > 0.08).all()
    assert known.kinematic_viscosity(known.temperatures) == pytest.approx(known.viscosities, rel=1e-12)


@given(st.floats(20.0, 180.0))
def test_thinning_is_the_slope_of_the_logarithm_of_viscosity(temperature):
    high, low = (np.log(ESTER.kinematic_viscosity(temperature + step)) for step in (0.01, -0.01))
    assert float(ESTER.thinning(temperature)) == pytest.approx(-(high - low) / 0.02, rel=1e-6)


def test_an_oil_that_thickens_as_it_warms_is_refused():
    with pytest.raises(FacegearError, match="viscosity must fall with temperature"):
        replace(ESTER, viscosities=(5e-6, 27e-6))
