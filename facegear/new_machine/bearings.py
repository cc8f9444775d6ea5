"""Bearings with which a split-torque machine splits its torque: soft for inputs, stiff for idlers."""

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite

import numpy as np

from facegear.arrays import Array
from facegear.machine.layout import Role
from facegear.machine.machine import Machine
from facegear.sharing.closed_form import SplitMachine
from facegear.sharing.hunting import HuntingCycle, hunting_cycle, hunting_length

STIFF = 5.0
"""Radial stiffness of a bearing over that of a mesh, where load sharing does not depend on it."""
IDLERS = (5.0, 3.0, 2.0, 1.2, 0.7, 0.4, 0.2, 0.1, 0.06, 0.03)
"""Radial stiffness of the idlers' bearings over that of a mesh, the stiffest tried first.

Stiff idlers even out the inputs, soft ones even out the idlers among each other.
"""
AIMS = (1.20, 1.15, 1.10, 1.05)
"""K_gamma of the inputs without errors, tried in this order; errors add to it."""
SOFTEST = 0.005
"""Softest radial bearing of an input over a mesh: some 2e6 N/m, a pinion on a quill shaft."""
LARGEST_K_GAMMA, LEAST_K_GAMMA = 1.3, 0.7
"""K_gamma up to which a split counts as right, and down to which that of idlers does."""
MARGIN = 0.94
"""Part of what a right split allows that an estimate may reach.

Estimates take a constant mesh stiffness. Over the machines of docs/measured/starters.csv they were up to
5.5 % below the numbers of the computed stiffness."""
POSITIONS, CYCLES = 2, 120
"""Positions in each mesh cycle, and cycles of the hunting cycle, that an estimate takes."""


@dataclass(frozen=True)
class Bearings:
    """Radial stiffness, N/m, of the bearings of inputs, idlers and face gears."""

    inputs: float
    idlers: float
    gears: float


@dataclass(frozen=True, eq=False)
class Split:
    """Load sharing of a machine at rest over the hunting cycle, errors included.

    Attributes
    ----------
    inputs : float
        Largest K_gamma of a mesh of an input.
    idlers : (2,) array
        Least and largest K_gamma of the idlers' meshes that share a load, nan without idlers.
    group_ratio : float
        Largest load of a path over the mean of its group.
    mesh_torques : (meshes,) array
        Torque on a pinion, N m, that the mean load of each mesh balances.
    """

    inputs: float
    idlers: Array
    group_ratio: float
    mesh_torques: Array

    @property
    def excess(self) -> float:
        """Largest ratio of a number of the split to what a right split allows, dimensionless; at most 1
        if right.

        Allowed are LARGEST_K_GAMMA for inputs, idlers and the group ratio, and LEAST_K_GAMMA from below
        for idlers.
        """
        low, high = self.idlers
        return float(
            max(
                self.inputs / LARGEST_K_GAMMA,
                high / LARGEST_K_GAMMA,
                LEAST_K_GAMMA / max(low, 1e-9),
                self.group_ratio / LARGEST_K_GAMMA,
            )
        )


@dataclass(frozen=True)
class ChosenBearings:
    """Bearings, and the split that they give."""

    bearings: Bearings
    split: Split


def choose_bearings(
    closed_form: SplitMachine,
    wishes: tuple[float | None, float | None, float | None],
    machine_with: Callable[[Bearings], Machine],
) -> ChosenBearings:
    """Choose the radial bearing stiffness of inputs, idlers and face gears so that the torque is split
    evenly.

    Tried are idler bearings from stiff to soft (IDLERS) and, for each, input bearings by which the closed
    form gives K_gamma of the inputs in AIMS. Each trial is checked by statics over the hunting cycle with
    errors.

    Parameters
    ----------
    closed_form : SplitMachine
        The machine without errors, for the closed form.
    wishes : tuple of three floats or None
        Radial stiffness of inputs, idlers and gears, N/m, each None where the choice is left.
    machine_with : callable
        Function from bearings to the machine with them and its errors.

    Returns
    -------
    ChosenBearings
        The first bearings whose `Split.excess` is at most MARGIN, else those with the smallest, and their
        split.
    """
    given_input, given_idler, given_gear = wishes
    mesh = closed_form.mesh_stiffness
    best: ChosenBearings | None = None
    for idler in [given_idler] if given_idler is not None else [factor * mesh for factor in IDLERS]:
        for aim in AIMS if given_input is None else AIMS[:1]:
            soft = closed_form.input_bearing_for(aim, idler) if given_input is None else given_input
            if given_input is None:
                soft = min(max(soft, SOFTEST * mesh), STIFF * mesh) if isfinite(soft) else STIFF * mesh
            bearings = Bearings(
                round_stiffness(soft),
                round_stiffness(idler),
                round_stiffness(STIFF * mesh) if given_gear is None else given_gear,
            )
            candidate = ChosenBearings(bearings, split_of(machine_with(bearings)))
            if best is None or candidate.split.excess < best.split.excess:
                best = candidate
            if candidate.split.excess <= MARGIN:
                return candidate
    assert best is not None
    return best


