"""Figures 9 to 12, Campbell diagram and waterfall, from tables alone."""

from facegear.io import arrays, tables
from facegear.plots.campbell import campbell, waterfall
from facegear.plots.response import deflections
from facegear.plots.style import save
from facegear.plots.sweep import mesh_sweeps, translations
from facegear.provenance.stage import stage

SWEEP = ["direction", "speed_rpm", "quantity", "body_or_mesh", "value", "class"]

with stage(snakemake) as run:
    params, given = snakemake.params, snakemake.input
    pinions = [place["name"] for place in params.pinions]
    roles = [place["role"] for place in params.pinions]
    typical = [name for i, name in enumerate(pinions) if roles[i] not in roles[:i]]
    sides = [side for side in ("upper", "lower") if side in params.gears]
    sweep = tables.read(given.sweep, SWEEP)
    jumps = tables.read(given.jumps, ["direction", "speed_after_rpm", "resonance", "order"], allow_empty=True)
    peaks = tables.read(given.resonances, ["speed_rpm", "resonance", "order"], allow_empty=True)
    response = tables.read(given.response, ["mesh_cycle", "mesh", "deflection_um"])
    spectrum = tables.read(given.spectrum, ["mesh", "order", "amplitude_um"])
    frequencies = tables.read(given.frequencies, ["frequency_hz", "class"])
    spectra = arrays.read(given.waterfall, {"orders": (None,)})
    gears = [f"{side} face gear" for side in ("lower", "upper") if side in params.gears]
    meshes = [f"{name}/{side}" for side in ("lower", "upper") if side in params.gears for name in pinions]
    shown = f"{typical[-1]}/{sides[0]}"
    figures = {
        "fig09": deflections(response, spectrum, pinions, params.speed_rpm),
        "fig10": translations(sweep, typical, "xy"),
        "fig11": translations(sweep, gears, "xyz"),
        "fig12": mesh_sweeps(sweep, jumps, typical, sides),
        "campbell": campbell(frequencies, peaks, jumps, params.pinion_teeth, sweep["speed_rpm"].max()),
        "waterfall": waterfall(spectra, meshes.index(shown), shown, params.pinion_teeth),
    }
    for svg, png, figure in zip(snakemake.output.svg, snakemake.output.png, figures.values(), strict=True):
        save(figure, svg, png)
