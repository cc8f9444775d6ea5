"""Tooth pairs put into contact again and again, face gears that bend, and what they mean for the machine.

The body of a face gear is solved again only where its section differs.
"""

import json
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, lru_cache
from typing import Any, Self

import numpy as np
import pandas as pd

from facegear.arrays import Arrays
from facegear.build.checks import geometric_backlash
from facegear.build.elastic_bodies import body_key, check_bodies, contact_patch, elastic_gears, fitted_shape
from facegear.build.machine import TablesOf
from facegear.build.plans import contact_plan, stiffness_request
from facegear.build.tooth_numbers import ToothNumbers
from facegear.build.tooth_pair import ToothPair, contact_setup, materials, pair_design
from facegear.contact.analysis import ContactAnalysis, contact_analysis
from facegear.contact.gear_flank import GearFlank, PairFlanks, gear_flanks
from facegear.contact.ltca import KnownContact, even_positions, known_contact
from facegear.contact.resolution import check_resolution
from facegear.contact.summary import contact_summary
from facegear.errors import FacegearError
from facegear.harmonics import Harmonics
from facegear.machine.elastic_gears import ElasticGears
from facegear.machine.layout import Layout
from facegear.machine.machine import Machine
from facegear.meshing.stiffness_curve import LoadTable, unloaded_samples
from facegear.meshing.stiffness_request import StiffnessRequest
from facegear.meshing.stiffness_source import curve_from_contact, stiffness_from_contact
from facegear.parts.gear_body import reduced_body, solve_body
from facegear.parts.reduced_body import ReducedBody
from facegear.quantities import BODIES, ERROR_HARMONIC, ERROR_RANGE, PRESSURE, ROOTS
from facegear.schema.base import parse
from facegear.schema.changes import GAPS, MODULI, without
from facegear.schema.contact import Contact, Mesh
from facegear.schema.gear_body import BodySection
from facegear.schema.stiffness import MeshStiffness
from facegear.schema.transmission import Transmission
from facegear.sharing.quantities import FlankLoads
from facegear.strength.contact_pressure import FlankAnswers, PairAnswers, contact_pressure
from facegear.strength.passage import PassingTension
from facegear.studies.lubricated_teeth import LubricatedTeeth, ReduceTeeth
from facegear.teeth.design import PairDesign
from facegear.teeth.placement import GEARS, nominal_pairs, nominal_teeth

Values = Mapping[str, Any]
GearFlanks = Mapping[str, Sequence["GearFlank"]]
"""Compliance of both bodies by name, in each of `placement.nominal_pairs`."""


@dataclass(frozen=True, eq=False)
class PairExcitation:
    """Excitation of a machine by a tooth pair: k and e over a pitch, and the teeth's numbers.

    `backlash_added` (um) is the difference of the pair's backlash from that of the config. `answers` are
    those of the contact where the pair was put into contact. `tables` are those of the flanks where k depends
    on the load. `lubricated_teeth` are given where the pair is lubricated. `harmonics` is the table of stage
    stiffness that may give single flanks a stiffness of their own, None where no flank has one.
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

    def quantities(self, loads: FlankLoads, layout: Layout) -> dict[str, float]:
        """Return the contact quantities of a machine: largest pressure and root stress of its flanks.

        Each flank has the contact and the arm of its gear and side, at the largest force that it carries.

        Parameters
        ----------
        loads : FlankLoads
            Loads of the machine's flanks.
        layout : Layout
            Layout of the machine.

        Returns
        -------
        dict[str, float]
            Peak-to-peak and mesh-frequency amplitude of the loaded transmission error (um), which do not
            depend on the force, pressure and root stress (MPa), by column; empty without contact.
        """
        if self.answers is None:
            return {}
        answers, flanks = self.answers, self.answers.flanks
        rows = [GEARS.index(gear) for gear in layout.contact_gears]
        numbers = answers.numbers[[rows[gear] for _, gear in layout.meshes]].T.ravel()
        forces = [loads.largest[numbers == number].max(initial=0.0) for number in range(len(flanks))]
        # without any load the first contact stands for all
        torques = [(flank, force * flank.arm) for flank, force in zip(flanks, forces, strict=True) if force]
        torques = torques or [(flanks[0], 0.0)]
        return {
            ERROR_RANGE: 1e6 * answers.error_range,
            ERROR_HARMONIC: 1e6 * answers.error_harmonic,
            PRESSURE: 1e-6 * float(np.max([flank.pressure.at(torque) for flank, torque in torques])),
            **{
                ROOTS[body]: 1e-6 * max(flank.roots[body](torque) for flank, torque in torques)
                for body in flanks[0].roots
            },
        }


Meshes = Callable[[Values], PairExcitation]
"""The mesh of a tooth pair, given the plain values of its section. Raises the errors that a config gets."""


Tensions = Mapping[str, Sequence[PassingTension]]
"""By body, in each of `placement.nominal_pairs`."""

CACHED_PAIRS = 16
"""Number of pairs that are remembered: samples of one block of Saltelli's design share theirs."""
KEPT_BODIES = 4
"""Compliances of both bodies that are remembered, some 70 MB each at the default resolution."""


