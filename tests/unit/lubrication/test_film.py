"""Film thickness against worked numbers and an open gear code."""

from math import pi

import numpy as np
import pytest
from contact_bodies import STEEL
from oils import oil
from spur_path import c40

from facegear.contact.hertz import contact_modulus, strip_pressure
from facegear.lubrication.film import elliptic_film, line_film, shear_heating
from facegear.lubrication.flash import flash
from facegear.lubrication.kinematics import slip
from facegear.lubrication.micropitting import local_film, sliding_factor
from facegear.lubrication.request import STEEL as HEATED

MODULUS = contact_modulus((STEEL, STEEL))
REDUCED = 2 * MODULUS
ESTER = oil()
TORQUE, WIDTH, SPEED = 215.5, 0.040, 1800 * pi / 30


def worked_point():
    """C40 gears 5 mm before the pitch point: line load, radius, speeds, pressure, half-width, sliding."""
    path, g = c40(), -5e-3
    radii = path.curvature_radii + np.array([g, -g])
    radius = radii.prod() / radii.sum()
    load = 0.5 * TORQUE / path.base[0] / WIDTH
    u1, u2 = SPEED * radii * np.array([1.0, path.base[0] / path.base[1]])
    velocity, _ = slip(*path.spins(SPEED), *path.points(g))
    pressure, half = (float(one) for one in strip_pressure(load, 1 / radius, MODULUS))
    return load, radius, u1, u2, pressure, half, float(np.linalg.norm(velocity))


def test_worked_point_of_a_spur_gear_has_the_reference_s_speeds_and_pressure():
    load, radius, u1, u2, pressure, half, sliding = worked_point()
    assert [load, radius, u1, u2] == pytest.approx(
        [79.62857985e3, 6.666287655e-3, 1.690836214, 3.261632541], rel=1e-9
    )
    assert [pressure, half] == pytest.approx([656.017523e6, 77.27404619e-6], rel=1e-8)
    assert sliding == pytest.approx(u2 - u1, rel=1e-12)


def test_worked_point_has_the_film_of_dowson_and_higginson_and_gupta_s_factor():
    load, radius, u1, u2, pressure, _, _ = worked_point()
    viscosity, coefficient = ESTER.viscosity(80.0), ESTER.pressure_coefficient_at(80.0)
    film = line_film(radius, 0.5 * (u1 + u2), load, viscosity, coefficient, REDUCED)
    assert float(film) == pytest.approx(0.1043790389e-6, rel=1e-8)
    kept = shear_heating(
        pressure, u1, u2, viscosity, ESTER.thinning(80.0), ESTER.conductivity_of(80.0), REDUCED
    )
    assert float(kept) == pytest.approx(0.9723835316, rel=1e-9)


def test_worked_point_has_the_specific_film_of_the_micropitting_standard():
    load, radius, u1, u2, pressure, half, sliding = worked_point()
    rise, _ = flash(0.05, load, sliding, (u1, u2), half, 2 * (HEATED.contact_coefficient,))
    assert float(rise) == pytest.approx(14.48535756, rel=1e-8)
    cold, hot = (
        (ESTER.viscosity(at), ESTER.pressure_coefficient_at(at)) for at in (80.0, 80.0 + float(rise))
    )
    factor = sliding_factor(hot, cold)
    assert float(factor) == pytest.approx(0.6778577595, rel=1e-8)
    film = local_film(radius, u1 + u2, pressure, *cold, factor, REDUCED)
    assert float(film) == pytest.approx(0.09286646242e-6, rel=1e-8)
    assert float(film) / 0.4e-6 == pytest.approx(0.2321661561, rel=1e-8)


def test_smallest_elliptic_film_is_that_of_hamrock_and_dowson():
    found = elliptic_film(9e-3, 12.0, 1200.0, 6.0, 4.8e-3, 11e-9, REDUCED)
    assert float(found) == pytest.approx(0.2010263022e-6, rel=1e-9)


def test_open_gear_code_has_the_same_least_film_along_the_path_of_c40_gears():
    """GEARpie, REPORT/C40.txt: 0.40 to 0.65 um with E* for E_r and a factor of shear heating of 0.995."""
    path = c40()
    g = np.linspace(-path.approach, path.recess, 4001) * path.pitch
    shared = (g > (path.recess - 1) * path.pitch) & (g < (1 - path.approach) * path.pitch)
    load = np.where(shared, 1.0, 0.5) * TORQUE / path.base[0] / WIDTH
    first, second = path.curvature_radii[:, None] + np.array([g, -g])
    entrained = 0.5 * SPEED * (first + second * path.base[0] / path.base[1])
    film = line_film(first * second / (first + second), entrained, load, 49.847e-3, 20.36e-9, MODULUS)
    assert [film.min(), film.max()] == pytest.approx([0.4021e-6, 0.6543e-6], rel=1e-3)
