"""The whole sweep from its chunks: table, jumps, resonances, seams, waterfall."""

import pandas as pd

from facegear.config.base import parse
from facegear.config.dynamics import Sweep, sweep_plan
from facegear.config.transmission import Transmission, machine, tooth_numbers
from facegear.dynamics.steady_state.simulate import build_model
from facegear.dynamics.steady_state.spectra import ORDERS
from facegear.dynamics.sweeps.stored import SHAPES, from_arrays
from facegear.dynamics.sweeps.summary import sweep_summary
from facegear.dynamics.sweeps.sweep_tables import jump_table, resonance_table, seam_table, sweep_table
from facegear.dynamics.sweeps.whole_sweep import whole_sweep
from facegear.io import arrays, tables
from facegear.provenance.stage import stage
from facegear.stiffness.tables import HARMONICS_COLUMNS, series_of
from facegear.transmission.loaded_modes import loaded_modes

with stage(snakemake) as run:
    params, output = snakemake.params, snakemake.output
    stiffness = series_of(tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS))
    model = build_model(
        machine(parse(Transmission, params.section), tooth_numbers(**params.teeth), stiffness)
    )
    plan, layout = sweep_plan(parse(Sweep, params.sweep)), model.machine.layout
    files = iter(snakemake.input.chunks)
    chunks = {
        name: [from_arrays(arrays.read(next(files), SHAPES)) for _ in range(plan.chunks)]
        for name in plan.directions
    }
    found = whole_sweep(model, plan, chunks, snakemake.threads)
    modes = loaded_modes(model.machine)
    tables.write(output.sweep, pd.concat([sweep_table(layout, n, d.piece) for n, d in found.items()]))
    tables.write(output.jumps, pd.concat([jump_table(layout, n, d, modes) for n, d in found.items()]))
    tables.write(
        output.resonances, pd.concat([resonance_table(layout, n, d.piece, modes) for n, d in found.items()])
    )
    tables.write(output.seams, seam_table([seam for d in found.values() for seam in d.seams]))
    spectra = {
        f"{name}_{key}": getattr(d.piece, f)
        for name, d in found.items()
        for key, f in (("speed_rpm", "speeds"), ("amplitude_m", "spectrum"))
    }
    arrays.write(output.waterfall, orders=ORDERS, **spectra)
    run.summary(sweep_summary(found))
