"""Conditions that decide which stages a case needs, and values of a stage's needs that depend on the case.

Every function takes the case alone. The config is imported inside functions: every job reads the table of
stages, and few jobs need the config.
"""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from facegear.config.changes import GAPS, moves_pair, without
from facegear.pipeline.stage import Case, Wildcards

if TYPE_CHECKING:
    from facegear.config.tolerances import Design

BODIES = ("pinion", "face_gear")
CONTACT = ("tooth_pair", "mesh", "contact")
"""Sections of the config that a contact analysis takes."""
PAIR_SECTIONS = (*CONTACT, "mesh_stiffness")
"""Sections of the config that a contact analysis of sampled or searched machines takes."""

LOADING = (
    *("torques_n_m", "positions_per_pitch"),
    *("fillet_contact", "neighbour_coupling", "edge_contact"),
)
"""Keys of section contact that describe how the bodies are loaded; they do not affect the compliance."""

DUTY_POINTS = 12
"""Torques of a duty cycle that are marked on the load-sharing map: as many as are told apart."""

TILTS = ("tilt", "hub_tilt", "body")
"""Keys of a gear whose teeth lean."""


def load_sharing_options(case: Case) -> Any:
    """Return section load_sharing without the limit that only the report's verdict needs.

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


def always(case: Case) -> bool:
    """Always.

    Parameters
    ----------
    case : Case
        The case, without effect.

    Returns
    -------
    bool
        True.
    """
    return True


def contact(case: Case) -> bool:
    """Whether a contact analysis gives the stiffness, or root stress or friction is asked for.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return computed_stiffness(case) or root_stress(case) or friction(case)


def computed_stiffness(case: Case) -> bool:
    """Whether k(t) follows from the contact.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return case.values["mesh_stiffness"]["source"] != "harmonics"


def single_teeth(case: Case) -> bool:
    """Whether a contact analysis is made and deviations of single teeth are given.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    bodies = (case.values["tooth_pair"][body] for body in BODIES)
    grids = (grid for body in bodies if body for grid in body["flanks"]["grids"])
    return contact(case) and any(grid["tooth"] is not None for grid in grids)


def measured_flanks(case: Case) -> bool:
    """Whether deviations of flanks are given.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    bodies = (case.values["tooth_pair"][body] for body in BODIES)
    return any(body and body["flanks"]["grids"] for body in bodies)


def load_dependent(case: Case) -> bool:
    """Whether mesh forces depend on the load.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return case.values["mesh_stiffness"]["mesh_law"] == "load_dependent"


def load_dependent_machine(case: Case) -> bool:
    """Whether section transmission is given and mesh forces depend on the load.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return machine(case) and load_dependent(case)


def poses(case: Case) -> bool:
    """Whether meshes stand where the machine's own forces put them.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return machine(case) and case.values["transmission"]["operating_pose"] == "static"


def posed_stress(case: Case) -> bool:
    """Whether meshes stand where their own forces put them, and root stress or a rating is asked for.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return poses(case) and (root_stress(case) or strength(case))


def posed_rating(case: Case) -> bool:
    """Whether meshes stand where the machine's own forces put them, and a rating is asked for.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return poses(case) and strength(case)


def tilting(case: Case) -> bool:
    """Whether a body of the machine may tilt or bend, so that the error of the shaft angle changes.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    section: Any = case.values["transmission"]
    gears = [section["face_gear"], *section["single_gears"].values()]
    return bool(section["shafts"]) or any(gear.get(key) for gear in gears for key in TILTS)


def modes_from_contact(case: Case) -> bool:
    """Whether modes take their stiffness from the contact analysis.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    from facegear.config.modal import modes_need_contact

    return modes_need_contact(case.values)


def root_stress(case: Case) -> bool:
    """Whether `contact.root_stress` asks for it.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return bool(case.values["contact"]["root_stress"])


def friction(case: Case) -> bool:
    """Whether section lubrication is given.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return case.values["lubrication"] is not None


