"""Natural frequencies and mode shapes with the mean mesh stiffness, equations (23) and (24)."""

import itertools
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from facegear.arrays import Array
from facegear.transmission.layout import Layout
from facegear.transmission.matrices import bearing_matrix, mass_diagonal, mesh_directions

EQUAL = 1e-8


@dataclass(frozen=True, eq=False)
class Modes:
    """Frequencies in Hz, shape (n,), ascending; shapes (n, n) by column with unit modal mass.

    `groups` holds runs of equal frequencies as (start, stop); shapes within a run are one basis of many.
    """

    frequencies: Array
    shapes: Array
    groups: tuple[tuple[int, int], ...]


def natural_modes(layout: Layout, mesh_stiffness: float) -> Modes:
    """All modes of the free, undamped, time-averaged system with every mesh on its drive flank (N/m).

    Rigid body modes come out as 0 Hz exactly.
    """
    directions = mesh_directions(layout)
    return modes_of(layout, mesh_stiffness * directions.T @ directions)


def modes_of(layout: Layout, meshes: Array) -> Modes:
    """All modes with the stiffness matrix (dof, dof) of the meshes, SI units."""
    mass = mass_diagonal(layout)
    stiffness = bearing_matrix(layout) + meshes
    root = np.sqrt(mass)
    squares, vectors = scipy.linalg.eigh(stiffness / np.outer(root, root))
    noise = squares.size * np.finfo(float).eps * squares[-1]
    squares[np.abs(squares) < 10.0 * noise] = 0.0
    frequencies = np.sqrt(squares) / (2.0 * np.pi)
    return Modes(frequencies, vectors / root[:, None], _equal_runs(frequencies))


def _equal_runs(frequencies: Array) -> tuple[tuple[int, int], ...]:
    """Split ascending frequencies into runs that agree to rounding."""
    gaps = np.diff(frequencies) > EQUAL * frequencies[-1]
    edges = [0, *(np.flatnonzero(gaps) + 1).tolist(), frequencies.size]
    return tuple(itertools.pairwise(edges))
