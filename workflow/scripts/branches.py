"""Branches of periodic motions over the speed, their special points, margins of the nominal speed."""

from facegear.config.base import parse
from facegear.config.branches import Branches, branch_plan
from facegear.config.machines import wired_machine
from facegear.dynamics.branches import tables as written
from facegear.dynamics.branches.machine import machine_flow, machine_survey, margins
from facegear.dynamics.branches.stored import SHAPES, from_arrays, special_arrays
from facegear.dynamics.branches.summary import survey_summary, tell
from facegear.dynamics.branches.survey import several
from facegear.dynamics.steady_state.simulate import build_model
from facegear.io import arrays, tables
from facegear.provenance.stage import stage
from facegear.stiffness.tables import HARMONICS_COLUMNS

JUMPS = ["direction", "speed_before_rpm", "speed_after_rpm", "class_before"]

with stage(snakemake) as run:
    params, output = snakemake.params, snakemake.output
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    model = build_model(wired_machine(params.transmission, params.teeth, harmonics))
    plan, layout = branch_plan(parse(Branches, params.branches), params.speed_rpm), model.machine.layout
    jumps = tables.read(snakemake.input.jumps, JUMPS, allow_empty=True)
    flow = machine_flow(model, plan)
    found = [from_arrays(flow, arrays.read(path, SHAPES)) for path in snakemake.input.starts]
    survey = machine_survey(model, plan, found, tell)
    branches, ranges, losses = (
        survey.branches,
        several(survey.branches),
        margins(model, plan, survey.branches),
    )
    tables.write(output.branches, written.branch_table(layout, branches))
    tables.write(output.ends, written.end_table(branches))
    tables.write(output.multipliers, written.multiplier_table(branches))
    tables.write(output.special, written.special_table(layout, branches))
    tables.write(output.coexistence, written.coexistence_table(found, branches))
    tables.write(output.ranges, written.range_table(ranges))
    tables.write(output.margins, written.margin_table(losses))
    named = written.jump_table(jumps, branches, params.jump_resolution_rpm)
    tables.write(output.jumps, named)
    arrays.write(output.orbits, **special_arrays(branches))
    run.summary(survey_summary(survey, ranges, losses, named))
