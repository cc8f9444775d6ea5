"""All dynamic tables of a machine and its studies in memory, for sets of inputs other than the config's."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import pandas as pd

from facegear.dynamics.motion import Settings
from facegear.dynamics.response_tables import response_table, spectrum_table
from facegear.dynamics.steady_state.simulate import build_model, simulate
from facegear.dynamics.sweeps.plan import SweepPlan
from facegear.dynamics.sweeps.sweep import run_chunk
from facegear.dynamics.sweeps.sweep_tables import jump_table, sweep_table
from facegear.dynamics.sweeps.whole_sweep import whole_sweep
from facegear.load_sharing.collect import NOMINAL, collected
from facegear.load_sharing.options import SharingOptions
from facegear.load_sharing.reference import reference_table
from facegear.load_sharing.run import load_sharing
from facegear.load_sharing.tables import curve_table, summary_table
from facegear.transmission.loaded_modes import loaded_modes
from facegear.transmission.machine import Machine


@dataclass(frozen=True)
class RunSettings:
    """Nominal speed (rpm), settings of the steady state, of the load sharing, and of the sweep."""

    speed: float
    settings: Settings
    sharing: SharingOptions
    sweep: SweepPlan


def simulated_tables(
    machine: Machine, studies: Mapping[tuple[str, str], Machine], settings: RunSettings
) -> dict[str, pd.DataFrame]:
    """The same tables as the workflow's stages write: response, spectrum, sweep, jumps, sharing, curves,
    reference. `studies` holds the machine of each (study, point).
    """
    model = build_model(machine)
    layout = machine.layout
    response = simulate(model, settings.speed, settings.settings)
    plan = replace(settings.sweep, chunks=1)
    chunks = {direction: [run_chunk(model, plan, direction, 0)] for direction in plan.directions}
    sweep = whole_sweep(model, plan, chunks)
    modes = loaded_modes(machine)
    sharing = {
        key: load_sharing(one, settings.speed, settings.settings, settings.sharing)
        for key, one in {(NOMINAL, NOMINAL): machine, **studies}.items()
    }
    return {
        "response": response_table(layout, response),
        "spectrum": spectrum_table(layout, response),
        "sweep": pd.concat([sweep_table(layout, name, one.piece) for name, one in sweep.items()]),
        "jumps": pd.concat([jump_table(layout, name, one, modes) for name, one in sweep.items()]),
        "sharing": collected({key: summary_table(one) for key, one in sharing.items()}),
        "curves": collected({key: curve_table(one) for key, one in sharing.items()}),
        "reference": reference_table(machine, settings.settings, settings.sharing),
    }
