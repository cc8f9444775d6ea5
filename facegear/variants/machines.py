"""Machines put together and judged again and again: what samples and designs have in common."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, Self

import pandas as pd

from facegear.arrays import Arrays
from facegear.config.base import parse
from facegear.config.buildable import require_buildable, require_room
from facegear.config.dynamics import Accuracy, settings
from facegear.config.keys import keys_named
from facegear.config.load_sharing import LoadSharing, sharing_options
from facegear.config.lubrication import LubricationSection, limits_of
from facegear.config.lumped_model import described, machine
from facegear.config.machine_layout import ToothNumbers
from facegear.config.mesh_law import tables_of
from facegear.config.transmission import Transmission
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.guide import Guide
from facegear.dynamics.steady_state.simulate import build_model
from facegear.dynamics.sweeps.jump_margin import jump_margin
from facegear.dynamics.sweeps.plan import JumpRange
from facegear.errors import FacegearError
from facegear.geometry.bodies import BODIES
from facegear.load_sharing.options import SharingOptions
from facegear.load_sharing.quantities import (
    FlankLoads,
    MachineQuantities,
    dynamic_quantities,
    orbit_of,
    quasi_static_quantities,
)
from facegear.load_sharing.quantity_names import JUMP_MARGIN, PEAK, quantity_names
from facegear.poses.fixed_point import posed_machine
from facegear.scenarios.chunks import identity
from facegear.stiffness.tables import series_of, unloaded_error
from facegear.transmission.layout import Layout
from facegear.transmission.machine import Machine
from facegear.transmission.static_gears import at_rest
from facegear.variants.teeth import Flanks, Meshes, PairExcitation, Values

if TYPE_CHECKING:
    from facegear.poses.surface import PoseSurface
    from facegear.variants.rubbed_teeth import Rub, RubbedTeeth
    from facegear.variants.varied_bodies import VariedBodies

Judge = Callable[[Mapping[str, Any]], dict[str, float]]
"""What a machine is judged by, by column name, given the values of `facegear.config.changes.variable_part`.

Raises the error that a config gets for a machine that cannot be built, NotConverged."""

ARRAYS = ("flanks", "pressure", "bodies")
"""What a machine is given beside values and tables that say the same of it."""
WHOLE = 2**31
"""More mesh cycles than any hunting cycle has: all of them."""


@dataclass(frozen=True)
class Question:
    """How machines are judged: by loads over `cycles` mesh cycles of the hunting cycle, or of the motion.

    `model`: quasi_static or dynamic; `accuracy`, `options`: sections dynamics.accuracy and load_sharing;
    `jumps`: where the nearest jump is looked for, None if it is not asked for. `every_place`: friction by all
    places of the contact, not by the few that stand for them.
    """

    model: str
    cycles: int
    accuracy: Mapping[str, Any]
    options: Mapping[str, Any]
    jumps: JumpRange | None = None
    every_place: bool = False

    @property
    def dynamic(self) -> bool:
        """Whether the motion is asked for."""
        return self.model == "dynamic"


@dataclass(frozen=True, eq=False, kw_only=True)
class VariedMachine:
    """The machine that many are made from, as plain config values: what samples and designs share.

    With `pair`, the sections that contact needs, and `flanks`, the compliance of its bodies, every tooth pair
    that differs is put into contact; without, all have the stiffness of `harmonics`, or the arrays `law` of
    stage mesh_law where it depends on the load. With `solid`, section tooth_pair, face gears bend; `bodies`:
    arrays `reduced` of stage gear_bodies. With `poses`, arrays `surface` of stage pose_surface, the meshes of
    each one stand as its own forces put them.
    """

    harmonics: pd.DataFrame
    transmission: Values
    accuracy: Values
    speed_rpm: float
    options: Values
    tolerances: Values | None
    pair: Values | None = None
    flanks: Flanks = field(default_factory=dict)
    law: Arrays | None = None
    solid: Values | None = None
    bodies: Arrays | None = None
    poses: Arrays | None = None

    @classmethod
    def of_stage(cls, flanks: Sequence[Arrays] = (), **given: Any) -> Self:
        """From the arguments of a stage; `flanks`: arrays of both bodies from stage compliance, if any."""
        return cls(flanks=stored_flanks(flanks), **given)

    @cached_property
    def meshes(self) -> Meshes:
        """The mesh of each one's tooth pair."""
        return tooth_meshes(self.harmonics, self.pair, self.flanks, self.law)

    @cached_property
    def varied_bodies(self) -> "VariedBodies | None":
        """The face gears of each one where they bend."""
        if self.solid is None or self.bodies is None:
            return None
        from facegear.variants.varied_bodies import VariedBodies

        return VariedBodies.of_stage(self.transmission, self.solid, self.bodies)

    @cached_property
    def surface(self) -> "PoseSurface | None":
        """Contact over pose, where the machine's own forces put the teeth."""
        if self.poses is None:
            return None
        from facegear.poses.surface import PoseSurface

        return PoseSurface.of_arrays(self.poses)

    def judge_of(self, question: Question, label: str, nominal: Values | None = None) -> Judge:
        """What each one is judged by; `label` names it in errors, `nominal`: the values that it is near."""
        return judge(question, self.meshes, label, self.varied_bodies, self.surface, nominal)

    def columns(self, layout: Layout, question: Question, jumps: bool = False) -> tuple[str, ...]:
        """Names of what a machine is judged by."""
        gauges = self.pair is not None and self.pair["contact"]["root_stress"]
        contact, law = self.pair is not None, self.law is not None
        return quantity_names(layout, question.dynamic, contact, gauges, jumps, self.friction, law)

    @property
    def friction(self) -> bool:
        """Whether friction is asked for."""
        return False

    def identity(self, *parts: object) -> str:
        """Text that differs whenever one of the parts or a value of the machine does."""
        plain = {field.name: getattr(self, field.name) for field in fields(self) if field.name not in ARRAYS}
        tables = {name: value.to_csv() for name, value in plain.items() if isinstance(value, pd.DataFrame)}
        arrays = {
            text: {name: values.tolist() for name, values in (given or {}).items()}
            for text, given in (("law", self.law), ("poses", self.poses))
        }
        return identity(*parts, {**plain, **tables, **arrays})


