"""One resolution of the contact benchmark."""

from facegear.build.plans import contact_plan
from facegear.build.tooth_pair import ToothPair, pair
from facegear.io import tables
from facegear.pipeline.provenance.stage import stage
from facegear.schema.contact import Contact
from validation.contact.benchmark import level, measure

with stage(snakemake) as run:
    teeth = pair(ToothPair.of_config(snakemake.params.tooth_pair))
    design = teeth.design
    plan = contact_plan(Contact.of_config(snakemake.params.contact))
    table = measure(design, level(snakemake.wildcards.level, design, plan), teeth.materials)
    tables.write(snakemake.output.table, table)
    row = table.iloc[-1]
    run.summary(f"{row['dof']} dof, mean {row['mean_n_per_m']:.4g} N/m at {row['torque_n_m']:g} N m")
