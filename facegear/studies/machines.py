"""Machines built and judged again and again, for samples and designs alike."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cache, cached_property
from typing import Any, Self

import pandas as pd

from facegear.arrays import Arrays
from facegear.build.lubrication import limits_of
from facegear.build.lumped_model import lumped_parts, machine
from facegear.build.machine import tables_of
from facegear.build.notes import require_buildable, require_room
from facegear.build.plans import settings, sharing_options
from facegear.build.tooth_numbers import ToothNumbers
from facegear.contact.gear_flank import every_flank_from_arrays
from facegear.errors import FacegearError
from facegear.machine.layout import Layout
from facegear.machine.machine import Machine
from facegear.machine.mean_load import at_mean_load
from facegear.machine.poses.fixed_point import posed_machine
from facegear.machine.poses.surface import PoseSurface
from facegear.machine.static_gears import at_rest
from facegear.meshing.stiffness_source import flank_series, series_of, unloaded_error
from facegear.motion.plan import JumpRange, Settings
from facegear.motion.steady_state.guide import Guide
from facegear.motion.steady_state.simulate import build_model
from facegear.motion.sweeps.whole_sweep import jump_margin
from facegear.quantities import BODIES, JUMP_MARGIN
from facegear.schema.base import keys_named, parse
from facegear.schema.lubrication import LubricationSection
from facegear.schema.motion import Accuracy, LoadSharing
from facegear.schema.transmission import Transmission
from facegear.sharing.groups import SharingOptions, quantity_names
from facegear.sharing.quantities import (
    FlankLoads,
    MachineQuantities,
    dynamic_quantities,
    orbit_of,
    quasi_static_quantities,
)
from facegear.studies.lubricated_teeth import LubricatedTeeth, ReduceTeeth, friction_quantities
from facegear.studies.summary import identity
from facegear.studies.tooth_contact import (
    GearFlanks,
    Meshes,
    PairExcitation,
    Values,
    VariedBodies,
    meshes_in_contact,
)
from facegear.teeth.placement import GEARS

Judge = Callable[[Mapping[str, Any]], dict[str, float]]
"""Function that returns the quantities of a machine by column, given values of
`facegear.schema.changes.variable_part`.

