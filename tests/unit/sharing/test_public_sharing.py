"""Load sharing of equal paths: the closed form of epicyclic gears and its public numbers.

Reference: the formula of Singh 2010, and what follows from it for a machine of this kind. Percentiles and the
enumeration were made for this project beside it, and are no numbers of the paper. They cannot see unequal
meshes, and nothing of dynamics.
"""

from dataclasses import replace

import numpy as np
import pytest
from idler_machines import ANGLE, ARM, BEARING, FLOATING, HELD, STIFFNESS, TORQUE, make_idlers, upper_shares
from lumped_machines import make_layout
from references import against, agrees

from facegear.machine.assembly import assembly
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role
from facegear.sharing.closed_form import (
    SplitMachine,
    k_gamma_samples,
    parting_number,
    path_forces,
    plane_freedom,
    share_deviation,
)

TOTAL = TORQUE / ARM
LATE_UM = 30.0
SHARES = {
    (3, FLOATING): [0.33333, 0.33333, 0.33333],
    (3, HELD): [0.26490, 0.36755, 0.36755],
    (5, FLOATING): [0.15894, 0.23322, 0.18731, 0.18731, 0.23322],
    (5, HELD): [0.11788, 0.22053, 0.22053, 0.22053, 0.22053],
}
PARTED = {
    FLOATING: [0.0, 0.36180, 0.13820, 0.13820, 0.36180],
    HELD: [0.0, 0.25, 0.25, 0.25, 0.25],
}
"""Five paths at X_e = 0.8, by enumeration of all contact sets."""
PERCENTILES = {(5, 1.0): (3.47, 7.29, 9.08), (3, 0.0): (2.32, 5.21, 6.64), (5, 0.0): (5.49, 10.40, 12.88)}
"""c of K_gamma = 1 + c X, P50, P95 and P99, by paths and freedom; 4e6 samples."""
SAMPLES = 200_000


def path_stiffness():
    return SplitMachine(1, 1, 1.0, STIFFNESS, 0.0, 2.0 * np.cos(ANGLE)).path_stiffness(BEARING)


@against(
    "external source",
    "Singh 2010, formula and public numbers for idlers",
    capability="sharing_map",
    module="facegear.machine.statics",
)
@pytest.mark.parametrize(("idlers", "upper"), list(SHARES))
def test_shares_of_idlers_are_the_printed_ones(idlers, upper):
    found = upper_shares(make_idlers(idlers, upper, late_um=LATE_UM), TOTAL)
    agrees("share of an idler, five digits", found, SHARES[idlers, upper], absolute=5.1e-6)
    late = np.zeros(idlers)
    late[0] = 1e-6 * LATE_UM
    stiffness = path_stiffness()
    freedom = plane_freedom(idlers, stiffness, (HELD, upper), (np.cos(ANGLE),) * 2)
    exact = path_forces(TOTAL, stiffness, late, freedom) / TOTAL
    agrees("share of an idler with the bearings of the gears", found, exact, absolute=1e-9)
    if upper == FLOATING:
        free = path_forces(TOTAL, stiffness, late, 1.0) / TOTAL
        agrees("share of an idler, one gear free", found, free, absolute=1e-9)
    else:
        held = path_forces(TOTAL, stiffness, late, 0.0) / TOTAL
        agrees("share of an idler, both gears rigidly held", found, held, absolute=1e-6)


@against(
    "external source",
    "Singh 2010, thresholds 1 / (N - 3) and 1 / (N - 1)",
    capability="sharing_map",
    module="facegear.machine.statics",
)
@pytest.mark.parametrize(("idlers", "upper"), [(3, HELD), (5, HELD), (5, FLOATING), (6, FLOATING)])
def test_a_late_path_parts_at_the_number_of_the_closed_form(idlers, upper):
    """The force of the late path falls in a straight line, which crosses zero where it parts."""
    number, stiffness = 0.05, path_stiffness()
    late_um = 1e6 * number * TOTAL / stiffness
    force = upper_shares(make_idlers(idlers, upper, late_um=late_um), TOTAL)[0]
    parts = number / (1.0 - idlers * force)
    agrees(
        "number at which the late path parts", parts, parting_number(idlers, upper == FLOATING), relative=2e-5
    )
    open_um = 1.02e6 * parts * TOTAL / stiffness
    shares = upper_shares(make_idlers(idlers, upper, late_um=open_um, backlash_um=2000.0), TOTAL)
    agrees("share of the path past that number", shares[0], 0.0, absolute=1e-12)


PLANETS = {
    4: [1 / 4, -1 / 4, 1 / 4, -1 / 4],
    5: [0.4, -0.32361, 0.12361, 0.12361, -0.32361],
    6: [1 / 2, -1 / 3, 0.0, 1 / 6, 0.0, -1 / 3],
}
"""Share that a first planet late by e = W / k_e takes off the share of each planet around a floating sun."""


