"""Flank compliance of a whole gear from one of its teeth."""

from dataclasses import dataclass, field, replace

import numpy as np
import scipy.sparse as sp

from facegear.arrays import AnyArray, Array, Arrays, Integers
from facegear.contact.bodies.body import ElasticBody
from facegear.contact.bodies.dense import backward, cholesky, forward, plus_square
from facegear.contact.bodies.layer import TiedSystem, tied_system
from facegear.contact.bodies.mirror import halves, unfolded
from facegear.contact.bodies.ring import LEFT, RIGHT, moved_faces, rest_stiffness
from facegear.contact.bodies.substructure import Superelement, condense
from facegear.contact.options import Element, Ends, Refinement
from facegear.progress import Progress

SHARES = (7, 3)
"""Tenths of the time that factorisation and joining the teeth take at the default resolution."""


@dataclass(frozen=True, eq=False)
class FlankCompliance:
    """Normal displacements of the flanks of a gear by unit normal forces on one of them, m/N.

    Attributes
    ----------
    own : (n, n)
        On the loaded tooth, nodes of the refined lattice `shape`.
    others : (2 d + 1, c, c)
        On the tooth t - d further along, nodes of the lattice before refinement `coarse_shape` (the field of
        a neighbour is smooth); the middle block repeats the own tooth and is not used.
    shape, coarse_shape
        Of the two lattices.
    refinement
        Relates the two lattices.
    linear
        Whether displacements are linear between nodes, not quadratic over elements.
    readings : (2 d + 1, g, c)
        What g gauges on the tooth t - d further along show by unit normal forces on the nodes of the lattice
        before refinement; empty without gauges.
    scale
        What the displacements are times `own` and `others`: another Young's modulus needs no copies of them.
    """

    own: Array
    others: Array
    shape: tuple[int, int]
    coarse_shape: tuple[int, int]
    refinement: Refinement
    linear: bool = False
    readings: Array = field(default_factory=lambda: np.zeros((0, 0, 0)))
    scale: float = 1.0

    def block(self, places: int) -> Array | None:
        """Coarse block, not scaled, for a tooth `places` further than the loaded one; None beyond."""
        reach = len(self.others) // 2
        return self.others[places + reach] if abs(places) <= reach else None


def flank_compliance(
    body: ElasticBody,
    refinement: Refinement,
    teeth: int = 1,
    neighbours: int = 2,
    ends: Ends = "ring",
    element: Element = "hex27",
    gauges: sp.csr_matrix | None = None,
) -> FlankCompliance:
    """Compliance of `teeth` copies of a body with cut faces; `neighbours` of the loaded one on each side are
    kept.

    `gauges` (g, 3 n): readings by the displacements of the body's nodes, which must lie on its surface.
    All teeth are refined alike, so that one factorisation serves the loaded tooth and its neighbours. A body
    without cut faces stands for itself.
    Raises FacegearError if the body is not held, ValueError if there are too few teeth.
    """
    system = tied_system(body, refinement, element)
    if gauges is not None:
        gauges = (gauges @ sp.kron(system.followed(body, refinement), sp.eye(3), format="csr")).tocsr()
    several = halves(system)
    progress = Progress("flank compliance", total=len(several) * sum(SHARES))
    solved = []
    for half in several:
        tooth = condense(half.system, None if gauges is None else (gauges @ half.fold).tocsr())
        progress.step(SHARES[0])
        solved.append(coupled_compliance(half.system, tooth, refinement, teeth, neighbours, ends, element))
        progress.step(SHARES[1])
    return whole(solved)


def whole(solved: list[FlankCompliance]) -> FlankCompliance:
    """The compliance of a body from that of its even and odd half; that of a body without halves as it is."""
    if len(solved) == 1:
        return solved[0]
    even, odd = solved
    shape, coarse = even.shape, even.coarse_shape
    return replace(
        even,
        own=unfolded(even.own, odd.own, shape),
        others=unfolded(even.others, odd.others, coarse),
        readings=unfolded(even.readings, odd.readings, coarse, rows=False),
        shape=(shape[0], 2 * shape[1] - 1),
        coarse_shape=(coarse[0], 2 * coarse[1] - 1),
    )


