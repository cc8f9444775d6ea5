"""Root stress compared with that of a mesh twice as fine, and the cost of reading it."""

import resource
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np
import scipy.sparse as sp
from threadpoolctl import threadpool_limits

from facegear.arrays import Array
from facegear.contact.gear_flank import GearFlank, gear_flank
from facegear.contact.options import ContactPlan
from facegear.strength.root_stress import down_the_fillet, root_stress
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.mesh_sizes import MeshSizes
from validation.contact.line_load import LoadedTooth, loaded_tooth
from validation.contact.stress_levels import HALVED_SIZES

Result = TypeVar("Result")

TEETH = 3
"""Number of teeth of the sector, its cut faces free; the middle one is loaded."""
ENDS = 0.1
"""Part of the face at each end that is left out: an edge's stress is no element's to give."""
REPEATS = 3
"""Number of runs whose least time counts."""
POSITIONS, LOADS, NODES = 32, 1000, 80
"""Numbers of positions and loads of the timed root stress, and of nodes of each of three pairs that carry
load."""


def stress_convergence(
    design: PairDesign, body: str, sizes: MeshSizes, material: Material, halvings: Sequence[str]
) -> Iterator[dict[str, float | str]]:
    """Yield one row a halving: largest tension (MPa) below an even line load of 1 kN, and its change.

    error_percent: of the largest value; largest_error_percent: of the largest down the fillet, anywhere along
    the face but at its ends. CPU seconds of both meshes, condensation and gauges included.

    Parameters
    ----------
    design : PairDesign
        The pair.
    body : str
        `pinion` or `face_gear`.
    sizes : MeshSizes
        Mesh sizes.
    material : Material
        Material of the body.
    halvings : Sequence[str]
        Keys of HALVED_SIZES.

    Yields
    ------
    dict
        Values by column; errors in percent, stress in MPa.
    """
    coarse, seconds = _measure_time(design, body, sizes, material)
    at, stress = _along_the_face(coarse)
    for sizes_halved in halvings:
        changes = {
            name: 0.5 * getattr(sizes, name) for name in HALVED_SIZES[sizes_halved] if getattr(sizes, name)
        }
        fine, fine_seconds = _measure_time(design, body, replace(sizes, **changes), material)
        reference = np.interp(at, *_along_the_face(fine))
        yield {
            "body": body,
            "halved": sizes_halved,
            "dof": 3 * len(coarse.mesh.nodes),
            "fine_dof": 3 * len(fine.mesh.nodes),
            "stress_mpa": 1e-3 * float(stress.max()),
            "fine_stress_mpa": 1e-3 * float(reference.max()),
            "error_percent": 100.0 * float(stress.max() / reference.max() - 1.0),
            "largest_error_percent": 100.0 * float(np.abs(stress / reference - 1.0).max()),
            "cpu_s": seconds,
            "fine_cpu_s": fine_seconds,
        }


def stress_costs(
    design: PairDesign, body: str, sizes: MeshSizes, material: Material, plan: ContactPlan
) -> dict[str, float | str]:
    """Measure the CPU seconds of the compliance of one body without and with gauges, and of many loads' root
    stress.

    Both in turn, the least of REPEATS each: the load of other programs on memory counts in CPU seconds as
    well.

    Parameters
    ----------
    design : PairDesign
        The pair.
    body : str
        `pinion` or `face_gear`.
    sizes : MeshSizes
        Mesh sizes.
    material : Material
        Material of the body.
    plan : ContactPlan
        Plan of the contact analysis.

    Returns
    -------
    dict[str, float or str]
        Values by column, times in s, memory in GB.
    """
    plain, reading = (replace(plan, root_stress=gauge_rows) for gauge_rows in (False, True))
    without = with_gauges = np.inf
    for _ in range(REPEATS):
        without = min(without, _cpu(lambda: gear_flank(design, body, sizes, material, plain))[0])
        seconds, flank = _cpu(lambda: gear_flank(design, body, sizes, material, reading))
        with_gauges = min(with_gauges, seconds)
    product, teeth = _many_loads(flank, body)
    return {
        "body": body,
        "compliance_cpu_s": without,
        "with_gauges_cpu_s": with_gauges,
        "gauges_percent": 100.0 * (with_gauges / without - 1.0),
        "gauges": float(flank.compliance.readings.shape[1]),
        "loads": float(LOADS),
        "positions": float(POSITIONS),
        "teeth": float(teeth),
        "root_stress_cpu_s": product,
        "peak_memory_gb": 1e-6 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss,
    }


def _along_the_face(tooth: LoadedTooth) -> tuple[Array, Array]:
    """Places (b,) along the face and the largest tension (Pa) down the loaded fillet there, ends left out."""
    at, values = tooth.gauges.along(tooth.mesh.body), down_the_fillet(tooth.stress[0]).max(axis=0)
    inside = np.abs(at - at.mean()) < (0.5 - ENDS) * np.ptp(at)
    return at[inside], values[inside]


def _many_loads(flank: GearFlank, body: str) -> tuple[float, int]:
    """CPU seconds of the root stress of LOADS loads at POSITIONS positions, three pairs, and teeth read.

    Each pair loads as many nodes as a line of contact across the flank does in the chain.
    """
    assert flank.gauges is not None
    random, nodes = np.random.default_rng(1), flank.side.nodes.size
    cases = np.tile(random.permuted(np.tile(np.arange(nodes), (POSITIONS, 1)), axis=1)[:, :NODES], (LOADS, 1))
    values = random.uniform(0.0, 100.0, cases.shape)
    rows = np.arange(len(cases))[:, None].repeat(NODES, axis=1)
    force = sp.csr_matrix((values.ravel(), (rows.ravel(), cases.ravel())), shape=(len(cases), nodes))
    loads = dict.fromkeys((-1, 0, 1), force)
    torques, positions = np.linspace(1.0, 1000.0, LOADS), np.arange(POSITIONS) / POSITIONS
    along, angle = flank.gauges.along(body), flank.gauges.tangent_angle
    seconds, stress = _cpu(
        lambda: root_stress(flank.compliance.readings, loads, torques, positions, along, angle)
    )
    return seconds, stress.passage.size // POSITIONS


def _measure_time(
    design: PairDesign, body: str, sizes: MeshSizes, material: Material
) -> tuple[LoadedTooth, float]:
    seconds, tooth = _cpu(lambda: loaded_tooth(design, body, sizes, material, TEETH))
    return tooth, seconds


def _cpu(work: Callable[[], Result]) -> tuple[float, Result]:
    """CPU seconds of a call on one thread, and its result: a second thread that waits for work counts as if
    it worked.
    """
    with threadpool_limits(1):
        start = time.process_time()
        result = work()
        return time.process_time() - start, result
