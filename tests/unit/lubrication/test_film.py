"""Film thickness against worked numbers and an open gear code."""

from math import pi

import numpy as np
from contact_bodies import STEEL
from oils import oil
from references import against, agrees
from spur_path import c40

from facegear.contact.hertz import contact_modulus, strip_pressure
from facegear.lubrication.film import elliptic_film, line_film, local_film, shear_heating, sliding_factor
from facegear.lubrication.flash import flash
from facegear.lubrication.kinematics import slip
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


@against(
    "external source",
    "worked point of C40 gears by the formulas of its sources",
    capability="lubrication",
    module="facegear.lubrication.kinematics",
)
def test_worked_point_of_a_spur_gear_has_the_reference_s_speeds_and_pressure():
    load, radius, u1, u2, pressure, half, sliding = worked_point()
    agrees(
        "load, radius and speeds of the worked point",
        [load, radius, u1, u2],
        [79.62857985e3, 6.666287655e-3, 1.690836214, 3.261632541],
        relative=1e-9,
    )
    agrees(
        "pressure and half-width of the worked point",
        [pressure, half],
        [656.017523e6, 77.27404619e-6],
        relative=1e-8,
    )
    agrees("sliding speed, m/s", sliding, u2 - u1, relative=1e-12)


@against(
    "external source",
    "worked point of C40 gears by the formulas of its sources",
    capability="lubrication",
    module="facegear.lubrication.film",
)
def test_worked_point_has_the_film_of_dowson_and_higginson_and_gupta_s_factor():
    load, radius, u1, u2, pressure, _, _ = worked_point()
    viscosity, coefficient = ESTER.viscosity(80.0), ESTER.pressure_coefficient_at(80.0)
    film = line_film(radius, 0.5 * (u1 + u2), load, viscosity, coefficient, REDUCED)
    agrees("film, m", float(film), 0.1043790389e-6, relative=1e-8)
    kept = shear_heating(
        pressure, u1, u2, viscosity, ESTER.thinning(80.0), ESTER.conductivity_of(80.0), REDUCED
    )
    agrees("factor of shear heating", float(kept), 0.9723835316, relative=1e-9)


@against(
    "external source",
    "worked point of C40 gears by the formulas of its sources",
    capability="lubrication",
    module="facegear.lubrication.film",
)
def test_worked_point_has_the_specific_film_of_the_micropitting_standard():
    load, radius, u1, u2, pressure, half, sliding = worked_point()
    rise, _ = flash(0.05, load, sliding, (u1, u2), half, 2 * (HEATED.contact_coefficient,))
    agrees("flash temperature, K", float(rise), 14.48535756, relative=1e-8)
    cold, hot = (
        (ESTER.viscosity(at), ESTER.pressure_coefficient_at(at)) for at in (80.0, 80.0 + float(rise))
    )
    factor = sliding_factor(hot, cold)
    agrees("sliding factor", float(factor), 0.6778577595, relative=1e-8)
    film = local_film(radius, u1 + u2, pressure, *cold, factor, REDUCED)
    agrees("local film, m", float(film), 0.09286646242e-6, relative=1e-8)
    agrees("specific film", float(film) / 0.4e-6, 0.2321661561, relative=1e-8)


@against(
    "external source",
    "Hamrock and Dowson",
    capability="lubrication",
    module="facegear.lubrication.film",
)
def test_smallest_elliptic_film_is_that_of_hamrock_and_dowson():
    found = elliptic_film(9e-3, 12.0, 1200.0, 6.0, 4.8e-3, 11e-9, REDUCED)
    agrees("film of an ellipse, m", float(found), 0.2010263022e-6, relative=1e-9)


@against(
    "third-party program",
    "GEARpie, an open gear code: C40 gears",
    capability="lubrication",
    module="facegear.lubrication.film",
)
def test_open_gear_code_has_the_same_least_film_along_the_path_of_c40_gears():
    """GEARpie, REPORT/C40.txt: 0.40 to 0.65 um with E* for E_r and a factor of shear heating of 0.995."""
    path = c40()
    g = np.linspace(-path.approach, path.recess, 4001) * path.pitch
    shared = (g > (path.recess - 1) * path.pitch) & (g < (1 - path.approach) * path.pitch)
    load = np.where(shared, 1.0, 0.5) * TORQUE / path.base[0] / WIDTH
    first, second = path.curvature_radii[:, None] + np.array([g, -g])
    entrained = 0.5 * SPEED * (first + second * path.base[0] / path.base[1])
    film = line_film(first * second / (first + second), entrained, load, 49.847e-3, 20.36e-9, MODULUS)
    agrees("smallest and largest film, m", [film.min(), film.max()], [0.4021e-6, 0.6543e-6], relative=1e-3)
