"""A machine to start from: what a user knows of a gearbox, and a choice with its reason for all the rest."""

from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property

from facegear.errors import FacegearError
from facegear.variants.first_estimates import estimate_lines, estimate_safeties
from facegear.variants.split_bearings import Bearings, Split, choose_bearings, split_of
from facegear.variants.starting_draft import Draft
from facegear.variants.starting_teeth import MORE_SHAPER_TEETH, choose_teeth
from facegear.variants.starting_wishes import MachineWishes
from facegear.variants.wish_limits import require_room, require_wishes

LEAST_LOADED = 0.05
"""Part of the largest mesh load below which the contact analysis does not follow a mesh."""


@dataclass(frozen=True)
class FirstMachine:
    """A config as YAML text, and what to expect of the machine, one line each."""

    text: str
    expectations: tuple[str, ...]


def first_machine(wishes: MachineWishes) -> FirstMachine:
    """Choose what is not wishes, and estimate what the machine will do.

    Parameters
    ----------
    wishes : MachineWishes
        Values that a user gave.

    Returns
    -------
    FirstMachine
        Config text and expectations.

    Raises
    ------
    ConfigError
        For numbers that no machine can have, and teeth that do not exist, with the geometric reason.
    """
    require_wishes(wishes)
    require_room(wishes, choose_teeth(wishes.teeth).design)
    best = _machine(Draft(wishes))
    if wishes.shaper_teeth is None:
        for more_shaper_teeth in MORE_SHAPER_TEETH[1:]:
            if best.spare[0] >= 1.0:
                break
            with suppress(FacegearError):
                best = max(
                    best, _machine(Draft(wishes, more_shaper_teeth)), key=lambda machine: machine.spare
                )
    return FirstMachine(
        best.draft.text(best.bearings, best.loads),
        tuple(estimate_lines(best.draft, best.bearings, best.split, best.loads[1])),
    )


@dataclass(frozen=True)
class _Machine:
    """A draft with its bearings, its load sharing and the torques (N m) of its meshes at rest."""

    draft: Draft
    bearings: Bearings
    split: Split
    loads: tuple[float, float]

    @cached_property
    def spare(self) -> tuple[float, float]:
        """Spare safety of the hardest loaded pinion, and that against pitting, which the shaper changes."""
        safeties = estimate_safeties(self.draft, self.loads[1])
        return safeties.spare, safeties.spare_pitting


def _machine(draft: Draft) -> _Machine:
    """Choose the bearings of a draft."""
    wishes = draft.wishes
    if wishes.idlers:
        bearing_wishes = (
            wishes.input_bearing_n_per_m,
            wishes.idler_bearing_n_per_m,
            wishes.gear_bearing_n_per_m,
        )
        choice = choose_bearings(draft.closed_form(), bearing_wishes, draft.machine)
        bearings, split = choice.bearings, choice.split
    else:
        bearings = draft.stiff_bearings()
        split = split_of(draft.machine(bearings))
    torques = split.mesh_torques
    largest = float(torques.max())
    return _Machine(draft, bearings, split, (float(torques[torques > LEAST_LOADED * largest].min()), largest))