def coupled_compliance(
    system: TiedSystem,
    tooth: Superelement,
    refinement: Refinement,
    teeth: int,
    neighbours: int,
    ends: Ends,
    element: Element,
) -> FlankCompliance:
    """Copies of a condensed tooth, or of one of its halves, joined to a ring or sector.

    Raises ValueError if there are too few teeth.
    """
    shape = system.surface.shape[:2]
    nodes = np.arange(shape[0] * shape[1]).reshape(shape)[:: refinement.profile, :: refinement.width]
    coarse = nodes.ravel()
    own, others = tooth.flank, np.zeros((1, coarse.size, coarse.size))
    readings = tooth.gauge_flank[None, :, coarse]
    if system.left.size:
        own, others, readings = _among_others(tooth, coarse, teeth, neighbours, ends)
    return FlankCompliance(
        own=own,
        others=others,
        shape=shape,
        coarse_shape=nodes.shape,
        refinement=refinement,
        linear=element != "hex27",
        readings=readings,
    )


def _among_others(
    tooth: Superelement, coarse: Integers, teeth: int, neighbours: int, ends: Ends
) -> tuple[Array, Array, Array]:
    """`own`, `others` and `readings` of a FlankCompliance, for nodes `coarse` (c,) of the refined lattice.

    In a ring one tooth moves another as it is moved by it, so that one side stands for both.
    """
    rests = rest_stiffness(tooth.faces, neighbours, teeth, ends)
    around = cholesky(tooth.faces + rests[0][0], overwrite=True)
    half = forward(around, tooth.influence.T)
    own = plus_square(tooth.flank, half)
    half = half[:, coarse]
    seen, moved = tooth.influence[coarse], backward(around, half)
    after = moved_faces(tooth.faces, rests, moved, RIGHT)
    further = [seen @ faces for faces in after]
    if ends == "ring" and not len(tooth.gauge_faces):
        others = np.stack([*(each.T for each in further[::-1]), half.T @ half, *further])
        return own, others, np.zeros((len(others), 0, coarse.size))
    before = moved_faces(tooth.faces, rests, moved, LEFT)[::-1]
    others = np.stack([*(seen @ faces for faces in before), half.T @ half, *further])
    readings = np.stack([-(tooth.gauge_faces @ faces) for faces in (*before, moved, *after)])
    readings[neighbours] += tooth.gauge_flank[:, coarse]
    return own, others, readings


def to_arrays(compliance: FlankCompliance) -> dict[str, AnyArray]:
    """Named arrays from which `from_arrays` rebuilds the compliance."""
    cuts = compliance.refinement
    return {
        "own_m_per_n": compliance.scale * compliance.own,
        "others_m_per_n": compliance.scale * compliance.others,
        "shape": np.array(compliance.shape),
        "coarse_shape": np.array(compliance.coarse_shape),
        "refinement": np.array([cuts.profile, cuts.width, cuts.depth, cuts.grading], dtype=float),
        "linear": np.array([compliance.linear]),
        "readings_pa_per_n": compliance.readings,
    }


STORED = {
    "own_m_per_n": (None, None),
    "others_m_per_n": (None, None, None),
    "shape": (2,),
    "coarse_shape": (2,),
    "refinement": (4,),
    "linear": (1,),
    "readings_pa_per_n": (None, None, None),
}
"""Names and shapes of the arrays of a stored compliance."""


def from_arrays(arrays: Arrays) -> FlankCompliance:
    """Inverse of `to_arrays`."""
    profile, width, depth, grading = arrays["refinement"]
    (rows, columns), (coarse_rows, coarse_columns) = arrays["shape"], arrays["coarse_shape"]
    return FlankCompliance(
        own=arrays["own_m_per_n"],
        others=arrays["others_m_per_n"],
        shape=(int(rows), int(columns)),
        coarse_shape=(int(coarse_rows), int(coarse_columns)),
        refinement=Refinement(int(profile), int(width), int(depth), float(grading)),
        linear=bool(arrays["linear"][0]),
        readings=arrays["readings_pa_per_n"],
    )
