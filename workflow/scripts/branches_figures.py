"""Branches over speed, loci, shares of starts and multipliers, from tables alone."""

from facegear.dynamics.branches.columns import BRANCH_COLUMNS
from facegear.io import tables
from facegear.plots.branches import amplitudes, loci, multipliers, shares, typical_meshes
from facegear.plots.style import save
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    params, given = snakemake.params, snakemake.input
    sweep = tables.read(given.sweep, ["direction", "speed_rpm", "quantity", "body_or_mesh", "value"])
    branches = tables.read(given.branches, [n for n in BRANCH_COLUMNS if "multiplier" not in n])
    special = tables.read(given.special, ["branch", "kind", "speed_rpm", "arc"], allow_empty=True)
    starts = tables.read(given.coexistence, ["speed_rpm", "share", "error"], text=["branch", "motion"])
    curves = tables.read(given.loci, ["locus", "factor", "speed_rpm"], allow_empty=True)
    circle = tables.read(given.multipliers, ["branch", "speed_rpm", "real", "imaginary"])
    meshes = typical_meshes(params.pinions, branches["mesh"])
    figures = [
        amplitudes(branches, special, sweep, meshes, params.speed_rpm),
        loci(curves, params.speed_rpm),
        shares(starts),
        multipliers(circle),
    ]
    for svg, png, figure in zip(snakemake.output.svg, snakemake.output.png, figures, strict=True):
        save(figure, svg, png)
