"""Contact of the cases of the studies side by side."""

from facegear.contact.studies import stored_cases, study_table
from facegear.io import tables
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    table = study_table(stored_cases(snakemake.params.points, dict(snakemake.input.items())))
    tables.write(snakemake.output.table, table)
    shift = table.loc[table["path_shift_mm"].abs().idxmax()]
    largest = f"{shift['path_shift_mm']:.2f} mm ({shift['label']})"
    run.summary(f"{len(snakemake.params.points) - 1} cases; largest shift of the contact path {largest}")
