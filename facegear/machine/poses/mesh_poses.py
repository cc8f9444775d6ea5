"""Pose of every mesh of a machine from the displacements and tilts of its bodies, to first order.

A pose is what the pair of a mesh meets as assembly errors. The frame of a mesh has x, y, z along s x, z and
-s y of the machine at the pinion: x along its tangent, y along the gears' axis, z outwards along the pinion,
and s = 1 for the upper, -1 for the lower gear. Pinions tilt about the middle of their faces, gears about a
point on their axis. The line of action's part of a displacement is what the meshes' deflections hold already:
it moves no path.

A motion of the pinion against the gear, v of the middle of its face and turn r, is to first order

    offset = v_x + y_m u.r,   error of the shaft angle = r_x,   w = (v_y - E u.r / sin g) / sin g,
    axial shift = v_z + w cos g,   u = (0, cos g, sin g)

beside turns of both bodies about their axes; y_m, g and E are the middle's place, the shaft angle and the
offset.
"""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array
from facegear.machine.elastic_coordinates import gear_forces
from facegear.machine.layout import DOF_PER_BODY, TILT_LETTERS, Layout
from facegear.machine.linear_model import LinearModel
from facegear.machine.mesh_frames import ToothKind
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.tooth_family import RelativeMotion

PARTS = ("offset", "gear_axial", "shaft_angle_error", "outward")
"""Parts of a pose, in the order of rows."""


@dataclass(frozen=True, eq=False)
class MeshPoses:
    """Poses of all meshes, each part (..., meshes), as the drive flanks of their own gears meet them.

    - offset, gear_axial (m), shaft_angle_error (rad): assembly errors of the pair
    - outward: shift of the pinion along its axis, away from the gears' axis, m
    - pinion_axial: the part of it with which the pair is assembled, at which its paths count, m
    """

    offset: Array
    gear_axial: Array
    shaft_angle_error: Array
    outward: Array
    pinion_axial: float = 0.0

    def errors(self, mesh: int, back: bool = False) -> AssemblyErrors:
        """Return the assembly errors that a flank of a mesh meets, as errors of a drive flank; for a single
        pose of every mesh. The pinion stands along its axis as assembled.

        Parameters
        ----------
        mesh : int
            Index of the mesh.
        back : bool
            Whether it is the back flank.

        Returns
        -------
        AssemblyErrors
            m and rad.
        """
        offset = float(self.offset[mesh])
        return AssemblyErrors(
            offset=-offset if back else offset,
            shaft_angle_error=float(self.shaft_angle_error[mesh]),
            gear_axial=float(self.gear_axial[mesh]),
            pinion_axial=self.pinion_axial,
        )


def middle_place(middle: float, axes: RelativeMotion) -> Array:
    """Return the nominal place of the middle of the pinion's face.

    Parameters
    ----------
    middle : float
        Position of the middle of the pinion's face on its axis, m.
    axes : RelativeMotion
        Shaft angle and offset of the nominal axes.

    Returns
    -------
    (3,) array
        Place in the mesh frame, m.
    """
    return np.array([axes.offset, 0.0, 0.0]) + middle * axes.basis[1]


def to_mesh_frame(sign: float) -> Array:
    """Return the matrix from the machine's frame at a pinion to that of its mesh.

    With s = `sign`, the mesh's x, y, z are s x, z and -s y of the machine: along the tangent, outwards
    along the pinion, and along the gears' axis. Where the axes are not square, a vector of the pinion's own
    frame is then along x, the pinion's axis and across both (`RelativeMotion.basis`).

    Parameters
    ----------
    sign : float
        1 for a mesh with the upper gear, -1 with the lower, dimensionless.

    Returns
    -------
    (3, 3) array
        Dimensionless, a rotation in units of 1.
    """
    return np.array([[sign, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -sign, 0.0]])


def to_pinion(angle: float) -> Array:
    """Return the matrix from x, y, z of a gear to tangent, gear axis and outwards at a pinion.

    Parameters
    ----------
    angle : float
        Distribution angle of the pinion, rad.

    Returns
    -------
    (3, 3) array
        Dimensionless, a rotation in units of 1.
    """
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, sine, 0.0], [0.0, 0.0, 1.0], [sine, -cosine, 0.0]])


