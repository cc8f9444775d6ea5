"""Forces of meshes along the normals that the loaded contact has, in place of those of the ideal one."""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array
from facegear.poses.mesh_poses import leaning_rows, pose_rows
from facegear.transmission.layout import TILT_LETTERS, Layout
from facegear.transmission.linear_model import LinearModel


@dataclass(frozen=True, eq=False)
class ForceDirections:
    """Directions of the flanks' forces by the pose, beside the motion along the ideal normal.

    Attributes
    ----------
    layout
        Layout of the machine.
    mean_radius
        Position of the middle of the pinion's face on its axis, m.
    slopes : (2 meshes, parts)
        Derivatives of the deflections by the parts of a pose, drive flanks first; m/m and m/rad.
    lever
        Lever of the ideal contact for an error of the shaft angle, m/rad: rows of a model have it of bodies
        that tilt, but not of rims that bend.
    """

    layout: Layout
    mean_radius: float
    slopes: Array
    lever: float = 0.0

    def __call__(self, base_model: LinearModel) -> LinearModel:
        """Return the model with these directions."""
        leaning = self.lever * leaning_rows(base_model, self.layout)
        added_rows = self.added_flank_rows(base_model) + np.concatenate([leaning, leaning])
        return replace(base_model, rows=base_model.rows + added_rows)

    def added_flank_rows(self, model: LinearModel) -> Array:
        """Return what the directions add to the rows of the ideal contact.

        A mesh turns no pinion about a diameter: the middle of its face takes the force.

        Parameters
        ----------
        model : LinearModel
            Linear model of the machine.

        Returns
        -------
        (2 meshes, n) array
            m for a unit of each coordinate.
        """
        parts = pose_rows(model, self.layout, self.mean_radius)
        tilts = [f"{pinion.name}:{letter}" for pinion in self.layout.pinions for letter in TILT_LETTERS]
        parts[:, :, np.isin(model.labels, tilts)] = 0.0
        return np.asarray(np.einsum("fp,pfn->fn", self.slopes, np.concatenate([parts, parts], axis=1)))