def meshes_in_contact(
    pair: Values, flanks: GearFlanks, gears: Sequence[str], rub: "ReduceTeeth | None" = None
) -> Meshes:
    """Return a function that solves the contact of tooth pairs, and keeps the last CACHED_PAIRS of them.

    Spur teeth are solved on the upper gear's drive flank alone, which stands for all; other teeth on every
    flank of the machine that differs, each with its own stiffness. Pairs with the nodes of the nominal pair
    start from its solved contact. The function raises the errors that a config gets for a pair that cannot be
    built or solved.

    Parameters
    ----------
    pair : Values
        Sections tooth_pair, mesh, contact and mesh_stiffness of the config.
    flanks : GearFlanks
        Compliance of both bodies of this pair by name.
    gears : Sequence[str]
        Gears of the machine, of `upper` and `lower`.
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
    bodies, own_nodes = _bodies(pair, flanks, gears), _nodes(pair["tooth_pair"])

    def solve(
        section: ToothPair, compliances: Sequence[PairFlanks], known_contacts: Sequence[KnownContact | None]
    ) -> ContactAnalysis:
        """Solve the contact of the flanks of a pair that differ, near `known_contacts`."""
        design = pair_design(section)
        has_own_flanks = not design.is_spur
        return contact_analysis(
            design, materials(section), compliances, plan, has_own_flanks, known_contacts, gears
        )

    @cache
    def nominal() -> list[KnownContact | None]:
        """Return solved contact of the nominal pair, from which similar pairs start, for each pair of
        bodies; nothing where it cannot be solved.
        """
        section = ToothPair.of_config(pair["tooth_pair"])
        try:
            compliances, _ = bodies(pair["tooth_pair"], section)
            analysis = solve(section, compliances, ())
        except FacegearError:
            return []
        positions = even_positions(plan.positions)
        contact_by_teeth: dict[PairDesign, KnownContact | None] = {}
        for model, (results, _) in zip(analysis.models, analysis.results, strict=True):
            contact = known_contact(results, positions, model.flanks.pinion.shape, model.design.normal_arm)
            contact_by_teeth.setdefault(nominal_teeth(model.design), contact)
        return [contact_by_teeth.get(teeth) for teeth in nominal_pairs(pair_design(section), gears)]

    @lru_cache(maxsize=CACHED_PAIRS)
    def solve_mesh(text: str) -> PairExcitation:
        """Solve the contact of the pair whose section tooth_pair is given as JSON text, a key for the
        cache.
        """
        values = json.loads(text)
        section = parse(ToothPair, values, "this pair")
        backlash_increase = geometric_backlash(section, even_positions(plan.positions)) - backlash
        compliances, tensions = bodies(values, section)
        analysis = solve(section, compliances, nominal() if _nodes(values) == own_nodes else ())
        curve, other_flanks = curve_from_contact(analysis.ltca[0], request), analysis.other_flanks
        harmonics = None
        if len(other_flanks):
            harmonics = stiffness_from_contact(analysis.ltca[0], request, other_flanks).harmonics
        numbers = ToothNumbers.of_config(values)
        return PairExcitation(
            numbers=numbers,
            stiffness=curve.series,
            unloaded_error=curve.error,
            backlash_added=backlash_increase,
            answers=_answers(analysis, tensions, numbers, curve.table, request),
            lubricated_teeth=rub(analysis.ltca[0], analysis.stored_pressure, section) if rub else None,
            harmonics=harmonics,
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
    the request. Pressure and root stress are functions of torque, for each contact that differs.
    """
    assert request.torque is not None
    torque, designs = request.torque, [model.design for model in analysis.models]
    approach = torque / numbers.pinion_arm / stiffness.at(torque, "average")
    error = 1e-6 * unloaded_samples(analysis.ltca[0]) + approach
    bodies = nominal_pairs(designs[0])
    flanks = []
    for number, (design, ltca) in enumerate(zip(designs, analysis.ltca, strict=True)):
        row = bodies.index(nominal_teeth(design))
        roots = {body: tension[row].under(analysis.loads, number) for body, tension in tensions.items()}
        arm = numbers.pinion_arm * (design.normal_arm / designs[0].normal_arm)
        flanks.append(FlankAnswers(arm, contact_pressure(contact_summary(ltca)), roots))
    return PairAnswers(error, tuple(flanks), analysis.numbers)


