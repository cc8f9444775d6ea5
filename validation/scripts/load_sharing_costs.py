"""Time and error of load sharing over random machines."""

from facegear.build.plans import settings, sharing_options
from facegear.io import tables
from facegear.meshing.stiffness_source import HARMONICS_COLUMNS
from facegear.pipeline.provenance.stage import stage
from facegear.pipeline.run import machine_inputs
from facegear.progress import Progress
from facegear.schema.motion import Accuracy, LoadSharing
from validation.dynamics.sharing_costs import COUNT, sharing_costs, sharing_summary

with stage(snakemake) as run:
    params = snakemake.params
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    table = sharing_costs(
        machine_inputs({**params.machine, "harmonics": harmonics}).build(),
        settings(Accuracy.of_config(params.accuracy)),
        sharing_options(LoadSharing.of_config(params.options)),
        step=Progress("random machines", COUNT).step,
    )
    tables.write(snakemake.output.table, table)
    run.summary(sharing_summary(table))
