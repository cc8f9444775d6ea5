"""The pair at two poses by three programs; `python -m validation.poses.peer` renews the table.

One tooth of each gear, the part of the face about the contact path, without errors and at an offset as large
as what the bearings of config/concentric.yaml let its pinions move.
"""

import tempfile
from pathlib import Path

import facegear
from facegear.build.tooth_pair import pair
from facegear.teeth.mesh_sizes import MeshSizes
from validation.contact.pair_peer import LEVELS, SLICE, posed_peer_study

TABLE = Path(__file__).parents[2] / "docs" / "measured" / "pose_peer.csv"
TORQUE = 600.0
"""On the whole face, N m; the part that is cut out carries the same line load."""
OFFSETS = (0.0, -170e-6)
RADIUS = 0.267
"""Middle of the part of the face that is cut out, m."""
LEVEL = "medium"
DIGITS = {
    "torque_n_m": 3,
    "stiffness_n_per_um": 3,
    "pressure_mpa": 1,
    "path_mm": 3,
    "turn_rad": 9,
} | dict.fromkeys(("pinion_root_mpa", "gear_root_mpa"), 1)


def main() -> None:
    """Solve and store."""
    teeth = pair(facegear.load("config/concentric.yaml", results=None).config.tooth_pair)
    module, gear = teeth.design.module, teeth.design.face_gear
    torque = TORQUE * SLICE * module / (gear.outer_radius - gear.inner_radius)
    sizes = MeshSizes(*(module * size for size in LEVELS[LEVEL]))
    with tempfile.TemporaryDirectory() as folder:
        table = posed_peer_study(teeth.design, teeth.materials, torque, OFFSETS, RADIUS, sizes, Path(folder))
    values = table.drop(columns=["level", "cpu_seconds", "memory_gb"])
    values.round(DIGITS).to_csv(TABLE, index=False)


if __name__ == "__main__":
    main()
