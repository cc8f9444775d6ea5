"""Arguments of stages: what depends on the case, and plain values as the objects that annotations name."""

from collections.abc import Callable, Mapping
from typing import Any, get_args, get_type_hints

from facegear.build.notes import turns
from facegear.build.tooth_numbers import machine_teeth
from facegear.build.tooth_pair import contact_setup
from facegear.pipeline.conditions import (
    BODIES,
    CONTACT,
    DUTY_POINTS,
    LOADING,
    PAIR_SECTIONS,
    friction,
    machine,
    single_teeth,
)
from facegear.pipeline.stage import Case, Wildcards
from facegear.quantities import is_contact_quantity
from facegear.schema.changes import GAPS, moves_pair, without
from facegear.schema.tolerances import Design, Tolerances, chunks


def typed_arguments(function: Callable[..., Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """Convert plain config values to the sections that a function's annotations ask for.

    The values are those of a config that was validated. This is where plain values, as Snakemake hands
    them from process to process, become objects again.

    Parameters
    ----------
    function : Callable[..., Any]
        Function whose annotations are read.
    values : Mapping[str, Any]
        Plain values by argument name.

    Returns
    -------
    dict[str, Any]
        The values by argument name. A mapping becomes an object where the annotation, or a part of a
        union, is a class with `of_config`; other values stay.
    """
    hints = get_type_hints(function)
    return {name: _section_of(hints.get(name), value) for name, value in values.items()}


def _section_of(kind: Any, value: Any) -> Any:
    """Return a mapping as an object of the class that the annotation `kind`, or a part of a union,
    names; other values as they are.
    """
    if isinstance(value, Mapping):
        for candidate in (kind, *get_args(kind)):
            if hasattr(candidate, "of_config"):
                return candidate.of_config(value)
    return value


def teeth_of_machine(case: Case) -> Any:
    """Return what a machine depends on of section `tooth_pair`.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    Any
        Plain values, see `machine_teeth`.
    """
    return machine_teeth(case.values["tooth_pair"])


def load_sharing_options(case: Case) -> Any:
    """Return section load_sharing without `required_k_gamma`, a limit that no result depends on but the
    report's verdict.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    Any
        Plain values of the section.
    """
    return without(case.values["load_sharing"], "required_k_gamma")


def turning_errors(case: Case) -> bool:
    """Whether meshes are geometric, and runouts, pitch deviations, unlike teeth or torques excite them.

    A pitch deviation counts if it is a cumulative one, a torque if it is periodic.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    if not machine(case) or case.values["transmission"]["mesh_kinematics"] != "geometric":
        return False
    section = case.values["transmission"]
    return turns(section) or single_teeth(case) or bool(section["excitations"])


def duty_torques(case: Case) -> list[float]:
    """Return the torques of the duty cycle at which the machine stands on the load-sharing map.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list of float
        Torques of bins with time in them, N m in each mesh of an input, rising, each once; DUTY_POINTS
        of them, evenly by rank, where there are more. Empty without section strength.
    """
    section = case.values["strength"]
    torques = sorted({load["torque_n_m"] for load in section["duty"] if load["hours"] > 0}) if section else []
    if len(torques) <= DUTY_POINTS:
        return torques
    return [torques[i * (len(torques) - 1) // (DUTY_POINTS - 1)] for i in range(DUTY_POINTS)]


def sweep_chunks(case: Case) -> list[Wildcards]:
    """Return the chunks of the sweep, direction by direction.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[Wildcards]
        `direction` (`up` or `down`) and `number` (text, from 0) of each chunk: the wildcards of stage
        dynamics_sweep_chunk.
    """
    sweep = case.values["dynamics"]["sweep"]
    numbers = range(sweep["chunks"])
    return [{"direction": name, "number": str(n)} for name in sweep["directions"] for n in numbers]


def random_starts(case: Case) -> list[Wildcards]:
    """Return the speeds at which random starts are made, by their index in
    `branches.explore.speeds_rpm`.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[Wildcards]
        `number` (text, from 0) of each speed: the wildcards of stage branches_starts. One, for the
        nominal speed, where none is given.
    """
    speeds = case.values["branches"]["explore"]["speeds_rpm"]
    return [{"number": str(number)} for number in range(max(len(speeds), 1))]


def tolerance_chunks(design: "Design") -> Callable[[Case], list[Wildcards]]:
    """Make a function that lists the chunks into which the samples of a design are cut.

    Parameters
    ----------
    design : 'Design'
        `samples` for random ones, `indices` for those from which Sobol indices follow.

    Returns
    -------
    Callable[[Case], list[Wildcards]]
        Function of the case that returns `design`, `first` and `last` of each chunk, the numbers of its
        samples.
    """

    def wildcards_of_chunks(case: Case) -> list[Wildcards]:
        """Return wildcards `design`, `first` and `last` (numbers of samples, as text, both included) of
        each chunk.
        """
        section = Tolerances.of_config(case.values["tolerances"])
        sample_ranges = chunks(section, design)
        return [{"design": design, "first": str(first), "last": str(last)} for first, last in sample_ranges]

    return wildcards_of_chunks


def islands(case: Case) -> list[Wildcards]:
    """Return the islands of a search by their seeds.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[Wildcards]
        `seed` (text) of each island: the wildcards of stage search_island.
    """
    return [{"seed": str(seed)} for seed in case.values["search"]["seeds"]]


def both_bodies(case: Case) -> list[Wildcards]:
    """Return wildcards for the pinion and for the face gear.

    Parameters
    ----------
    case : Case
        The case, without effect.

    Returns
    -------
    list[Wildcards]
        `{"body": "pinion"}` and `{"body": "face_gear"}`.
    """
    return [{"body": body} for body in BODIES]


def config_name(case: Case) -> str:
    """Return the name of the config: the id of the case without `/studies/...`, so that all points of
    its studies share it.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    str
        The name.
    """
    return str(case.values["case"]).partition("/")[0]


def without_gaps(case: Case) -> Any:
    """Return section tooth_pair without GAPS, the keys that move flanks but no node of the finite
    element bodies.

    Cases that differ in these keys alone share their compliance.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    Any
        Plain values of the section.
    """
    section: Any = case.values["tooth_pair"]
    for key in GAPS:
        section = without(section, key)
    return section


def without_loads(case: Case) -> Any:
    """Return section contact without LOADING, so that cases that differ in loads share their
    compliance.

    For a pair with crowned or measured flanks `refinement.width`, the number of cuts along the face, is
    replaced by the one that the contact ellipse needs, which depends on the loads.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    Any
        Plain values of the section.
    """
    section = {key: value for key, value in case.values["contact"].items() if key not in LOADING}
    pinion, gear = (case.values["tooth_pair"][body] for body in BODIES)
    modifications = (pinion, gear and gear["modifications"])
    has_grids = any(body and body["flanks"]["grids"] for body in (pinion, gear))
    if not has_grids and not any(
        modification and modification["lead_crowning"]["amount_um"] for modification in modifications
    ):
        return section
    plan = contact_setup(**typed_arguments(contact_setup, {key: case.values[key] for key in CONTACT})).plan
    return {**section, "refinement": {**section["refinement"], "width": plan.refinement.width}}


RIGHT_ANGLE_DEG = 90.0
"""Shaft angle (deg) at which an upper and a lower gear are alike."""


def gears_met(case: Case) -> list[str]:
    """Return the names of the machine's face gears, upper and lower; a single one is the upper.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[str]
        `upper` without a machine or with one face gear, whatever its name; otherwise `upper` and
        `lower`.
    """
    machine: Any = case.values["transmission"]
    return ["upper"] if machine is None or len(machine["face_gears"]) == 1 else ["upper", "lower"]


def gears_with_bodies(case: Case) -> list[str]:
    """Return the names of the face gears that flanks are needed of.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[str]
        `upper`, and `lower` where there is one that the offset or the shaft angle makes another gear.
    """
    pair: Any = case.values["tooth_pair"]
    is_alike = pair["offset_mm"] == 0.0 and pair["shaft_angle_deg"] == RIGHT_ANGLE_DEG
    return ["upper"] if is_alike else gears_met(case)


def sampled_contact(case: Case) -> bool:
    """Whether samples of tolerances have a contact analysis of their own: asked for, or a cause moves
    the tooth pair.

    Otherwise all samples have the mesh stiffness of the machine itself.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    section = case.values["tolerances"]
    return section is not None and (section["tooth_contact"] or moves_pair(_causes(section)))


def lubricated_samples(case: Case) -> dict[str, Any] | None:
    """Return sections lubrication and tooth_pair, from which samples of tolerances take their friction.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    dict[str, Any] | None
        Plain values of both sections by name, None without section lubrication.
    """
    if case.values["lubrication"] is None:
        return None
    return {key: case.values[key] for key in ("lubrication", "tooth_pair")}


def stored_rubbing(case: Case) -> bool:
    """Whether samples take friction from the stored contact, because they have no contact of their own.

    It needs a section `lubrication`.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return friction(case) and not sampled_contact(case)


def searched_contact(case: Case) -> bool:
    """Whether designs have a contact analysis of their own.

    They have one where a variable, or a cause of a percentile, moves the tooth pair, or where an objective
    needs a quantity of the contact.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    section = case.values["search"]
    if section is None:
        return False
    goals = [*section["objectives"], *section["constraints"]]
    robust = any(goal["percentile"] is not None for goal in goals)
    keys = [key for variable in section["variables"] for key in variable["sets"]]
    needs_contact = any(
        is_contact_quantity(text) for goal in goals for text in (*goal["largest_of"], *goal["smallest_of"])
    )
    return needs_contact or moves_pair(keys) or (robust and moves_pair(_causes(case.values["tolerances"])))


def pair_where(has_contact: Callable[[Case], bool]) -> Callable[[Case], dict[str, Any] | None]:
    """Make a function that gives the sections of the tooth pair where sampled or searched machines are
    put into contact.

    Parameters
    ----------
    has_contact : Callable[[Case], bool]
        Condition of the case under which machines have a contact analysis of their own.

    Returns
    -------
    Callable[[Case], dict[str, Any] | None]
        Function of the case that returns plain values of PAIR_SECTIONS by name, None where the
        condition fails.
    """

    def sections(case: Case) -> dict[str, Any] | None:
        """Return plain values of PAIR_SECTIONS by name if the condition holds for the case, else None."""
        return {key: case.values[key] for key in PAIR_SECTIONS} if has_contact(case) else None

    return sections


def _causes(section: Mapping[str, Any] | None) -> list[str]:
    """Return the dotted config keys that the causes of section tolerances change; none without the
    section.
    """
    return [key for cause in (section or {}).get("causes", ()) for key in cause["moves"]]
