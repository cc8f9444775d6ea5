"""Hubs that tilt on their bearings beside webs that bend, against the whole body with a free hub."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import gear_bodies
import numpy as np
import pytest
import scipy.linalg
import scipy.sparse as sp
from gear_bodies import PATCH, TEETH
from lumped_machines import make_layout, make_machine
from references import against, agrees
from scipy.sparse.linalg import eigsh

from facegear.machine.elastic_gears import ElasticGears
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Tilt
from facegear.machine.static_gears import at_rest
from facegear.parts.body_mesh import body_mesh
from facegear.parts.gear_body import reduced_body
from facegear.parts.matrices import body_matrices, rigid_motions
from facegear.parts.modes import order_modes
from facegear.parts.reduced_body import ReducedBody
from facegear.parts.section import inertia_about, section_properties
from facegear.sharing import sensitivity

RADIAL, TILTING, CENTRE = 3e8, 4e6, -0.02
"""Bearings, N/m and N m/rad; height of the point about which the hub tilts, m."""
MORE = 4.0, 0.03
"""Mass and inertia that the hub has beyond the section: kg and kg m2 about a diameter there."""
MASS, POLAR, _, _ = section_properties(gear_bodies.section())
INERTIA = inertia_about(gear_bodies.section(), CENTRE) + MORE[1]
SPEED = 200.0


@cache
def matrices():
    """On a mesh as coarse as the question allows: both answers are of the same one."""
    return body_matrices(gear_bodies.section(), body_mesh(gear_bodies.section(), 1, 2.0))


@cache
def body() -> ReducedBody:
    """Thirty modes of one nodal diameter and a few of none, without damping."""
    orders = (order_modes(matrices(), 0, 6e3), order_modes(matrices(), 1, np.inf, expected_count=29))
    solved = SimpleNamespace(
        orders=orders,
        section=gear_bodies.section(),
        static=lambda patch: np.zeros((2, 3, 3)),
        leaning=lambda patch: np.zeros((2, 3)),
    )
    return reduced_body(solved, PATCH, 0.0)


def machine(side=1, tilt=TILTING, own=None, below=None):
    """The paper's layout with one gear that bends, the lower 0 or the upper 1."""
    layout = make_layout(kinematics=GEOMETRIC)
    below = PATCH.height - CENTRE if below is None else below
    gears = list(layout.gears)
    rocking = None if tilt is None else Tilt(INERTIA, tilt, below)
    own_body = replace(
        gears[side].body, mass=MASS + MORE[0], inertia=POLAR, bearing=(RADIAL, RADIAL, 1e9), tilt=rocking
    )
    gears[side] = replace(gears[side], body=own_body)
    layout = replace(layout, gears=tuple(gears))
    lumped = make_machine(layout, mass_damping=0.0)
    return replace(lumped, bodies=ElasticGears(layout, {side: own or body()}))


def frequencies(turned, gear_speed, count):
    """First frequencies (count,), rad/s, of one nodal diameter of the gear that bends, all meshes open."""
    linear = turned.linear
    (gear,) = turned.bodies.bodies
    name = turned.layout.gears[gear].name
    hub = {f"{name}:{letter}" for letter in ("x", "y", "tilt_x", "tilt_y")}
    own = [k for k, label in enumerate(linear.labels) if label in hub or label.startswith(f"{name}:n1 ")]
    rest = np.setdiff1d(np.arange(linear.size), own)
    speed, at = gear_speed * TEETH / 23, np.ix_(own, own)
    for matrix in (linear.mass, linear.stiffness, linear.spin.gyroscopic, linear.spin.centrifugal):
        assert not matrix[np.ix_(own, rest)].any()
    stiffness = linear.stiffness[at] + speed**2 * linear.spin.centrifugal[at]
    solved = np.linalg.solve(linear.mass[at], np.hstack([stiffness, speed * linear.spin.gyroscopic[at]]))
    one, none, size = np.eye(len(own)), np.zeros((len(own), len(own))), len(own)
    roots = scipy.linalg.eigvals(np.block([[none, one], [-solved[:, :size], -solved[:, size:]]]))
    return np.sort(roots.imag[roots.imag > 1.0])[:count]


