"""Flank compliance of a whole gear from one of its teeth."""

from dataclasses import dataclass, field, replace

import numpy as np
import scipy.sparse as sp

from facegear.arrays import AnyArray, Array, Arrays, Integers
from facegear.contact.bodies.elements import ElasticBody
from facegear.contact.bodies.layer import TiedSystem, tied_system
from facegear.contact.bodies.ring import LEFT, RIGHT, moved_faces, rest_stiffness
from facegear.contact.bodies.substructure import Superelement, condense, halves, unfold_matrix
from facegear.contact.options import Element, Ends, Refinement
from facegear.progress import Progress
from facegear.sparse.matrices import backward, cholesky, forward, plus_square

SHARES = (7, 3)
"""Tenths of the time that factorisation and joining the teeth take at the default resolution."""


@dataclass(frozen=True, eq=False)
class FlankCompliance:
    """Normal displacements of the flanks of a gear by unit normal forces on one of them, m/N.

    Forces and displacements are along the outward normal; those of a pressed flank are negative. Lattice
    node (i, j) has number i nv + j, i across the profile from the tip, j along the face width.

    Attributes
    ----------
    loaded_tooth : (n, n) array
        On the loaded tooth, nodes of the refined lattice `shape`; row: displaced node, column: loaded
        node.
    neighbour_blocks : (2 d + 1, c, c) array
        On the tooth t - d further along, nodes of the lattice before refinement `coarse_shape` (the field
        of a neighbour is smooth); the middle block repeats the loaded tooth and is not used.
    shape, coarse_shape
        Numbers of nodes (nu, nv) of the refined lattice and of the lattice before refinement.
    refinement
        Relates the two lattices.
    linear
        Whether displacements are linear between nodes, not quadratic over elements.
    readings : (2 d + 1, g, c) array
        Readings of g gauges on the tooth t - d further along by unit normal forces on the nodes of the
        lattice before refinement, Pa/N; empty without gauges.
    scale
        Factor of the displacements in `loaded_tooth` and `neighbour_blocks`, not of `readings`: another
        Young's modulus needs no copies of them.
    """

    loaded_tooth: Array
    neighbour_blocks: Array
    shape: tuple[int, int]
    coarse_shape: tuple[int, int]
    refinement: Refinement
    linear: bool = False
    readings: Array = field(default_factory=lambda: np.zeros((0, 0, 0)))
    scale: float = 1.0

    def block(self, tooth_offset: int) -> Array | None:
        """Return the coarse block, not scaled, for a tooth at an offset from the loaded one.

        Parameters
        ----------
        tooth_offset : int
            Number of teeth further along.

        Returns
        -------
        (c, c) array, optional
            m/N; None beyond the neighbours that are kept.
        """
        reach = len(self.neighbour_blocks) // 2
        return self.neighbour_blocks[tooth_offset + reach] if abs(tooth_offset) <= reach else None

    def reverse_along_face(self, gauges: tuple[int, ...]) -> "FlankCompliance":
        """Return the compliance of the body in a mirror across its face: nodes along it change their order.

        Parameters
        ----------
        gauges : tuple of int
            Shape of the gauges, the last along the face.

        Returns
        -------
        FlankCompliance
            Compliance of the image, m/N.
        """
        lattice, coarse, blocks = self.shape, self.coarse_shape, len(self.neighbour_blocks)
        tooth = self.loaded_tooth.reshape(*lattice, *lattice)[:, ::-1, :, ::-1]
        neighbours = self.neighbour_blocks.reshape(blocks, *coarse, *coarse)[:, :, ::-1, :, ::-1]
        readings = self.readings.reshape(len(self.readings), *gauges, *coarse)[:, :, :, ::-1, :, ::-1]
        return replace(
            self,
            loaded_tooth=tooth.reshape(self.loaded_tooth.shape),
            neighbour_blocks=neighbours.reshape(self.neighbour_blocks.shape),
            readings=readings.reshape(self.readings.shape),
        )


