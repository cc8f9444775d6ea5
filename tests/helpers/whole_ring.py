"""A whole ring of steel in space, loaded by tractions: strains of vector fields, no equations of its orders.

Fields are products of shapes of the section and of cosines and sines of the angle, along the directions
outwards, round the axis and to the teeth, which turn with the angle. Their gradients are taken as those of
vectors in space, and energies are sums over points of the whole ring.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from facegear.parts.body_mesh import BodyMesh
from facegear.parts.section import Section
from facegear.teeth.design import Material


def lagrange(at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Values and slopes (3, n) of the quadratic shapes of -1, 0 and 1."""
    values = np.stack([at * (at - 1) / 2, 1 - at**2, at * (at + 1) / 2])
    return values, np.stack([at - 0.5, -2 * at, at + 0.5])


@dataclass(frozen=True)
class WholeRing:
    """A ring whose section is cut by lines of radii and heights, clamped at its lowest height."""

    radii: np.ndarray
    heights: np.ndarray
    material: Material
    orders: int

    @property
    def section(self) -> Section:
        """Section of the ring for the package, with teeth all across."""
        r, z = self.radii[[0, -1]], self.heights[[0, -1]]
        corners = np.array([(r[0], z[0]), (r[1], z[0]), (r[1], z[1]), (r[0], z[1])])
        return Section(corners, (True, False, False, False), (r[0], r[1]), self.material, 7850.0)

    @property
    def mesh(self) -> BodyMesh:
        """Elements of the ring for the package."""
        nodes = np.stack(np.meshgrid(self.radii, self.heights), axis=-1).reshape(-1, 2)
        columns, rows = self.radii.size, self.heights.size
        first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
        quads = np.stack([first, first + 1, first + columns + 1, first + columns], axis=1)
        return BodyMesh(nodes, quads, np.zeros(len(quads), bool))

    @property
    def waves(self) -> list:
        """Functions of the angle with their slopes: 1, then cosines and sines."""
        found = [(np.ones_like, np.zeros_like)]
        for n in range(1, self.orders):
            found.append((lambda a, n=n: np.cos(n * a), lambda a, n=n: -n * np.sin(n * a)))
            found.append((lambda a, n=n: np.sin(n * a), lambda a, n=n: n * np.cos(n * a)))
        return found

    def along(self, ends: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Values and slopes (2 k + 1, n) of the quadratic shapes over k pieces at points of a line."""
        pieces = ends.size - 1
        values, slopes = np.zeros((2, 2 * pieces + 1, points.size))
        number = np.clip(np.searchsorted(ends, points, side="right") - 1, 0, pieces - 1)
        for piece in range(pieces):
            on = number == piece
            half = 0.5 * (ends[piece + 1] - ends[piece])
            shape, slope = lagrange((points[on] - ends[piece]) / half - 1.0)
            values[2 * piece : 2 * piece + 3, on] = shape
            slopes[2 * piece : 2 * piece + 3, on] = slope / half
        return values, slopes

    @cached_property
    def stiffness(self) -> np.ndarray:
        """Energy's second derivatives by all coordinates: shape of r, of height, wave, direction."""
        gauss, weights = np.polynomial.legendre.leggauss(5)
        count = 4 * self.orders + 4
        angles = 2 * np.pi * np.arange(count) / count
        lines = []
        for ends in (self.radii, self.heights):
            half = 0.5 * np.diff(ends)
            points = (ends[:-1, None] + half[:, None] * (1 + gauss)).ravel()
            lines.append((points, (half[:, None] * weights).ravel(), *self.along(ends, points)))
        (r, r_weight, by_r, r_slope), (_, z_weight, by_z, z_slope) = lines
        cos, sin, nothing = np.cos(angles), np.sin(angles), np.zeros(count)
        out = np.stack([sin, -cos, nothing])
        around = np.stack([cos, sin, nothing])
        up = np.stack([nothing, nothing, np.ones(count)])
        directions = ((out, around), (around, -out), (up, np.zeros((3, count))))
        young, nu = self.material.young_modulus, self.material.poisson_ratio
        shear = young / (2 * (1 + nu))
        lame = young * nu / ((1 + nu) * (1 - 2 * nu))
        size = by_r.shape[0] * by_z.shape[0] * len(self.waves) * 3
        whole = np.zeros((size, size))
        for k in range(r.size):
            for m in range(z_weight.size):
                grid = np.multiply.outer(by_r[:, k], by_z[:, m])
                grid_r = np.multiply.outer(r_slope[:, k], by_z[:, m])
                grid_z = np.multiply.outer(by_r[:, k], z_slope[:, m])
                gradients = []
                for wave, slope in self.waves:
                    f, f_slope = wave(angles), slope(angles)
                    for direction, turned in directions:
                        across = (f_slope * direction + f * turned) / r[k]
                        # gradient[i, j] = d u_i / d x_j at every angle
                        g = np.einsum("ab,ip,jp->abijp", grid_r, f * direction, out)
                        g += np.einsum("ab,ip,jp->abijp", grid, across, around)
                        g += np.einsum("ab,ip,jp->abijp", grid_z, f * direction, up)
                        gradients.append(g)
                g = np.stack(gradients, axis=2).reshape(size, 3, 3, count)
                strain = 0.5 * (g + g.transpose(0, 2, 1, 3))
                spread = np.trace(strain, axis1=1, axis2=2)
                weight = r_weight[k] * z_weight[m] * r[k] * 2 * np.pi / count
                strain = strain.reshape(size, -1)
                whole += weight * (2 * shear * strain @ strain.T + lame * spread @ spread.T)
        return whole

    def load(self, angle: float, force: np.ndarray, height: float, half_width: float) -> np.ndarray:
        """Work by a unit of each coordinate of a force over height 0, a raised cosine round an angle.

        force: outwards, round the axis, to the teeth. Where it acts moves as the plane of height 0 does: by
        the line that fits the heights across the face best, and by their slope round the axis.
        """
        points, weights = np.polynomial.legendre.leggauss(60)
        at = angle + half_width * points
        spread = weights * (1 + np.cos(np.pi * points)) / 2
        across, parts = np.polynomial.legendre.leggauss(8)
        inner, outer = self.radii[[0, -1]]
        ends = list(zip(self.radii[:-1], self.radii[1:], strict=True))
        r = np.concatenate([0.5 * (b + a) + 0.5 * (b - a) * across for a, b in ends])
        parts = np.concatenate([0.5 * (b - a) * parts for a, b in ends]) / (outer - inner)
        values = self.along(self.radii, r)[0]
        plain, over_r = values @ parts, values @ (parts / r)
        middle = r @ parts
        fitted = values @ (parts * (r - middle)) / (parts @ (r - middle) ** 2)
        level = self.along(self.heights, np.zeros(1))[0][:, 0]
        radial, tangential, axial = force
        found = np.zeros((plain.size, level.size, len(self.waves), 3))
        for number, (wave, slope) in enumerate(self.waves):
            f, f_slope = spread @ wave(at), spread @ slope(at)
            found[:, :, number, 0] = np.multiply.outer(radial * f * plain, level)
            found[:, :, number, 1] = np.multiply.outer(tangential * f * plain, level)
            tilted = axial * f * plain - radial * height * f * fitted - tangential * height * f_slope * over_r
            found[:, :, number, 2] = np.multiply.outer(tilted, level)
        return found.ravel()

    def answers(self, loads: np.ndarray) -> np.ndarray:
        """Motions (k, k) along each of k loads (k, n) by the others, lowest height clamped."""
        rows, columns = 2 * self.radii.size - 1, 2 * self.heights.size - 1
        is_free = np.ones((rows, columns, len(self.waves), 3), bool)
        is_free[:, 0] = False
        free = np.flatnonzero(is_free.ravel())
        moved = np.linalg.solve(self.stiffness[np.ix_(free, free)], loads[:, free].T)
        return loads[:, free] @ moved
