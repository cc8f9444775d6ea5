"""Mesh stiffness over a pitch at the operating load, and its harmonics."""

import pandas as pd

from facegear.config.stiffness import MeshStiffness, stiffness_request
from facegear.stages.outcome import Outcome
from facegear.stiffness.source import stiffness_from_contact, stiffness_given


def stiffness(mesh_stiffness: MeshStiffness, ltca: pd.DataFrame | None = None) -> Outcome:
    """`tvms`, `harmonics` and `spectrum` (tables), from the contact table or from the config's harmonics.

    Raises ConfigError for a load outside those solved and for a k(t) that is not positive throughout.
    """
    request = stiffness_request(mesh_stiffness)
    result = stiffness_given(request) if ltca is None else stiffness_from_contact(ltca, request)
    content = {
        "tvms": result.curve,
        "harmonics": result.harmonics,
        "spectrum": result.spectrum,
    }
    return Outcome(content, result.summary)
