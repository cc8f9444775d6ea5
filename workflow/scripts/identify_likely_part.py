"""The most likely inputs of all searches judged with a speed sweep, a part of them."""

from pathlib import Path

from facegear.config.base import parse
from facegear.contact.columns import LTCA_FINITE
from facegear.io import tables
from facegear.paper.config.sections import Identify
from facegear.paper.identify.claim_judge import QUICK
from facegear.paper.identify.likelihood import Likelihood
from facegear.paper.identify.motions import judged_motions
from facegear.paper.identify.random_verdicts import dynamic_judge
from facegear.paper.identify.region import candidates
from facegear.paper.scorecard.claims import read_claims
from facegear.progress import Progress
from facegear.provenance.stage import stage
from facegear.scenarios.chunks import identity

with stage(snakemake) as run:
    files, params = snakemake.input, snakemake.params
    section = parse(Identify, params.identify).search
    ltca = tables.read(files.ltca, LTCA_FINITE)
    random = tables.read_joined([*files.structures, *files.random])
    searched = tables.read_joined(files.searched, allow_empty=True)
    likelihood = Likelihood.of(read_claims(files.claims).claims, random)
    chosen = candidates(searched, likelihood, section.judged).iloc[
        int(snakemake.wildcards.part) :: section.parts
    ]
    judge = dynamic_judge(params.case, ltca, files.claims, settings=QUICK)
    partial = Path(snakemake.output.judged).with_suffix(".partial")
    same = identity(judge.deciding, chosen.to_csv(), section.starts, params.code)
    progress = Progress(f"likely inputs, part {snakemake.wildcards.part}", len(chosen) * section.starts)
    rows = chosen.to_dict("records")
    found = judged_motions(judge, likelihood, rows, section.starts, partial, same, progress.step)
    tables.write(snakemake.output.judged, found)
    partial.unlink()
    held = found[judge.names].sum(axis=1)
    run.summary(
        f"{len(found)} motions hold {held.mean():.1f} of {len(judge.names)} claims, at most {held.max():.0f}"
    )
