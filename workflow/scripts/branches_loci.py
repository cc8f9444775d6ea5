"""Loci of folds and period doublings in the plane of speed and a second parameter."""

from facegear.config.base import parse
from facegear.config.branches import Branches, branch_plan
from facegear.config.machines import wired_machine
from facegear.dynamics.branches.machine import machine_flow, machine_loci
from facegear.dynamics.branches.stored import SPECIAL_SHAPES, special_points
from facegear.dynamics.branches.summary import loci_summary
from facegear.dynamics.branches.tables import locus_table
from facegear.dynamics.steady_state.simulate import build_model
from facegear.io import arrays, tables
from facegear.provenance.stage import stage
from facegear.stiffness.tables import HARMONICS_COLUMNS

with stage(snakemake) as run:
    params = snakemake.params
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    model = build_model(wired_machine(params.transmission, params.teeth, harmonics))
    plan = branch_plan(parse(Branches, params.branches), params.speed_rpm)
    specials = special_points(machine_flow(model, plan), arrays.read(snakemake.input.orbits, SPECIAL_SHAPES))
    loci = machine_loci(model, plan, specials)
    tables.write(snakemake.output.loci, locus_table(loci))
    run.summary(loci_summary(loci))