def free_hub(gear_speed, count):
    """Solve by finite elements with the hub's surface as a rigid body on springs.

    The modes are of the body at rest, among which the matrices of the turning body stand still in space.
    """
    whole, free = matrices(), matrices().free
    rigid = rigid_motions(whole.elements, 1)
    rigid[:, 1] += CENTRE * rigid[:, 0]
    bore = np.setdiff1d(np.arange(len(rigid)), free)
    held = np.zeros_like(rigid)
    held[bore] = rigid[bore]
    unit = sp.identity(len(rigid), format="csc")[:, free]
    joined = sp.hstack([unit, sp.csc_matrix(held)]).tocsr()
    mass = (joined.T @ (np.pi * whole.mass) @ joined).tolil()
    stiffness = (joined.T @ whole.stiffness.at(1) @ joined).tolil()
    hub = np.arange(2) + free.size
    mass[hub, hub] += np.array(MORE)
    stiffness[hub, hub] += np.array([RADIAL, TILTING])
    squares, shapes = eigsh(stiffness.tocsc(), 30, mass.tocsc(), sigma=0.0, tol=1e-11)
    moved = joined @ shapes
    bent = moved - rigid @ shapes[hub]
    gyroscopic = moved.T @ (np.pi * (whole.mass + whole.coriolis)) @ moved
    # What the hub has beyond the section belongs to no plane: its polar inertia is that of the section.
    centrifugal = whole.stress.at(1) - np.pi * (whole.centrifugal + whole.mass + 2.0 * whole.coriolis)
    size = squares.size
    restoring = np.diag(squares) + gear_speed**2 * bent.T @ (centrifugal @ bent)
    one, none = np.eye(size), np.zeros((size, size))
    roots = scipy.linalg.eigvals(np.block([[none, one], [-restoring, 2j * gear_speed * gyroscopic]]))
    return np.sort(np.abs(roots.imag))[:count]


@against(
    "second implementation",
    "finite elements of the whole body whose bore is a rigid body on springs",
    capability="gear_waves",
    module="facegear.machine.elastic_gears",
)
@pytest.mark.parametrize("side", [0, 1])
def test_hub_that_tilts_beside_a_web_has_the_frequencies_of_a_body_whose_bore_is_free(side):
    """Both waves of every mode."""
    for speed in (0.0, SPEED):
        computed, expected = frequencies(machine(side), speed, 8), free_hub(speed, 8)
        agrees(f"frequencies at {speed:g} rad/s over the others'", computed / expected, 1.0, absolute=3e-5)


def test_stiffer_bearings_of_the_hub_come_to_a_hub_that_does_not_tilt_in_proportion():
    square = frequencies(machine(tilt=None), SPEED, 6)
    away = [frequencies(machine(tilt=stiffness), SPEED, 6) - square for stiffness in (1e11, 1e12)]
    assert away[0] == pytest.approx(10.0 * away[1], rel=2e-2, abs=1e-6 * square.min())
    assert np.abs(away[1] / square).max() < 1e-3 < np.abs(away[0]).max()


@against(
    "analytic",
    "a rigid gear on springs whose centre of mass is off its bearings, by its equation of two motions",
    capability="gear_waves",
    module="facegear.machine.elastic_gears",
)
def test_gear_that_does_not_bend_sways_and_tilts_with_its_gyroscopic_moments():
    """Its web is 1e6 times stiffer, which leaves 1e-6 of the compliance."""
    own = replace(body(), frequency=1e3 * body().frequency)
    off = float(own.moment - own.mass * CENTRE)
    mass = np.array([[MASS + MORE[0], -off], [-off, INERTIA]])
    turning = np.diag([0.0, POLAR])
    for speed in (0.0, SPEED):
        solved = np.linalg.solve(mass, np.hstack([np.diag([RADIAL, TILTING]), -1j * speed * turning]))
        system = np.block([[np.zeros((2, 2)), np.eye(2)], [-solved[:, :2], -solved[:, 2:]]])
        expected = np.sort(np.abs(np.linalg.eigvals(system).imag))
        computed = frequencies(machine(own=own), speed, 4)
        agrees(f"sway and tilt at {speed:g} rad/s, rad/s", computed, expected, relative=1e-5)


