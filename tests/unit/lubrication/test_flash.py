"""Flash temperature: closed forms, Jaeger's integral and a transient solution of the heat equation."""

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given
from hypothesis import strategies as st
from references import against, agrees
from scipy.sparse.linalg import splu

from facegear.lubrication.flash import (
    HERTZ,
    flash,
    flash_at_any_speed,
    moving_heat,
    moving_temperature,
    slow_factor,
)
from facegear.lubrication.request import STEEL, FlankMaterial


def transient_rise(number: float, step: float = 0.04) -> float:
    """Largest surface temperature, over q0 b/k, while a strip of heat runs over a cold half space.

    Finite volumes and backward Euler in the frame of the material, lengths in half-widths, diffusivity 1:
    the strip starts on the left and runs on by six half-widths. `number`: its Peclet number.
    """
    edges = np.arange(-4.5, 4.5 + step / 2, step)
    depths = np.concatenate([[0.0], np.cumsum(0.25 / np.sqrt(number) * 0.12 * 1.16 ** np.arange(34))])
    dx, dz = np.diff(edges), np.diff(depths)
    across, down = _conduction(dx), _conduction(dz)
    volume = np.outer(dx, dz).ravel()
    conduction = sp.kron(across, sp.diags_array(dz)) + sp.kron(sp.diags_array(dx), down)
    speed = 2 * number
    dt = 0.5 * step / speed
    solver = splu((sp.diags_array(volume) / dt + conduction).tocsc())
    temperature, largest = np.zeros(volume.size), 0.0
    for centre in np.arange(-3.0, 3.0, speed * dt):
        flux = np.zeros((dx.size, dz.size))
        flux[:, 0] = np.diff(_half_disc(edges - centre - speed * dt))
        temperature = solver.solve(volume / dt * temperature + flux.ravel())
        surface = temperature.reshape(flux.shape)[:, 0] + flux[:, 0] / dx * dz[0] / 2
        largest = max(largest, float(surface.max()))
    return largest


def _conduction(size):
    """Finite volumes of unit conductivity with insulated ends."""
    between = 2.0 / (size[1:] + size[:-1])
    matrix = sp.diags_array(
        [np.append(between, 0) + np.append(0, between), -between, -between], offsets=[0, 1, -1]
    )
    return matrix.tocsr()


def _half_disc(at):
    """Integral of sqrt(1 - s^2) from -1."""
    s = np.clip(at, -1.0, 1.0)
    return 0.5 * (s * np.sqrt(1 - s * s) + np.arcsin(s) + np.pi / 2)


@against(
    "external source",
    "ISO/TS 6336-20: thermal contact coefficient of steel",
    capability="lubrication",
    module="facegear.lubrication.flash",
)
def test_steel_has_the_contact_coefficient_of_the_standard():
    agrees("thermal contact coefficient, N/(m s^0.5 K)", STEEL.contact_coefficient, 12427.389, absolute=5e-4)


@against(
    "external source",
    "worked point of Blok's formula",
    capability="lubrication",
    module="facegear.lubrication.flash",
)
def test_blok_s_temperature_and_share_of_the_heat_are_the_worked_ones():
    rise, share = flash(0.05, 400e3, 7.1, (8.0, 15.0), 0.22e-3, 2 * (STEEL.contact_coefficient,))
    agrees("flash temperature, K", float(rise), 90.35334994, relative=1e-9)
    agrees("share of the heat", float(share), 0.42206445, relative=1e-8)


@against(
    "analytic",
    "Jaeger's moving source at high speed",
    capability="lubrication",
    module="facegear.lubrication.flash",
)
def test_constant_of_hertz_s_pressure_is_the_limit_of_jaeger_s_integral():
    fast = 1e6
    places = np.linspace(0.6, 0.7, 201)
    rises = np.array([moving_temperature(at, fast) for at in places])
    agrees("constant of the flash temperature", rises.max() * np.sqrt(fast) * 4 / np.pi, HERTZ, relative=1e-6)
    assert places[rises.argmax()] == pytest.approx(0.65223, abs=5e-4)


@against(
    "analytic",
    "Jaeger's moving source",
    capability="lubrication",
    module="facegear.lubrication.flash",
)
@pytest.mark.parametrize(("number", "rise", "excess"), [(5, 0.388836, 0.0041), (20, 0.195169, 0.0002)])
def test_slow_strips_heat_less_than_the_closed_form_says(number, rise, excess):
    assert moving_heat(number) == pytest.approx(rise, abs=1e-6)
    agrees("excess of the closed form", 1 / float(slow_factor(number)) - 1, excess, absolute=5e-5)


@against(
    "analytic",
    "Jaeger's moving source",
    capability="lubrication",
    module="facegear.lubrication.flash",
)
def test_factor_of_slow_flanks_is_jaeger_s_between_the_points_of_its_table():
    for number in (0.0123, 0.37, 2.9, 41.0):
        closed = HERTZ * np.pi / (4 * np.sqrt(number))
        agrees(
            "factor of slow flanks", float(slow_factor(number)), moving_heat(number) / closed, relative=2e-5
        )
    assert float(slow_factor(2000.0)) == 1.0


@against(
    "second implementation",
    "finite volumes of transient heat conduction",
    capability="lubrication",
    module="facegear.lubrication.flash",
)
def test_both_flanks_of_a_transient_solution_reach_the_flash_temperature_within_a_percent():
    flanks = STEEL, FlankMaterial(30.0, 7700.0, 500.0)
    b, friction, load, sliding = 2e-4, 0.05, 3e5, 6.0
    numbers = 4.0, 12.0
    speeds = tuple(2 * pe * flank.diffusivity / b for pe, flank in zip(numbers, flanks, strict=True))
    rise, share = flash_at_any_speed(friction, load, sliding, speeds, b, flanks)
    largest = 2 * friction * load * sliding / (np.pi * b)
    for part, number, flank in zip((share, 1 - share), numbers, flanks, strict=True):
        alone = float(part) * largest * b / flank.conductivity * transient_rise(number)
        agrees("flash temperature, K", alone, float(rise), relative=0.01)


@given(st.floats(0.2, 30.0), st.floats(0.2, 30.0), st.floats(2e-5, 5e-4))
def test_flash_stays_when_the_flanks_change_names(u1, u2, b):
    flanks = STEEL, FlankMaterial(30.0, 7700.0, 500.0)
    rise, share = flash_at_any_speed(0.05, 3e5, abs(u1 - u2), (u1, u2), b, flanks)
    swapped, other = flash_at_any_speed(0.05, 3e5, abs(u1 - u2), (u2, u1), b, flanks[::-1])
    assert float(swapped) == pytest.approx(float(rise), rel=1e-12)
    assert float(other) == pytest.approx(1 - float(share), rel=1e-12)