def tooth_meshes(
    harmonics: pd.DataFrame,
    pair: Values | None,
    flanks: Flanks,
    law: Arrays | None = None,
    rub: "Rub | None" = None,
    rubbed: "RubbedTeeth | None" = None,
) -> Meshes:
    """One mesh for all, of `harmonics`; or by contact where `pair` holds the sections that it needs.

    `pair`: tooth_pair, mesh, contact, mesh_stiffness; `flanks`: the compliance of its bodies by name.
    Lubricated teeth: those `rubbed` of the one mesh, or what `rub` makes of each contact.
    """
    if pair is not None:
        from facegear.variants.contact import meshes_in_contact  # only contact needs finite elements

        return meshes_in_contact(pair, flanks, rub)
    series, error = series_of(harmonics), unloaded_error(harmonics)
    tables = None if law is None else tables_of(law)
    return lambda values: PairExcitation(
        ToothNumbers.of_config(values), series, error, tables=tables, rubbed=rubbed
    )


def stored_flanks(arrays: Sequence[Arrays]) -> Flanks:
    """From the arrays of the pinion and of the face gear, or from none where there is no contact."""
    if not arrays:
        return {}
    from facegear.contact.gear_flank import from_arrays

    return {body: from_arrays(arrays_of_body) for body, arrays_of_body in zip(BODIES, arrays, strict=True)}


def judge(
    question: Question,
    meshes: Meshes,
    label: str,
    bodies: "VariedBodies | None" = None,
    surface: "PoseSurface | None" = None,
    nominal: Values | None = None,
) -> Judge:
    """`label` names the machine in errors; `bodies` of face gears that bend; `surface`: contact over pose,
    where meshes stand as the forces of their own machine put them. nominal: values that all are near, whose
    orbit guides theirs.
    """
    ask = _ask(question)

    def rubbed(
        teeth: "RubbedTeeth", lubrication: Values, built: Machine, speed: float, loads: FlankLoads
    ) -> dict[str, float]:
        from facegear.variants.rubbed_teeth import friction_quantities  # only friction needs it

        section = parse(LubricationSection, lubrication, label)
        pair = teeth.pair(section, question.every_place)
        return friction_quantities(built, speed, loads, pair, limits_of(section))

    def assembled(values: Values) -> tuple[PairExcitation, Machine]:
        mesh = meshes(values["tooth_pair"])
        section = parse(Transmission, mesh.in_machine(values["transmission"]), label)
        made = described(section, mesh.numbers, mesh.unloaded)
        require_buildable(section, mesh.numbers, made)
        require_room(section, mesh.numbers, made)
        tables = None if mesh.tables is None else mesh.tables(made[0])
        built = machine(section, mesh.numbers, mesh.stiffness, mesh.unloaded, made, tables)
        if bodies is not None:
            built = bodies.joined(built, section, values["tooth_pair"])
        if surface is not None:
            built = posed_machine(built, surface)
        return mesh, built

    @cache
    def guide() -> Guide | None:
        if nominal is None or not question.dynamic:
            return None
        try:
            _, built = assembled(nominal)
        except FacegearError:
            return None
        return orbit_of(built, nominal["dynamics"]["speed_rpm"], *_precision(question))

    @keys_named()
    def judged(values: Mapping[str, Any]) -> dict[str, float]:
        mesh, built = assembled(values)
        speed = values["dynamics"]["speed_rpm"]
        quantities, loads = ask(built, speed, guide())
        quantities |= mesh.quantities(quantities[PEAK])
        if mesh.rubbed is not None:
            quantities |= rubbed(mesh.rubbed, values["lubrication"], built, speed, loads)
        if question.jumps is not None:
            quantities[JUMP_MARGIN] = jump_margin(build_model(built), speed, question.jumps)
        return quantities

    return judged


def _ask(question: Question) -> Callable[[Machine, float, Guide | None], MachineQuantities]:
    if not question.dynamic:
        return lambda built, speed, guide: quasi_static_quantities(at_rest(built), question.cycles)
    precision = _precision(question)
    return lambda built, speed, guide: dynamic_quantities(built, speed, *precision, guide)


def _precision(question: Question) -> tuple[Settings, SharingOptions]:
    precise = settings(Accuracy.of_config(question.accuracy))
    return precise, replace(sharing_options(LoadSharing.of_config(question.options)), starts=1)
