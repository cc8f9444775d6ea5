"""Names that tables and files share: the two bodies of a pair, quantities by which a machine is judged."""

from collections.abc import Sequence
from typing import Literal

Body = Literal["pinion", "face_gear"]
BODIES: tuple[Body, ...] = ("pinion", "face_gear")
"""Names of the bodies of a pair, pinion first."""

K_GAMMA, K_V = "k_gamma", "k_v"
"""Mesh load factor and dynamic factor, with which names of paths begin."""
PEAK, OPEN_FRACTION, REVERSED_FRACTION = "peak_mesh_force_n", "open_fraction", "reversed_fraction"
"""Largest load of a mesh, and fractions of time with an open and with a reversed mesh."""
BEARINGS = "bearing_mass"
"""Mass of all bearings (`facegear.sharing.quantities`)."""
PAST_LAW = "past_law_fraction"
"""Largest fraction of positions at which a flank is past the last level of its law."""
ERROR_RANGE, ERROR_HARMONIC, PRESSURE = "te_peak_to_peak_um", "te_first_harmonic_um", "pressure_mpa"
"""Loaded transmission error of the tooth pair, and its pressure."""
ROOTS = {"pinion": "root_stress_pinion_mpa", "face_gear": "root_stress_face_gear_mpa"}
"""Root stress of both bodies."""
CONTACT = (ERROR_RANGE, ERROR_HARMONIC, PRESSURE, *ROOTS.values())
"""Quantities that a contact analysis alone gives."""
LOSS, LOSS_PERCENT = "friction_loss_w", "friction_loss_percent"
"""Friction loss of all meshes."""
BULK, FLASH, CONTACT_TEMPERATURE = "hottest_body_c", "largest_flash_k", "contact_temperature_c"
"""Hottest body, largest flash temperature and hottest contact."""
SCUFFING, SCUFFING_MARGIN = "scuffing_safety", "scuffing_margin_k"
"""Scuffing safety, and its margin in temperature."""
FILM, FILM_RATIO = "smallest_film_um", "smallest_film_ratio"
"""Thinnest film, and its smallest ratio to the roughness."""
MICROPITTING = "smallest_micropitting_film_ratio"
"""Smallest specific film for micropitting, dimensionless."""
UNSOLVED = "unsolved_loss_share"
"""Fraction of the loss by meshes at torques beyond those solved, dimensionless."""
FRICTION = (
    *(LOSS, LOSS_PERCENT, BULK, FLASH, CONTACT_TEMPERATURE, SCUFFING, SCUFFING_MARGIN),
    *(FILM, FILM_RATIO, MICROPITTING, UNSOLVED),
)
"""Quantities of section lubrication: loss of all meshes, the hottest body and contact, the thinnest film."""
BETTER_LARGE = (SCUFFING, SCUFFING_MARGIN, FILM, FILM_RATIO, MICROPITTING)
"""Quantities of which small values are the bad ones."""
SIMPLIFICATION_ERRORS = {name: f"{name}_simplified" for name in (LOSS, BULK, FLASH, FILM_RATIO, MICROPITTING)}
"""Error of each quantity by the few places that stand for the whole contact, relative; of a body's
temperature, in K.
"""
CYCLE_SELECTION_ERRORS = {name: f"{name}_missed" for name in (K_GAMMA, OPEN_FRACTION, REVERSED_FRACTION)}
"""Error of each quantity by the mesh cycles taken from the hunting cycle: of the largest K_gamma of any path,
relative; of a fraction of time, the difference.
"""
JUMP_MARGIN = "jump_margin_rpm"
"""Quantity that sweeps around the operating speed alone give."""
QUANTITIES = (
    *(PEAK, OPEN_FRACTION, REVERSED_FRACTION, BEARINGS, PAST_LAW),
    *(*CYCLE_SELECTION_ERRORS.values(), *CONTACT, *FRICTION, *SIMPLIFICATION_ERRORS.values()),
)
"""Columns of a sample that do not name a mesh or a group."""


def matching_names(start: str, names: Sequence[str]) -> list[str]:
    """Return the names that begin with a text.

    Parameters
    ----------
    start : str
        The text.
    names : Sequence of str
        The names.

    Returns
    -------
    list of str
        In the order of `names`.
    """
    return [name for name in names if name.startswith(start)]


def is_contact_quantity(start: str) -> bool:
    """Whether a text begins the name of a quantity that a contact analysis alone gives.

    Parameters
    ----------
    start : str
        The text.

    Returns
    -------
    bool
        True if a name of CONTACT begins with it.
    """
    return bool(matching_names(start, CONTACT))


def is_jump_quantity(start: str) -> bool:
    """Whether a text begins the name of the margin to the nearest jump.

    Parameters
    ----------
    start : str
        The text.

    Returns
    -------
    bool
        True if JUMP_MARGIN begins with it.
    """
    return bool(matching_names(start, (JUMP_MARGIN,)))
