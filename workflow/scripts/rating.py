"""Safety and life of the tooth pair."""

from facegear.io import arrays, tables
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.rating import rating
from facegear.strength.columns import DUTY_SPECTRUM_COLUMNS, ROOT_STRESS_ARRAYS

with stage(snakemake) as run:
    stress = arrays.read(snakemake.input.stress, ROOT_STRESS_ARRAYS)
    loads = [tables.read(path, DUTY_SPECTRUM_COLUMNS) for path in snakemake.input.duty_spectrum]
    by_torque = tables.read(snakemake.input.by_torque, ("torque_n_m",))
    found = rating(stress, by_torque, *loads, **snakemake.params.needs)
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
