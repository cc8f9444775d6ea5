"""Tooth pairs put into contact again and again, face gears that bend, and what they mean for the machine.

The body of a face gear is solved again only where its section differs.
"""

import json
from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache, lru_cache
from typing import Any, Self

import pandas as pd

from facegear.arrays import Arrays
from facegear.build.checks import geometric_backlash
from facegear.build.elastic_bodies import body_key, check_bodies, contact_patch, elastic_gears, fitted_shape
from facegear.build.machine import TablesOf
from facegear.build.plans import contact_plan, stiffness_request
from facegear.build.tooth_numbers import ToothNumbers
from facegear.build.tooth_pair import ToothPair, contact_setup, materials, pair_design
from facegear.contact.analysis import ContactAnalysis, contact_analysis
from facegear.contact.gear_flank import GearFlank, gear_flank
from facegear.contact.ltca import KnownContact, even_positions, known_contact
from facegear.contact.resolution import check_resolution
from facegear.contact.summary import contact_summary
from facegear.errors import FacegearError
from facegear.harmonics import Harmonics
from facegear.machine.elastic_gears import ElasticGears
from facegear.machine.machine import Machine
from facegear.meshing.stiffness_curve import LoadTable, unloaded_samples
from facegear.meshing.stiffness_request import StiffnessRequest
from facegear.meshing.stiffness_source import curve_from_contact
from facegear.parts.gear_body import reduced_body, solve_body
from facegear.parts.reduced_body import ReducedBody
from facegear.quantities import BODIES, ERROR_HARMONIC, ERROR_RANGE, PRESSURE, ROOTS
from facegear.schema.base import parse
from facegear.schema.changes import GAPS, MODULI, without
from facegear.schema.contact import Contact, Mesh
from facegear.schema.gear_body import BodySection
from facegear.schema.stiffness import MeshStiffness
from facegear.schema.transmission import Transmission
from facegear.strength.contact_pressure import PairAnswers, contact_pressure
from facegear.strength.passage import PassingTension
from facegear.studies.lubricated_teeth import LubricatedTeeth, ReduceTeeth

Values = Mapping[str, Any]
GearFlanks = Mapping[str, "GearFlank"]
"""Compliance of both bodies by name."""


@dataclass(frozen=True, eq=False)
class PairExcitation:
    """Excitation of a machine by a tooth pair: k and e over a pitch, and the teeth's numbers.

    `backlash_added` (um) is the difference of the pair's backlash from that of the config. `answers` are
    those of the contact where the pair was put into contact. `tables` are those of the flanks where k depends
    on the load. `lubricated_teeth` are given where the pair is lubricated. `harmonics` is the table of stage
    stiffness that may give single flanks a stiffness of their own.
    """

    numbers: ToothNumbers
    stiffness: Harmonics
    unloaded_error: Harmonics | None
    backlash_added: float = 0.0
    answers: PairAnswers | None = None
    tables: TablesOf | None = None
    lubricated_teeth: "LubricatedTeeth | None" = None
    harmonics: pd.DataFrame | None = None

    def in_machine(self, transmission: Values) -> dict[str, Any]:
        """Return section `transmission` with `backlash_added` on the backlash of all meshes.

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
        """Return the contact quantities of a machine: pressure and root stress at its largest mesh force.

        Parameters
        ----------
        force : float
            Largest mesh force of the machine, N.

        Returns
        -------
        dict[str, float]
            Peak-to-peak and mesh-frequency amplitude of the loaded transmission error (um), which do not
            depend on the force, pressure and root stress (MPa), by column; empty without contact.
        """
        if self.answers is None:
            return {}
        answers, torque = self.answers, force * self.numbers.pinion_arm
        return {
            ERROR_RANGE: 1e6 * answers.error_range,
            ERROR_HARMONIC: 1e6 * answers.error_harmonic,
            PRESSURE: 1e-6 * answers.pressure.at(torque),
            **{ROOTS[body]: 1e-6 * largest(torque) for body, largest in answers.roots.items()},
        }


Meshes = Callable[[Values], PairExcitation]
"""The mesh of a tooth pair, given the plain values of its section. Raises the errors that a config gets."""


Tensions = Mapping[str, PassingTension]
"""By body."""

CACHED_PAIRS = 16
"""Number of pairs that are remembered: samples of one block of Saltelli's design share theirs."""
KEPT_BODIES = 4
"""Compliances of both bodies that are remembered, some 70 MB each at the default resolution."""