def test_lumped_gear_that_rocks_is_the_rigid_gear_whose_centre_is_in_its_bearings():
    """Flanks feel its tilts alike; a lumped one has no gyroscopic moments, so that both stand still."""
    own = replace(body(), frequency=1e3 * body().frequency, moment=body().mass * CENTRE)
    turned = machine(own=own)
    assert frequencies(turned, 0.0, 4) == pytest.approx(
        np.repeat(np.sort(np.sqrt([RADIAL / (MASS + MORE[0]), TILTING / INERTIA])), 2), rel=1e-5
    )
    lumped = replace(turned, bodies=None).linear
    assert np.array_equal(turned.linear.rows[:, : lumped.size], lumped.rows)


@pytest.mark.parametrize("side", [0, 1])
def test_tilt_of_a_hub_moves_flanks_and_momentum_as_the_same_motion_of_a_body_that_carries_it(side):
    """About a point 30 mm below the pitch plane; a mode that is this motion itself."""
    below, radius = 0.03, make_layout(kinematics=GEOMETRIC).mesh_radius
    own = ReducedBody(
        order=np.array([1]),
        frequency=np.array([100.0]),
        coriolis=np.zeros((1, 1)),
        stiffening=np.zeros((1, 1)),
        mesh=np.array([[radius], [below], [0.0]]),
        hub=np.array([[0.5], [0.2]]),
        hub_spin=np.zeros(1),
        round=np.zeros(1),
        static=np.zeros((2, 3, 3)),
        damping_ratio=np.array(0.0),
        pitch_height=np.array(0.01),
    )
    turned = machine(side, own=own, below=below)
    linear, gear = turned.linear, turned.layout.gears[side]
    at = {letter: linear.labels.index(f"{gear.name}:{letter}") for letter in ("tilt_x", "tilt_y")}
    for letter, column in (("tilt_x", -2), ("tilt_y", -1)):
        same = gear.sign * linear.rows[:, at[letter]]
        assert linear.rows[:, column] == pytest.approx(same, abs=1e-12), letter
        # About height 0 it is 0.2, and sideways 0.5: 20 mm above the point it turns about.
        assert linear.mass[at[letter], column] == pytest.approx(gear.sign * (0.2 - 0.02 * 0.5)), letter


def forces_at_rest(tilt):
    """Mesh forces (meshes,), N, on two gears that bend whose hubs tilt as stiffly, None for not at all."""
    soft = gear_bodies.small_body()
    turned = gear_bodies.gearbox(replace(soft, frequency=100.0 * soft.frequency, static=1e-4 * soft.static))
    rocking = None if tilt is None else Tilt(1.0, tilt, 0.02)
    gears = tuple(replace(gear, body=replace(gear.body, tilt=rocking)) for gear in turned.layout.gears)
    layout = replace(turned.layout, gears=gears)
    turned = replace(turned, layout=layout, bodies=replace(turned.bodies, layout=layout))
    return gear_bodies.mesh_forces(at_rest(turned))


def test_load_at_rest_leaves_that_of_hubs_that_do_not_tilt_in_proportion_to_what_they_give():
    square = forces_at_rest(None)
    away = [forces_at_rest(stiffness) - square for stiffness in (1e9, 1e10)]
    assert np.abs(away[0]).max() > 1.0
    assert away[0] == pytest.approx(10.0 * away[1], rel=1e-2, abs=1e-2 * np.abs(away[0]).max())


def test_comparison_of_kinematics_takes_a_gear_that_bends_without_the_tilt_of_its_hub():
    """The printed kinematics know no tilts; a body that still counted them joined the wrong coordinates."""
    compared = sensitivity._with_kinematics(machine(), GEOMETRIC).linear
    assert np.array_equal(compared.mass, machine(tilt=None).linear.mass)
    assert compared.labels == machine(tilt=None).linear.labels
