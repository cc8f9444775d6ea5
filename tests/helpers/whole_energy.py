"""Statics and tangent modes of machines on rolling bearings, written once more: one Newton iteration over the
energy of everything, with each shaft as a beam of finite elements and bearings by the formulas in NumPy.

Coordinates are those of the machine's model, then x, y, z, tilt_x, tilt_y of every node of each shaft but
the pinion's, whose tilts are added where the model has none.
"""

from itertools import pairwise

import numpy as np
from rolling_bearings import ball_constants
from scipy.linalg import eigh

from facegear.bearings.elements import BallBearing


def numbers_of(bearing):
    """Constants of a bearing in SI units by the formulas of the notes, none of them from facegear."""
    angles = bearing.first_element + 2 * np.pi * np.arange(bearing.elements) / bearing.elements
    alpha, sign, diameter = bearing.contact_angle, bearing.direction, bearing.element_diameter
    if isinstance(bearing, BallBearing):
        inner, outer = np.array(ball_constants(bearing)) * 1e3**1.5
        total = (inner ** (-2 / 3) + outer ** (-2 / 3)) ** -1.5
        length = (bearing.groove_ratio_inner - 0.5) * diameter
        gap = (bearing.groove_ratio_inner + bearing.groove_ratio_outer - 1) * diameter
        arm = 0.5 * bearing.pitch_diameter + length * np.cos(alpha)
        height = sign * length * np.sin(alpha)
        rest = np.array([gap * np.cos(alpha) - 0.5 * bearing.clearance, sign * gap * np.sin(alpha)])
        return angles, total, gap, arm, height, rest
    length = 1e3 * bearing.effective_length
    at = length * ((np.arange(1, bearing.slices + 1) - 0.5) / bearing.slices - 0.5)
    factor = 0.00045 if alpha else 0.00035
    drop = factor * 1e3 * diameter * -np.log(1 - (2 * at / length) ** 2) * bearing.has_profile
    stiffness = 35948 * length ** (8 / 9) / bearing.slices * 1e3 ** (10 / 9)
    return angles, stiffness, 1e-3 * at, 1e-3 * drop


def answer(bearing, q):
    """Energy, force and stiffness of a bearing at one motion."""
    if isinstance(bearing, np.ndarray):
        return 0.5 * q @ bearing @ q, bearing @ q, bearing
    if isinstance(bearing, BallBearing):
        return answer_of_balls(bearing, q)
    return answer_of_rollers(bearing, q)


def answer_of_balls(bearing, q):
    angles, total, gap, arm, height, rest = numbers_of(bearing)
    cosine, sine, zero, one = np.cos(angles), np.sin(angles), np.zeros_like(angles), np.ones_like(angles)
    radial = np.stack([cosine, sine, zero, -height * sine, height * cosine], axis=1)
    axial = np.stack([zero, zero, one, arm * sine, -arm * cosine], axis=1)
    rows = np.stack([radial, axial], axis=1)
    vectors = rest + rows @ q
    lengths = np.linalg.norm(vectors, axis=1)
    delta = np.maximum(lengths - gap, 0.0)
    load, stiffness = total * delta**1.5, 1.5 * total * np.sqrt(delta)
    along = vectors / lengths[:, None]
    projections = along[:, :, None] * along[:, None, :]
    blocks = stiffness[:, None, None] * projections
    blocks += (load / lengths)[:, None, None] * (np.eye(2) - projections)
    force = np.einsum("j,jk,jkm->m", load, along, rows)
    matrix = np.einsum("jkm,jkl,jln->mn", rows, blocks, rows)
    return float((0.4 * load * delta).sum()), force, matrix