def mesh_poses(linear: LinearModel, layout: Layout, middle: float, displacements: Array) -> MeshPoses:
    """Return the poses at displacements of the linear model's coordinates.

    Parameters
    ----------
    linear : LinearModel
        Linear model of the machine.
    layout : Layout
        Bodies and mesh geometry.
    middle : float
        Position of the middle of the pinion's face on its axis, m.
    displacements : (..., n) array
        m and rad.

    Returns
    -------
    MeshPoses
        Each part (..., meshes), m and rad.
    """
    return MeshPoses(*(displacements @ part.T for part in pose_rows(linear, layout, middle)))


def pose_rows(linear: LinearModel, layout: Layout, middle: float, with_pinions: bool = True) -> Array:
    """Return the derivatives of PARTS by the coordinates.

    Tilts of a pinion count where the model has coordinates `tilt_x`, `tilt_y` of it, in the machine's frame
    at the pinion. Coordinates of gears that bend lift the teeth, a shift along the axis, and lean them with
    the rim below the mesh: by its slope along the radius about the tangent, by that round the axis about the
    line through the pitch point that is parallel to the pinion's axis, which is an offset as well. The motion
    of a rim round the axis moves no path, as a turn of the gear does not. That of spur teeth along the
    pinion's axis does not either, and is left out.

    Parameters
    ----------
    linear : LinearModel
        Linear model of the machine.
    layout : Layout
        Bodies and mesh geometry.
    middle : float
        Position of the middle of the pinion's face on its axis, m.
    with_pinions : bool
        Whether tilts of pinions with seats on a casing count.

    Returns
    -------
    (4, meshes, n) array
        m and rad for a unit of each coordinate.
    """
    rows = np.zeros((len(PARTS), len(layout.meshes), linear.size))
    number_of_label = {label: number for number, label in enumerate(linear.labels)}
    parts = [_GearParts.of_gear(layout, gear, middle) for gear in range(len(layout.gears))]
    names_of_tilts = [[f"{pinion.name}:{letter}" for letter in TILT_LETTERS] for pinion in layout.pinions]
    tilts_of_pinions = [
        [number_of_label[name] for name in names if name in number_of_label] for names in names_of_tilts
    ]
    for mesh, (i, g) in enumerate(layout.meshes):
        pinion, gear = DOF_PER_BODY * i, DOF_PER_BODY * (len(layout.pinions) + g)
        rows[:, mesh, pinion : pinion + 3] = parts[g].pinion_shifts
        if tilts_of_pinions[i]:
            rows[:, mesh, tilts_of_pinions[i]] = parts[g].pinion_tilts
        at_pinion = to_pinion(layout.angles[i])
        rows[:, mesh, gear : gear + 3] = parts[g].gear_shifts @ at_pinion
        if g in layout.first_tilts:
            tilts = slice(layout.first_tilts[g], layout.first_tilts[g] + 2)
            rows[:, mesh, tilts] = parts[g].gear_turns @ at_pinion[:, :2]
    if linear.seat_tilts is not None:
        _add_seat_tilts(linear, layout, parts, rows, with_pinions)
    if linear.slopes is not None and layout.kind is not None:
        for mesh, (_, g) in enumerate(layout.meshes):
            rows[:, mesh] += _rim_parts(layout, layout.kind, g, middle) @ linear.slopes[:, mesh]
    elif linear.slopes is not None:
        _bend_spur_rims(linear, linear.slopes, layout, middle, rows)
    return rows


