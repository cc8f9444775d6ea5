"""Mesh stiffness over a period and its harmonics."""

from facegear.io import tables
from facegear.plots.stiffness import harmonic_amplitudes, stiffness_curve
from facegear.plots.style import save
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    curve = tables.read(snakemake.input.tvms, ["position", "k_n_per_m", "k_series_n_per_m"])
    spectrum = tables.read(snakemake.input.spectrum, ["order", "amplitude_n_per_m"])
    drawn = (stiffness_curve(curve), harmonic_amplitudes(spectrum))
    for figure, svg, png in zip(drawn, snakemake.output.svg, snakemake.output.png, strict=True):
        save(figure, svg, png)
