"""Error against time of our integrator and others."""

from facegear.config.base import parse
from facegear.config.transmission import Transmission, machine, tooth_numbers
from facegear.io import tables
from facegear.plots.style import save
from facegear.progress import Progress
from facegear.provenance.stage import stage
from facegear.stiffness.tables import HARMONICS_COLUMNS, series_of
from facegear.validation.dynamics.methods import all_methods
from facegear.validation.dynamics.problems import machine_problems, oscillator_problem
from facegear.validation.dynamics.work_precision import (
    Budget,
    cheapest_within_chance,
    seconds_at,
    work_precision,
)
from facegear.validation.plots.work_precision import work_precision_diagram

with stage(snakemake) as run:
    params, output = snakemake.params, snakemake.output
    stiffness = series_of(tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS))
    built = machine(parse(Transmission, params.section), tooth_numbers(**params.teeth), stiffness)
    problems = [*machine_problems(built, params.speed_rpm), oscillator_problem()]
    methods = all_methods()
    table = work_precision(
        problems, methods, Budget(), Progress("methods", len(methods) * len(problems)).step
    )
    tables.write(output.table, table)
    save(work_precision_diagram(table), output.svg, output.png)
    own, rest = methods[0].name, [method.name for method in methods[1:]]
    gains = []
    for problem in problems:
        if problem.statistical:
            enough = cheapest_within_chance(table, problem.name).set_index("method")["seconds"]
            gain = enough.drop(own).min() / enough[own]
            gains.append(
                f"{problem.name}: {gain:.1f} times the next best where only chance is left of the error"
            )
            continue
        others = [seconds_at(table, problem.name, name, 1e-6) for name in rest]
        gain = min(t for t in others if t == t) / seconds_at(table, problem.name, own, 1e-6)
        gains.append(f"{problem.name}: {gain:.1f} times the next best at 1e-6")
    run.summary("; ".join(gains))
