"""Load sharing of one machine at one speed: averages and the curve over a mesh cycle."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.motion import Motion, Settings, State
from facegear.dynamics.steady_state.simulate import Model, SteadyState, build_model, simulate, static_start
from facegear.load_sharing.coefficients import lost_contact, sharing_coefficient
from facegear.load_sharing.groups import LoadGroup, load_groups
from facegear.load_sharing.options import SharingOptions
from facegear.load_sharing.statistics import Average, average
from facegear.transmission.layout import DOF_PER_BODY
from facegear.transmission.machine import Machine
from facegear.transmission.matrices import mass_diagonal

WATCHED = 2


@dataclass(frozen=True, eq=False)
class GroupSharing:
    """One group: coefficient and lost contact (cycles, samples), average, range of the means over starts."""

    group: LoadGroup
    coefficients: NDArray[np.float64]
    lost: NDArray[np.bool_]
    average: Average
    starts_low: float
    starts_high: float


@dataclass(frozen=True, eq=False)
class Sharing:
    """All groups of a machine at a speed; `motions` holds the class of motion reached from each start."""

    response: SteadyState
    groups: tuple[GroupSharing, ...]
    motions: tuple[str, ...]

    @property
    def period(self) -> float:
        """Mesh period in s."""
        return 2.0 * np.pi / self.response.frequency


def load_sharing(
    machine: Machine | Model, speed_rpm: float, settings: Settings, options: SharingOptions
) -> Sharing:
    """Coefficients from static equilibrium, and how far the means move from other, disturbed starts.

    The averages belong to the first start; with several stable motions, or an irregular one, the range over
    the starts says how much that choice matters. Raises NotConverged if an integration fails.
    """
    model = build_model(machine) if isinstance(machine, Machine) else machine
    settings = replace(watched(settings, options), window=options.cycles, samples=options.samples)
    first = static_start(model)
    responses = [simulate(model, speed_rpm, settings, start=first)]
    random = np.random.default_rng(options.seed)
    for _ in range(options.starts - 1):
        disturbed = disturb(model, first, options.spread, random)
        responses.append(simulate(model, speed_rpm, settings, start=disturbed))
    groups = tuple(
        _group(group, responses, options.confidence) for group in load_groups(model.machine.layout)
    )
    return Sharing(responses[0], groups, tuple(response.label for response in responses))


def watched(settings: Settings, options: SharingOptions) -> Settings:
    """Settings for averages: a motion that has not closed after a few times the cycles averaged is measured.

    A class that must hold for good, as that of the response at the nominal speed, is watched for longer.
    """
    return replace(settings, settle=min(settings.settle, WATCHED * options.cycles))


def disturb(model: Model, start: State, spread: float, random: np.random.Generator) -> State:
    """A start moved by normal displacements of size `spread` (m; rotations at the mesh radius)."""
    layout = model.machine.layout
    moved = spread * random.normal(size=layout.dof)
    pinions, bodies = DOF_PER_BODY * len(layout.pinions), DOF_PER_BODY * len(layout.bodies)
    moved[3:pinions:DOF_PER_BODY] /= layout.pinion_radius
    moved[pinions + 3 : bodies : DOF_PER_BODY] /= layout.gear_radius
    moved[bodies:] /= layout.mesh_radius
    return replace(
        start, displacement=start.displacement + model.reduced.basis.T @ (mass_diagonal(layout) * moved)
    )


def cycle_forces(response: SteadyState) -> NDArray[np.float64]:
    """Elastic mesh forces by cycle, shape (cycles, samples, meshes), N."""
    return response.forces.reshape(response.periods, response.per_period, -1)


def group_average(
    response: SteadyState, group: LoadGroup, confidence: float
) -> tuple[NDArray[np.float64], NDArray[np.bool_], Average]:
    """Coefficient and lost contact of a group, each (cycles, samples), and their average."""
    forces = cycle_forces(response)[..., group.meshes]
    coefficients, lost = sharing_coefficient(forces), lost_contact(forces)
    periodic = response.motion is Motion.PERIODIC
    return coefficients, lost, average(coefficients, lost, confidence, periodic)


def _group(group: LoadGroup, responses: list[SteadyState], confidence: float) -> GroupSharing:
    coefficients, lost, first = group_average(responses[0], group, confidence)
    others = [group_average(response, group, confidence)[2].mean for response in responses[1:]]
    means = [first.mean, *others]
    defined = [mean for mean in means if not np.isnan(mean)] or [float("nan")]
    return GroupSharing(group, coefficients, lost, first, min(defined), max(defined))
