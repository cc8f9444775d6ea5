"""Natural frequencies, mode shapes and their classes."""

from dataclasses import replace

import numpy as np
import pandas as pd

from facegear.config.machines import MachineInputs
from facegear.errors import ConfigError
from facegear.harmonics.series import Harmonics
from facegear.number_format import count_noun, format_number
from facegear.stages.outcome import Outcome
from facegear.transmission.loaded_modes import vibrating_machine
from facegear.transmission.modal_tables import contact_table, frequency_table, shape_table
from facegear.transmission.mode_classes import name_modes


def modal(
    inputs: MachineInputs,
    mean_stiffness: float | None,
    source: str,
    definition: str,
) -> Outcome:
    """Compute natural frequencies and mode shapes with the mean mesh stiffness.

    With the stiffness stage's `harmonics` it is the mean of `definition` at the operating load, without them
    the config's own mean. With the arrays `law` of stage mesh_law every mesh has its local stiffness under
    its own load instead.

    Parameters
    ----------
    inputs : MachineInputs
        What the machine is built from.
    mean_stiffness : float or None
        Mean mesh stiffness of the config, N/m; None if it gives none.
    source : str
        Source of the mesh stiffness in the config.
    definition : str
        `local` or `average`.

    Returns
    -------
    Outcome
        Tables `frequencies`, `shapes` and `contacts`.

    Raises
    ------
    ConfigError
        Without any mean stiffness.
    """
    if isinstance(inputs.harmonics, pd.DataFrame):
        mean: float | None = float(inputs.harmonics[f"mean_{definition}_n_per_m"].iloc[0])
        source_text = definition
    else:
        mean = mean_stiffness
        source_text = f"{definition}, given" if source == "fem_scaled" else "given"
    if mean is None:
        raise ConfigError("mesh_stiffness.mean_n_per_m", None, "given where k(t) is not computed")
    constant, no_error = Harmonics(np.zeros(1), np.array([mean])), Harmonics(np.zeros(1), np.zeros(1))
    machine = replace(inputs, harmonics=constant, unloaded_error=no_error).build()
    vibration = vibrating_machine(machine)
    modes, contacts = vibration.modes, contact_table(machine, vibration, source_text)
    rigid = int((modes.frequencies == 0.0).sum())
    elastic = modes.frequencies[rigid:]
    content = {
        "frequencies": frequency_table(vibration, name_modes(machine.layout, machine.linear, modes)),
        "shapes": shape_table(machine.linear.labels, modes),
        "contacts": contacts,
    }
    stiffness_of_closed = contacts.loc[
        contacts["state"].isin(["drive", "back", "wedged"]), "stiffness_n_per_m"
    ]
    sizes = [mean] if inputs.law is None else [stiffness_of_closed.min(), stiffness_of_closed.max()]
    size = " to ".join(format_number(1e-6 * stiffness) for stiffness in sizes)
    summary = (
        f"{count_noun(rigid, 'rigid body mode')}, {elastic.size} elastic from {elastic[0]:.1f} to "
        f"{elastic[-1]:.1f} Hz, with a mesh stiffness of {size} N/um ({source_text})"
    )
    return Outcome(content, summary + _remarks(contacts, vibration.is_decided))


def _remarks(contacts: pd.DataFrame, is_decided: np.ndarray) -> str:
    """Remarks on contacts that are not simply closed."""
    parts = []
    for state in ("open", "wedged", "undecided"):
        if names := contacts.loc[contacts["state"] == state, "contact"].to_list():
            parts.append(f"; {state}: {', '.join(names)}")
    if not is_decided.all():
        parts.append(f"; {int((~is_decided).sum())} frequencies hang on contacts that are undecided")
    return "".join(parts)
