"""Stages of the mesh stiffness: its harmonics from contact or as given, and how it depends on load."""

import pandas as pd

from facegear.build.plans import stiffness_request
from facegear.meshing.stiffness_curve import load_table
from facegear.meshing.stiffness_source import load_dependence as table_of
from facegear.meshing.stiffness_source import stiffness_from_contact, stiffness_given
from facegear.number_format import format_number
from facegear.pipeline.outcome import Outcome
from facegear.schema.stiffness import MeshStiffness


def stiffness(
    mesh_stiffness: MeshStiffness,
    ltca: pd.DataFrame | None = None,
    flanks: pd.DataFrame | None = None,
) -> Outcome:
    """Compute the mesh stiffness over a pitch, from the contact table or from the config's harmonics.

    Parameters
    ----------
    mesh_stiffness : MeshStiffness
        Section `mesh_stiffness` of the config.
    ltca : pd.DataFrame or None
        Table `ltca` of stage contact; None where the config gives harmonics.
    flanks : pd.DataFrame or None
        Table `ltca_by_flank` of stage contact, of the flanks that have a stiffness of their own.

    Returns
    -------
    Outcome
        Tables `tvms` (k over a pitch, and its series), `harmonics` (series of k and of the transmission
        error) and `spectrum` (amplitudes of all orders). `StiffnessResult` lists the columns of the
        first two.

    Raises
    ------
    ConfigError
        For a load outside those solved and for a k(t) that is not positive throughout.
    """
    request = stiffness_request(mesh_stiffness)
    result = stiffness_given(request) if ltca is None else stiffness_from_contact(ltca, request, flanks)
    content = {
        "tvms": result.curve,
        "harmonics": result.harmonics,
        "spectrum": result.spectrum,
    }
    return Outcome(content, result.summary)


def load_dependence(ltca: pd.DataFrame) -> Outcome:
    """Compute mean and variation over a pitch of the mesh stiffness at every torque, by both
    definitions.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table `ltca` of stage contact.

    Returns
    -------
    Outcome
        `table`, a row a torque and definition (`average` or `local`), with mean_n_per_m (N/m) among its
        columns.
    """
    table = table_of(load_table(ltca))
    means = table.loc[table["definition"] == "average", "mean_n_per_m"]
    least, largest = (format_number(1e-6 * mean) for mean in (means.min(), means.max()))
    summary = f"mean average stiffness {least} to {largest} N/um over the torques solved"
    return Outcome({"table": table}, summary)