def meshes_in_contact(pair: Values, flanks: GearFlanks, rub: "ReduceTeeth | None" = None) -> Meshes:
    """Return a function that solves the contact of tooth pairs, and keeps the last CACHED_PAIRS of them.

    Pairs with the nodes of the nominal pair start from its solved contact. The function raises the errors
    that a config gets for a pair that cannot be built or solved.

    Parameters
    ----------
    pair : Values
        Sections tooth_pair, mesh, contact and mesh_stiffness of the config.
    flanks : GearFlanks
        Compliance of both bodies of this pair by name.
    rub : ReduceTeeth or None
        Function that reduces the contact of a lubricated pair; None without lubrication.

    Returns
    -------
    Meshes
        Function from plain values of section tooth_pair to stiffness, unloaded error, change of backlash
        and answers of the contact.
    """
    backlash = geometric_backlash(ToothPair.of_config(pair["tooth_pair"]))
    plan, request = contact_plan(Contact.of_config(pair["contact"])), _request(pair)
    bodies, own_nodes = _bodies(pair, flanks), _nodes(pair["tooth_pair"])

    @cache
    def nominal() -> KnownContact | None:
        """Return solved contact of the nominal pair, from which similar pairs start; None where it cannot
        be solved.
        """
        section = ToothPair.of_config(pair["tooth_pair"])
        try:
            compliances, _ = bodies(pair["tooth_pair"], section)
            analysis = contact_analysis(
                pair_design(section), materials(section), [compliances], plan, every_flank=False
            )
        except FacegearError:
            return None
        flanks_of_it, normal_arm = analysis.models[0].flanks, analysis.models[0].design.normal_arm
        positions = even_positions(plan.positions)
        return known_contact(analysis.results[0][0], positions, flanks_of_it.pinion.shape, normal_arm)

    @lru_cache(maxsize=CACHED_PAIRS)
    def solve_mesh(text: str) -> PairExcitation:
        """Solve the contact of the pair whose section tooth_pair is given as JSON text, a key for the
        cache.
        """
        values = json.loads(text)
        section = parse(ToothPair, values, "this pair")
        backlash_increase = geometric_backlash(section, even_positions(plan.positions)) - backlash
        compliances, tensions = bodies(values, section)
        start_contact = nominal() if _nodes(values) == own_nodes else None
        analysis = contact_analysis(
            pair_design(section),
            materials(section),
            [compliances],
            plan,
            every_flank=False,
            known_contact=start_contact,
        )
        curve = curve_from_contact(analysis.ltca[0], request)
        numbers = ToothNumbers.of_config(values)
        return PairExcitation(
            numbers=numbers,
            stiffness=curve.series,
            unloaded_error=curve.error,
            backlash_added=backlash_increase,
            answers=_answers(analysis, tensions, numbers, curve.table, request),
            lubricated_teeth=rub(analysis.ltca[0], analysis.pressure[0], section) if rub else None,
        )

    return lambda values: solve_mesh(json.dumps(values, sort_keys=True))


def _request(pair: Values) -> StiffnessRequest:
    """Return what is asked of the mesh stiffness: section mesh_stiffness of `pair` in SI units."""
    return stiffness_request(MeshStiffness.of_config(pair["mesh_stiffness"]))


def _answers(
    analysis: ContactAnalysis,
    tensions: Tensions,
    numbers: ToothNumbers,
    stiffness: LoadTable,
    request: StiffnessRequest,
) -> PairAnswers:
    """Return loaded transmission error, contact pressure and root stress of a pair from its contact.

    The error (positions,) m is that without load plus mesh force over average stiffness, at the torque of
    the request. Pressure and root stress are functions of torque.
    """
    assert request.torque is not None
    torque, ltca = request.torque, analysis.ltca[0]
    approach = torque / numbers.pinion_arm / stiffness.at(torque, "average")
    error = 1e-6 * unloaded_samples(ltca) + approach
    roots = {body: tension.under(analysis.loads) for body, tension in tensions.items()}
    return PairAnswers(error, contact_pressure(contact_summary(ltca)), roots)


