"""The dynamic tables of a case and its studies, by the stages that the workflow runs, in memory."""

import json
from collections.abc import Mapping
from typing import Any

import pandas as pd

from facegear.config.base import parse
from facegear.config.dynamics import Accuracy, settings
from facegear.config.load_sharing import LoadSharing, sharing_options
from facegear.config.machines import wired_machine
from facegear.config.needs import stage_needs
from facegear.dynamics.response_tables import response_table, spectrum_table
from facegear.dynamics.steady_state.simulate import build_model, simulate
from facegear.load_sharing.collect import NOMINAL, collected
from facegear.load_sharing.options import SharingOptions
from facegear.load_sharing.run import starting_states
from facegear.stages.dynamics_sweep import dynamics_sweep
from facegear.stages.dynamics_sweep_chunk import dynamics_sweep_chunk
from facegear.stages.load_sharing import load_sharing
from facegear.stages.outcome import Outcome
from facegear.stages.stiffness import stiffness

Values = Mapping[str, Any]


def set_tables(
    base: Values,
    points: Mapping[tuple[str, str], Values],
    ltca: pd.DataFrame,
    swept: bool = True,
    start: int = 0,
) -> dict[str, Any]:
    """Tables by name, as the criteria read them, from plain config values and the contact table.

    `points`: config values of each (study, point). All share the case's mesh stiffness. Without the sweep its
    two tables are not there. `start`: number of the starting state, 0 at rest; a sweep always begins there.
    """
    harmonics = stiffness(**stage_needs("stiffness", base), ltca=ltca).content["harmonics"]
    options = sharing_options(parse(LoadSharing, stage_needs("load_sharing", base)["options"]))
    response = _response(harmonics, options, start, **stage_needs("dynamics_response", base))
    sharing = _sharing({(NOMINAL, NOMINAL): base, **points}, harmonics, start)
    return {
        **response,
        **(_sweep(base, harmonics) if swept else {}),
        "sharing": collected({key: one.content["summary"] for key, one in sharing.items()}),
        "curves": collected({key: one.content["curve"] for key, one in sharing.items()}),
    }


def _response(
    harmonics: pd.DataFrame,
    options: SharingOptions,
    start: int,
    transmission: Values,
    teeth: Values,
    accuracy: Values,
    speed_rpm: float,
) -> dict[str, pd.DataFrame]:
    """The two tables of the response that criteria read; the stage makes more, which take as long again."""
    model = build_model(wired_machine(transmission, teeth, harmonics))
    state = starting_states(model, options, start + 1)[start]
    found = simulate(model, speed_rpm, settings(parse(Accuracy, accuracy)), state)
    layout = model.machine.layout
    return {"response": response_table(layout, found), "spectrum": spectrum_table(layout, found)}


def _sharing(
    cases: Mapping[tuple[str, str], Values], harmonics: pd.DataFrame, start: int
) -> dict[Any, Outcome]:
    """Load sharing of every case; cases that are the same machine are computed once."""
    known: dict[str, Outcome] = {}
    found = {}
    for key, values in cases.items():
        needs = stage_needs("load_sharing", values)
        machine = json.dumps(needs)
        if machine not in known:
            known[machine] = load_sharing(harmonics, **needs, start=start)
        found[key] = known[machine]
    return found


def _sweep(base: Values, harmonics: pd.DataFrame) -> Mapping[str, Any]:
    needs = stage_needs("dynamics_sweep", base)
    needs["sweep"] = {**needs["sweep"], "chunks": 1}
    chunks = [
        dynamics_sweep_chunk(direction, 0, harmonics, **needs).content["chunk"]
        for direction in needs["sweep"]["directions"]
    ]
    return dynamics_sweep(chunks, harmonics, **needs).content