@against(
    "external source",
    "Singh 2010, four to six planets around a floating sun, one of them out of place",
    capability="sharing_map",
    module="facegear.machine.statics",
)
@pytest.mark.parametrize("planets", list(PLANETS))
def test_shares_of_idlers_are_those_of_planets_around_a_floating_sun(planets):
    """The lateness is small enough for all planets to carry; a late planet carries less."""
    number = 0.05
    late_um = 1e6 * number * TOTAL / path_stiffness()
    shares = upper_shares(make_idlers(planets, FLOATING, late_um=late_um), TOTAL)
    found = (1.0 / planets - shares) / number
    agrees("change of a planet's share over k_e e / W", found, PLANETS[planets], absolute=5.1e-6)


@against(
    "second implementation",
    "formula of Singh 2010, enumeration of all contact sets at X_e = 0.8",
    capability="sharing_map",
    module="facegear.machine.block_statics",
)
@pytest.mark.parametrize("upper", list(PARTED))
def test_shares_past_the_loss_of_contact_are_the_enumerated_ones(upper):
    late_um = 0.8e6 * TOTAL / path_stiffness()
    found = upper_shares(make_idlers(5, upper, late_um=late_um, backlash_um=2000.0), TOTAL)
    agrees("share of an idler past the loss of contact", found, PARTED[upper], absolute=5.1e-6)


@against(
    "second implementation",
    "formula of Singh 2010, percentiles of 4e6 samples drawn for this project",
    capability="sharing_map",
    module="facegear.sharing.closed_form",
)
@pytest.mark.parametrize(("paths", "freedom"), list(PERCENTILES))
def test_percentiles_of_samples_hold_the_printed_ones_in_their_intervals(paths, freedom):
    """Distribution-free 99.9 % intervals of the percentiles from order statistics."""
    draws = np.random.default_rng(53).standard_normal((SAMPLES, paths))
    uneven = np.sort(k_gamma_samples(1.0, draws, freedom) - 1.0)
    for level, printed in zip((0.5, 0.95, 0.99), PERCENTILES[paths, freedom], strict=True):
        spread = 3.29 * np.sqrt(SAMPLES * level * (1.0 - level))
        low, high = (uneven[int(SAMPLES * level + side * spread)] for side in (-1, 1))
        half = 0.5 * (high - low) + 0.005
        agrees(f"c of K_gamma = 1 + c X, P{100 * level:g}", 0.5 * (low + high), printed, absolute=half)


@against(
    "external source",
    "Singh 2010, X sqrt(N (N - 3)) and X sqrt(N (N - 1))",
    capability="sharing_map",
    module="facegear.sharing.closed_form",
)
@pytest.mark.parametrize(("paths", "freedom"), [(3, 0.0), (3, 1.0), (5, 0.0), (5, 1.0), (6, 0.4)])
def test_deviation_of_a_share_is_that_of_the_samples(paths, freedom):
    draws = np.random.default_rng(7).standard_normal((SAMPLES, paths))
    found = paths * path_forces(0.0, 0.1, draws, freedom).std(axis=0)
    expected = share_deviation(paths, 0.1, freedom)
    if freedom in (0.0, 1.0):
        printed = 0.1 * np.sqrt(paths * (paths - (3 if freedom else 1)))
        agrees("standard deviation of a share, formula", expected, printed, absolute=1e-15)
    agrees("standard deviation of a share", found, expected, relative=0.01, absolute=1e-12)


def fits_at(place, teeth):
    """Return whether a second pinion mounts `place` pitches from the first, without backlash."""
    places = (("first", Role.IDLER, 0.0), ("second", Role.IDLER, place))
    layout = make_layout(places, kinematics=GEOMETRIC)
    ratio = teeth / layout.pinion_teeth
    other = replace(layout, gear_teeth=teeth, gear_radius=ratio * layout.pinion_radius)
    return assembly(other, np.zeros(4)).fits.all()


@against(
    "external source",
    "Zhao and Li 2018, whole pitches between the pinions of a concentric face gear",
    capability="sharing_map",
    module="facegear.machine.assembly",
)
@pytest.mark.parametrize("teeth", [120, 143])
def test_every_layout_of_whole_pitches_can_be_assembled(teeth):
    """All places of a second pinion at quarters of a pitch, without backlash; half pitches fit as well."""
    places = 0.25 * np.arange(4, 4 * (teeth - 1) + 1)
    fits = np.array([fits_at(place, teeth) for place in places])
    whole = places % 1.0 == 0.0
    agrees("layouts of whole pitches that fit", fits[whole].sum(), teeth - 1, absolute=0)
    agrees("layouts of half pitches that fit", fits[places % 1.0 == 0.5].sum(), teeth - 2, absolute=0)
    agrees("layouts of quarter pitches that fit", fits[places % 0.5 == 0.25].sum(), 0, absolute=0)
