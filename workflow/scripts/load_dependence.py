"""Mean and harmonics of the mesh stiffness at every torque solved."""

from facegear.contact.columns import LTCA_FINITE
from facegear.io import tables
from facegear.provenance.stage import stage
from facegear.stiffness.curve import load_table
from facegear.stiffness.tables import load_dependence

with stage(snakemake) as run:
    table = load_dependence(load_table(tables.read(snakemake.input.ltca, LTCA_FINITE)))
    tables.write(snakemake.output.table, table)
    means = table.loc[table["definition"] == "average", "mean_n_per_m"]
    run.summary(f"mean average stiffness {means.min():.3g} to {means.max():.3g} N/m over the torques solved")
