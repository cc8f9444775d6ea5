"""Mesh stiffness over a pitch at the operating load, and its harmonics."""

import pandas as pd

from facegear.config.stiffness import MeshStiffness, stiffness_request
from facegear.stages.outcome import Outcome
from facegear.stiffness.source import stiffness_from_contact, stiffness_given


def stiffness(mesh_stiffness: MeshStiffness, ltca: pd.DataFrame | None = None) -> Outcome:
    """Compute the mesh stiffness over a pitch, from the contact table or from the config's harmonics.

    Parameters
    ----------
    mesh_stiffness : MeshStiffness
        Section `mesh_stiffness` of the config.
    ltca : pd.DataFrame or None
        Table `ltca` of stage contact, None for the harmonics of the config.

    Returns
    -------
    Outcome
        Tables `tvms`, `harmonics` and `spectrum`.

    Raises
    ------
    ConfigError
        For a load outside those solved and for a k(t) that is not positive throughout.
    """
    request = stiffness_request(mesh_stiffness)
    result = stiffness_given(request) if ltca is None else stiffness_from_contact(ltca, request)
    content = {
        "tvms": result.curve,
        "harmonics": result.harmonics,
        "spectrum": result.spectrum,
    }
    return Outcome(content, result.summary)
