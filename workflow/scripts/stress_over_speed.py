"""Root stress and pressure over the speed range."""

from facegear.dynamics.branches.columns import BRANCH_COLUMNS
from facegear.io import arrays, tables
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.stress_over_speed import stress_over_speed
from facegear.stiffness.tables import HARMONICS_COLUMNS
from facegear.strength.columns import ROOT_STRESS_ARRAYS

with stage(snakemake) as run:
    given = snakemake.input
    sweep = tables.read(given.sweep, ("direction", "speed_rpm", "quantity", "body_or_mesh", "value", "class"))
    branches = tables.read(given.branches[0], BRANCH_COLUMNS[:6]) if given.branches else None
    stress = arrays.read(given.stress, ROOT_STRESS_ARRAYS)
    by_torque = tables.read(given.by_torque, ("torque_n_m",))
    harmonics = tables.read(given.harmonics, HARMONICS_COLUMNS)
    found = stress_over_speed(sweep, branches, stress, by_torque, harmonics, **snakemake.params.needs)
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
