"""Search one branch of the undisclosed inputs."""

from facegear.config.base import parse
from facegear.contact.columns import LTCA_COLUMNS
from facegear.io import tables
from facegear.paper.config.search import search_problem
from facegear.paper.config.sections import Identify, branches, search_budget
from facegear.paper.identify.search import search_branch
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    values = snakemake.params.values
    section = parse(Identify, snakemake.params.identify)
    branch = next(one for one in branches(section) if one.name == snakemake.wildcards.branch)
    problem = search_problem(values, section, tables.read(snakemake.input.ltca, LTCA_COLUMNS))
    found = search_branch(problem, branch, search_budget(section.budget))
    tables.write(snakemake.output.evaluations, found)
    best = found.loc[found["misfit"].idxmin()]
    run.summary(
        f"{len(found)} evaluations, misfit {best['misfit']:.2f}, largest deviation of a mean "
        f"{best['worst_mean']:.2f} at {best['per_input_n_m']:.0f} N m, tail {best['tail_share']:.2f}"
    )
