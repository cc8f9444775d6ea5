"""Error against time of our integrator and others."""

import pandas as pd

import facegear
from facegear.door.outputs import machine_of
from facegear.io import tables
from facegear.meshing.stiffness_source import HARMONICS_COLUMNS
from facegear.pipeline.provenance.stage import stage
from facegear.pipeline.run import machine_inputs
from facegear.progress import Progress
from facegear.report.figures.draw_matplotlib import save_drawn
from validation.dynamics.methods import all_methods, tangent_methods
from validation.dynamics.problems import law_problems, machine_problems, oscillator_problem, tangent_problems
from validation.dynamics.work_precision import (
    Budget,
    gain,
    work_precision,
)
from validation.plots.work_precision import work_precision_diagram

with stage(snakemake) as run:
    params, output = snakemake.params, snakemake.output
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    machine = machine_inputs({**params.machine, "harmonics": harmonics}).build()
    load_dependent = machine_of(facegear.example())
    problems = [
        *machine_problems(machine, params.speed_rpm),
        oscillator_problem(),
        *law_problems(machine, load_dependent, params.speed_rpm),
    ]
    comparisons = [(problems, all_methods()), (tangent_problems(problems), tangent_methods())]
    step = Progress("methods", sum(len(first) * len(second) for first, second in comparisons)).step
    table = pd.concat([work_precision(*comparison, Budget(), step) for comparison in comparisons])
    tables.write(output.table, table)
    save_drawn(work_precision_diagram(table), output.svg, output.png)
    gains = [gain(table, problem, methods) for problems, methods in comparisons for problem in problems]
    run.summary("; ".join(gains))
