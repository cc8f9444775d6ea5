"""Names of what one machine among many is judged by."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from facegear.transmission.layout import Layout

K_GAMMA, K_V = "k_gamma", "k_v"
PEAK, OPEN, REVERSED = "peak_mesh_force_n", "open_fraction", "reversed_fraction"
BEARINGS = "bearing_mass"
PAST_LAW = "past_law_fraction"
ERROR_RANGE, ERROR_HARMONIC, PRESSURE = "te_peak_to_peak_um", "te_first_harmonic_um", "pressure_mpa"
ROOTS = {"pinion": "root_stress_pinion_mpa", "face_gear": "root_stress_face_gear_mpa"}
CONTACT = (ERROR_RANGE, ERROR_HARMONIC, PRESSURE, *ROOTS.values())
"""What a contact analysis alone tells."""
LOSS, LOSS_PERCENT = "friction_loss_w", "friction_loss_percent"
BULK, FLASH, CONTACT_TEMPERATURE = "hottest_body_c", "largest_flash_k", "contact_temperature_c"
SCUFFING, SCUFFING_MARGIN = "scuffing_safety", "scuffing_margin_k"
FILM, FILM_RATIO = "smallest_film_um", "smallest_film_ratio"
MICROPITTING = "smallest_micropitting_film_ratio"
UNSOLVED = "unsolved_loss_share"
FRICTION = (
    *(LOSS, LOSS_PERCENT, BULK, FLASH, CONTACT_TEMPERATURE, SCUFFING, SCUFFING_MARGIN),
    *(FILM, FILM_RATIO, MICROPITTING, UNSOLVED),
)
"""What section lubrication brings: loss of all meshes, the hottest body and contact, the thinnest film."""
BETTER_LARGE = (SCUFFING, SCUFFING_MARGIN, FILM, FILM_RATIO, MICROPITTING)
"""Quantities of which small values are the bad ones."""
SIMPLIFIED = {name: f"{name}_simplified" for name in (LOSS, BULK, FLASH, FILM_RATIO, MICROPITTING)}
"""What the few places that stand for the whole contact miss, relative; of a body's temperature, in K."""
MISSED = {name: f"{name}_missed" for name in (K_GAMMA, OPEN, REVERSED)}
"""What the mesh cycles taken from the hunting cycle miss: of the largest K_gamma of any path, relative; of a
fraction of time, the difference."""
JUMP_MARGIN = "jump_margin_rpm"
"""What sweeps around the operating speed alone tell."""
QUANTITIES = (
    *(PEAK, OPEN, REVERSED, BEARINGS, PAST_LAW),
    *(*MISSED.values(), *CONTACT, *FRICTION, *SIMPLIFIED.values()),
)
"""Columns of a sample that do not name a mesh or a group."""


def quantity_names(
    layout: "Layout",
    dynamic: bool,
    contact: bool = False,
    gauges: bool = False,
    jumps: bool = False,
    friction: bool = False,
    law: bool = False,
) -> tuple[str, ...]:
    """Columns of a sample.

    `k_gamma <mesh>`: mesh load factor of a path, its largest mean of a mesh cycle over its nominal even share
    (`facegear.load_sharing.even_shares`); of the motion with `k_v <mesh>`, the largest load over that mean;
    `coefficient <group>`: mean over time of the largest load over the mean (equations (25), (26));
    then the largest load of a mesh, the fraction of time in which some mesh that shares a load carries
    nothing, and in which some mesh is loaded on the flank that it does not work on; the mass of bearings for
    the loads on them (`facegear.load_sharing.bearings`). With `law`, the fraction of positions at which a
    flank is past the last level of its load-dependent law, the largest of all. With `contact`, the loaded
    transmission error of the tooth pair and its pressure, with `gauges` the root stress of both bodies
    (`facegear.strength.pair_answers`); with `friction` the columns FRICTION; with `jumps` the distance from
    the operating speed to the nearest jump (`facegear.dynamics.sweeps.jump_margin`).
    """
    # Those who only check names, as a config does, need not load what a machine is made of.
    from facegear.load_sharing.groups import load_groups, split_groups

    groups = load_groups(layout)
    shared = [layout.mesh_names[mesh] for group in groups for mesh in group.meshes]
    paths = [f"{factor} {mesh}" for factor in (K_GAMMA, K_V)[: 1 + dynamic] for mesh in shared]
    names = [
        *paths,
        *(f"coefficient {group.name}" for group in split_groups(layout)),
        PEAK,
        OPEN,
        REVERSED,
        BEARINGS,
    ]
    names += [PAST_LAW] if law else []
    names += [ERROR_RANGE, ERROR_HARMONIC, PRESSURE] if contact else []
    names += ROOTS.values() if contact and gauges else []
    names += FRICTION if friction else ()
    return (*names, *([JUMP_MARGIN] if jumps else []))


def columns_of(start: str, names: Sequence[str]) -> list[str]:
    """Those of the names that begin with a text."""
    return [name for name in names if name.startswith(start)]


def of_contact(start: str) -> bool:
    """Whether a text begins the name of something that a contact analysis alone tells."""
    return bool(columns_of(start, CONTACT))


def of_jumps(start: str) -> bool:
    """Whether a text begins the name of the margin to the nearest jump."""
    return bool(columns_of(start, (JUMP_MARGIN,)))