def split_of(machine: Machine) -> Split:
    """Estimate how a machine shares its load at rest, by about CYCLES mesh cycles spread over the hunting
    cycle.

    Parameters
    ----------
    machine : Machine
        The machine with its bearings and errors.

    Returns
    -------
    Split
        K_gamma of inputs and idlers, largest ratio of a path's load to the mean of its group, and mean
        torque of each mesh.
    """
    run = hunting_cycle(machine, POSITIONS, max(hunting_length(machine) // CYCLES, 1))
    roles = [machine.layout.pinions[pinion].role for pinion, _ in machine.layout.meshes]
    factors = run.mesh_load_factors
    inputs = np.array([role is Role.INPUT for role in roles])
    shares_load = np.zeros(inputs.size, dtype=bool)
    for group in run.groups:
        shares_load[list(group.meshes)] = True
    idlers = factors[~inputs & shares_load]
    return Split(
        inputs=float(np.nanmax(factors[inputs])),
        idlers=np.array([idlers.min(), idlers.max()]) if idlers.size else np.full(2, np.nan),
        group_ratio=_group_ratio(run),
        mesh_torques=run.loads.mean(axis=0) * machine.layout.pinion_arm,
    )


def _group_ratio(run: HuntingCycle) -> float:
    """Return the largest load of a path over the mean of its group, over all positions of a hunting
    cycle.

    Only groups that split a load count; NaN without any.
    """
    ratios = [run.group_ratios(group).max() for group in run.groups if group.splits_load]
    return float(max(ratios, default=np.nan))


def smallest_torque(closed_form: SplitMachine, bearings: Bearings, torque: float) -> float:
    """Find the input torque from which inputs on the softest bearings reach a K_gamma of at most
    LARGEST_K_GAMMA.

    The closed form without errors is evaluated at torques that rise by factors of 2^(1/4), up to 2^11.75
    times.

    Parameters
    ----------
    closed_form : SplitMachine
        The machine in closed form, at its present torque.
    bearings : Bearings
        Bearings of the machine, of which those of the idlers are taken.
    torque : float
        Present torque of an input, N m.

    Returns
    -------
    float
        First of these torques of an input that is enough, N m, the present one included; infinite if none
        is.
    """
    loop = closed_form.input_k_gamma(SOFTEST * closed_form.mesh_stiffness, bearings.idlers)
    if loop <= LARGEST_K_GAMMA:
        return torque
    factors = 2.0 ** np.arange(0.25, 12.0, 0.25)
    for factor in factors:
        heavier = SplitMachine(
            closed_form.inputs,
            closed_form.idlers,
            closed_form.input_force * float(factor),
            closed_form.mesh_stiffness,
            closed_form.backlash,
            closed_form.idler_push,
        )
        if heavier.input_k_gamma(SOFTEST * closed_form.mesh_stiffness, bearings.idlers) <= LARGEST_K_GAMMA:
            return torque * float(factor)
    return float("inf")


def round_stiffness(stiffness: float) -> float:
    """Round a stiffness to three significant digits, as a config writes it.

    Parameters
    ----------
    stiffness : float
        Stiffness, N/m.

    Returns
    -------
    float
        Rounded stiffness, N/m.
    """
    return float(f"{stiffness:.3g}")
