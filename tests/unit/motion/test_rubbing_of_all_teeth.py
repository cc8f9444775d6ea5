"""Friction of any teeth on pinions that float and tilt: wrenches in space, SciPy, energy, mirror image."""

from dataclasses import replace

import numpy as np
import pytest
from floating_machines import KINDS, MESH_DAMPING, ByHand, make_floating_machine, motion_at
from public_casing import mount_public
from recorded_motion import record
from references import against, agrees
from scipy.integrate import solve_ivp
from scipy_motions import kicked
from seated_machines import make_small_layout, make_small_machine, place_on
from wrench_machines import coordinates, make_layout, mirrored, place, random_teeth

from facegear.harmonics import stacked_values
from facegear.machine.disturbances import MeshFriction, friction_rows
from facegear.machine.flank_errors import flank_lags
from facegear.machine.layout import Side, Tilt
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Settings
from facegear.motion.steady_state.simulate import build_model

FLIP = np.array([-1.0, 1.0, 1.0])
"""Mirror across the tangent, of components along tangent, pinion's axis and the third axis."""
SIZE = 0.06
LEVER = 0.01


class Wrenches:
    """Made-up wrenches of friction on the pinion over the flank's force, a few harmonics each.

    Components along tangent x, pinion's axis a and u, moments about the middle of the face; of drive flanks,
    and of the drive flanks of the mirrored pairs.
    """

    def __init__(self, seed=7):
        random = np.random.default_rng(seed)
        self.force = SIZE * random.normal(size=(2, 4, 3, 2, 4))
        self.moment = LEVER * SIZE * random.normal(size=(2, 4, 3, 2, 4))
        for series in (self.force, self.moment):
            series[..., 0, 0] = 0.0  # the sine of order 0
        # power is lost: the moment about the pinion's axis -a is negative in the mean
        self.moment[:, :, 1, 1, 0] += LEVER * SIZE

    def friction(self, machine, teeth):
        """Return the wrenches as ratios of the machine."""
        layout, both = machine.layout, []
        for number, shape in enumerate((teeth, mirrored(teeth))):
            ratios = []
            for mesh, (_, g) in enumerate(layout.meshes):
                at = place(shape, 0.0, layout.gears[g].side is Side.UPPER)
                force, moment = self.force[number, mesh], self.moment[number, mesh]
                sine, cosine = np.sin(at.shaft), np.cos(at.shaft)
                middle = np.array([at.offset, shape.face, 0.0])
                about_gear = moment + np.stack(
                    [
                        middle[1] * force[2] - middle[2] * force[1],
                        middle[2] * force[0] - middle[0] * force[2],
                        middle[0] * force[1] - middle[1] * force[0],
                    ]
                )
                ratios.append(
                    [
                        force[0],
                        force[1],
                        cosine * force[1] - sine * force[2],
                        -moment[1] / layout.pinion_arm,
                        (-cosine * about_gear[1] + sine * about_gear[2]) / layout.gear_arm,
                        moment[0] / layout.pinion_arm,
                        -moment[2] / layout.pinion_arm,
                    ]
                )
            both.append(np.array(ratios))
        return MeshFriction(*both)

    def rubbing(self, machine, teeth, ahead):
        """Generalised forces of all flanks for 1 N, and the moment that turns the machine, by the phase."""
        layout, parts = machine.layout, coordinates(machine, teeth)
        pinions, ratio = len(layout.pinions), layout.pinion_teeth / layout.gear_teeth
        output = 4 * (pinions + layout.output) + 3

        def acting(cycle, at_output=True):
            rows = np.zeros((8, len(parts)))
            for flank in range(8):
                mesh, back = flank % 4, flank // 4
                i, g = layout.meshes[mesh]
                at = place(teeth, layout.angles[i], layout.gears[g].side is Side.UPPER)
                where = (-1.0) ** back * (cycle - machine.phases[mesh] + ahead[flank])
                force, moment = (
                    stacked_values(series[back, mesh], np.array([where]))[0]
                    for series in (self.force, self.moment)
                )
                if back:  # friction of a mirrored motion that runs backwards
                    force, moment = -FLIP * force, FLIP * moment
                axes = np.array([at.x, at.a, at.u])
                force, moment = force @ axes, moment @ axes
                middle = at.offset * at.x + teeth.face * at.a
                for column, part in enumerate(parts):
                    sign = {i: 1.0, pinions + g: -1.0}.get(part.body, 0.0)
                    about = moment + np.cross(middle - part.centre, force)
                    rows[flank, column] = sign * (force @ part.motion + about @ part.turn)
                if at_output:
                    rows[flank, output] -= (rows[flank, 4 * i + 3] / ratio) + rows[
                        flank, 4 * (pinions + g) + 3
                    ]
            return rows

        return acting


