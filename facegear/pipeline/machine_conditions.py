"""Conditions under which a case makes stages of the machine, of load sharing and of strength."""

from typing import Any

from facegear.build.casing import has_casing
from facegear.build.elastic_bodies import any_elastic
from facegear.build.machine_layout import has_groups, split_kinds
from facegear.build.notes import turns
from facegear.pipeline.conditions import friction, machine, root_stress, single_teeth, strength
from facegear.pipeline.stage import Case


def friction_in_motion(case: Case) -> bool:
    """Whether friction disturbs the motion.

    It does where `lubrication.friction.effect` is `excitation`.

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


def elastic_gears(case: Case) -> bool:
    """Whether the body of a face gear bends.

    It does where a gear of section `transmission` has a section `body`.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return any_elastic(case.values["transmission"])


def casing(case: Case) -> bool:
    """Whether the machine stands on a casing.

    It does where section `transmission` has a section `casing`.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return has_casing(case.values["transmission"])


def casing_sensors(case: Case) -> bool:
    """Whether the casing of the machine has sensors.

    They are listed in `transmission.casing.sensors`.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return casing(case) and bool(case.values["transmission"]["casing"]["sensors"])


def solid_pair(case: Case) -> Any:
    """Return section tooth_pair where the body of a face gear bends, for stages that take the pair only
    because of that body.

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

    These are the sections `transmission.shafts` and `transmission.torsion`.

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


def rolling_bearings(case: Case) -> bool:
    """Whether a shaft stands on rolling bearings.

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
    shafts = {} if transmission is None else transmission["shafts"]
    return any(bearing["rolling"] is not None for shaft in shafts.values() for bearing in shaft["bearings"])


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


def machine_loads(case: Case) -> bool:
    """Whether the rating takes K_v and K_gamma from the machine's motion.

    It does where `strength.load_factors` is `machine`.

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

    Scuffing and micropitting are then rated as well.

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
    """Whether the machine splits one load among several of its meshes.

    Such meshes form groups, of inputs or of idlers, for which load-sharing coefficients exist.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return machine(case) and bool(split_kinds(case.values))


def has_groups_of_pinions(case: Case) -> bool:
    """Whether several pinions of the machine have the same function.

    It does not matter whether they split a load.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return machine(case) and has_groups(case.values)


def hunting(case: Case) -> bool:
    """Whether several pinions do the same, with geometric kinematics.

    The kinematics are `transmission.mesh_kinematics`; `printed` ones treat both flanks of a mesh as
    one.

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

    A pitch deviation counts if it is a cumulative one. Several pinions must do the same, as for
    `hunting`.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return hunting(case) and (turns(case.values["transmission"]) or single_teeth(case))


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
