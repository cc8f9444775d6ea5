"""The region of likely inputs: what holds in it, how well inputs are known, what never holds together."""

import pandas as pd

from facegear.config.base import parse
from facegear.io import tables
from facegear.paper.config.sections import Identify
from facegear.paper.identify.inputs import INPUT_COLUMNS
from facegear.paper.identify.region import (
    LOG_UNITS,
    correlations,
    held_counts,
    most_likely,
    never_together,
    searches,
)
from facegear.paper.identify.search import LOG_LIKELIHOOD
from facegear.paper.plots.region import region_figure
from facegear.paper.scorecard.base_rates import by_input, shares_of, sound
from facegear.paper.scorecard.claims import read_claims
from facegear.plots.style import save
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    files, output = snakemake.input, snakemake.output
    claims = [claim for claim in read_claims(files.claims).claims if claim.dynamic]
    random, structures, searched, judged = (
        sound(pd.concat([tables.read(path) for path in files[name]], ignore_index=True))
        for name in ("random", "structures", "searched", "judged")
    )
    region = most_likely(judged, LOG_UNITS)
    held = [claim.id for claim in claims]
    told = pd.concat(
        [region[[*INPUT_COLUMNS, LOG_LIKELIHOOD]], held_counts(region, claims), region[held]], axis=1
    )
    tables.write(output.region, told)
    tables.write(output.searches, searches(searched, claims))
    tables.write(output.shares, shares_of({"region": region, "random": random}, claims))
    looked_at = {"random": random, "patterns": structures, "searched": searched, "likely": judged}
    kinds = pd.concat([one.assign(kind=name) for name, one in looked_at.items()], ignore_index=True)
    counts = [by_input(one.assign(kind=name), claims, "kind") for name, one in looked_at.items()]
    tables.write(output.counts, pd.concat(counts, ignore_index=True))
    tables.write(output.never_together, never_together(kinds, claims))
    correlated = correlations(region)
    tables.write(output.correlations, correlated.reset_index(names="input"))
    section = parse(Identify, snakemake.params.identify)
    save(region_figure(region, correlated, section.ranges), output.svg, output.png)
    best = told.iloc[0]
    run.summary(
        f"{len(region)} inputs within {LOG_UNITS:g} log units; the most likely ({best['pattern']}, "
        f"{best['per_input_n_m']:.0f} N m) holds {best['fitted']} fitted, {best['held_out']} held-out claims"
    )
