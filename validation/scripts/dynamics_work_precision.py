"""Error against time of our integrator and others."""

import pandas as pd

import facegear
from facegear.io import tables
from facegear.meshing.stiffness_source import HARMONICS_COLUMNS
from facegear.pipeline.provenance.stage import stage
from facegear.pipeline.run import machine_inputs
from facegear.progress import Progress
from facegear.report.figures.draw_matplotlib import save_drawn
from validation.dynamics.methods import all_methods, law_methods, tangent_methods
from validation.dynamics.problems import (
    LAW_SPEED,
    law_machines,
    law_problems,
    machine_problems,
    oscillator_problem,
    tangent_problems,
)
from validation.dynamics.work_precision import Budget, gain, work_precision
from validation.plots.work_precision import work_precision_diagram

with stage(snakemake) as run:
    params, output = snakemake.params, snakemake.output
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    machine = machine_inputs({**params.machine, "harmonics": harmonics}).build()
    example = facegear.example()
    problems = [*machine_problems(machine, params.speed_rpm), oscillator_problem()]
    laws = law_problems(law_machines(example), LAW_SPEED * example.values["dynamics"]["speed_rpm"])
    comparisons = [
        (problems, all_methods()),
        (tangent_problems(problems), tangent_methods()),
        (laws, law_methods()),
    ]
    step = Progress("methods", sum(len(methods) for _, methods in comparisons)).step
    parts = [work_precision(*comparison, Budget(), step) for comparison in comparisons]
    table = pd.concat(parts)
    tables.write(output.table, table)
    save_drawn(work_precision_diagram(pd.concat(parts[:2])), output.svg, output.png)
    save_drawn(work_precision_diagram(parts[2]), output.svg_of_laws, output.png_of_laws)
    gains = [gain(table, problem, methods) for problems, methods in comparisons for problem in problems]
    run.summary("; ".join(gains))