def flank_compliance(
    body: ElasticBody,
    refinement: Refinement,
    teeth: int = 1,
    neighbours: int = 2,
    ends: Ends = "ring",
    element: Element = "hex27",
    gauges: sp.csr_matrix | None = None,
) -> FlankCompliance:
    """Compute the flank compliance of `teeth` copies of a body with cut faces, by static condensation.

    All teeth have the same refinement, so that one factorisation serves the loaded tooth and its
    neighbours. A body without cut faces is a gear of its own.

    Parameters
    ----------
    body : ElasticBody
        One tooth, or any body with a flank.
    refinement : Refinement
        Refinement of the flank layer.
    teeth : int
        Number of copies; not used for a body without cut faces.
    neighbours : int
        Number of neighbours on each side of the loaded tooth whose compliance is kept.
    ends : Ends
        `ring` of all teeth, or a row with the loaded tooth in the middle and `free` or `clamped` end
        faces.
    element : Element
        Other elements than hex27 are linear elements on the same nodes, for comparison.
    gauges : (g, 3 n) sparse matrix, optional
        Readings by the displacements of the body's n nodes, which must lie on its surface, Pa/m.

    Returns
    -------
    FlankCompliance
        Compliance, m/N.

    Raises
    ------
    FacegearError
        If the body is not held.
    ValueError
        If there are too few teeth.
    """
    system = tied_system(body, refinement, element)
    if gauges is not None:
        gauges = (
            gauges @ sp.kron(system.node_displacements(body, refinement), sp.eye(3), format="csr")
        ).tocsr()
    half_systems = halves(system)
    progress = Progress("flank compliance", total=len(half_systems) * sum(SHARES))
    compliances = []
    for half in half_systems:
        tooth = condense(half.system, None if gauges is None else (gauges @ half.fold).tocsr())
        progress.step(SHARES[0])
        compliances.append(
            coupled_compliance(half.system, tooth, refinement, teeth, neighbours, ends, element)
        )
        progress.step(SHARES[1])
    return whole(compliances)


