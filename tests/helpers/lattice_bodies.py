"""Contact models without finite elements: exact flanks on a foundation or on half spaces."""

import numpy as np

from facegear.arrays import Array
from facegear.contact.bodies.compliance import FlankCompliance
from facegear.contact.flanks import FlankPair, flank_pair
from facegear.contact.ltca import ContactModel
from facegear.contact.options import ContactOptions, Refinement
from facegear.contact.teeth import ContactSide
from facegear.teeth.design import PairDesign
from facegear.teeth.helicoid import pinion_start

FLANKS_ALONE = ContactOptions(fillet=False, is_coupled=False, edges=False)
"""Contact of flanks alone, without tip edges, fillets and neighbours."""
GEAR_LATTICE = (5, 5)
"""Nodes of the gear's lattice, which is rigid."""


def side_of(u: Array, v: Array) -> ContactSide:
    """Return a contact surface without a fillet, by parameters (nu, nv) of its nodes."""
    return ContactSide(np.arange(u.size).reshape(u.shape), u, v, len(u), u[-1])


def whole_flank(design: PairDesign, shape: tuple[int, int]) -> ContactSide:
    """Return the pinion's whole flank, with nodes evenly in the square of the roll and along the axis."""
    flank, half = design.family.pinion_flanks[0], design.pinion.width / 2
    y = np.linspace(design.middle - half, design.middle + half, shape[1])
    growth = (y - design.middle) * design.family.taper
    tip = np.sqrt((design.family.pinion_flank_radius + growth) ** 2 - flank.base_radius**2)
    start = np.maximum(pinion_start(design.family, 1, y), 0.0)
    u = np.sqrt(np.linspace(tip**2, start**2, shape[0])) / flank.base_radius
    return side_of(u, np.broadcast_to(y, u.shape))


def patch(design: PairDesign, centre: tuple[float, float], step: tuple[float, float], shape, slope=0.0):
    """Return a patch of the pinion's flank about (transverse length of roll, y), m, with rows along lines.

    `step`: distances (m) of nodes across generators and along them; `slope` (rad) of the lines against the
    generators, from these towards the root.
    """
    flank, (roll, y) = design.family.pinion_flanks[0], centre
    along = step[1] * (np.arange(shape[1]) - (shape[1] - 1) / 2)
    across = step[0] * (np.arange(shape[0]) - (shape[0] - 1) / 2)[:, None] + np.tan(slope) * along
    # the arc of an involute is s^2 / (2 r_b)
    u = np.sqrt(roll**2 - 2.0 * flank.base_radius * across) - flank.lead * flank.cosine * along
    return side_of(u / flank.base_radius, np.broadcast_to(y + flank.cosine * along, u.shape))


def model_of(design: PairDesign, pinion: ContactSide, compliance) -> ContactModel:
    """Return the contact of a lattice on the pinion, with compliance(nodes (nu, nv, 3)) (n, n) m/N, on a
    rigid gear.
    """
    radius = np.linspace(design.face_gear.inner_radius, design.face_gear.outer_radius, GEAR_LATTICE[1])
    gear = side_of(np.zeros(GEAR_LATTICE), np.broadcast_to(radius, GEAR_LATTICE))
    flanks = flank_pair(design, (pinion, gear), (Refinement(), Refinement()), linear=True)
    nodes = flanks.pinion.nodes.reshape(*pinion.shape, 3)
    return ContactModel(
        flanks, body(compliance(flanks, nodes), pinion.shape), body(np.zeros((25, 25)), (5, 5))
    )


def body(matrix: Array, shape: tuple[int, int]) -> FlankCompliance:
    """Return a compliance (n, n) of a tooth that moves no neighbour."""
    return FlankCompliance(matrix, np.zeros((1, *matrix.shape)), shape, shape, Refinement(), linear=True)


def foundation(stiffness: float):
    """Return a function that gives the compliance of a foundation with a stiffness per area, N/m3."""

    def compliance(flanks: FlankPair, _) -> Array:
        hats = flanks.pinion.hats
        mass = (hats.T.multiply(flanks.pinion.area) @ hats).toarray()
        return np.linalg.inv(mass) / stiffness

    return compliance


def half_spaces(modulus: float):
    """Return a function that gives the compliance of two half spaces of a contact modulus, Pa.

    Each node's force is spread evenly over the rectangle half way to its neighbours. Source: Johnson 1985,
    chapter 3.
    """

    def compliance(_, nodes: Array) -> Array:
        rows, columns = nodes.shape[:2]
        row, column = rows // 2, columns // 2
        across = (nodes[row + 1, column] - nodes[row - 1, column]) / 2
        along = (nodes[row, column + 1] - nodes[row, column - 1]) / 2
        size = np.linalg.norm(across)
        shear = along @ across / size
        length = np.sqrt(along @ along - shear**2)
        places = np.arange(1.0 - rows, rows)[:, None], np.arange(1.0 - columns, columns)
        x, y = np.broadcast_arrays(places[0] * size + places[1] * shear, places[1] * length)
        left, right, low, high = x - size / 2, x + size / 2, y - length / 2, y + length / 2

        def part(coordinate: Array, first: Array, second: Array) -> Array:
            sums = (end + np.hypot(end, coordinate) for end in (first, second))
            return coordinate * np.log(next(sums) / next(sums))

        by_distance = (
            part(right, high, low) + part(high, right, left) + part(left, low, high) + part(low, left, right)
        ) / (np.pi * modulus * size * length)
        apart = np.arange(rows)[:, None] - np.arange(rows) + rows - 1
        beside = np.arange(columns)[:, None] - np.arange(columns) + columns - 1
        matrix = by_distance[apart[:, None, :, None], beside[None, :, None, :]]
        return matrix.reshape(rows * columns, rows * columns)

    return compliance
