"""Natural frequencies, mode shapes and their classes."""

from facegear.config.base import parse
from facegear.config.transmission import Transmission, layout, tooth_numbers
from facegear.io import tables
from facegear.provenance.stage import stage
from facegear.transmission.modal_tables import frequency_table, shape_table
from facegear.transmission.mode_classes import name_modes
from facegear.transmission.modes import natural_modes

with stage(snakemake) as run:
    params = snakemake.params
    shape = layout(parse(Transmission, params.section), tooth_numbers(**params.teeth))
    modes = natural_modes(shape, params.mean_stiffness)
    names = name_modes(shape, modes)
    tables.write(snakemake.output.frequencies, frequency_table(modes, names))
    tables.write(snakemake.output.shapes, shape_table(shape, modes))
    rigid = int((modes.frequencies == 0.0).sum())
    elastic = modes.frequencies[rigid:]
    run.summary(f"{rigid} rigid body modes, {elastic.size} from {elastic[0]:.1f} to {elastic[-1]:.1f} Hz")
