"""Do the classes of random oscillators hold, and are their orbits those that the runs come to?"""

from facegear.io import tables
from facegear.motion.plan import Settings
from facegear.pipeline.provenance.stage import stage
from facegear.progress import Progress
from validation.dynamics.oscillators import suite, verdict

COUNT = 500

with stage(snakemake) as run:
    table = suite(COUNT, Settings(), Progress("random oscillators", COUNT).step)
    tables.write(snakemake.output.table, table)
    run.summary(verdict(table))
