"""Gear ratio, speeds, torques and powers of the machine at its nominal speed."""

from facegear.stages.outcome import Outcome
from facegear.transmission.machine import Machine
from facegear.transmission.ratings import body_table, compute_ratings, mesh_table, number_table


def ratings(
    machine: Machine,
    speed_rpm: float,
) -> Outcome:
    """Compute ratio, speeds, torques and powers.

    Parameters
    ----------
    machine : Machine
        The machine.
    speed_rpm : float
        Nominal speed of the pinions, rpm.

    Returns
    -------
    Outcome
        Tables `ratings`, `bodies` and `meshes`.

    Raises
    ------
    NotConverged
        Where the equilibrium does not converge.
    """
    rating = compute_ratings(machine, speed_rpm)
    content = {
        "ratings": number_table(rating),
        "bodies": body_table(machine, speed_rpm),
        "meshes": mesh_table(machine, speed_rpm),
    }
    summary = f"ratio {rating.ratio:.4f}, mesh frequency {rating.mesh_frequency:.1f} Hz"
    return Outcome(
        content, f"{summary}, {1e-3 * rating.power_in:.4g} kW in, {1e-3 * rating.power_out:.4g} kW out"
    )