def _bodies(
    pair: Values, flanks: GearFlanks
) -> Callable[[Values, ToothPair], tuple[tuple[GearFlank, GearFlank], Tensions]]:
    """Return a function that gives the compliance of both bodies of a pair, and the root stress of those
    with gauges.

    It takes plain values and section of the pair. Compliances are kept by the values that decide the
    nodes, at most those of `flanks` and KEPT_BODIES others. With the same nodes they are scaled by 1/E,
    which is exact. It raises ConfigError for a pair whose contact the mesh cannot resolve.
    """
    start = ToothPair.of_config(pair["tooth_pair"])
    mesh, contact = Mesh.of_config(pair["mesh"]), Contact.of_config(pair["contact"])
    cache_by_nodes = {_nodes(pair["tooth_pair"]): (start, dict(flanks), _tensions(flanks))}

    def bodies(values: Values, section: ToothPair) -> tuple[tuple[GearFlank, GearFlank], Tensions]:
        """Return the compliance of pinion and gear of a pair, and the root stress by body, from the cache
        or solved.
        """
        key = _nodes(values)
        if key not in cache_by_nodes:
            setup = contact_setup(section, mesh, contact)
            check_resolution(setup.pair.design, setup.pair.materials, setup.sizes, setup.plan)
            compliances: dict[str, GearFlank] = {
                body: gear_flank(setup.pair.design, body, setup.sizes, setup.pair.material(body), setup.plan)
                for body in BODIES
            }
            if len(cache_by_nodes) > KEPT_BODIES:
                cache_by_nodes.pop(list(cache_by_nodes)[1])
            cache_by_nodes[key] = section, compliances, _tensions(compliances)
        of, compliances, tensions = cache_by_nodes[key]
        moduli = (
            [material.young_modulus for material in materials(pair_section)] for pair_section in (of, section)
        )
        first, second = (
            compliances[body] if before == after else compliances[body].softer(before / after)
            for body, before, after in zip(BODIES, *moduli, strict=True)
        )
        return (first, second), tensions

    return bodies


def _tensions(flanks: GearFlanks) -> Tensions:
    """Return the root stress by forces on the passing flank, for each body with gauges, by name.

    It does not depend on Young's modulus.
    """
    return {body: PassingTension.of_flank(body, flank) for body, flank in flanks.items() if flank.gauges}


def _nodes(tooth_pair: Values) -> str:
    """Return a text of all values that decide the nodes of a pair's bodies and their compliance times E.

    These are the values of section tooth_pair without those that only move unloaded flanks, and without
    moduli.
    """
    for key in (*GAPS, *MODULI):
        tooth_pair = without(tooth_pair, key)
    return json.dumps(tooth_pair, sort_keys=True)


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
        """Build the cache, filled with the solved bodies of the config itself.

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
            The cache.
        """
        bodies = cls(ToothPair.of_config(pair))
        for side, section in elastic_gears(Transmission.of_config(transmission)).items():
            bodies.cache[body_key(section, bodies.pair, side)] = ReducedBody.of_arrays(arrays, side)
        return bodies

    def add_bodies(self, machine: Machine, section: Transmission, values: Values) -> Machine:
        """Return a machine with elastic face gears in place of rigid ones; a body not in the cache is
        solved.

        Parameters
        ----------
        machine : Machine
            The machine with rigid gears.
        section : Transmission
            Section `transmission` of the machine.
        values : Values
            Plain values of section `tooth_pair`; without `face_gear` the pair of the config is taken.

        Returns
        -------
        Machine
            Copy with elastic gears and the compliance that they put in series with the meshes.

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
            number: self._body(sections[gear.side.value], pair, gear.side.value)
            for number, gear in enumerate(machine.layout.gears)
            if gear.side.value in sections
        }
        elastic = ElasticGears(machine.layout, gears)
        return replace(machine, bodies=elastic, softening=elastic.softening())

    def _body(self, section: BodySection, pair: ToothPair, side: str) -> ReducedBody:
        """Return a reduced face gear from the cache, or solve and keep it.

        With CACHED_BODIES in the cache the oldest one is dropped.
        """
        key = body_key(section, pair, side)
        if key not in self.cache:
            if len(self.cache) >= CACHED_BODIES:
                del self.cache[next(iter(self.cache))]
            self.cache[key] = _solve_body(section, pair, side)
        return self.cache[key]


def _solve_body(section: BodySection, pair: ToothPair, side: str) -> ReducedBody:
    """Solve the elasticity of a face gear's body and return its reduced model: modes and mesh compliance."""
    shape, teeth = fitted_shape(section, pair, side), pair.face_gear_teeth
    solution = solve_body(shape, section.max_frequency_hz, section.nodal_diameters, teeth)
    return reduced_body(solution, contact_patch(section, pair, side), *section.damping)
