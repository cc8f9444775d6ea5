"""Time of contact against the number of positions and of loads."""

from facegear.build.plans import contact_plan
from facegear.build.tooth_pair import ToothPair, pair
from facegear.io import tables
from facegear.pipeline.provenance.stage import stage
from facegear.schema.contact import Contact
from validation.contact.benchmark import growth, level
from validation.contact.refinement_levels import DEFAULT

with stage(snakemake) as run:
    teeth = pair(ToothPair.of_config(snakemake.params.tooth_pair))
    design = teeth.design
    plan = contact_plan(Contact.of_config(snakemake.params.contact))
    base = level(DEFAULT, design, plan)
    table = growth(design, base, teeth.materials, (8, 16, 32, 64), (1, 2, 4, 8, 16))
    tables.write(snakemake.output.table, table)
    run.summary(f"{len(table)} runs, the longest {table['contact_s'].max():.1f} s")
