"""Mesh of a tooth pair for the machine that it is built into."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from facegear.config.machine_layout import ToothNumbers
from facegear.config.mesh_law import TablesOf
from facegear.harmonics.series import Harmonics
from facegear.load_sharing.quantity_names import ERROR_HARMONIC, ERROR_RANGE, PRESSURE, ROOTS
from facegear.strength.pair_answers import PairAnswers

if TYPE_CHECKING:
    from facegear.contact.gear_flank import GearFlank
    from facegear.variants.lubricated_teeth import LubricatedTeeth

Values = Mapping[str, Any]
Flanks = Mapping[str, "GearFlank"]
"""Compliance of both bodies by name."""


@dataclass(frozen=True, eq=False)
class PairExcitation:
    """Excitation of a machine by a tooth pair: k and e over a pitch, and the teeth's numbers.

    `backlash_added` (um) is the difference of the pair's backlash from that of the config. `answers` are
    those of the contact where the pair was put into contact. `tables` are those of the flanks where k depends
    on the load. `lubricated_teeth` are given where the pair is lubricated.
    """

    numbers: ToothNumbers
    stiffness: Harmonics
    unloaded_error: Harmonics | None
    backlash_added: float = 0.0
    answers: PairAnswers | None = None
    tables: TablesOf | None = None
    lubricated_teeth: "LubricatedTeeth | None" = None

    def in_machine(self, transmission: Values) -> dict[str, Any]:
        """Return section `transmission` with the backlash of this pair.

        Parameters
        ----------
        transmission : Values
            Plain values of the section.

        Returns
        -------
        dict[str, Any]
            Plain values with the added backlash at all meshes.
        """
        section = dict(transmission)
        if self.backlash_added == 0.0:
            return section
        section["backlash_um"] += self.backlash_added
        section["single_meshes"] = {
            name: mesh
            if mesh.get("backlash_um") is None
            else {**mesh, "backlash_um": mesh["backlash_um"] + self.backlash_added}
            for name, mesh in transmission["single_meshes"].items()
        }
        return section

    def quantities(self, force: float) -> dict[str, float]:
        """Return the contact quantities of a machine.

        Parameters
        ----------
        force : float
            Largest mesh force of the machine, N.

        Returns
        -------
        dict[str, float]
            Transmission error (um), pressure and root stress (MPa) by column; none without contact.
        """
        if self.answers is None:
            return {}
        answers, torque = self.answers, force * self.numbers.pinion_base_radius
        return {
            ERROR_RANGE: 1e6 * answers.error_range,
            ERROR_HARMONIC: 1e6 * answers.error_harmonic,
            PRESSURE: 1e-6 * answers.pressure.at(torque),
            **{ROOTS[body]: 1e-6 * largest(torque) for body, largest in answers.roots.items()},
        }


Meshes = Callable[[Values], PairExcitation]
"""The mesh of a tooth pair, given the plain values of its section. Raises the errors that a config gets."""
