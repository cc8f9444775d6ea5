"""Machine code of contact and time integration, compiled while the compliances are computed."""

from facegear.contact.prepare import prepare as prepare_contact
from facegear.dynamics.steady_state.prepare import prepare, prepare_abreast
from facegear.stages.outcome import Outcome


def machine_code(mesh_law: str, contact: bool, motion: bool, side_by_side: bool) -> Outcome:
    """Fill the user's cache with compiled code, so that stages that start side by side find it there.

    Parameters
    ----------
    mesh_law : str
        Law of the mesh forces, as in the config.
    contact, motion, side_by_side : bool
        Whether code of a contact, of the time integration and of machines side by side is needed.

    Returns
    -------
    Outcome
        No files.
    """
    if contact:
        prepare_contact()
    if motion:
        prepare(load_dependent=mesh_law == "load_dependent")
    if side_by_side:
        prepare_abreast()
    return Outcome({}, "ready")
