"""Load sharing at rest, running slowly, and over a range of speeds."""

from facegear.config.base import parse
from facegear.config.dynamics import Accuracy, settings
from facegear.config.load_sharing import LoadSharing, sharing_options
from facegear.config.transmission import Transmission, machine, tooth_numbers
from facegear.io import tables
from facegear.load_sharing.reference import reference_table, speed_range_table
from facegear.provenance.stage import stage
from facegear.stiffness.tables import HARMONICS_COLUMNS, series_of

with stage(snakemake) as run:
    params = snakemake.params
    stiffness = series_of(tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS))
    built = machine(parse(Transmission, params.section), tooth_numbers(**params.teeth), stiffness)
    options = sharing_options(parse(LoadSharing, params.options))
    reference = reference_table(built, settings(parse(Accuracy, params.accuracy)), options)
    speeds = speed_range_table(built, settings(parse(Accuracy, params.range_accuracy)), options)
    tables.write(snakemake.output.reference, reference)
    tables.write(snakemake.output.speeds, speeds)
    if speeds["mean"].notna().any():
        worst = speeds.loc[speeds["mean"].idxmax()]
        run.summary(f"largest mean {worst['mean']:.2f} ({worst['group']}) at {worst['speed_rpm']:.0f} rpm")
    else:
        run.summary("no meshes share a load")
