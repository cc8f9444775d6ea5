"""Kinematics of meshes: as the teeth move, and as the source paper prints them.

Equation (13) of the source paper to the letter, to compare with the paper: not what gears do. It stands in
the library and not with the paper. The scan of bearing stiffness compares both kinematics for every machine,
a copy of the paper's config is to load from the installed package, and the fingerprint of a stage must reach
the code that its config names.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.errors import InvalidInput
from facegear.machine.layout import DOF_PER_BODY, Kinematics, Layout
from facegear.machine.mesh_frames import FlankFrame


@dataclass(frozen=True)
class PrintedKinematics:
    """Kinematics of equation (13): both flanks of a mesh share one line of action.

    Any radii are multiplied by the cosine of the pressure angle, and the angles of the pinions know no sense
    of rotation.
    """

    name: str = "printed"
    flanks_apart: bool = False
    follows_rotation: bool = False

    def require(self, layout: Layout) -> None:
        """Accept any radii of spur teeth, as the printed equation does, and refuse all other teeth.

        Parameters
        ----------
        layout : Layout
            The layout to check.
        """
        if layout.kind is not None:
            raise InvalidInput("transmission.mesh_kinematics", self.name, f"{GEOMETRIC.name}, {OTHER_TEETH}")

    def arm(self, radius: float, pressure_angle: float) -> float:
        """Return the torque over the mesh force that balances it: the radius times the cosine of the pressure
        angle.

        Parameters
        ----------
        radius : float
            Radius that a layout gives to a body, m.
        pressure_angle : float
            Pressure angle, rad.

        Returns
        -------
        float
            m.
        """
        return radius * float(np.cos(pressure_angle))

    def mesh_radius(self, layout: Layout) -> float:
        """Return the given radius of the face gear.

        Parameters
        ----------
        layout : Layout
            The layout.

        Returns
        -------
        float
            m.
        """
        return layout.gear_radius

    def gear_radius(self, base_radius: float, pressure_angle: float) -> float:
        """Return the radius that a layout gives to a face gear: base radius / cos(pressure angle).

        With it `arm` is the base radius again.

        Parameters
        ----------
        base_radius : float
            Base radius, m.
        pressure_angle : float
            Pressure angle, rad.

        Returns
        -------
        float
            m.
        """
        return float(base_radius / np.cos(pressure_angle))

    def flank_rows(self, layout: Layout) -> Array:
        """Return the derivative of the flanks' deflections by the degrees of freedom, as equation (13) is
        printed.

        With pressure angle a and distribution angle p of the pinion, a drive flank has cos a, sin a, 0,
        r_p cos a by the pinion's x, y, z, theta, and -cos p cos a, -sin p cos a, -+sin a, -r_g cos a by
        the gear's (upper sign for the upper gear). A back flank has the negative of all.

        Parameters
        ----------
        layout : Layout
            The layout.

        Returns
        -------
        (2 meshes, dof) array
            Drive flanks first; m/m, and m/rad for rotations. Positive motion along a row compresses the
            flank.
        """
        cosine, sine = np.cos(layout.pressure_angle), np.sin(layout.pressure_angle)
        angles = layout.angles
        rows = np.zeros((len(layout.meshes), layout.dof))
        for row, (i, g) in zip(rows, layout.meshes, strict=True):
            pinion = DOF_PER_BODY * i
            gear = DOF_PER_BODY * (len(layout.pinions) + g)
            axial = -layout.gears[g].sign
            row[pinion : pinion + 4] = cosine, sine, 0.0, layout.pinion_radius * cosine
            row[gear] = -np.cos(angles[i]) * cosine
            row[gear + 1] = -np.sin(angles[i]) * cosine
            row[gear + 2] = axial * sine
            row[gear + 3] = -layout.gear_radius * cosine
        return np.concatenate([rows, -rows])


PRINTED_KINEMATICS = PrintedKinematics()
"""The only object of its class."""


OTHER_TEETH = "where teeth are not spur teeth at right angles"
"""Condition of two refusals."""
SAME_ARM = 1e-9
"""Relative difference of radii that counts as none."""


@dataclass(frozen=True)
class Teeth:
    """Kinematics `geometric`: forces act along the normals of the flanks, each flank is a contact of its
    own, and `pinion_radius` and `gear_radius` of the layout are base radii.
    """

    name: str = "geometric"
    flanks_apart: bool = True
    follows_rotation: bool = True

    def require(self, layout: Layout) -> None:
        """Raise InvalidInput unless gear radius / pinion radius = gear teeth / pinion teeth, to 1e-9, and
        unless the pinion's radius is the arm of teeth that are not spur teeth at right angles.

        Parameters
        ----------
        layout : Layout
            The layout to check.
        """
        if layout.kind is not None:
            arm = layout.kind.normal_arms[0]
            if abs(layout.pinion_radius - arm) > SAME_ARM * arm:
                requirement = f"{arm:.9g} m, the arm of the drive flank's force, {OTHER_TEETH}"
                raise InvalidInput("pinion_radius", layout.pinion_radius, requirement)
        conjugate = layout.pinion_radius * layout.gear_teeth / layout.pinion_teeth
        if abs(layout.gear_radius - conjugate) > SAME_ARM * conjugate:
            requirement = f"{conjugate:.9g} m, as the tooth numbers say, where mesh_kinematics is geometric"
            raise InvalidInput("gear_radius", layout.gear_radius, requirement)

    def arm(self, radius: float, pressure_angle: float) -> float:
        """Return the torque over the mesh force that balances it: the radius itself.

        Parameters
        ----------
        radius : float
            Base radius, m.
        pressure_angle : float
            Pressure angle, rad.

        Returns
        -------
        float
            m.
        """
        return radius

    def mesh_radius(self, layout: Layout) -> float:
        """Return the distance of the meshes from the face gears' axis: the transverse module times the gear's
        tooth number over 2.

        Of spur teeth that is the gear's base radius / cos(pressure angle).

        Parameters
        ----------
        layout : Layout
            The layout.

        Returns
        -------
        float
            m.
        """
        if layout.kind is not None:
            return layout.kind.pitch_radius * layout.gear_teeth / layout.pinion_teeth
        return layout.gear_radius / float(np.cos(layout.pressure_angle))

    def gear_radius(self, base_radius: float, pressure_angle: float) -> float:
        """Return the radius of a face gear in the layout: its base radius.

        Parameters
        ----------
        base_radius : float
            Base radius, m.
        pressure_angle : float
            Pressure angle, rad.

        Returns
        -------
        float
            m.
        """
        return base_radius

    def flank_rows(self, layout: Layout) -> Array:
        """Return the derivative of the flanks' deflections by the degrees of freedom, from `flank_frames`.

        A force along the normal of a flank and its moment about the centre of a body are the derivative of
        the flank's deflection by the motion and the turn of the body. A pinion sees the lower gear as the
        upper one rotated by 180 degrees about its axis. Gears turn positively as the pinions drive them, and
        share one axial direction.

        Parameters
        ----------
        layout : Layout
            The layout.

        Returns
        -------
        (2 meshes, dof) array
            Drive flanks first; m/m, and m/rad for rotations and tilts. Positive motion along a row
            compresses the flank.
        """
        rows = np.zeros((2, len(layout.meshes), layout.dof))
        for mesh, (i, g) in enumerate(layout.meshes):
            for row, frame in zip(rows[:, mesh], layout.flank_frames[g], strict=True):
                pinion = DOF_PER_BODY * i
                row[pinion : pinion + 3] = frame.normal
                row[pinion + 3] = layout.pinion_arm * frame.arm
                _add_gear(row, layout, frame, (i, g))
        return np.concatenate([rows[0], rows[1]])


GEOMETRIC = Teeth()
"""The only object of its class."""


def _add_gear(row: Array, layout: Layout, frame: FlankFrame, mesh: tuple[int, int]) -> None:
    """Add to the row (dof,) of a flank the derivatives by the motions of its gear, in place.

    mesh: numbers of its pinion and gear.
    """
    pinion, g = mesh
    along = np.array([np.cos(layout.angles[pinion]), np.sin(layout.angles[pinion])])
    away = np.array([along[1], -along[0]])
    gear = DOF_PER_BODY * (len(layout.pinions) + g)
    across, height, outwards = frame.gear_normal
    row[gear : gear + 2] = -(across * along + outwards * away)
    row[gear + 2] = -height
    row[gear + 3] = -layout.gear_arm * frame.arm
    if g in layout.first_tilts:
        below = getattr(layout.gears[g].body.tilt, "below", 0.0)
        row[layout.first_tilts[g] : layout.first_tilts[g] + 2] = tilt_row(layout, frame, mesh, below)


def tilt_row(layout: Layout, frame: FlankFrame, mesh: tuple[int, int], below: float) -> Array:
    """Return the derivative of the deflection of a flank by tilts of its gear about x and y.

    Parameters
    ----------
    layout : Layout
        The layout.
    frame : FlankFrame
        Line of contact of the flank.
    mesh : tuple of int
        Numbers of its pinion and gear.
    below : float
        Distance of the point about which the gear tilts from the pitch plane, away from the pinions, m.

    Returns
    -------
    (2,) array
        m/rad.
    """
    pinion, gear = mesh
    along = np.array([np.cos(layout.angles[pinion]), np.sin(layout.angles[pinion])])
    away = np.array([along[1], -along[0]])
    about_tangent, _, about_outwards = frame.gear_moment(layout.gears[gear].sign * below)
    return -(about_tangent * along + about_outwards * away)


KINEMATICS: Mapping[str, Kinematics] = {
    kinematics.name: kinematics for kinematics in (GEOMETRIC, PRINTED_KINEMATICS)
}
"""Kinematics of the meshes by their names in a config."""
