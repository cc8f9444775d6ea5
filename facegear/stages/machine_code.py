"""Machine code of the time integration, compiled while the compliances are computed."""

from facegear.dynamics.steady_state.prepare import prepare, prepare_abreast
from facegear.stages.outcome import Outcome


def machine_code(mesh_law: str, motion: bool, side_by_side: bool) -> Outcome:
    """Fill the user's cache with compiled code, so that stages that start side by side find it there.

    Parameters
    ----------
    mesh_law : str
        Law of the mesh forces, as in the config.
    motion, side_by_side : bool
        Whether code of the time integration and of machines side by side is needed.

    Returns
    -------
    Outcome
        No files.
    """
    if motion:
        prepare(load_dependent=mesh_law == "load_dependent")
    if side_by_side:
        prepare_abreast()
    return Outcome({}, "ready")
