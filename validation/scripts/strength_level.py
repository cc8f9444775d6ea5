"""Root stress of one resolution beside that of meshes twice as fine."""

import pandas as pd

from facegear.build.tooth_pair import ToothPair, pair
from facegear.io import tables
from facegear.pipeline.provenance.stage import stage
from facegear.teeth.mesh_sizes import named_sizes, thin_fillet
from validation.contact.stress_benchmark import stress_convergence
from validation.contact.stress_levels import OF_LEVEL

with stage(snakemake) as run:
    teeth, level = pair(ToothPair.of_config(snakemake.params.tooth_pair)), snakemake.wildcards.level
    sizes = thin_fillet(named_sizes(level, teeth.design.module), level)
    rows = [
        {"level": level, **row}
        for body in ("pinion", "face_gear")
        for row in stress_convergence(teeth.design, body, sizes, teeth.material(body), OF_LEVEL[level])
    ]
    table = pd.DataFrame(rows)
    tables.write(snakemake.output.table, table)
    run.summary(f"{level}: within {table['error_percent'].abs().max():.2g} % of the finer meshes")
