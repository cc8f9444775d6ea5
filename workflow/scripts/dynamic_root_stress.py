"""Root stress of every mesh of the running machine at its nominal speed."""

from facegear.io import arrays, tables
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.dynamic_root_stress import dynamic_root_stress
from facegear.strength.columns import ROOT_STRESS_ARRAYS

with stage(snakemake) as run:
    response = tables.read(snakemake.input.response, ("mesh", "elastic_force_n"))
    stress = arrays.read(snakemake.input.stress, ROOT_STRESS_ARRAYS)
    by_torque = tables.read(snakemake.input.by_torque, ("torque_n_m",))
    found = dynamic_root_stress(response, stress, by_torque, **snakemake.params.needs)
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
