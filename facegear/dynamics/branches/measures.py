"""What a periodic motion means for the machine: deflections, forces and contact of every mesh."""

from dataclasses import dataclass

from facegear.arrays import Array
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import BranchPoint
from facegear.dynamics.steady_state.mesh_samples import (
    each_deflection,
    largest_mesh_forces,
    mesh_fractions,
)
from facegear.dynamics.steady_state.window import run_window

SAMPLES = 64


@dataclass(frozen=True, eq=False)
class Measures:
    """Of each mesh, shape (meshes,): RMS without and with mean, least and largest deflection in m, largest
    elastic force in N. fractions (3, meshes): time open, on drive and
    back flank.
    """

    ac_rms: Array
    rms: Array
    minimum: Array
    maximum: Array
    peak_force: Array
    fractions: Array


def measures(period_map: PeriodMap, point: BranchPoint) -> Measures:
    """Measures of an orbit, by the same sums as those of a sweep."""
    integrator = period_map.integrator(point.u)
    system = integrator.system
    state = integrator.by_phase(period_map.state(point.z, point.u))
    window = run_window(integrator, state, period_map.period, SAMPLES)
    each = each_deflection(system, window.samples, window.per_period)
    moments = window.averages.meshes(True)
    return Measures(
        ac_rms=moments.ac_rms,
        rms=moments.rms,
        minimum=moments.minimum,
        maximum=moments.maximum,
        peak_force=largest_mesh_forces(system, each, window.per_period, wraps=True),
        fractions=mesh_fractions(system, window.fractions[:, : system.contacts], each),
    )