def answer_of_rollers(bearing, q):
    angles, stiffness, at, drop = numbers_of(bearing)
    alpha, sign = bearing.contact_angle, bearing.direction
    radius, height = 0.5 * bearing.pitch_diameter - at * np.sin(alpha), sign * at * np.cos(alpha)
    cosine, sine, ones = np.cos(angles)[:, None], np.sin(angles)[:, None], np.ones((len(angles), len(at)))
    normal_r, normal_z = np.cos(alpha), sign * np.sin(alpha)
    rows = np.stack(
        [
            normal_r * cosine * ones,
            normal_r * sine * ones,
            normal_z * ones,
            -normal_r * height * sine + normal_z * radius * sine,
            normal_r * height * cosine - normal_z * radius * cosine,
        ],
        axis=2,
    ).reshape(-1, 5)
    free = np.tile(0.5 * bearing.clearance * normal_r + 2 * drop, len(angles))
    delta = np.maximum(rows @ q - free, 0.0)
    load = stiffness * delta ** (10 / 9)
    slope = 10 / 9 * stiffness * delta ** (1 / 9)
    return float((9 / 19 * load * delta).sum()), load @ rows, (rows.T * slope) @ rows


def beam_stiffness(length, section, material):
    """Stiffness (10, 10) of a Timoshenko beam without turning about its axis."""
    young, shear = material.young, material.shear
    inner = section.bore / section.diameter
    area = np.pi / 4 * (section.diameter**2 - section.bore**2)
    second = np.pi / 64 * (section.diameter**4 - section.bore**4)
    nu = material.poisson
    cowper = 6 * (1 + nu) * (1 + inner**2) ** 2
    cowper /= (7 + 6 * nu) * (1 + inner**2) ** 2 + (20 + 12 * nu) * inner**2
    shape = 12 * young * second / (cowper * area * shear * length**2)
    factor = young * second / (length**3 * (1 + shape))
    bend = factor * np.array(
        [
            [12, 6 * length, -12, 6 * length],
            [6 * length, (4 + shape) * length**2, -6 * length, (2 - shape) * length**2],
            [-12, -6 * length, 12, -6 * length],
            [6 * length, (2 - shape) * length**2, -6 * length, (4 + shape) * length**2],
        ]
    )
    stretch = young * area / length
    matrix = np.zeros((10, 10))
    turned = np.array([1, -1, 1, -1])
    # dx/dz = tilt_y and dy/dz = -tilt_x.
    matrix[np.ix_([0, 4, 5, 9], [0, 4, 5, 9])] += bend
    matrix[np.ix_([1, 3, 6, 8], [1, 3, 6, 8])] += bend * np.outer(turned, turned)
    matrix[np.ix_([2, 7], [2, 7])] += stretch * np.array([[1, -1], [-1, 1]])
    return matrix


