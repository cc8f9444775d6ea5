"""Loss, temperature and film of the studies' cases side by side."""

from collections.abc import Sequence

import pandas as pd

from facegear.lubrication.columns import FRICTION_STUDY_COLUMNS
from facegear.number_format import count_noun
from facegear.stages.outcome import Outcome


def friction_studies(
    points: Sequence[Sequence[str]], meshes: Sequence[pd.DataFrame], machine: Sequence[pd.DataFrame]
) -> Outcome:
    """Collect loss, temperature and film of the studies' cases side by side.

    Parameters
    ----------
    points : Sequence[Sequence[str]]
        Study, point and label of each case, the machine itself first.
    meshes : Sequence[pd.DataFrame]
        Table `meshes` of stage machine_loss of each case.
    machine : Sequence[pd.DataFrame]
        Table `machine` of stage machine_loss of each case.

    Returns
    -------
    Outcome
        `table`, a row for each case at its nominal load: loss of the machine, and its hottest mesh.
    """
    rows = []
    for point, by_mesh, whole in zip(points, meshes, machine, strict=True):
        nominal = whole[whole["bin"] == 0].iloc[0]
        at_rest = by_mesh[by_mesh["bin"] == 0]
        hottest = at_rest.loc[at_rest["contact_temperature_c"].idxmax()]
        of_machine = [nominal[key] for key in ("speed_rpm", "power_in_w", "loss_w", "loss_percent")]
        of_mesh = [hottest[key] for key in ("mesh", "contact_temperature_c", "scuffing_safety")]
        is_within_torques = bool(at_rest["within_torques_solved"].all())
        rows.append((*point, *of_machine, *of_mesh, at_rest["smallest_film_ratio"].min(), is_within_torques))
    table = pd.DataFrame(rows, columns=list(FRICTION_STUDY_COLUMNS))
    min_loss, max_loss = table["loss_percent"].min(), table["loss_percent"].max()
    return Outcome(
        {"table": table},
        f"{count_noun(len(table) - 1, 'case')}; loss from {min_loss:.3f} to {max_loss:.3f} %",
    )