def rubbing_machine(name, moving=False):
    teeth = KINDS[name]
    machine = make_floating_machine(teeth, moving)
    return teeth, replace(machine, friction=Wrenches().friction(machine, teeth))


def acting_by_hand(machine, teeth, by_hand):
    """Forces of friction on all coordinates for 1 N at each flank."""
    return Wrenches().rubbing(machine, teeth, by_hand.ahead)


@pytest.mark.parametrize("at_output", [True, False])
@pytest.mark.parametrize("name", KINDS)
def test_rows_of_friction_are_wrenches_in_space(name, at_output):
    teeth, machine = rubbing_machine(name)
    acting = acting_by_hand(machine, teeth, ByHand(machine, teeth, 1.0))
    rows = np.tile(friction_rows(machine.layout, machine.linear, machine.drive_line, at_output), (2, 1, 1))
    ratios = machine.friction.flank_ratios(flank_lags(machine, machine.phases))
    for cycle in (0.0, 0.31, 0.77):
        at = stacked_values(ratios.reshape(-1, *ratios.shape[2:]), np.array([cycle])).reshape(8, 7)
        found = np.einsum("fp,fpn->fn", at, rows)
        expected = acting(cycle, at_output)
        np.testing.assert_allclose(found, expected, atol=1e-12 * np.abs(expected).max())


class RubbedByHand(ByHand):
    """The equations of all coordinates, with friction on the elastic forces of the flanks."""

    def __init__(self, machine, teeth, omega):
        super().__init__(machine, teeth, omega)
        acting, cycles = acting_by_hand(machine, teeth, self), np.arange(8) / 8
        # harmonics up to the third: eight places know them all
        self.acting = {
            at_output: np.fft.fft([acting(cycle, at_output) for cycle in cycles], axis=0)[:4] / 8
            for at_output in (True, False)
        }

    def friction(self, t, elastic, at_output=True):
        waves = np.exp(1j * self.omega * t * np.arange(4)) * [1.0, 2.0, 2.0, 2.0]
        return elastic @ np.tensordot(waves, self.acting[at_output], 1).real

    def slope(self, t, state):
        moved, speed = np.split(state, 2)
        stiffness, over, *_ = self.flanks(t, moved, speed)
        slope = super().slope(t, state)
        slope[moved.size :] += self.friction(t, stiffness * over) / self.mass
        return slope


