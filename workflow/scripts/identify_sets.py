"""Separate optima of the search, and how well they are known."""

import pandas as pd

from facegear.config.base import parse
from facegear.config.dynamics import Accuracy, settings
from facegear.contact.columns import LTCA_COLUMNS
from facegear.io import tables
from facegear.paper.config.search import search_problem
from facegear.paper.config.sections import Identify, search_space
from facegear.paper.identify.judge import confirmed, judge_sets
from facegear.paper.identify.optima import separate_optima
from facegear.paper.plots.landscape import landscape
from facegear.plots.style import save
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    values, output = snakemake.params.values, snakemake.output
    section = parse(Identify, snakemake.params.identify)
    problem = search_problem(values, section, tables.read(snakemake.input.ltca, LTCA_COLUMNS))
    found = pd.concat([tables.read(path) for path in snakemake.input.branches], ignore_index=True)
    budget = section.budget
    accuracy = settings(parse(Accuracy, values["dynamics"]["accuracy"]))
    points = confirmed(problem, found, accuracy, budget.slack)
    optima = separate_optima(points, search_space(section.ranges), budget.sets)
    judged = judge_sets(problem, optima, accuracy, budget.starts, budget.seed)
    tables.write(output.sets, judged.sets)
    tables.write(output.coefficients, judged.coefficients)
    tables.write(output.sensitivity, judged.sensitivity)
    save(landscape(found, judged.sets), output.svg, output.png)
    best = judged.sets[judged.sets["recommended"]].iloc[0]
    run.summary(
        f"{len(judged.sets)} sets; recommended {best['set']}: misfit {best['misfit']:.2f}, largest "
        f"deviation of a mean {best['judged_worst_mean']:.2f}"
    )
