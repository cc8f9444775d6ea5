"""Face gears that bend in machines that differ: a body is solved again only where its section differs."""

from collections.abc import Hashable
from dataclasses import dataclass, field, replace
from typing import Self

from facegear.arrays import Arrays
from facegear.build.elastic_bodies import body_shape, check_bodies, contact_patch, elastic_gears, fitted_shape
from facegear.build.tooth_pair import ToothPair, pair_design
from facegear.machine.elastic_gears import ElasticGears
from facegear.machine.machine import Machine
from facegear.parts.gear_body import reduced_body, solve_body
from facegear.parts.reduced_body import ReducedBody
from facegear.schema.gear_body import BodySection
from facegear.schema.transmission import Transmission
from facegear.studies.tooth_contact import Values
from facegear.teeth.design import Flanks, GearModifications, PairDesign

CACHED_BODIES = 64
"""Number of bodies that are remembered."""


@dataclass(frozen=True, eq=False)
class VariedBodies:
    """Bodies of face gears for machines that differ.

    `pair` is the tooth pair of the config. `cache` holds solved bodies by everything that they depend on.
    """

    pair: ToothPair
    cache: dict[Hashable, ReducedBody] = field(default_factory=dict)

    @classmethod
    def of_stage(cls, transmission: Values, pair: Values, arrays: Arrays) -> Self:
        """Build the cache with the bodies of the config itself.

        Parameters
        ----------
        transmission : Values
            Plain values of section `transmission`.
        pair : Values
            Plain values of section `tooth_pair`.
        arrays : mapping of arrays
            Arrays `reduced` of stage gear_bodies, in SI units.

        Returns
        -------
        Self
            The bodies.
        """
        bodies = cls(ToothPair.of_config(pair))
        for side, section in elastic_gears(Transmission.of_config(transmission)).items():
            bodies.cache[_key(section, bodies.pair)] = ReducedBody.of_arrays(arrays, side)
        return bodies

    def add_bodies(self, machine: Machine, section: Transmission, values: Values) -> Machine:
        """Put a machine on its bodies; a body is solved where it is not in the cache.

        Parameters
        ----------
        machine : Machine
            The machine with rigid gears.
        section : Transmission
            Section `transmission` of the machine.
        values : Values
            Plain values of section `tooth_pair`, as far as they are known.

        Returns
        -------
        Machine
            The machine with elastic gears.

        Raises
        ------
        ConfigError
            For a body that cannot exist.
        NotConverged
            If a body is not solved.
        """
        pair = ToothPair.of_config(values) if values.get("face_gear") is not None else self.pair
        check_bodies(pair, section)
        sections = elastic_gears(section)
        gears = {
            number: self._body(sections[gear.side.value], pair)
            for number, gear in enumerate(machine.layout.gears)
            if gear.side.value in sections
        }
        elastic = ElasticGears(machine.layout, gears)
        return replace(machine, bodies=elastic, softening=elastic.softening())

    def _body(self, section: BodySection, pair: ToothPair) -> ReducedBody:
        """Return a reduced face gear from the cache, or compute it; the oldest one goes."""
        key = _key(section, pair)
        if key not in self.cache:
            if len(self.cache) >= CACHED_BODIES:
                del self.cache[next(iter(self.cache))]
            self.cache[key] = _solve_body(section, pair)
        return self.cache[key]


def _key(section: BodySection, pair: ToothPair) -> Hashable:
    """Return a hashable key of everything on which a reduced face gear depends."""
    shape = body_shape(section, pair)
    mounting = (shape.teeth, shape.material, shape.layer, contact_patch(section, pair), pair.face_gear_teeth)
    fitted_teeth = _nominal_teeth(pair_design(pair)) if section.teeth == "fitted" else None
    return (section, shape.corners.tobytes(), mounting, fitted_teeth)


def _nominal_teeth(design: PairDesign) -> Hashable:
    """Return a hashable key of everything on which the nominal teeth of a face gear depend."""
    gear = replace(design.face_gear, modifications=GearModifications(), flanks=Flanks())
    pinion = design.pinion.teeth, design.pinion.profile_shift
    return (design.module, design.pressure_angle, pinion, gear, design.shaper)


def _solve_body(section: BodySection, pair: ToothPair) -> ReducedBody:
    """Compute the reduced model of a face gear that bends."""
    shape, teeth = fitted_shape(section, pair), pair.face_gear_teeth
    solution = solve_body(shape, section.max_frequency_hz, section.nodal_diameters, teeth)
    return reduced_body(solution, contact_patch(section, pair), *section.damping)