@against(
    "third-party program",
    "scipy.integrate.solve_ivp",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.parametrize("name", KINDS)
def test_rubbing_pinions_that_float_and_tilt_move_as_scipy_says(name, moving):
    """Where pinions that move shift the place in the mesh cycle, friction takes the force that follows."""
    teeth, machine = rubbing_machine(name, moving)
    omega = TAU * 2100.0
    model, by_hand = build_model(machine), RubbedByHand(machine, teeth, omega)
    start = kicked(model, 0.05)
    phases = np.linspace(0.0, TAU, 21)
    run = record(model.system, omega, start, 1, Settings(tolerance=1e-13))
    coordinates_found, deflections = run.at(phases)
    assert (run.states[:, :8] > 0).any() and (run.states[:, :8] == 0).any()
    basis = model.reduction.basis
    found = solve_ivp(
        by_hand.slope,
        (0.0, phases[-1] / omega),
        np.concatenate([basis @ start.displacement, basis @ start.velocity]),
        "DOP853",
        phases / omega,
        rtol=1e-11,
        atol=1e-14,
        max_step=2e-6,
    )
    moved = np.split(found.y.T, 2, axis=1)[0]
    bent = moved @ by_hand.rows.T - [by_hand.law(phase / omega)[1] for phase in phases]
    gap = np.abs(deflections[:, :8] - bent).max() / np.abs(bent).max()
    agrees("largest difference of the deflections over the largest", gap, 0.0, absolute=1e-6)
    plain = record(build_model(replace(machine, friction=None)).system, omega, start, 1, Settings())
    without = plain.at(phases)[1][:, :8]
    assert np.abs(bent - without).max() > 1e-3 * np.abs(bent).max()  # friction does something
    turn = np.zeros(moved.shape[1])
    turn[[3, 7]], turn[[11, 15]] = 1.0, teeth.pinion / teeth.gear
    apart = coordinates_found @ basis.T - moved
    apart -= np.outer(apart @ (by_hand.mass * turn), turn) / (turn @ (by_hand.mass * turn))
    lengths = machine.linear.lengths
    assert np.abs(apart * lengths).max() < 1e-6 * np.abs(moved * lengths).max()


@against(
    "analytic",
    "balance of energy",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
@pytest.mark.parametrize("name", KINDS)
def test_power_in_less_power_out_less_friction_less_damping_changes_the_energy(name):
    """The balance is that of the whole machine at even rotation; the output's torque gives way."""
    teeth, machine = rubbing_machine(name)
    omega = TAU * 2100.0
    model, by_hand = build_model(machine), RubbedByHand(machine, teeth, omega)
    run = record(model.system, omega, kicked(model, 0.05), 1, Settings(tolerance=1e-14))
    basis = model.reduction.basis
    turn = np.zeros(len(by_hand.mass))
    turn[[3, 7]], turn[[11, 15]] = omega / teeth.pinion, omega / teeth.gear
    layout = machine.layout
    output = 4 * (len(layout.pinions) + layout.output) + 3

    phases, weights = run.quadrature(14)
    step = np.searchsorted(run.starts, phases, side="right") - 1
    sums = dict.fromkeys(("power", "friction", "damping", "law", "even"), 0.0)
    for phase, weight, moved, speed in zip(
        phases, weights / omega, *motion_at(run, basis, omega, phases, step), strict=True
    ):
        t, tick = phase / omega, 1e-9
        stiffness, over, closing, _ = by_hand.flanks(t, moved, speed)
        growth = (by_hand.law(t + tick)[0] - by_hand.law(t - tick)[0]) / (2 * tick)
        force, error_rate = stiffness * over, by_hand.law(t)[2]
        rubbing = by_hand.friction(t, force, at_output=False)
        torque = by_hand.load.copy()
        torque[output] -= (rubbing @ turn) / (omega / teeth.gear)
        sums["power"] += weight * torque @ (turn + speed)
        sums["friction"] -= weight * rubbing @ (turn + speed)
        sums["even"] -= weight * rubbing @ turn
        sums["damping"] += weight * (
            speed @ by_hand.damping @ speed + MESH_DAMPING * closing @ (by_hand.rows @ speed)
        )
        sums["law"] += weight * (0.5 * growth @ over**2 - force @ error_rate)
    ends = []
    for phase, number in ((0.0, 0), (run.starts[-1] + run.lengths[-1], -1)):
        moved, speed = (part[0] for part in motion_at(run, basis, omega, np.array([phase]), [number]))
        ends.append(by_hand.energy(phase / omega, moved, speed))
    left = sums["power"] - sums["friction"] - sums["damping"] + sums["law"] - (ends[1] - ends[0])
    assert abs(sums["friction"]) > 1e-2 * abs(ends[1] - ends[0]) and sums["even"] > 0.0
    scale = abs(sums["friction"]) + abs(sums["damping"])
    agrees("work left over, J", left, 0.0, absolute=1e-8 * scale)


def parts_of_normals(layout, kind_of_parts):
    """Return the parts of friction that make up the force of the flanks' normals on the pinions."""
    parts = np.zeros((2, len(layout.meshes), kind_of_parts))
    for mesh, (_, g) in enumerate(layout.meshes):
        side = layout.gears[g].sign
        for flank, frame in enumerate(layout.flank_frames[g]):
            tangent, axis = side * frame.gear_normal[0], side * frame.gear_normal[1]
            tilts = side * np.array(frame.moment[:2]) / layout.pinion_arm
            whole = [-tangent, -frame.normal[2], -axis, -frame.arm, frame.arm, *-tilts]
            parts[flank, mesh] = whole[:kind_of_parts]
    return parts.reshape(-1, kind_of_parts)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("spur", [False, True])
@pytest.mark.parametrize("tilts", [False, True])
def test_friction_along_the_normal_acts_as_the_flank_does_on_bodies_and_casing(seed, spur, tilts):
    """Spur gears that tilt with a seat, or about a point below the pitch plane, lost parts of the moment."""
    rng = np.random.default_rng([61, seed])
    layout = make_small_layout()
    gears = layout.gears
    if tilts:
        gears = tuple(replace(g, body=replace(g.body, tilt=Tilt(0.3, 1e7, 0.01))) for g in gears)
    if spur:
        layout = replace(layout, gears=gears)
    else:
        layout = make_layout(replace(random_teeth(rng), pinion=20, gear=60), layout.pinions, gears)
    machine = make_small_machine(layout, place_on(mount_public(modes=0), layout))
    rows = np.tile(friction_rows(layout, machine.linear, machine.drive_line, at_output=False), (2, 1, 1))
    acting = np.einsum("fp,fpn->fn", parts_of_normals(layout, rows.shape[1]), rows)
    expected = -machine.linear.rows
    np.testing.assert_allclose(acting, expected, atol=1e-13 * np.abs(expected).max())
