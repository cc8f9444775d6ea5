"""Natural frequencies, mode shapes and their classes."""

import numpy as np

from facegear.config.base import parse
from facegear.config.transmission import Transmission, machine, tooth_numbers
from facegear.harmonics.series import Harmonics
from facegear.io import tables
from facegear.provenance.stage import stage
from facegear.stiffness.tables import HARMONICS_COLUMNS, series_of
from facegear.transmission.loaded_modes import loaded_modes
from facegear.transmission.modal_tables import frequency_table, shape_table
from facegear.transmission.mode_classes import name_modes

with stage(snakemake) as run:
    params = snakemake.params
    mean = params.mean_stiffness
    if mean is None:
        mean = series_of(tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)).mean
    constant = Harmonics(np.zeros(1), np.array([mean]))
    whole = machine(parse(Transmission, params.section), tooth_numbers(**params.teeth), constant)
    shape, modes = whole.layout, loaded_modes(whole)
    names = name_modes(shape, modes)
    tables.write(snakemake.output.frequencies, frequency_table(modes, names))
    tables.write(snakemake.output.shapes, shape_table(shape, modes))
    rigid = int((modes.frequencies == 0.0).sum())
    elastic = modes.frequencies[rigid:]
    run.summary(f"{rigid} rigid body modes, {elastic.size} from {elastic[0]:.1f} to {elastic[-1]:.1f} Hz")
