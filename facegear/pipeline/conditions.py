"""Conditions that decide which stages a case needs, and values of a stage's needs that depend on the case.

Every function takes the case alone. The config is imported inside functions: every job reads the table of
stages, and few jobs need the config.
"""

from typing import Any

from facegear.pipeline.stage import Case
from facegear.schema.contact import modes_need_contact

BODIES = ("pinion", "face_gear")
"""Names of the bodies of a pair, pinion first."""
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


def always(case: Case) -> bool:
    """Always.

    The condition of a stage that every case needs; its first line stands in the table of stages.

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

    That is `mesh_stiffness.source` other than harmonics, `contact.root_stress`, or a section
    `lubrication`.

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
    """Whether the mesh stiffness k(t) is computed from contact, not given by the config.

    It is given where `mesh_stiffness.source` is `harmonics`.

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

    They are measured grids of `flanks.grids` of either body that name a tooth.

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

    They are grids of `flanks.grids` of either body, for all teeth or for one.

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

    They do where `mesh_stiffness.mesh_law` is `load_dependent`.

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

    They do where `transmission.operating_pose` is `static`.

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

    A rating is asked for by section `strength`.

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

    Shafts of pinions let them tilt; so do the keys TILTS of any face gear. It needs a section
    `transmission`.

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

    Otherwise they take the mean stiffness that the config gives; `modes_need_contact` of
    facegear.schema has the rules.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return modes_need_contact(case.values)


def root_stress(case: Case) -> bool:
    """Whether the config asks for root stress by `contact.root_stress`.

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


def strength(case: Case) -> bool:
    """Whether section strength rates the teeth.

    It does where it gives their materials (`strength.pinion`, `strength.face_gear`).

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    section = case.values["strength"]
    return section is not None and section["pinion"] is not None
