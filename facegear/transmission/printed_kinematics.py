"""Equation (13) of the source paper to the letter, to compare with the paper: not what gears do.

It stands in the library and not with the paper. The scan of bearing stiffness compares both kinematics for
every machine, a copy of the paper's config is to load from the installed package, and the fingerprint of a
stage must reach the code that its config names.
"""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.transmission.layout import DOF_PER_BODY, Layout


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
        """Accept any radii.

        Parameters
        ----------
        layout : Layout
            The layout to check.
        """

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
        """Return the radius at which forces act along the base radius.

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
        """Return the derivative of the flanks' deflections by the DOF.

        Drive flanks are as equation (13) has them; back flanks are their negative.

        Parameters
        ----------
        layout : Layout
            The layout.

        Returns
        -------
        (2 meshes, dof) array
            Drive flanks first; m/m, and m/rad for rotations.
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
