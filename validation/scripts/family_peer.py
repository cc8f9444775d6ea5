"""A helical and a tapered pair by three programs, or a message where one of them is not installed."""

from pathlib import Path

from facegear.io import tables
from facegear.pipeline.provenance.stage import stage
from validation.contact.family_peer import family_peer_study

with stage(snakemake) as run:
    table = family_peer_study(Path(snakemake.output.table).parent / "family", snakemake.threads)
    tables.write(snakemake.output.table, table)
    finest = table[table["program"].str.startswith("CalculiX")].groupby("teeth").tail(1)
    stiffness, pressure = (finest[f"{name}_error_percent"].abs().max() for name in ("stiffness", "pressure"))
    run.summary(f"CalculiX' stiffness within {stiffness:.2f} %, pressure within {pressure:.1f} % of ours")