def friction_in_motion(case: Case) -> bool:
    """Whether friction disturbs the motion.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return friction(case) and case.values["lubrication"]["friction"]["effect"] == "excitation"


def machine_friction(case: Case) -> bool:
    """Whether sections lubrication and transmission are given.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return friction(case) and machine(case)


def machine(case: Case) -> bool:
    """Whether section transmission is given.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return case.values["transmission"] is not None


def elastic_gears(case: Case) -> bool:
    """Whether the body of a face gear bends.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    from facegear.config.elastic_bodies import any_elastic

    return any_elastic(case.values["transmission"])


def solid_pair(case: Case) -> Any:
    """Return section tooth_pair where the body of a face gear bends.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    Any
        Plain values of the section, None where all bodies are rigid.
    """
    return case.values["tooth_pair"] if elastic_gears(case) else None


def drive_line(case: Case) -> bool:
    """Whether pinions have shafts, or torques turn masses behind torsional springs.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    transmission = case.values["transmission"]
    return transmission is not None and bool(transmission["shafts"] or transmission["torsion"])


def shaft_figures(case: Case) -> list[str]:
    """Return the names of the figures of shafts.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[str]
        `shafts` where pinions have shafts, else nothing.
    """
    return ["shafts"] if drive_line(case) and case.values["transmission"]["shafts"] else []


def pinion_width(case: Case) -> float | None:
    """Return the face width of the pinions, where the tooth pair gives it.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    float or None
        mm, None without a pinion's body.
    """
    pinion = case.values["tooth_pair"]["pinion"]
    return pinion and float(pinion["width_mm"])


def machine_stress(case: Case) -> bool:
    """Whether section transmission is given and root stress asked for.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return machine(case) and root_stress(case)


def strength(case: Case) -> bool:
    """Whether section strength is given.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return case.values["strength"] is not None


def machine_loads(case: Case) -> bool:
    """Whether the rating takes K_v and K_gamma from the machine's motion.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return strength(case) and case.values["strength"]["load_factors"] == "machine"


def scuffed_loads(case: Case) -> bool:
    """Whether the rating takes the machine's loads and its flanks are lubricated.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return machine_loads(case) and machine_friction(case)


def branches(case: Case) -> bool:
    """Whether section branches is given.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return machine(case) and case.values["branches"] is not None


def shares_load(case: Case) -> bool:
    """Whether the machine splits a load among some of its meshes.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    from facegear.config.sharing_groups import split_kinds

    return machine(case) and bool(split_kinds(case.values))


def has_groups_of_pinions(case: Case) -> bool:
    """Whether several pinions do the same.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    from facegear.config.sharing_groups import has_groups

    return machine(case) and has_groups(case.values)


def hunting(case: Case) -> bool:
    """Whether several pinions do the same, with geometric kinematics.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return has_groups_of_pinions(case) and case.values["transmission"]["mesh_kinematics"] == "geometric"


def follows_rotation(case: Case) -> bool:
    """Whether meshes are geometric, and runouts, pitch deviations or unlike teeth disturb them.

    A pitch deviation counts if it is a cumulative one.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    from facegear.config.notes import turns

    return hunting(case) and (turns(case.values["transmission"]) or single_teeth(case))


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
    from facegear.config.notes import turns

    if not machine(case) or case.values["transmission"]["mesh_kinematics"] != "geometric":
        return False
    section = case.values["transmission"]
    return turns(section) or single_teeth(case) or bool(section["excitations"])


def tolerances(case: Case) -> bool:
    """Whether section tolerances is given.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return machine(case) and case.values["tolerances"] is not None


def load_map(case: Case) -> bool:
    """Whether `tolerances.load_map` is given.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return tolerances(case) and case.values["tolerances"]["load_map"] is not None


def sharing_map(case: Case) -> bool:
    """Whether section sharing_map is given.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True where its map is drawn.
    """
    return machine(case) and case.values["sharing_map"] is not None