def _rim_parts(layout: Layout, kind: ToothKind, gear: int, middle: float) -> Array:
    """Return the derivatives (4, 4) of PARTS by the slopes and motions of a rim below a mesh, those of
    `LinearModel.slopes` of teeth that push outwards.

    The rim moves the teeth as a rigid whole about the point of the pitch plane below the middle of the
    pinion's face.
    """
    axes, sign = _axes(layout, gear), layout.gears[gear].sign
    middle_point = middle_place(middle, axes)
    radius, up = np.hypot(*middle_point[:2]), np.array([0.0, 0.0, 1.0])
    outwards = np.append(middle_point[:2] / radius, 0.0)
    around = sign * np.cross(outwards, up)
    turns = np.cross(np.stack([outwards, around / radius, 0.0 * up, 0.0 * up]), up)
    motions = np.stack([0.0 * up, 0.0 * up, up, outwards])
    motions += np.cross(turns, (middle_point[2] + kind.pitch_height(sign)) * up)
    by_shift, by_turn = _parts(axes, middle)
    return -by_shift @ motions.T - by_turn @ turns.T


def _bend_spur_rims(linear: LinearModel, slopes: Array, layout: Layout, middle: float, rows: Array) -> None:
    """Add to `rows` (4, meshes, n) what rims that bend below spur teeth add, in place.

    slopes (2, meshes, n): of the rims, those of `linear`.
    """
    offset, shift, angle, _ = rows
    _bending(linear, layout, shift)
    angle -= slopes[0]
    sides = np.array([[layout.gears[g].sign] for _, g in layout.meshes])
    pitch_radius = layout.pinion_arm / np.cos(layout.pressure_angle)
    offset += sides * pitch_radius / middle * slopes[1]


def _axes(layout: Layout, gear: int) -> RelativeMotion:
    """Return the motion of the pinions against a gear, in the mesh frame of that gear."""
    if layout.kind is not None:
        return layout.kind.motion(layout.gears[gear].sign)
    return RelativeMotion(layout.pinion_teeth / layout.gear_teeth)


def _parts(axes: RelativeMotion, middle: float) -> tuple[Array, Array]:
    """Return the derivatives (4, 3) of PARTS by shifts and turns of the pinion about the middle of its face,
    in the mesh frame.
    """
    sine, cosine, up = axes.sine, axes.cosine, axes.basis[2]
    by_shift, by_turn = np.zeros((2, len(PARTS), 3))
    by_shift[0, 0], by_shift[1, 2], by_shift[3, 1] = 1.0, 1.0, 1.0 / sine
    by_turn[0], by_turn[2, 0], by_turn[3] = middle * up, 1.0, -axes.offset / sine**2 * up
    by_shift[1] += cosine * by_shift[3]
    by_turn[1] = cosine * by_turn[3]
    return by_shift, by_turn


@dataclass(frozen=True, eq=False)
class _GearParts:
    """Derivatives of PARTS at one gear, m/m, m/rad and rad/rad.

    pinion_shifts (4, 3), pinion_tilts (4, 2): by motions along x, y, z of a pinion and by tilts about x, y.
    gear_shifts, gear_turns (4, 3): by motions of the gear along tangent, its axis and outwards, and by its
    turns about these directions.
    """

    pinion_shifts: Array
    pinion_tilts: Array
    gear_shifts: Array
    gear_turns: Array

    @classmethod
    def of_gear(cls, layout: Layout, gear: int, middle: float) -> "_GearParts":
        """Return the derivatives at a gear; middle: place of the middle of the pinion's face, m."""
        axes, to_mesh = _axes(layout, gear), to_mesh_frame(layout.gears[gear].sign)
        by_shift, by_turn = _parts(axes, middle)
        x, y, z = middle_place(middle, axes) + [0.0, 0.0, layout.tilt_distance(gear)]
        # a turn of the gear moves the middle of the pinion's face by the turn times the arm (x, y, z)
        at_middle = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
        of_pinion = axes.basis.T @ to_mesh
        return cls(
            pinion_shifts=by_shift @ of_pinion,
            pinion_tilts=by_turn @ of_pinion[:, :2],
            gear_shifts=-by_shift @ to_mesh,
            gear_turns=-(by_shift @ at_middle + by_turn) @ to_mesh,
        )


