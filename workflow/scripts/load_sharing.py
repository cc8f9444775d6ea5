"""Load sharing of one case at the nominal speed."""

from facegear.config.base import parse
from facegear.config.dynamics import Accuracy, settings
from facegear.config.load_sharing import LoadSharing, sharing_options
from facegear.config.transmission import Transmission, machine, tooth_numbers
from facegear.io import tables
from facegear.load_sharing.run import load_sharing
from facegear.load_sharing.tables import curve_table, summary_table
from facegear.provenance.stage import stage
from facegear.stiffness.tables import HARMONICS_COLUMNS, series_of

with stage(snakemake) as run:
    params = snakemake.params
    stiffness = series_of(tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS))
    built = machine(parse(Transmission, params.section), tooth_numbers(**params.teeth), stiffness)
    sharing = load_sharing(
        built,
        params.speed_rpm,
        settings(parse(Accuracy, params.accuracy)),
        sharing_options(parse(LoadSharing, params.options)),
    )
    summary = summary_table(sharing)
    tables.write(snakemake.output.curve, curve_table(sharing))
    tables.write(snakemake.output.summary, summary)
    means = ", ".join(f"{row.group} {row.mean:.3f}" for row in summary.itertuples())
    run.summary(f"{sharing.response.label}; mean coefficients: {means or 'no meshes share a load'}")