def duty_torques(case: Case) -> list[float]:
    """Return the torques of the duty cycle at which the machine stands on the load-sharing map.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list of float
        N m in each mesh of an input, rising, each once: DUTY_POINTS of them where there are more.
    """
    section = case.values["strength"]
    torques = sorted({load["torque_n_m"] for load in section["duty"] if load["hours"] > 0}) if section else []
    if len(torques) <= DUTY_POINTS:
        return torques
    return [torques[i * (len(torques) - 1) // (DUTY_POINTS - 1)] for i in range(DUTY_POINTS)]


def search(case: Case) -> bool:
    """Whether section search is given.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return machine(case) and case.values["search"] is not None


def sweep_chunks(case: Case) -> list[Wildcards]:
    """Return the chunks of the sweep, direction by direction.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[Wildcards]
        `direction` and `number` of each chunk.
    """
    sweep = case.values["dynamics"]["sweep"]
    numbers = range(sweep["chunks"])
    return [{"direction": name, "number": str(n)} for name in sweep["directions"] for n in numbers]


def random_starts(case: Case) -> list[Wildcards]:
    """Return the speeds at which random starts are made, by number.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[Wildcards]
        `number` of each speed.
    """
    speeds = case.values["branches"]["explore"]["speeds_rpm"]
    return [{"number": str(number)} for number in range(max(len(speeds), 1))]


def tolerance_chunks(design: "Design") -> Callable[[Case], list[Wildcards]]:
    """Return a function that lists the chunks of a design of samples.

    Parameters
    ----------
    design : 'Design'
        `samples` or `indices`.

    Returns
    -------
    Callable[[Case], list[Wildcards]]
        Function of the case that returns `design`, `first` and `last` of each chunk, the numbers of its
        samples.
    """

    def wildcards_of_chunks(case: Case) -> list[Wildcards]:
        from facegear.config.tolerances import Tolerances, chunks

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
        `seed` of each island.
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
        `body` of each.
    """
    return [{"body": body} for body in BODIES]


def config_name(case: Case) -> str:
    """Return the name of the config, which the points of its studies share.

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
    """Return section tooth_pair without keys that move no node: cases that differ in gaps share their
    compliance.

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
    """Return section contact without LOADING, so that cases that differ in loads share their compliance.

    Its cuts along the face are those that the contact ellipse of a crowned pair needs.

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
    from facegear.config.arguments import typed_arguments
    from facegear.config.contact_setup import contact_setup

    plan = contact_setup(**typed_arguments(contact_setup, {key: case.values[key] for key in CONTACT})).plan
    return {**section, "refinement": {**section["refinement"], "width": plan.refinement.width}}


def gears_met(case: Case) -> list[str]:
    """Return the face gears of the machine, as `geometry.flank_errors` names them: one alone is the upper.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[str]
        `upper`, or `upper` and `lower`.
    """
    machine: Any = case.values["transmission"]
    return ["upper"] if machine is None or len(machine["face_gears"]) == 1 else ["upper", "lower"]


def sampled_contact(case: Case) -> bool:
    """Whether samples have a contact analysis of their own: asked for, or a cause moves the tooth pair.

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
    """Return sections lubrication and tooth_pair where samples of tolerances are lubricated.

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
    from facegear.load_sharing.quantity_names import is_contact_quantity

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
    """Return a function that gives the sections of the tooth pair where machines among many are put into
    contact.

    Parameters
    ----------
    has_contact : Callable[[Case], bool]
        Condition of the case.

    Returns
    -------
    Callable[[Case], dict[str, Any] | None]
        Function of the case that returns plain values of PAIR_SECTIONS by name, None where the condition
        fails.
    """

    def sections(case: Case) -> dict[str, Any] | None:
        return {key: case.values[key] for key in PAIR_SECTIONS} if has_contact(case) else None

    return sections


def _causes(section: Mapping[str, Any] | None) -> list[str]:
    return [key for cause in (section or {}).get("causes", ()) for key in cause["moves"]]