def _add_seat_tilts(
    linear: LinearModel, layout: Layout, parts: list[_GearParts], rows: Array, with_pinions: bool
) -> None:
    """Add to `rows` (4, meshes, n) what bodies that tilt with their seats on a casing add, in place.

    parts: of each gear.
    """
    assert linear.seat_tilts is not None
    tilts = linear.over_all(linear.seat_tilts)
    for mesh, (i, g) in enumerate(layout.meshes):
        gear_tilts = parts[g].gear_turns @ to_pinion(layout.angles[i])[:, :2]
        rows[:, mesh] += gear_tilts @ tilts[len(layout.pinions) + g]
        if with_pinions:
            rows[:, mesh] += parts[g].pinion_tilts @ tilts[i]


def rim_levers(layout: Layout, middle: float) -> Array:
    """Return the moments that unit forces of flanks have about the tangent below the middle of the pinion's
    face, of which rows of rims that bend know nothing.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.
    middle : float
        Position of the middle of the pinion's face on its axis, m.

    Returns
    -------
    (2 meshes,) array
        m, drive flanks first: the part of a force along the gear's axis times its way outwards from there.
    """
    levers = np.zeros((2, len(layout.meshes)))
    for mesh, (_, gear) in enumerate(layout.meshes):
        forces = gear_forces(layout, gear)
        radius = np.hypot(*middle_place(middle, _axes(layout, gear))[:2])
        levers[:, mesh] = forces.directions[:, 0] * (forces.radii - radius)
    return levers.ravel()


def _bending(linear: LinearModel, layout: Layout, shift: Array) -> None:
    """Add the lift of the teeth by coordinates of gears that bend to `shift` (meshes, n), in place, m for
    a unit.

    It is minus the mean of the two flanks' rows, which is their separating part, over sin(pressure
    angle).
    """
    gears = {gear.name for gear in layout.gears}
    elastic_coordinates = [
        number
        for number, label in enumerate(linear.labels)
        if number >= layout.dof and label.rpartition(":")[0] in gears
    ]
    meshes = len(layout.meshes)
    separating_motion = 0.5 * (
        linear.rows[:meshes, elastic_coordinates] + linear.rows[meshes : 2 * meshes, elastic_coordinates]
    )
    shift[:, elastic_coordinates] = -separating_motion / np.sin(layout.pressure_angle)


@dataclass(frozen=True, eq=False)
class ForceDirections:
    """Directions of the flanks' forces by the pose, beside the motion along the ideal normal.

    Attributes
    ----------
    layout
        Layout of the machine.
    middle
        Position of the middle of the pinion's face on its axis, m.
    slopes : (2 meshes, parts)
        Derivatives of the deflections by the parts of a pose, drive flanks first; m/m and m/rad.
    levers : (2 meshes,)
        `rim_levers`, m: rows of a model have them of bodies that tilt, but not of rims that bend; None to
        leave them out.
    """

    layout: Layout
    middle: float
    slopes: Array
    levers: Array | None = None

    def __call__(self, base_model: LinearModel) -> LinearModel:
        """Return the model whose flank rows have these directions: `added_flank_rows` less `levers` times
        the slopes of rims along the radius is added to its rows.
        """
        added_rows = self.added_flank_rows(base_model)
        if self.levers is not None and base_model.slopes is not None:
            added_rows -= self.levers[:, None] * np.tile(base_model.slopes[0], (2, 1))
        return replace(base_model, rows=base_model.rows + added_rows)

    def added_flank_rows(self, model: LinearModel) -> Array:
        """Return what the directions add to the rows of the ideal contact: `slopes` times `pose_rows`.

        Columns of the pinions' tilts are zero where the middles of their faces take the force
        (`Layout.meshes_tilt_pinions`).

        Parameters
        ----------
        model : LinearModel
            Linear model of the machine.

        Returns
        -------
        (2 meshes, n) array
            m for a unit of each coordinate, drive flanks first.
        """
        has_tilts = self.layout.meshes_tilt_pinions
        parts = pose_rows(model, self.layout, self.middle, with_pinions=has_tilts)
        if not has_tilts:
            tilts = [f"{pinion.name}:{letter}" for pinion in self.layout.pinions for letter in TILT_LETTERS]
            parts[:, :, np.isin(model.labels, tilts)] = 0.0
        return np.asarray(np.einsum("fp,pfn->fn", self.slopes, np.concatenate([parts, parts], axis=1)))