def _bodies(
    pair: Values, flanks: GearFlanks, gears: Sequence[str]
) -> Callable[[Values, ToothPair], tuple[Sequence[PairFlanks], Tensions]]:
    """Return a function that gives the compliance of both bodies of a pair, and the root stress of those
    with gauges.

    It takes plain values and section of the pair, and has both for each of `placement.nominal_pairs`.
    Compliances are kept by the values that decide the nodes, at most those of `flanks` and KEPT_BODIES
    others. With the same nodes they are scaled by 1/E, which is exact. It raises ConfigError for a pair whose
    contact the mesh cannot resolve.
    """
    start = ToothPair.of_config(pair["tooth_pair"])
    mesh, contact = Mesh.of_config(pair["mesh"]), Contact.of_config(pair["contact"])
    cache_by_nodes = {_nodes(pair["tooth_pair"]): (start, dict(flanks), _tensions(flanks))}

    def bodies(values: Values, section: ToothPair) -> tuple[Sequence[PairFlanks], Tensions]:
        """Return the compliance of pinion and gear of a pair, and the root stress by body, from the cache
        or solved.
        """
        key = _nodes(values)
        if key not in cache_by_nodes:
            setup = contact_setup(section, mesh, contact)
            check_resolution(setup.pair.design, setup.pair.materials, setup.sizes, setup.plan)
            compliances: dict[str, Sequence[GearFlank]] = {
                body: gear_flanks(
                    setup.pair.design, body, setup.sizes, setup.pair.material(body), setup.plan, gears
                )
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
            [flank if before == after else flank.softer(before / after) for flank in compliances[body]]
            for body, before, after in zip(BODIES, *moduli, strict=True)
        )
        return list(zip(first, second, strict=True)), tensions

    return bodies


def _tensions(flanks: GearFlanks) -> Tensions:
    """Return the root stress by forces on the passing flank, for each body with gauges, by name.

    It does not depend on Young's modulus.
    """
    return {
        body: [PassingTension.of_flank(body, flank) for flank in of_body]
        for body, of_body in flanks.items()
        if of_body[0].gauges
    }


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
