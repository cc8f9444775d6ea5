"""A machine to start from: what a user knows of a gearbox, and a choice with its reason for all the rest."""

from dataclasses import dataclass

from facegear.variants.first_estimates import estimate_lines
from facegear.variants.split_bearings import (
    choose_bearings,
    split_of,
)
from facegear.variants.starting_draft import Draft
from facegear.variants.starting_teeth import choose_teeth
from facegear.variants.starting_wishes import MachineWishes
from facegear.variants.wish_limits import require_room, require_wishes

LEAST_LOADED = 0.05
"""Part of the largest mesh load below which the contact analysis does not follow a mesh."""


@dataclass(frozen=True)
class FirstMachine:
    """A config as YAML text, and what to expect of the machine, one line each."""

    text: str
    expected: tuple[str, ...]


def first_machine(wishes: MachineWishes) -> FirstMachine:
    """Choose what is not wishes, and estimate what the machine will do.

    Raises
    ------
    ConfigError
        For numbers that no machine can have, and teeth that do not exist, with the geometric reason.
    """
    require_wishes(wishes)
    require_room(wishes, choose_teeth(wishes.teeth).design)
    draft = Draft(wishes)
    if wishes.idlers:
        bearing_wishes = (
            wishes.input_bearing_n_per_m,
            wishes.idler_bearing_n_per_m,
            wishes.gear_bearing_n_per_m,
        )
        chosen = choose_bearings(draft.closed_form(), bearing_wishes, draft.machine)
        bearings, split = chosen.bearings, chosen.split
    else:
        bearings = draft.stiff_bearings()
        split = split_of(draft.machine(bearings))
    torques = split.mesh_torques
    largest = float(torques.max())
    loads = float(torques[torques > LEAST_LOADED * largest].min()), largest
    text = draft.text(bearings, loads)
    return FirstMachine(text, tuple(estimate_lines(draft, bearings, split, largest)))
