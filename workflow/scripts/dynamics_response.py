"""Response at the nominal speed: time history, spectrum, statistics, multipliers."""

from facegear.config.base import parse
from facegear.config.dynamics import Accuracy, settings
from facegear.config.transmission import Transmission, machine, tooth_numbers
from facegear.dynamics.response_tables import (
    multiplier_table,
    response_table,
    spectrum_table,
    summary_of_response,
)
from facegear.dynamics.steady_state.simulate import build_model, simulate
from facegear.dynamics.sweeps.summary import response_summary
from facegear.io import tables
from facegear.provenance.stage import stage
from facegear.stiffness.tables import HARMONICS_COLUMNS, series_of

with stage(snakemake) as run:
    params, output = snakemake.params, snakemake.output
    stiffness = series_of(tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS))
    model = build_model(
        machine(parse(Transmission, params.section), tooth_numbers(**params.teeth), stiffness)
    )
    response = simulate(model, params.speed_rpm, settings(parse(Accuracy, params.accuracy)))
    layout = model.machine.layout
    tables.write(output.response, response_table(layout, response))
    tables.write(output.spectrum, spectrum_table(layout, response))
    tables.write(output.summary, summary_of_response(model, params.speed_rpm, response))
    tables.write(output.multipliers, multiplier_table(response))
    run.summary(response_summary(response))