def whole(compliances: list[FlankCompliance]) -> FlankCompliance:
    """Join the compliances of the even and the odd half of a body.

    Parameters
    ----------
    compliances : list[FlankCompliance]
        Those of both halves, or that of a body without halves.

    Returns
    -------
    FlankCompliance
        Compliance of the body, m/N.
    """
    if len(compliances) == 1:
        return compliances[0]
    even, odd = compliances
    shape, coarse = even.shape, even.coarse_shape
    return replace(
        even,
        loaded_tooth=unfold_matrix(even.loaded_tooth, odd.loaded_tooth, shape),
        neighbour_blocks=unfold_matrix(even.neighbour_blocks, odd.neighbour_blocks, coarse),
        readings=unfold_matrix(even.readings, odd.readings, coarse, rows=False),
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
    """Join copies of a condensed tooth, or of one of its halves, to a ring or sector.

    Parameters
    ----------
    system : TiedSystem
        System of the tooth.
    tooth : Superelement
        Condensed tooth.
    refinement : Refinement
        Refinement of the flank layer.
    teeth : int
        Number of copies.
    neighbours : int
        Number of neighbours on each side that are kept.
    ends : Ends
        Kind of ends.
    element : Element
        Kind of elements.

    Returns
    -------
    FlankCompliance
        Compliance, m/N.

    Raises
    ------
    ValueError
        If there are too few teeth.
    """
    shape = system.surface.shape[:2]
    nodes = np.arange(shape[0] * shape[1]).reshape(shape)[:: refinement.profile, :: refinement.width]
    coarse = nodes.ravel()
    loaded_tooth, neighbour_blocks = tooth.flank, np.zeros((1, coarse.size, coarse.size))
    readings = tooth.gauge_flank[None, :, coarse]
    if system.left.size:
        loaded_tooth, neighbour_blocks, readings = _among_others(tooth, coarse, teeth, neighbours, ends)
    return FlankCompliance(
        loaded_tooth=loaded_tooth,
        neighbour_blocks=neighbour_blocks,
        shape=shape,
        coarse_shape=nodes.shape,
        refinement=refinement,
        linear=element != "hex27",
        readings=readings,
    )


def _among_others(
    tooth: Superelement, coarse: Integers, teeth: int, neighbours: int, ends: Ends
) -> tuple[Array, Array, Array]:
    """Return `loaded_tooth`, `neighbour_blocks` and `readings` of a FlankCompliance for a tooth among its
    copies.

    The other `teeth` - 1 copies are attached to the faces of the condensed `tooth` as a stiffness.
    `coarse` (c,) are the nodes of the refined lattice that exist before refinement, `neighbours` is d. In
    a ring without gauges only the teeth on the right are computed: blocks on the left are their
    transposes (Maxwell's theorem).
    """
    rests = rest_stiffness(tooth.faces, neighbours, teeth, ends)
    around = cholesky(tooth.faces + rests[0][0], overwrite=True)
    half = forward(around, tooth.influence.T)
    loaded_tooth = plus_square(tooth.flank, half)
    half = half[:, coarse]
    coarse_influence, face_displacement = tooth.influence[coarse], backward(around, half)
    after = moved_faces(tooth.faces, rests, face_displacement, RIGHT)
    further = [coarse_influence @ faces for faces in after]
    if ends == "ring" and not len(tooth.gauge_faces):
        neighbour_blocks = np.stack([*(block.T for block in further[::-1]), half.T @ half, *further])
        return loaded_tooth, neighbour_blocks, np.zeros((len(neighbour_blocks), 0, coarse.size))
    before = moved_faces(tooth.faces, rests, face_displacement, LEFT)[::-1]
    neighbour_blocks = np.stack([*(coarse_influence @ faces for faces in before), half.T @ half, *further])
    readings = np.stack([-(tooth.gauge_faces @ faces) for faces in (*before, face_displacement, *after)])
    readings[neighbours] += tooth.gauge_flank[:, coarse]
    return loaded_tooth, neighbour_blocks, readings


def to_arrays(compliance: FlankCompliance) -> dict[str, AnyArray]:
    """Return named arrays from which `from_arrays` rebuilds the compliance.

    Parameters
    ----------
    compliance : FlankCompliance
        Compliance to store.

    Returns
    -------
    dict of arrays
        Arrays with the (...) shapes of ARRAY_SHAPES.
    """
    cuts = compliance.refinement
    return {
        "own_m_per_n": compliance.scale * compliance.loaded_tooth,
        "others_m_per_n": compliance.scale * compliance.neighbour_blocks,
        "shape": np.array(compliance.shape),
        "coarse_shape": np.array(compliance.coarse_shape),
        "refinement": np.array([cuts.profile, cuts.width, cuts.depth, cuts.grading], dtype=float),
        "linear": np.array([compliance.linear]),
        "readings_pa_per_n": compliance.readings,
    }


ARRAY_SHAPES = {
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
    """Rebuild a compliance from the arrays of `to_arrays`.

    Parameters
    ----------
    arrays : Arrays
        Arrays as ARRAY_SHAPES.

    Returns
    -------
    FlankCompliance
        Compliance, m/N.
    """
    profile, width, depth, grading = arrays["refinement"]
    (rows, columns), (coarse_rows, coarse_columns) = arrays["shape"], arrays["coarse_shape"]
    return FlankCompliance(
        loaded_tooth=arrays["own_m_per_n"],
        neighbour_blocks=arrays["others_m_per_n"],
        shape=(int(rows), int(columns)),
        coarse_shape=(int(coarse_rows), int(coarse_columns)),
        refinement=Refinement(int(profile), int(width), int(depth), float(grading)),
        linear=bool(arrays["linear"][0]),
        readings=arrays["readings_pa_per_n"],
    )