Raises the error that a config gets for a machine that cannot be built, NotConverged.
"""

ARRAYS = ("flanks", "pressure", "bodies")
"""Fields of arrays that follow from the values and tables of the same machine; `identity` leaves them out."""
WHOLE = 2**31
"""More mesh cycles than any hunting cycle has: all of them."""


@dataclass(frozen=True)
class Question:
    """Settings of how machines are judged.

    Loads are taken over `cycles` mesh cycles of the hunting cycle, or of the motion. `model` is quasi_static
    or dynamic. `accuracy` and `options` are the sections dynamics.accuracy and load_sharing. The nearest jump
    is looked for in `jumps`, None if it is not asked for. With `every_place`, friction is taken at all points
    of the contact, not at the few that stand for them.
    """

    model: str
    cycles: int
    accuracy: Mapping[str, Any]
    options: Mapping[str, Any]
    jumps: JumpRange | None = None
    every_place: bool = False

    @property
    def dynamic(self) -> bool:
        """Whether quantities are those of the motion (`model` dynamic), not of statics over the hunting
        cycle.
        """
        return self.model == "dynamic"


@dataclass(frozen=True, eq=False, kw_only=True)
class VariedMachine:
    """Machine that many are made from, as plain config values: the common part of samples and designs.

    With `pair`, the sections that contact needs, and `flanks`, the compliance of its bodies, every tooth pair
    that differs is put into contact. Without, all have the stiffness of `harmonics`, or the arrays `law` of
    stage mesh_law where it depends on the load. With `solid`, section tooth_pair, face gears bend; `bodies`
    are the arrays `reduced` of stage gear_bodies. With `poses`, arrays `surface` of stage pose_surface, the
    meshes of each machine stand where its own forces put them.
    """

    harmonics: pd.DataFrame
    transmission: Values
    accuracy: Values
    speed_rpm: float
    options: Values
    tolerances: Values | None
    pair: Values | None = None
    flanks: GearFlanks = field(default_factory=dict)
    law: Arrays | None = None
    solid: Values | None = None
    bodies: Arrays | None = None
    poses: Arrays | None = None

    @classmethod
    def of_stage(cls, flanks: Sequence[Arrays] = (), **arguments: Any) -> Self:
        """Build the machine from the arguments that a stage of the pipeline is given.

        Parameters
        ----------
        flanks : Sequence[Arrays]
            Arrays of pinion and face gear from stage compliance; empty where samples are not put into
            contact.
        **arguments : Any
            The other fields by name, as the class lists them.

        Returns
        -------
        Self
            The machine.
        """
        return cls(flanks=stored_flanks(flanks), **arguments)

    @cached_property
    def meshes(self) -> Meshes:
        """Function from section tooth_pair to stiffness, error and contact of its meshes, see
        `tooth_meshes`.
        """
        return tooth_meshes(self.harmonics, self.pair, self.flanks, self.gears, self.law)

    @property
    def gears(self) -> Sequence[str]:
        """Gears of the machine by the names under which contact knows them: one alone is the upper."""
        return GEARS if len(self.transmission["face_gears"]) > 1 else GEARS[:1]

    @cached_property
    def varied_bodies(self) -> "VariedBodies | None":
        """Cache of elastic face gears, which solves those that a varied machine changes; None for rigid
        gears.
        """
        if self.solid is None or self.bodies is None:
            return None
        return VariedBodies.of_stage(self.transmission, self.solid, self.bodies)

    @cached_property
    def surface(self) -> "PoseSurface | None":
        """Contact over the pose of pinion and gear, for meshes in the loaded position; None for meshes as
        assembled.
        """
        if self.poses is None:
            return None
        return PoseSurface.of_arrays(self.poses)

    def judge_of(self, question: Question, label: str, nominal: Values | None = None) -> Judge:
        """Return the function that builds each varied machine and computes its quantities, with this
        one's meshes, elastic gears and poses.

        Parameters
        ----------
        question : Question
            Loads over how many cycles, at rest or in motion, and accuracy.
        label : str
            What errors call the machine, such as `this sample`.
        nominal : Values or None
            Values of a machine that all are near: in motion its orbit is the first guess. None without a
            guess.

        Returns
        -------
        Judge
            Function from the values of `schema.changes.variable_part` to quantities by column.
        """
        return judge(question, self.meshes, label, self.varied_bodies, self.surface, nominal)

    def columns(self, layout: Layout, question: Question, jumps: bool = False) -> tuple[str, ...]:
        """Return the names of the quantities that a judge computes for a machine with this layout.

        Parameters
        ----------
        layout : Layout
            Layout of the machine.
        question : Question
            Settings of the judge, of which the model is taken.
        jumps : bool
            Whether the margin to the nearest jump is one of them.

        Returns
        -------
        tuple[str, ...]
            Names of the columns, those of single meshes and groups included.
        """
        gauges = self.pair is not None and self.pair["contact"]["root_stress"]
        contact, law = self.pair is not None, self.law is not None
        return quantity_names(layout, question.dynamic, contact, gauges, jumps, self.friction, law)

    @property
    def friction(self) -> bool:
        """Whether quantities of friction are computed: never here, see `SampledMachine`."""
        return False

    def identity(self, *parts: object) -> str:
        """Return a text that differs whenever one of the parts or a value of the machine does, for a
        journal.

        Parameters
        ----------
        *parts : object
            Further values that JSON can hold.

        Returns
        -------
        str
            JSON text of parts and fields; arrays that follow from other fields are left out.
        """
        plain = {field.name: getattr(self, field.name) for field in fields(self) if field.name not in ARRAYS}
        tables = {name: value.to_csv() for name, value in plain.items() if isinstance(value, pd.DataFrame)}
        arrays = {
            text: {name: values.tolist() for name, values in (mapping or {}).items()}
            for text, mapping in (("law", self.law), ("poses", self.poses))
        }
        return identity(*parts, {**plain, **tables, **arrays})


def tooth_meshes(
    harmonics: pd.DataFrame,
    pair: Values | None,
    flanks: GearFlanks,
    gears: Sequence[str],
    law: Arrays | None = None,
    rub: "ReduceTeeth | None" = None,
    lubricated_teeth: "LubricatedTeeth | None" = None,
) -> Meshes:
    """Return the function that gives stiffness, error and lubrication of a tooth pair's meshes.

    Without `pair` all machines have one mesh, that of `harmonics`; with it, `harmonics`, `law` and
    `lubricated_teeth` are not used.

    Parameters
    ----------
    harmonics : pd.DataFrame
        Table `harmonics` of stage stiffness: mesh stiffness and unloaded transmission error.
    pair : Values or None
        Sections tooth_pair, mesh, contact and mesh_stiffness, where each pair is put into contact; else
        None.
    flanks : GearFlanks
        Compliance of the bodies of `pair` by name.
    gears : Sequence[str]
        Gears of the machine, of `upper` and `lower`.
    law : mapping of arrays or None
        Arrays `law` of stage mesh_law; None where k does not depend on the load.
    rub : ReduceTeeth or None
        Function that reduces the contact of each pair to few points; None without lubrication.
    lubricated_teeth : LubricatedTeeth or None
        Lubricated teeth of the one mesh; None without lubrication.

    Returns
    -------
    Meshes
        Function from plain values of section tooth_pair to the excitation by its meshes.
    """
    if pair is not None:
        return meshes_in_contact(pair, flanks, gears, rub)
    series, error = series_of(harmonics), unloaded_error(harmonics)
    tables = None if law is None else tables_of(law)
    return lambda values: PairExcitation(
        ToothNumbers.of_config(values),
        series,
        error,
        tables=tables,
        lubricated_teeth=lubricated_teeth,
        harmonics=harmonics,
    )


def stored_flanks(arrays: Sequence[Arrays]) -> GearFlanks:
    """Return the compliance of both bodies from stored arrays, in all pairs of bodies.

    Parameters
    ----------
    arrays : Sequence[Arrays]
        Arrays of pinion and face gear from stage compliance; empty without contact.

    Returns
    -------
    GearFlanks
        Compliance of the flanks by body, `pinion` and `face_gear`; empty without arrays.
    """
    if not arrays:
        return {}
    return {body: every_flank_from_arrays(of_body) for body, of_body in zip(BODIES, arrays, strict=True)}


def judge(
    question: Question,
    meshes: Meshes,
    label: str,
    bodies: "VariedBodies | None" = None,
    surface: "PoseSurface | None" = None,
    nominal: Values | None = None,
) -> Judge:
    """Return a function that builds a varied machine and computes its quantities.

    The machine is refused if it cannot be assembled or is pressed together at rest. The nominal orbit is
    found at the first call and then kept.

    Parameters
    ----------
    question : Question
        Loads over how many cycles, at rest or in motion, accuracy, jumps, and points of the contact.
    meshes : Meshes
        Function from plain values of section tooth_pair to the excitation by its meshes.
    label : str
        What errors call the machine, such as `this sample`.
    bodies : VariedBodies or None
        Face gears that bend; None for rigid ones.
    surface : PoseSurface or None
        Contact over pose, where meshes stand as the forces of their machine put them; else None.
    nominal : Values or None
        Values of a machine that all are near, whose orbit is the first guess of motion; None without a
        guess.

    Returns
    -------
    Judge
        Function from the values of `schema.changes.variable_part` (transmission, tooth_pair, dynamics
        and, with friction, lubrication) to quantities by column: load sharing, contact, friction, jump
        margin.
    """
    ask = _ask(question)

    def judge_friction(
        teeth: "LubricatedTeeth",
        lubrication: Values,
        lumped_machine: Machine,
        speed: float,
        loads: FlankLoads,
    ) -> dict[str, float]:
        """Return the friction quantities of a machine by column, given the loads of its flanks (N) and
        its speed (rpm).
        """
        section = parse(LubricationSection, lubrication, label)
        pairs = teeth.pairs(section, question.every_place)
        return friction_quantities(lumped_machine, speed, loads, pairs, limits_of(section))

    def assemble(values: Values) -> tuple[PairExcitation, Machine]:
        """Build the machine of some config values, and return the excitation by its tooth pair and the
        machine.
        """
        mesh = meshes(values["tooth_pair"])
        section = parse(Transmission, mesh.in_machine(values["transmission"]), label)
        section = section.at_speed(values["dynamics"]["speed_rpm"])
        parts = lumped_parts(section, mesh.numbers, mesh.unloaded_error)
        require_buildable(section, mesh.numbers, parts)
        require_room(section, mesh.numbers, parts)
        tables = None if mesh.tables is None else mesh.tables(parts[0])
        flanks = None if mesh.harmonics is None else flank_series(mesh.harmonics)
        lumped_machine = machine(
            section,
            mesh.numbers,
            mesh.stiffness,
            mesh.unloaded_error,
            parts,
            tables,
            flank_stiffness=flanks,
        )
        if bodies is not None:
            lumped_machine = bodies.add_bodies(lumped_machine, section, values["tooth_pair"])
        if surface is not None:
            lumped_machine = posed_machine(lumped_machine, surface)
        return mesh, at_mean_load(lumped_machine)

    @cache
    def guide() -> Guide | None:
        """Return the orbit of the nominal machine as first guess; None at rest, or where it cannot be
        built.
        """
        if nominal is None or not question.dynamic:
            return None
        try:
            _, lumped_machine = assemble(nominal)
        except FacegearError:
            return None
        return orbit_of(lumped_machine, nominal["dynamics"]["speed_rpm"], *_precision(question))

    @keys_named()
    def judge_machine(values: Mapping[str, Any]) -> dict[str, float]:
        """Return all quantities of the machine that config values describe, by column."""
        mesh, lumped_machine = assemble(values)
        speed = values["dynamics"]["speed_rpm"]
        quantities, loads = ask(lumped_machine, speed, guide())
        quantities |= mesh.quantities(loads, lumped_machine.layout)
        if mesh.lubricated_teeth is not None:
            quantities |= judge_friction(
                mesh.lubricated_teeth, values["lubrication"], lumped_machine, speed, loads
            )
        if question.jumps is not None:
            quantities[JUMP_MARGIN] = jump_margin(build_model(lumped_machine), speed, question.jumps)
        return quantities

    return judge_machine


def _ask(question: Question) -> Callable[[Machine, float, Guide | None], MachineQuantities]:
    """Return the function that computes load quantities of a machine, at rest or in motion as the
    question says.

    Its arguments are the machine, the pinion speed (rpm) and a first guess of the orbit or None; at rest
    the last two do nothing. It returns quantities by column and the loads of the flanks (N).
    """
    if not question.dynamic:
        return lambda lumped_machine, speed, guide: quasi_static_quantities(
            at_rest(lumped_machine), question.cycles
        )
    precision = _precision(question)
    return lambda lumped_machine, speed, guide: dynamic_quantities(lumped_machine, speed, *precision, guide)


def _precision(question: Question) -> tuple[Settings, SharingOptions]:
    """Return settings of the steady-state search and of load sharing, the latter with a single start."""
    precise = settings(Accuracy.of_config(question.accuracy))
    return precise, replace(sharing_options(LoadSharing.of_config(question.options)), starts=1)
