"""The region of likely inputs: what holds in it, how well inputs are known, what never holds together."""

from facegear.config.base import parse
from facegear.io import tables
from facegear.paper.config.sections import Identify
from facegear.paper.identify.motions import distinct_inputs
from facegear.paper.identify.region import LOG_UNITS, region_tables
from facegear.paper.plots.region import region_figure
from facegear.paper.scorecard.base_rates import sound
from facegear.paper.scorecard.claims import read_claims
from facegear.plots.style import save
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    files, output = snakemake.input, snakemake.output
    claims = [claim for claim in read_claims(files.claims).claims if claim.dynamic]
    drawn = [tables.read_joined(paths) for paths in (files.random, files.structures)]
    searched = [tables.read_joined(paths, allow_empty=True) for paths in (files.searched, files.judged)]
    found = region_tables(*map(sound, (*drawn, *searched)), claims)
    for name, frame in found.items():
        tables.write(output[name], frame)
    ranges = parse(Identify, snakemake.params.identify).ranges
    correlated = found["correlations"].set_index("input")
    save(region_figure(distinct_inputs(found["region"]), correlated, ranges), output.svg, output.png)
    inputs = distinct_inputs(found["region"])
    best = inputs.iloc[0]
    run.summary(
        f"{len(inputs)} inputs within {LOG_UNITS:g} log units; the most likely ({best['pattern']}, "
        f"{best['per_input_n_m']:.0f} N m) holds {best['fitted']} fitted, {best['held_out']} held-out claims"
    )
