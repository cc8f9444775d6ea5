"""A machine to start from: what a user knows of a gearbox, and a choice with its reason for all the rest."""

from dataclasses import dataclass

from facegear.config.transmission import MAX_PINIONS
from facegear.errors import ConfigError
from facegear.variants.first_estimates import estimate_lines
from facegear.variants.split_bearings import (
    choose_bearings,
    split_of,
)
from facegear.variants.starting_draft import Draft
from facegear.variants.starting_wishes import MachineWishes

LEAST_LOADED = 0.05
"""Part of the largest mesh load below which the contact analysis does not follow a mesh."""
BOUNDS = {"torque_n_m": (1e-5, 1e6), "speed_rpm": (1.0, 1e5), "pinions": (1, MAX_PINIONS)}
"""Smallest and largest values; the config has loads and speeds beyond them."""


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
    for key, (low, high) in BOUNDS.items():
        if not low <= getattr(wishes, key) <= high:
            raise ConfigError(key, getattr(wishes, key), f"from {low:g} to {high:g}")
    if wishes.idlers < 0:
        raise ConfigError("idlers", wishes.idlers, "0 or more")
    if wishes.pinions + wishes.idlers > MAX_PINIONS:
        most = MAX_PINIONS - wishes.idlers
        raise ConfigError(
            "pinions", wishes.pinions, f"at most {most}, with {wishes.idlers} idlers beside them"
        )
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
