"""Figures 7 and 8: mesh stiffness over a period and its harmonics."""

from facegear.io import tables
from facegear.plots.stiffness import harmonic_amplitudes, stiffness_curve
from facegear.plots.style import save
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    curve = tables.read(snakemake.input.tvms, ["position", "k_n_per_m", "k_series_n_per_m"])
    spectrum = tables.read(snakemake.input.spectrum, ["order", "amplitude_n_per_m"])
    save(stiffness_curve(curve), snakemake.output.tvms_svg, snakemake.output.tvms_png)
    save(harmonic_amplitudes(spectrum), snakemake.output.harmonics_svg, snakemake.output.harmonics_png)