class WholeMachine:
    """All coordinates of a machine with linear flanks, beams and bearings."""

    def __init__(self, machine, stiffness):
        linear, line = machine.linear_without_rolling, machine.drive_line
        self.machine, self.flank_stiffness = machine, stiffness
        self.size = linear.size
        self.places, blocks = [], []
        for pinion in line.rolling:
            shaft = line.seats[pinion].rolling
            at = list(line.motions(pinion))
            nodes, elements = mesh_of(shaft)
            numbers = []
            for node in nodes:
                known = at if node == shaft.pinion else []
                numbers.append(known + list(range(self.size, self.size + 5 - len(known))))
                self.size += 5 - len(known)
            self.places += [
                (pinion, support, np.array(numbers[nodes.index(support.position)]))
                for support in shaft.supports
            ]
            blocks += [
                (np.array(numbers[i] + numbers[i + 1]), beam_stiffness(length, section, shaft.material))
                for i, (length, section) in enumerate(elements)
            ]
        self.stiffness = np.zeros((self.size, self.size))
        self.stiffness[: linear.size, : linear.size] = linear.stiffness
        for at, block in blocks:
            self.stiffness[np.ix_(at, at)] += block
        grow = self.size - linear.size
        self.rows, self.loads = np.pad(linear.rows, ((0, 0), (0, grow))), np.pad(linear.loads, (0, grow))
        self.arms = np.concatenate([linear.lengths, np.tile(1.0, grow)])
        self.mass = np.pad(linear.mass, (0, grow))
        self.places = [(pinion, support, np.eye(self.size)[at]) for pinion, support, at in self.places]

    def derivatives(self, q, gaps, lifted=0.0):
        """Energy, gradient and matrix; flanks with less than `lifted` of the largest compression are open."""
        over = np.maximum(self.rows @ q - gaps, 0.0)
        forces = self.flank_stiffness * over
        energy = 0.5 * forces @ over + 0.5 * q @ self.stiffness @ q - self.loads @ q
        gradient = self.stiffness @ q + forces @ self.rows - self.loads
        pressed = np.where(over > lifted * over.max(), self.flank_stiffness, 0.0)
        matrix = self.stiffness + (self.rows.T * pressed) @ self.rows
        for _, support, ring in self.places:
            own, force, tangent = answer(support.bearing, ring @ q + support.offset)
            energy += own
            gradient += force @ ring
            matrix += ring.T @ tangent @ ring
        return energy, gradient, matrix

    def settle(self, gaps):
        """Newton's method with halved steps and a fading spring to ground; coordinates in balance."""
        q, tie = np.zeros(self.size), 1e6
        size = np.abs(self.loads / self.arms).max()
        for _ in range(400):
            energy, gradient, matrix = self.derivatives(q, gaps)
            if np.abs(gradient / self.arms).max() <= 1e-11 * size:
                break
            step = -np.linalg.solve(matrix + tie * np.diag(self.arms**2), gradient)
            part = 1.0
            while part > 1e-12:
                moved, slope, _ = self.derivatives(q + part * step, gaps)
                if slope @ step <= 0.0 or moved <= energy + 0.1 * part * (gradient @ step):
                    break
                part *= 0.5
            q, tie = q + part * step, max(0.3 * tie, 1e-2)
        return q

    def forces(self, q, gaps):
        """Forces of the flanks, and of each shaft on its bearings, by pinion."""
        loads = {}
        for pinion, support, ring in self.places:
            loads.setdefault(pinion, []).append(answer(support.bearing, ring @ q + support.offset)[1])
        return self.flank_stiffness * np.maximum(self.rows @ q - gaps, 0.0), loads

    def frequencies(self, q, gaps):
        """Natural frequencies, Hz, with the coordinates that have no mass condensed."""
        _, _, matrix = self.derivatives(q, gaps, lifted=1e-7)
        has_mass = np.diagonal(self.mass) > 0.0
        kept, rest = np.flatnonzero(has_mass), np.flatnonzero(~has_mass)
        inner = matrix[np.ix_(rest, rest)]
        across = matrix[np.ix_(rest, kept)]
        condensed = matrix[np.ix_(kept, kept)] - across.T @ np.linalg.solve(inner, across)
        mass = self.mass[np.ix_(kept, kept)]
        squares = eigh(0.5 * (condensed + condensed.T), mass, eigvals_only=True)
        return np.sqrt(np.maximum(squares, 0.0)) / (2 * np.pi)


def mesh_of(shaft):
    """Places of the nodes, rising, and length and segment of each element between two of them."""
    ends = np.concatenate([[0.0], np.cumsum([segment.length for segment in shaft.segments])])
    inside = [shaft.pinion, *(support.position for support in shaft.supports)]
    low, high = min(inside), max(inside)
    nodes = sorted({*inside, *(end for end in ends if low < end < high)})
    nodes = [node for i, node in enumerate(nodes) if i == 0 or node - nodes[i - 1] > 1e-9 or node in inside]
    elements = []
    for first, second in pairwise(nodes):
        number = int(np.searchsorted(ends, 0.5 * (first + second))) - 1
        elements.append((second - first, shaft.segments[number]))
    return nodes, elements
