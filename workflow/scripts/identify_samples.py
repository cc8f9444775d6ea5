"""What random inputs say: base rates, patterns of e(t), other choices, the null, kinematics."""

import pandas as pd

from facegear.config.base import parse
from facegear.io import tables
from facegear.paper.config.sections import Identify
from facegear.paper.identify.inputs import CHOICES
from facegear.paper.identify.null import THIS, null_counts, null_summary
from facegear.paper.scorecard.base_rates import by_input, shares_of, totals
from facegear.paper.scorecard.claims import read_claims
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    files, output = snakemake.input, snakemake.output
    claims = read_claims(files.claims).claims
    section = parse(Identify, snakemake.params.identify).search
    random, structures, geometric = (
        tables.read_joined(files[name]) for name in ("random", "structures", "geometric")
    )
    patterns = by_input(structures, claims, "pattern")
    choices = pd.concat([by_input(structures, claims, name) for name in CHOICES], ignore_index=True)
    null = null_summary(null_counts(structures, claims, section.papers, section.seed)).set_index("paper")
    tables.write(output.random, random)
    tables.write(output.structures, patterns)
    tables.write(output.choices, choices)
    tables.write(output.null, null.reset_index())
    same = structures[structures["sample"].isin(geometric["sample"])]
    tables.write(output.kinematics, shares_of({"printed": same, "geometric": geometric}, claims))
    found = totals(random, claims)
    run.summary(
        f"random inputs hold {found.mean:.1f} of {found.claims} claims on average; best pattern "
        f"{patterns['value'][0]}: {patterns['mean'][0]:.1f} of {patterns['claims'][0]} fitted ones; the most "
        f"likely {null.loc[THIS, 'fitted_mean']:.0f}, and {null.loc[THIS, 'held_out_mean']:.0f} of the others"
    )
