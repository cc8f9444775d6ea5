"""Deflections, forces and contact of every mesh in a periodic motion of a branch."""

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
"""Minimum number of samples in each mesh period."""


@dataclass(frozen=True, eq=False)
class Measures:
    """Measures of each mesh in a periodic motion.

    Attributes
    ----------
    ac_rms, rms : (meshes,) array
        RMS of the deflection without and with its mean, m.
    minimum, maximum : (meshes,) array
        Smallest and largest deflection, m.
    peak_force : (meshes,) array
        Largest elastic force, N.
    fractions : (3, meshes) array
        Fraction of the time open, on the drive flank, and on the back flank.
    """

    ac_rms: Array
    rms: Array
    minimum: Array
    maximum: Array
    peak_force: Array
    fractions: Array


def measures(period_map: PeriodMap, point: BranchPoint) -> Measures:
    """Compute the measures of an orbit, by the same sums as those of a sweep.

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    point : BranchPoint
        The orbit.

    Returns
    -------
    Measures
        Measures of each mesh.
    """
    integrator = period_map.integrator(point.u)
    system = integrator.system
    state = integrator.by_phase(period_map.state(point.z, point.u))
    window = run_window(integrator, state, period_map.period, SAMPLES)
    deflections = each_deflection(system, window.samples, window.per_period)
    moments = window.averages.meshes(True)
    return Measures(
        ac_rms=moments.ac_rms,
        rms=moments.rms,
        minimum=moments.minimum,
        maximum=moments.maximum,
        peak_force=largest_mesh_forces(system, deflections, window.per_period, wraps=True),
        fractions=mesh_fractions(system, window.fractions[:, : system.contacts], deflections),
    )
