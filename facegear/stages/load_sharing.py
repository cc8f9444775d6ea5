"""Load sharing of one machine at one speed."""

from facegear.config.dynamics import Accuracy, settings
from facegear.config.load_sharing import LoadSharing, sharing_options
from facegear.load_sharing.run import load_sharing as solve_load_sharing
from facegear.load_sharing.study_forces import force_table
from facegear.load_sharing.tables import curve_table, summary_table
from facegear.stages.outcome import Outcome
from facegear.transmission.machine import Machine


def load_sharing(
    machine: Machine,
    accuracy: Accuracy,
    speed_rpm: float,
    options: LoadSharing,
) -> Outcome:
    """Compute the load sharing at one speed.

    Parameters
    ----------
    machine : Machine
        The machine.
    accuracy : Accuracy
        Section `dynamics.accuracy` of the config.
    speed_rpm : float
        Speed of the pinions, rpm.
    options : LoadSharing
        Section `load_sharing` of the config.

    Returns
    -------
    Outcome
        Tables `curve`, `summary` and `forces`.

    Raises
    ------
    NotConverged
        Naming the speed.
    """
    sharing = solve_load_sharing(
        machine,
        speed_rpm,
        settings(accuracy),
        sharing_options(options),
    )
    summary, response = summary_table(sharing), sharing.response
    forces = force_table(
        machine.layout,
        response.mean_forces[1],
        response.largest_forces,
        response.label,
    )
    means = ", ".join(f"{row.group} {row.mean:.3f}" for row in summary.itertuples())
    return Outcome(
        {"curve": curve_table(sharing), "summary": summary, "forces": forces},
        f"{response.label}; mean coefficients: {means or 'no meshes share a load'}",
    )
