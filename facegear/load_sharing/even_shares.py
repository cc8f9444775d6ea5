"""Even shares: load of every mesh if the branches of the machine shared its torques evenly."""

import numpy as np

from facegear.arrays import Array
from facegear.transmission.flanks import significant_forces
from facegear.transmission.layout import Layout, Role, Side
from facegear.transmission.machine import Machine


def even_shares(machine: Machine) -> Array:
    """Return the nominal even share of the load at each mesh.

    With one face gear a mesh carries its own pinion's torque. Between two, an input gives half of its torque
    to each, and idlers and tails share evenly what the lower gear passes on; without idlers the inputs serve
    the lower gear's own load in proportion to their torques. Mesh load factors (K_gamma of ISO 6336-1, AGMA
    6123) count from these.

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    (meshes,) array
        N along the line of action; nan where a mesh has none.
    """
    layout = machine.layout
    pinion_torques = machine.torques[: len(layout.pinions)] / layout.pinion_arm
    size = np.abs(
        significant_forces(_even_forces(layout, pinion_torques, machine.torques[len(layout.pinions) :]))
    )
    return np.where(size > 0.0, size, np.nan)


def _even_forces(layout: Layout, coefficients: Array, on_gears: Array) -> Array:
    """Forces (meshes,), positive where the pinion drives; own (pinions,): what each torque asks for."""
    if len(layout.gears) == 1:
        return coefficients
    inputs = np.array([pinion.role is Role.INPUT for pinion in layout.pinions])
    lower_gear = [gear.side for gear in layout.gears].index(Side.LOWER)
    torques = -on_gears[lower_gear] / layout.gear_arm
    lower = np.where(inputs, 0.5 * coefficients, 0.0)
    if inputs.all():
        total = coefficients.sum()
        lower = coefficients * (torques / total if total != 0.0 else 0.0)
    else:
        lower[~inputs] = (torques - lower.sum()) / (~inputs).sum()
    by_side = {Side.LOWER: lower, Side.UPPER: coefficients - lower}
    return np.concatenate([by_side[gear.side] for gear in layout.gears])
