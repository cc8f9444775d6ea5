"""Exact teeth as STEP and STL."""

from facegear.geometry.solids import triangles
from facegear.io.cad import write_step, write_stl
from facegear.provenance.stage import stage
from facegear.stages.cad import cad

with stage(snakemake) as run:
    body = snakemake.wildcards.body
    patches = cad(body, **snakemake.params.needs)
    volume = write_step(snakemake.output.step, patches, body)
    write_stl(snakemake.output.stl, triangles(patches))
    run.summary(f"{len(patches)} surfaces around {1e9 * volume:.2f} mm3")
