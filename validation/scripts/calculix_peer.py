"""Contact by CalculiX on the same pair, or a message where it is not installed."""

from pathlib import Path

from facegear.build.tooth_pair import ToothPair, pair
from facegear.io import tables
from facegear.pipeline.provenance.stage import stage
from facegear.teeth.mesh_sizes import MeshSizes, named_sizes
from validation.contact.peer_study import HAND_OVER, POSITIONS, peer_study

with stage(snakemake) as run:
    teeth = pair(ToothPair.of_config(snakemake.params.tooth_pair))
    design = teeth.design
    m = design.module
    levels = {
        "coarser": (MeshSizes(0.2 * m, 1.07 * m, 0.8 * m), POSITIONS),
        "coarse": (named_sizes("coarse", m), POSITIONS),
        "finer": (MeshSizes(0.13 * m, 0.6 * m, 0.8 * m), (HAND_OVER,)),
    }
    folder = Path(snakemake.output.table).parent / "calculix"
    folder.mkdir(parents=True, exist_ok=True)
    table = peer_study(design, levels, teeth.materials, 600.0, folder, snakemake.threads)
    tables.write(snakemake.output.table, table)
    run.summary(
        f"largest difference {table['difference_percent'].abs().max():.1f} %, time ratio "
        f"{table['time_ratio'].min():.0f} and more"
    )
