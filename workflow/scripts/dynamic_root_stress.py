"""Root stress of every mesh of the running machine at its nominal speed."""

from facegear.io import arrays, tables
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.dynamic_root_stress import dynamic_root_stress
from facegear.strength.columns import ROOT_STRESS_ARRAYS

with stage(snakemake) as run:
    response = tables.read(snakemake.input.response, ("mesh", "elastic_force_n"))
    stress = arrays.read(snakemake.input.stress, ROOT_STRESS_ARRAYS)
    found = dynamic_root_stress(response, stress, **snakemake.params.needs)
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
