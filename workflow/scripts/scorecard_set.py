"""What the criteria find with another set of undisclosed inputs."""

from facegear.contact.columns import LTCA_COLUMNS
from facegear.io import tables
from facegear.paper.scorecard.claims import read_claims
from facegear.paper.scorecard.rows import outcome_table
from facegear.paper.scorecard.set_tables import set_tables
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    base, *others = snakemake.params.cases
    points = dict(zip(map(tuple, snakemake.params.points), others, strict=True))
    found = set_tables(base, points, tables.read(snakemake.input.ltca, LTCA_COLUMNS))
    claims = [claim for claim in read_claims(snakemake.input.claims).claims if claim.dynamic]
    outcomes = outcome_table(claims, found)
    tables.write(snakemake.output.outcomes, outcomes)
    run.summary(
        f"{outcomes['holds'].sum()} of {len(outcomes)} claims hold with set {snakemake.wildcards.set}"
    )
