"""Random inputs, patterns of e(t) and repeated runs as the tables that the repository stores."""

import pandas as pd

from facegear.io import tables
from facegear.paper.scorecard.base_rates import by_pattern, totals
from facegear.paper.scorecard.claims import read_claims
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    files, output = snakemake.input, snakemake.output
    claims = read_claims(files.claims).claims
    random, structures, runs = (
        pd.concat([tables.read(path) for path in files[name]], ignore_index=True)
        for name in ("random", "structures", "runs")
    )
    patterns = by_pattern(structures, claims)
    tables.write(output.random, random)
    tables.write(output.structures, patterns)
    tables.write(output.runs, runs)
    found = totals(random, claims)
    run.summary(
        f"random inputs hold {found.mean:.1f} of {found.claims} claims on average, {found.spread[0]:.0f} to "
        f"{found.spread[1]:.0f} in 90 % of {found.held.size}; best pattern {patterns['pattern'][0]}: "
        f"{patterns['mean'][0]:.1f} of {patterns['claims'][0]}"
    )
