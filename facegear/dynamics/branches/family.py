"""Systems that depend on one positive parameter, such as the speed or the torque."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from facegear.dynamics.integrator.compiled import TAU
from facegear.dynamics.integrator.reduction import modal_damping
from facegear.dynamics.integrator.system import System
from facegear.dynamics.steady_state.simulate import Model
from facegear.transmission.machine import mesh_frequency

MACHINE_PARAMETERS = ("torque", "backlash", "mesh_damping", "bearing_stiffness")


@dataclass(frozen=True, eq=False)
class Family:
    """at(value) gives the system and its angular mesh frequency (rad/s) at a value of the parameter.

    The value is positive; branches are followed in its logarithm. Every system has the same length scale.
    """

    name: str
    at: Callable[[float], tuple[System, float]]


@dataclass(frozen=True, eq=False)
class Plane:
    """at(first, second): the system and its angular mesh frequency at two positive parameters."""

    names: tuple[str, str]
    at: Callable[[float, float], tuple[System, float]]

    def line(self, second: float) -> Family:
        """The family in the first parameter at a fixed second one."""
        return Family(self.names[0], lambda first: self.at(first, second))

    def across(self, first: float) -> Family:
        """The family in the second parameter at a fixed first one."""
        return Family(self.names[1], lambda second: self.at(first, second))


def speed_family(model: Model) -> Family:
    """A machine over its pinion speed in rpm."""
    layout = model.machine.layout
    return Family("speed_rpm", lambda speed: (model.system, TAU * mesh_frequency(layout, speed)))


def machine_plane(model: Model, second: str) -> Plane:
    """A machine over its pinion speed in rpm and a factor on one of MACHINE_PARAMETERS."""
    layout = model.machine.layout

    def at(speed: float, factor: float) -> tuple[System, float]:
        return changed(model, second, factor), TAU * mesh_frequency(layout, speed)

    return Plane(("speed_rpm", f"{second}_factor"), at)


def changed(model: Model, parameter: str, factor: float) -> System:
    """The system of a machine with all torques, the backlash, the mesh damping or all bearing stiffnesses
    multiplied, in the same coordinates. Raises ValueError for another parameter.
    """
    system, linear = model.system, model.machine.linear
    if factor == 1.0:
        return system
    if parameter == "torque":
        load = system.load.copy()
        load[:, 1, 0] += (factor - 1.0) * (model.reduced.basis.T @ linear.torques)
        return replace(system, load=load)
    if parameter == "backlash":
        return replace(system, lower=system.lower * factor, upper=system.upper * factor)
    if parameter == "mesh_damping":
        return replace(system, mesh_damping=system.mesh_damping * factor)
    if parameter == "bearing_stiffness":
        # Of shafts, too; a config refuses it beside torsional springs and bodies, which have no bearing.
        scaled = system.omega_squared * factor
        own = system.damping - modal_damping(linear, system.omega_squared)
        return replace(system, omega_squared=scaled, damping=modal_damping(linear, scaled) + own)
    raise ValueError(f"{parameter!r}: one of {', '.join(MACHINE_PARAMETERS)}")
