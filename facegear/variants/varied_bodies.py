"""Face gears that bend in machines that differ: a body is solved again only where its section differs."""

from collections.abc import Hashable
from dataclasses import dataclass, field, replace
from typing import Self

from facegear.arrays import Arrays
from facegear.config.elastic_bodies import (
    body_shape,
    check_bodies,
    contact_patch,
    elastic_gears,
    fitted_shape,
)
from facegear.config.gear_body import BodySection
from facegear.config.tooth_pair import ToothPair, pair_design
from facegear.config.transmission import Transmission
from facegear.gear_body.reduced_body import ReducedBody
from facegear.geometry.design import Flanks, GearModifications, PairDesign
from facegear.transmission.elastic_gears import ElasticGears
from facegear.transmission.machine import Machine
from facegear.variants.teeth import Values

KEPT = 64
"""Bodies that are remembered."""


@dataclass(frozen=True, eq=False)
class VariedBodies:
    """pair: of the config; `known`: bodies by all that they depend on."""

    pair: ToothPair
    known: dict[Hashable, ReducedBody] = field(default_factory=dict)

    @classmethod
    def of_stage(cls, transmission: Values, pair: Values, arrays: Arrays) -> Self:
        """With the bodies of the config itself from the arrays `reduced` of stage gear_bodies."""
        bodies = cls(ToothPair.of_config(pair))
        for side, section in elastic_gears(Transmission.of_config(transmission)).items():
            bodies.known[_key(section, bodies.pair)] = ReducedBody.of_arrays(arrays, side)
        return bodies

    def joined(self, machine: Machine, section: Transmission, values: Values) -> Machine:
        """The machine of a section `transmission` on its bodies; values: of its section tooth_pair, as far as
        they are known.

        Raises ConfigError for a body that cannot be, NotConverged.
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
        key = _key(section, pair)
        if key not in self.known:
            if len(self.known) >= KEPT:
                del self.known[next(iter(self.known))]
            self.known[key] = _solved(section, pair)
        return self.known[key]


def _key(section: BodySection, pair: ToothPair) -> Hashable:
    """All that a body depends on."""
    shape = body_shape(section, pair)
    mounting = (shape.teeth, shape.material, shape.layer, contact_patch(section, pair), pair.face_gear_teeth)
    own = _nominal_teeth(pair_design(pair)) if section.teeth == "fitted" else None
    return (section, shape.corners.tobytes(), mounting, own)


def _nominal_teeth(design: PairDesign) -> Hashable:
    """All that the nominal teeth of a face gear depend on."""
    gear = replace(design.face_gear, modifications=GearModifications(), flanks=Flanks())
    pinion = design.pinion.teeth, design.pinion.profile_shift
    return (design.module, design.pressure_angle, pinion, gear, design.shaper)


def _solved(section: BodySection, pair: ToothPair) -> ReducedBody:
    from facegear.gear_body.body import (
        solve_body,  # only a body that no stage has solved needs finite elements
    )
    from facegear.gear_body.reduction import reduced_body

    shape, teeth = fitted_shape(section, pair), pair.face_gear_teeth
    solved = solve_body(shape, section.max_frequency_hz, section.nodal_diameters, teeth)
    return reduced_body(solved, contact_patch(section, pair), *section.damping)
