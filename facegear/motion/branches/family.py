"""Systems that depend on one positive parameter, and extrema of their deflections."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array
from facegear.machine.machine import mesh_frequency
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.integrator.reduction import modal_damping
from facegear.motion.integrator.system import System
from facegear.motion.steady_state.simulate import Model

MACHINE_PARAMETERS = ("torque", "backlash", "mesh_damping", "bearing_stiffness")
"""Parameters of a machine, beside its speed, on which a branch or a locus may put a factor."""


@dataclass(frozen=True, eq=False)
class Family:
    """Systems that depend on one positive parameter.

    Branches are followed in its natural logarithm. Every system has the same length scale.

    Attributes
    ----------
    name : str
        Name of the parameter.
    at : callable
        Returns the system and its angular mesh frequency, rad/s, at a value of the parameter.
    """

    name: str
    at: Callable[[float], tuple[System, float]]


@dataclass(frozen=True, eq=False)
class Plane:
    """Systems that depend on two positive parameters.

    Attributes
    ----------
    names : tuple of str
        Names of both parameters.
    at : callable
        Returns the system and its angular mesh frequency, rad/s, at a value of each parameter.
    """

    names: tuple[str, str]
    at: Callable[[float, float], tuple[System, float]]

    def line(self, second: float) -> Family:
        """Return the family in the first parameter at a fixed second one.

        Parameters
        ----------
        second : float
            Second parameter, in its unit.

        Returns
        -------
        Family
            Systems, by the first parameter.
        """
        return Family(self.names[0], lambda first: self.at(first, second))

    def across(self, first: float) -> Family:
        """Return the family in the second parameter at a fixed first one.

        Parameters
        ----------
        first : float
            First parameter, in its unit.

        Returns
        -------
        Family
            Systems, by the second parameter.
        """
        return Family(self.names[1], lambda second: self.at(first, second))


def speed_family(model: Model) -> Family:
    """Return the systems of a machine over its pinion speed.

    Parameters
    ----------
    model : Model
        Reduced machine.

    Returns
    -------
    Family
        Parameter `speed_rpm`, rpm.
    """
    layout = model.machine.layout
    return Family("speed_rpm", lambda speed: (model.system, TAU * mesh_frequency(layout, speed)))


def machine_plane(model: Model, second: str) -> Plane:
    """Return the systems of a machine over its pinion speed and a factor on another parameter, see
    scale_parameter().

    Parameters
    ----------
    model : Model
        Reduced machine.
    second : str
        One of MACHINE_PARAMETERS.

    Returns
    -------
    Plane
        Parameters `speed_rpm`, rpm, and `<second>_factor`, dimensionless.
    """
    layout = model.machine.layout

    def at(speed: float, factor: float) -> tuple[System, float]:
        return scale_parameter(model, second, factor), TAU * mesh_frequency(layout, speed)

    return Plane(("speed_rpm", f"{second}_factor"), at)


def scale_parameter(model: Model, parameter: str, factor: float) -> System:
    """Return the system of a machine with one parameter multiplied, in the same reduced coordinates.

    "torque" scales the mean torques and not other forces. "bearing_stiffness" scales the damping that is
    proportional to it, too. The length scale stays.

    Parameters
    ----------
    model : Model
        Reduced machine.
    parameter : str
        All torques ("torque"), "backlash", "mesh_damping", or all bearing stiffnesses ("bearing_stiffness").
    factor : float
        Factor on the parameter, dimensionless.

    Returns
    -------
    System
        Changed equations of motion.

    Raises
    ------
    ValueError
        For another parameter.
    """
    system, linear = model.system, model.machine.linear
    if factor == 1.0:
        return system
    if parameter == "torque":
        load = system.load.copy()
        load[:, 1, 0] += (factor - 1.0) * (model.reduction.basis.T @ linear.torques)
        return replace(system, load=load)
    if parameter == "backlash":
        return replace(system, lower=system.lower * factor, upper=system.upper * factor)
    if parameter == "mesh_damping":
        return replace(system, mesh_damping=system.mesh_damping * factor)
    if parameter == "bearing_stiffness":
        # Of shafts, too; a config refuses it beside torsional springs and bodies, which have no bearing.
        omega_squared = system.omega_squared * factor
        extra_damping = system.damping - modal_damping(linear, system.omega_squared)
        return replace(
            system, omega_squared=omega_squared, damping=modal_damping(linear, omega_squared) + extra_damping
        )
    raise ValueError(f"{parameter!r}: one of {', '.join(MACHINE_PARAMETERS)}")


MAX_EXTREMA = 64
"""Number of extrema of a mesh that are stored for each mesh period."""


def extrema(integrator: Integrator, state: Array, periods: int) -> Array:
    """Return the maxima and minima of each row's deflection over a run, sorted and filled up.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    state : (2, n) array
        State by phase at the start, m and m/rad.
    periods : int
        Number of mesh periods.

    Returns
    -------
    (m, 2, most) array
        Maxima, then minima of each mesh in falling order, m; minus infinity fills the rows that have fewer.

    Raises
    ------
    NotConverged
        If a step fails.
    """
    values, counts = integrator.extrema(state, periods, MAX_EXTREMA * periods)
    return -np.sort(-values[:, :, : min(counts.max(), values.shape[2])])
