"""The linear part of a machine: bodies, bearings, mesh directions and their matrices.

    M q'' + (D + W G) q' + (K + W N + W^2 P) q = torques + forces - rows^T F,   D = a M + b K + dampers

W is the angular speed of the pinions (rad/s) and F the forces of the flanks.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import Protocol

import numpy as np

from facegear.arrays import AnyArray, Array, Integers, Mask
from facegear.machine.layout import DOF_PER_BODY, Layout, Tilt


@dataclass(frozen=True, eq=False)
class Spin:
    """Matrices that rotation adds, for a speed of the pinions of 1 rad/s; each (n, n), SI units.

    Attributes
    ----------
    gyroscopic
        G, skew-symmetric, force by velocity.
    circulatory
        N, force by displacement, from damping that turns with a body.
    centrifugal
        P, symmetric, force by displacement for the square of the speed.
    """

    gyroscopic: Array
    circulatory: Array
    centrifugal: Array


@dataclass(frozen=True, eq=False)
class Rings:
    """Bearings with clearance, R of them.

    Attributes
    ----------
    body : (R,)
        Index in the order of the bodies.
    stiffness : (R,)
        Beyond the clearance, N/m.
    clearance : (R,)
        To each side, m.
    """

    body: Integers
    stiffness: Array
    clearance: Array


@dataclass(frozen=True, eq=False)
class CondensedCasing:
    """A casing whose slow motions alone are coordinates, by the first k coordinates of a model.

    Attributes
    ----------
    stiffness, dampers : (b, k) array
        Loads on the bearings of the first b coordinates, those of bodies, by displacements and by velocities,
        SI units. The model's own matrices hold what moves the casing with the bodies, too.
    casing : (c, k) array
        Motions of all seats, feet and modes of the casing, m and rad.
    rest : (c,) array
        The constant part of these motions that no coordinate has, m and rad: what constant loads on seats do,
        which tangents of rolling bearings have.
    """

    stiffness: Array
    dampers: Array
    casing: Array
    rest: Array


@dataclass(frozen=True, eq=False)
class LinearModel:
    """n coordinates; m flanks; SI units.

    Attributes
    ----------
    labels : (n,)
        `body:letter`. The coordinates of the layout come first, as it orders them.
    mass, stiffness : (n, n)
        Symmetric; stiffness holds all bearings, those with clearance as if they had none.
    rows : (m, n)
        Derivative of the flanks' deflections by the coordinates, drive flanks first.
    torques : (n,)
        Those that the flanks hold in balance.
    forces : (n,)
        All other external loads.
    lengths : (n,)
        Length (m) that one unit of a coordinate counts as: 1 for a displacement, an arm for a rotation.
    translations : (bodies, 3)
        Which coordinates are x, y, z of each body.
    mass_damping, bearing_damping
        Factors of M (1/s) and K (s) in equation (21).
    dampers : (n, n)
        All other damping, N s/m.
    rings
        Bearings with clearance.
    spin
        What turning bodies add, None for nothing.
    slopes : (2 or 4, meshes, n)
        Slopes of the height W of the rim (positive towards the teeth) below each mesh, by all coordinates:
        dW/dr, 1/m, and dW/dphi round the axis, m for a metre; then of teeth that push outwards W itself and
        the motion of the rim outwards, m for a metre; None for rigid gears.
    tangent_loads : (n,)
        The part of `forces` that tangents of rolling bearings add: tangent times motion less load, both at
        the mean load; None without rolling bearings.
    seat_tilts : (bodies, 2, k)
        Tilts about x and y of bodies that have no such coordinates, by the first k coordinates, rad: those
        with their seats on a casing; None without one.
    condensed_casing : CondensedCasing
        What a casing does that follows the bodies but for its slow motions; None where all of its motions are
        coordinates, and without one.
    """

    labels: tuple[str, ...]
    mass: Array
    stiffness: Array
    rows: Array
    torques: Array
    forces: Array
    lengths: Array
    translations: Integers
    mass_damping: float
    bearing_damping: float
    dampers: Array
    rings: Rings
    spin: Spin | None = field(default=None)
    slopes: Array | None = field(default=None)
    tangent_loads: Array | None = field(default=None)
    seat_tilts: Array | None = field(default=None)
    condensed_casing: CondensedCasing | None = field(default=None)

    @property
    def size(self) -> int:
        """The number n of coordinates."""
        return len(self.labels)

    @property
    def loads(self) -> Array:
        """Constant generalised loads (n,): `torques` plus `forces`, N m for rotations and N for
        displacements.
        """
        return self.torques + self.forces

    @property
    def damping(self) -> Array:
        """Damping matrix C without gyroscopic terms: mass_damping M + bearing_damping K + dampers, (n,
        n), N s/m.
        """
        return self.mass_damping * self.mass + self.bearing_damping * self.stiffness + self.dampers

    @cached_property
    def masses(self) -> Array | None:
        """The diagonal (n,) of a mass matrix that has no other entries, else None."""
        diagonal = np.diagonal(self.mass)
        return diagonal.copy() if np.count_nonzero(self.mass) == np.count_nonzero(diagonal) else None

    @cached_property
    def stiffness_without_rings(self) -> Array:
        """Stiffness (n, n) without the bearings that have clearance."""
        stiffness = self.stiffness.copy()
        for pair, spring in zip(self.ring_coordinates, self.rings.stiffness, strict=True):
            stiffness[pair, pair] -= spring
        return stiffness

    @property
    def ring_coordinates(self) -> Integers:
        """Indices of the coordinates x and y of each bearing with clearance, (R, 2)."""
        return self.translations[self.rings.body, :2]

    def momentum(self, velocities: AnyArray) -> AnyArray:
        """Multiply vectors by the mass matrix M.

        Parameters
        ----------
        velocities : (n, ...) array
            m/s and rad/s.

        Returns
        -------
        (n, ...) array
            kg m/s and kg m2/s.
        """
        if self.masses is None:
            return self.mass @ velocities
        return self.masses.reshape(-1, *(1,) * (velocities.ndim - 1)) * velocities

    def over_all(self, rows: Array) -> Array:
        """Extend rows over the coordinates of the layout to all n coordinates of the model, with zeros
        behind.

        Parameters
        ----------
        rows : (..., dof) array
            Any unit.

        Returns
        -------
        (..., n) array
            In the same unit.
        """
        added_count = self.size - rows.shape[-1]
        return np.concatenate([rows, np.zeros((*rows.shape[:-1], added_count))], axis=-1)

    def with_slopes(self, meshes: Mask, added_slopes: Array | None = None) -> Array | None:
        """Return `slopes` with columns for k more coordinates behind the n present ones.

        Parameters
        ----------
        meshes : (meshes,) array of bool
            The meshes below which these coordinates move the rim; the others get zeros.
        added_slopes : (2 or 4, meshes of a gear, k) array or None
            Slopes by k more coordinates below these meshes, 1/m and m/m; None for one that moves no rim.

        Returns
        -------
        (2 or 4, meshes, n + k) array or None
            In the units of `slopes`, 1/m and m/m.
        """
        if added_slopes is None:
            return None if self.slopes is None else np.pad(self.slopes, ((0, 0), (0, 0), (0, 1)))
        slopes = np.zeros((len(added_slopes), meshes.size, self.size + added_slopes.shape[2]))
        if self.slopes is not None:
            slopes[:, :, : self.size] = self.slopes
        slopes[:, meshes, self.size :] = added_slopes
        return slopes

    def bearing_rows(self, coordinates: Integers) -> tuple[Array, Array]:
        """Return the derivatives of the loads of bodies on their bearings.

        Parameters
        ----------
        coordinates : (r,) array of int
            Indices of coordinates of bodies along which the loads act.

        Returns
        -------
        tuple of two (r, n) arrays
            By displacements, N/m, and of dampers by velocities, N s/m; the share of `bearing_damping` is left
            out.
        """
        if self.condensed_casing is None:
            return self.stiffness[:, coordinates].T, self.dampers[coordinates]
        stiffness, dampers = self.condensed_casing.stiffness, self.condensed_casing.dampers
        return self.over_all(stiffness[coordinates]), self.over_all(dampers[coordinates])

    def of_body(self, name: str) -> Integers:
        """Return the indices of the coordinates that belong to a body, those of tilts and elastic waves
        included.

        Parameters
        ----------
        name : str
            Name of the body, as in the labels before the colon.

        Returns
        -------
        array of int, shape (coordinates,)
            Indices.
        """
        owners = [label.rpartition(":")[0] for label in self.labels]
        return np.flatnonzero(np.array(owners) == name)


class Bodies(Protocol):
    """Function that extends a linear model: by coordinates of bending gears, or by other directions of
    forces.
    """

    def __call__(self, base_model: LinearModel) -> LinearModel:
        """Return the model with coordinates added behind its own, or with other matrices or rows; the
        given model is not changed.
        """


def mass_diagonal(layout: Layout) -> Array:
    """Return the diagonal of the mass matrix M: m, m, m, I for each body, then the tilts' inertias.

    Parameters
    ----------
    layout : Layout
        The layout.

    Returns
    -------
    (dof,) array
        kg and kg m2.
    """
    bodies = [value for body in layout.bodies for value in (*3 * (body.mass,), body.inertia)]
    return np.array(bodies + [value for tilt in _tilts(layout) for value in 2 * (tilt.inertia,)])


def bearing_diagonal(layout: Layout) -> Array:
    """Return the diagonal of the bearing stiffness K: k_x, k_y, k_z, 0 for each body, then the tilts.

    Parameters
    ----------
    layout : Layout
        The layout.

    Returns
    -------
    (dof,) array
        N/m and N m/rad.
    """
    bodies = [value for body in layout.bodies for value in (*body.bearing, 0.0)]
    return np.array(bodies + [value for tilt in _tilts(layout) for value in 2 * (tilt.stiffness,)])


def bearing_matrix(layout: Layout) -> Array:
    """Return the bearing stiffness K with the cross-coupling of x and y.

    Parameters
    ----------
    layout : Layout
        The layout.

    Returns
    -------
    (dof, dof) array
        N/m and N m/rad.
    """
    matrix = np.diag(bearing_diagonal(layout))
    for k, body in enumerate(layout.bodies):
        x = DOF_PER_BODY * k
        matrix[x, x + 1] = matrix[x + 1, x] = body.bearing_xy
    return matrix


def flank_jacobian(layout: Layout) -> Array:
    """Return the derivative of the flanks' deflections by the degrees of freedom, of the layout's
    kinematics.

    The deflection of a flank is its row times q, minus its error; positive closes the flank. A pinion's x
    is tangential to the face gear and its y is along the face gear's axis.

    Parameters
    ----------
    layout : Layout
        The layout.

    Returns
    -------
    (2 meshes, dof) array
        Drive flanks, then back flanks; m/m, and m/rad for rotations.
    """
    return layout.kinematics.flank_rows(layout)


def _tilts(layout: Layout) -> list[Tilt]:
    """Return the tilts of the gears that may tilt, in the order of the gears."""
    return [tilt for gear in layout.gears if (tilt := gear.body.tilt) is not None]


def lumped_model(
    layout: Layout,
    torques: Array | None = None,
    forces: Array | None = None,
    damping: tuple[float, float] = (0.0, 0.0),
    clearance: Array | None = None,
) -> LinearModel:
    """Return the linear part of a layout; what is left out is zero.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.
    torques : (bodies,) array or None
        Torques on the bodies, N m.
    forces : (bodies, 3) array or None
        Forces on the bodies along x, y, z, N.
    damping : tuple[float, float]
        Factors of the masses (1/s) and of the bearings (s).
    clearance : (pinions,) array or None
        Radial clearance of the bearings, m.

    Returns
    -------
    LinearModel
        SI units.
    """
    alone = _alone(layout)
    turning, external_forces = np.zeros((2, layout.dof))
    turning[layout.spins] = 0.0 if torques is None else torques
    external_forces[alone.translations] = 0.0 if forces is None else forces
    return replace(
        alone,
        torques=turning,
        forces=external_forces,
        mass_damping=damping[0],
        bearing_damping=damping[1],
        rings=_rings(layout, np.zeros(len(layout.pinions)) if clearance is None else clearance),
    )


@lru_cache(maxsize=16)
def _alone(layout: Layout) -> LinearModel:
    """Return the model of a layout without loads, damping and clearance; equal layouts share it."""
    zeros = np.zeros(layout.dof)
    return LinearModel(
        labels=layout.dof_names,
        mass=np.diag(mass_diagonal(layout)),
        stiffness=bearing_matrix(layout),
        rows=flank_jacobian(layout),
        torques=zeros,
        forces=zeros,
        lengths=_lengths(layout),
        translations=DOF_PER_BODY * np.arange(len(layout.bodies))[:, None] + np.arange(3),
        mass_damping=0.0,
        bearing_damping=0.0,
        dampers=np.zeros((layout.dof, layout.dof)),
        rings=_rings(layout, np.zeros(len(layout.pinions))),
    )


def _rings(layout: Layout, clearance: Array) -> Rings:
    """Return the bearings of pinions whose clearance (pinions,), m, is positive, with the stiffness along
    x.
    """
    body = np.flatnonzero(clearance > 0.0)
    return Rings(body, np.array([layout.pinions[i].body.bearing[0] for i in body]), clearance[body])


def _lengths(layout: Layout) -> Array:
    """Return the length of a unit of each degree of freedom (dof,), m: 1 for displacements, the layout's
    radius of the body for rotations, the mesh radius for tilts.
    """
    lengths = np.ones(layout.dof)
    radii = [layout.pinion_radius] * len(layout.pinions) + [layout.gear_radius] * len(layout.gears)
    lengths[layout.spins] = radii
    lengths[DOF_PER_BODY * len(layout.bodies) :] = layout.mesh_radius
    return lengths
