"""Vibration at the orders of the gears' turns: runouts, pitch deviations and single teeth, linearised.

What differs from tooth to tooth repeats with a turn of the pinions or of the face gears. About the place
where the torques hold the machine, with the flanks that carry at their mean stiffness k, an error e of the
flanks at one frequency w gives

    (K + rows^T k rows + i w (D + rows^T c rows) - w^2 M) q = rows^T (k + i w c) e
    F = k (rows q - e)

with W N, W^2 P and W G of bodies that turn. k is a matrix that couples the two flanks of a wedged mesh on a
gear that bends (`flank_springs`). Flanks that part and the mesh stiffness' own variation, which
spreads each order to its sidebands about the mesh frequency, are left out; sidebands that the errors have by
themselves, as their curves differ within a mesh cycle, are in.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array, ComplexArray, Integers, Mask
from facegear.machine.disturbances import Excitation
from facegear.machine.flank_errors import slow_errors
from facegear.machine.flanks import flank_dampers
from facegear.machine.linear_model import LinearModel
from facegear.machine.loaded_modes import pressed_springs
from facegear.machine.machine import Machine

SAMPLES = 32
"""Samples of the errors in a mesh cycle."""
LAST = 1.5
"""Frequency over that of the mesh up to which orders are kept."""
ERROR_TOLERANCE = 1e-9
"""Part of the largest error below which an order is rounding."""
GEARS = ("pinion", "face_gear")
"""Names of the bodies whose turns are counted."""


@dataclass(frozen=True, eq=False)
class TurnOrders:
    """Errors of the flanks at n orders of turns.

    Attributes
    ----------
    turning
        Name from GEARS for each order: the gear whose turns it counts.
    order : (n,)
        Vibrations in one turn of that gear.
    teeth : (n,)
        Teeth of that gear: the frequency is `order` over `teeth` times the mesh frequency.
    error : (n, 2 meshes)
        Complex amplitudes a of errors Re[a e^(i w t)], m, drive flanks first; a positive error keeps a
        flank from touching.
    """

    turning: list[str]
    order: Integers
    teeth: Integers
    error: ComplexArray

    def select(self, rows: Sequence[int]) -> "TurnOrders":
        """Return the orders in some rows.

        Parameters
        ----------
        rows : Sequence of int
            Their indices.

        Returns
        -------
        TurnOrders
            Errors in m.
        """
        numbers = np.array(rows, dtype=np.int64)
        turning = [self.turning[row] for row in rows]
        return TurnOrders(turning, self.order[numbers], self.teeth[numbers], self.error[numbers])

    @property
    def of_mesh(self) -> Array:
        """Frequency of each order over that of the mesh, (n,): order / teeth."""
        return np.asarray(self.order / self.teeth)


def turn_orders(machine: Machine, last: float = LAST) -> TurnOrders:
    """Return the orders of runouts, pitch deviations and single teeth, by a Fourier transform over a
    whole turn.

    Parameters
    ----------
    machine : Machine
        A machine whose meshes have two flanks each.
    last : float
        Highest frequency over the mesh frequency, dimensionless.

    Returns
    -------
    TurnOrders
        Orders of the pinions, then of the face gears, whose error is above ERROR_TOLERANCE of the
        largest; amplitudes in m. Both gears may have an order at the same frequency.
    """
    layout = machine.layout
    turning: list[str] = []
    order: list[int] = []
    teeth: list[int] = []
    error = []
    for gear, count in zip(GEARS, (layout.pinion_teeth, layout.gear_teeth), strict=True):
        cycles = np.arange(count * SAMPLES) / SAMPLES
        curves = slow_errors(_errors_of(machine, gear), cycles)
        amplitudes = 2.0 * np.fft.rfft(curves, axis=0) / cycles.size
        for number in range(1, int(last * count) + 1):
            turning.append(gear)
            order.append(number)
            teeth.append(count)
            error.append(amplitudes[number])
    errors = np.array(error)
    largest = np.abs(errors).max(axis=1)
    is_significant = largest > ERROR_TOLERANCE * largest.max(initial=0.0)
    every = TurnOrders(turning, np.array(order), np.array(teeth), errors)
    return every.select(np.flatnonzero(is_significant).tolist())


def _errors_of(machine: Machine, gear: str) -> Machine:
    """Return the machine with slow errors of the pinions alone, or of the face gears alone; `gear` is
    from GEARS.
    """
    flaws = machine.imperfections
    even, teeth = flaws.without_slow_errors, flaws.teeth
    if gear == "pinion":
        imperfections = replace(even, pinion_runout=flaws.pinion_runout, pinion_pitch=flaws.pinion_pitch)
        curves = None if teeth is None else replace(teeth, gear=_flat(teeth.gear))
    else:
        imperfections = replace(even, gear_runout=flaws.gear_runout, gear_pitch=flaws.gear_pitch)
        curves = None if teeth is None else replace(teeth, pinion=_flat(teeth.pinion))
    return replace(machine, imperfections=replace(imperfections, teeth=curves))


def _flat(curves: tuple[Array, Array]) -> tuple[Array, Array]:
    """Return zeros in place of two curves (drive and back flank), of the same shapes."""
    return np.zeros_like(curves[0]), np.zeros_like(curves[1])


@dataclass(frozen=True, eq=False)
class LoadedMachine:
    """Linear model of a machine about its static load.

    Attributes
    ----------
    linear
        Bodies and bearings.
    springs : (2 meshes, 2 meshes)
        Stiffness of the flanks, N/m; the two flanks of a wedged mesh may be coupled.
    dampers : (2 meshes,)
        Damping of the flanks, N s/m.
    """

    linear: LinearModel
    springs: Array
    dampers: Array

    @property
    def contact_mask(self) -> Mask:
        """Mask of the flanks that carry load, (2 meshes,)."""
        return np.asarray(np.diagonal(self.springs) > 0.0)

    def forces(self, orders: TurnOrders, speed_rpm: float, pinion_teeth: int) -> ComplexArray:
        """Return the elastic forces of the flanks that carry load, excited by errors at a speed.

        Parameters
        ----------
        orders : TurnOrders
            Errors of the flanks at n orders.
        speed_rpm : float
            Speed of the pinions, rpm.
        pinion_teeth : int
            Number of teeth of the pinions.

        Returns
        -------
        (n, 2 meshes) complex array
            Amplitudes, N, beside the static force; 0 for flanks without load.
        """
        rows, speed = self.linear.rows, speed_rpm * np.pi / 30.0
        forces = np.zeros_like(orders.error)
        for row, of_mesh in enumerate(orders.of_mesh):
            omega = speed * pinion_teeth * of_mesh
            flank = self.springs + 1j * omega * np.diag(self.dampers)
            motion = np.linalg.solve(self._dynamic(speed, omega), rows.T @ (flank @ orders.error[row]))
            forces[row] = self.springs @ (rows @ motion - orders.error[row])
        return forces

    def excited_motion(self, machine: Machine, excitation: Excitation, speed_rpm: float) -> ComplexArray:
        """Return the complex amplitudes of all coordinates under one periodic torque.

        Parameters
        ----------
        machine : Machine
            The machine of this model.
        excitation : Excitation
            The torque.
        speed_rpm : float
            Speed of the pinions, rpm.

        Returns
        -------
        (n,) complex array
            m and rad; the common rotation of all bodies is left out.
        """
        speed = speed_rpm * np.pi / 30.0
        omega = speed * machine.layout.pinion_teeth * excitation.of_mesh
        force = excitation.amplitude * np.exp(1j * excitation.phase)
        torque = force * machine.straining_torque(excitation.body)
        return np.asarray(np.linalg.solve(self._dynamic(speed, omega), torque))

    def motion(self, error: ComplexArray, force: ComplexArray, speed: float, omega: float) -> ComplexArray:
        """Return the complex amplitudes of all coordinates by errors and forces of the flanks.

        Parameters
        ----------
        error, force : (2 meshes,) complex array
            Errors (m), which the flanks' springs and dampers feel, and forces (N) that press the flanks
            apart.
        speed : float
            Speed of the pinions, rad/s.
        omega : float
            Angular frequency of the excitation, rad/s.

        Returns
        -------
        (n,) complex array
            m and rad.
        """
        flank = self.springs + 1j * omega * np.diag(self.dampers)
        loads = self.linear.rows.T @ (flank @ error - force)
        return np.asarray(np.linalg.solve(self._dynamic(speed, omega), loads))

    def flank_forces(self, motion: ComplexArray) -> ComplexArray:
        """Return the complex amplitudes of the elastic forces of the flanks that carry load.

        Parameters
        ----------
        motion : (n,) complex array
            Amplitudes of all coordinates, m and rad.

        Returns
        -------
        (2 meshes,) complex array
            N, drive flanks first.
        """
        return np.asarray(self.springs @ (self.linear.rows @ motion))

    def _dynamic(self, speed: float, omega: float) -> ComplexArray:
        """Return the dynamic stiffness (n, n) of coordinates, N/m, at a pinion speed and an excitation
        frequency, both in rad/s: the bracket on the left of this module's equation, with the terms of
        turning bodies.
        """
        linear, rows = self.linear, self.linear.rows
        stiffness = linear.stiffness + rows.T @ self.springs @ rows
        damping = linear.damping + (self.dampers * rows.T) @ rows
        if linear.spin is not None:
            stiffness = stiffness + speed * linear.spin.circulatory + speed**2 * linear.spin.centrifugal
            damping = damping + speed * linear.spin.gyroscopic
        return np.asarray(stiffness + 1j * omega * damping - omega**2 * linear.mass)

    def at_rest(self, orders: TurnOrders) -> ComplexArray:
        """Return the elastic forces of the flanks that carry load at a speed close to zero, without
        inertia and damping.

        Parameters
        ----------
        orders : TurnOrders
            Errors of the flanks at n orders.

        Returns
        -------
        (n, 2 meshes) complex array
            Amplitudes, N.
        """
        rows = self.linear.rows
        stiffness = self.linear.stiffness + rows.T @ self.springs @ rows
        loads = rows.T @ (self.springs @ orders.error.T)
        displacements = np.linalg.lstsq(stiffness, loads, rcond=1e-13)[0]
        return np.asarray((self.springs @ (rows @ displacements - orders.error.T)).T)


def loaded_machine(machine: Machine) -> LoadedMachine:
    """Return the linear model of a machine about its mean torques.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.

    Returns
    -------
    LoadedMachine
        SI units.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    linear, springs = pressed_springs(machine)
    return LoadedMachine(linear, springs, flank_dampers(machine.damping, np.diagonal(springs) > 0.0))


def mesh_amplitudes(forces: ComplexArray, contact_mask: Mask) -> Array:
    """Return the force amplitude of the flank of each mesh that carries load.

    Parameters
    ----------
    forces : (..., 2 meshes) complex array
        Amplitudes of the flanks, N, drive flanks first.
    contact_mask : (2 meshes,) array of bool
        Which flanks carry load.

    Returns
    -------
    (..., meshes) array
        N; 0 for an open mesh, and the drive flank's where both flanks carry.
    """
    drive, back = np.split(np.abs(forces), 2, axis=-1)
    first, second = np.split(contact_mask, 2)
    return np.asarray(np.where(first, drive, np.where(second, back, 0.0)))
