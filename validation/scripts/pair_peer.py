"""The pair by three programs, or a message where one of them is not installed."""

from pathlib import Path

from facegear.build.tooth_pair import ToothPair, pair
from facegear.io import tables
from facegear.pipeline.provenance.stage import stage
from facegear.teeth.mesh_sizes import MeshSizes
from validation.contact.pair_peer import LEVELS, SLICE, middle, pair_peer_study

TORQUE = 600.0
"""On the whole face, N m; its middle carries the same line load."""

with stage(snakemake) as run:
    teeth = pair(ToothPair.of_config(snakemake.params.tooth_pair))
    gear, m = teeth.design.face_gear, teeth.design.module
    torque = TORQUE * SLICE * m / (gear.outer_radius - gear.inner_radius)
    levels = {name: MeshSizes(*(m * size for size in sizes)) for name, sizes in LEVELS.items()}
    folder = Path(snakemake.output.table).parent / "pair"
    folder.mkdir(parents=True, exist_ok=True)
    table = pair_peer_study(middle(teeth.design), teeth.materials, torque, levels, folder, snakemake.threads)
    tables.write(snakemake.output.table, table)
    stiffest = table["stiffness_error_percent"].abs().max()
    run.summary(f"stiffness within {stiffest:.1f} % of the resolved one")
