"""Deflections, sweeps, Campbell diagram and waterfall, from tables alone."""

from facegear.io import arrays, tables
from facegear.plots.dynamics import SWEEP_FIGURES, drawn_machine
from facegear.plots.response import deflections
from facegear.plots.style import save
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    params, given = snakemake.params, snakemake.input
    machine = drawn_machine(params.transmission, params.pinion_teeth)
    response = tables.read(given.response, ["mesh_cycle", "mesh", "deflection_um"])
    spectrum = tables.read(given.spectrum, ["mesh", "order", "amplitude_um"])
    found = {
        "sweep": tables.read(
            given.sweep, ["direction", "speed_rpm", "quantity", "body_or_mesh", "value", "class"]
        ),
        "jumps": tables.read(given.jumps, ["direction", "speed_after_rpm", "order"], allow_empty=True),
        "resonances": tables.read(given.resonances, ["speed_rpm", "resonance", "order"], allow_empty=True),
        "frequencies": tables.read(given.frequencies, ["frequency_hz", "class"]),
        "waterfall": arrays.read(given.waterfall, {"orders": (None,)}),
    }
    figures = [deflections(response, spectrum, machine.pinions, params.speed_rpm)]
    figures += [draw(found, machine) for draw in SWEEP_FIGURES.values()]
    for svg, png, figure in zip(snakemake.output.svg, snakemake.output.png, figures, strict=True):
        save(figure, svg, png)
