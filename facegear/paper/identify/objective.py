"""Misfit of one set of inputs against the claims used in the fit."""

from dataclasses import dataclass, replace

import numpy as np

from facegear.dynamics.motion import Settings, State
from facegear.dynamics.steady_state.simulate import Model, SteadyState, build_model, simulate, static_start
from facegear.errors import NotConverged
from facegear.load_sharing.groups import GroupKind, load_groups
from facegear.load_sharing.run import group_average
from facegear.paper.identify.resonance import jump_distance
from facegear.paper.identify.targets import Targets
from facegear.transmission.machine import Machine

SWEEP_POINTS = 17
SWEEP_WORTH = 1.5
"""Sharing misfit above which jumps are not looked for and count as far off: such a set cannot win."""


@dataclass(frozen=True)
class Misfit:
    """Root mean square of all deviations over their tolerances, that of the coefficients alone, the largest
    deviation of a mean, distances of the jumps (relative), and the coefficients at each backlash."""

    total: float
    sharing: float
    worst_mean: float
    jumps: tuple[float, ...]
    coefficients: tuple[tuple[float, float, float], ...]


def misfit(machine: Machine, targets: Targets, settings: Settings, sweep: Settings) -> Misfit:
    """Compare a machine with the targets, each backlash starting from its own static equilibrium.

    A set whose coefficients are undefined throughout, or whose integration fails, gets the largest misfit.
    """
    reach = targets.cap * targets.speed_tolerance
    nothing = (float("nan"),) * 3
    worst = Misfit(targets.cap, targets.cap, float("inf"), (reach,) * len(targets.jumps), (nothing,))
    try:
        found = tuple(
            _from_rest(replace(machine, half_backlash=0.5 * target.backlash), targets.speed, settings)
            for target in targets.backlash
        )
        wanted = np.array([(one.inputs, one.idlers, one.idlers_minimum) for one in targets.backlash])
        off = np.abs(np.array(found) - wanted)
        if not np.isfinite(off).all():
            return worst
        units = np.minimum(off / targets.coefficient_tolerance, targets.cap)
        sharing = float(np.sqrt((units**2).mean()))
        jumps = (reach,) * len(targets.jumps)
        if sharing <= SWEEP_WORTH:
            model = build_model(machine)
            start = static_start(model)
            jumps = tuple(
                jump_distance(model, speed, reach, SWEEP_POINTS, sweep, start) for speed in targets.jumps
            )
    except NotConverged:
        return worst
    everything = np.concatenate([units.ravel(), np.array(jumps) / targets.speed_tolerance])
    total = float(np.sqrt((everything**2).mean()))
    return Misfit(total, sharing, float(off[:, :2].max()), jumps, found)


def _from_rest(machine: Machine, speed: float, settings: Settings) -> tuple[float, float, float]:
    model = build_model(machine)
    return coefficients(model, speed, settings, static_start(model))


def coefficients(model: Model, speed: float, settings: Settings, start: State) -> tuple[float, float, float]:
    """Means of inputs and idlers and the idlers' minimum in a cycle, at a speed in rpm."""
    response = simulate(model, speed, settings, start=start)
    inputs = _averages(response, model, GroupKind.INPUTS)
    idlers = _averages(response, model, GroupKind.IDLERS)
    return float(inputs[:, 0].mean()), float(idlers[:, 0].mean()), float(idlers[:, 1].mean())


def _averages(response: SteadyState, model: Model, kind: GroupKind) -> np.ndarray:
    """Mean and one-cycle minimum of each group of a kind, shape (groups, 2)."""
    groups = [group for group in load_groups(model.machine.layout) if group.kind is kind]
    averages = [group_average(response, group, 0.95)[2] for group in groups]
    return np.array([(one.mean, one.cycle_minimum) for one in averages])
