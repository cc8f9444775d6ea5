"""Cases of studies whose contact, friction or mesh law is set side by side."""

from collections.abc import Callable
from typing import Any

from facegear.pipeline import conditions, machine_conditions
from facegear.pipeline.stage import Case, Wildcards
from facegear.pipeline.studies import NOMINAL, Points, _id, names, points


def contact_points(case: Case) -> Points:
    """Return the machine itself and all points that are compared with it by their contact.

    A point of a study is one changed machine. A study is taken, with all its points that have a contact
    analysis, if one of them has another contact than the machine itself.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    Points
        Study, point and label of each, NOMINAL first; NOMINAL alone where nothing is compared.
    """
    return _with_own(case, "contact", conditions.contact)


def friction_points(case: Case) -> Points:
    """Return the machine itself and the points of every study that changes the loss of its meshes.

    A study is taken, with all its points that have losses, if one of them has another loss than the
    machine itself.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    Points
        Study, point and label of each, NOMINAL first; NOMINAL alone where nothing is compared.
    """
    return _with_own(case, "machine_loss", machine_conditions.machine_friction)


def _with_own(case: Case, stage: str, has: Callable[[Case], bool]) -> Points:
    """Return NOMINAL and the points of studies for which a stage is made anew.

    A study counts if for one of its points the files of `stage` are not shared with the case itself.
    All points of such a study are taken for which `has`, the condition of the stage, is true.
    """
    if not has(case) or not case.values["studies"]:
        return [NOMINAL]
    selection: Points = []
    for name in names(case):
        study_points = [point for point in points(case) if point[0] == name]
        stage_points = [point for point in study_points if has(Case(case.cases[_id(case, *point[:2])]))]
        if any(case.source(stage, _id(case, *point[:2])) != case.values["case"] for point in stage_points):
            selection += stage_points
    return [NOMINAL, *selection]


def contact_cases(case: Case) -> list[Wildcards]:
    """Return the case itself and the studied cases that have a contact analysis of their own.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[Wildcards]
        Wildcards `{"case": id}` of each, in the order of `contact_points`.
    """
    return _cases(case, contact_points(case))


def friction_cases(case: Case) -> list[Wildcards]:
    """Return the case itself and the studied cases whose mesh losses differ from its own.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[Wildcards]
        Wildcards `{"case": id}` of each, in the order of `friction_points`.
    """
    return _cases(case, friction_points(case))


def _cases(case: Case, selection: Points) -> list[Wildcards]:
    """Return wildcards `{"case": id}` of the case itself and of the study points behind the first of
    `selection`.
    """
    point_cases = ({"case": _id(case, *point[:2])} for point in selection[1:])
    return [{"case": str(case.values["case"])}, *point_cases]


def law_points(case: Case) -> Points:
    """Return the machine itself and the study points whose `mesh_stiffness.mesh_law` differs from the
    machine's.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    Points
        Study, point and label of each, NOMINAL first.
    """
    machine_law = case.values["mesh_stiffness"]["mesh_law"]
    other_points = [
        point
        for point in points(case)
        if case.cases[_id(case, *point[:2])]["mesh_stiffness"]["mesh_law"] != machine_law
    ]
    return [NOMINAL, *other_points]


def other_laws(case: Case) -> list[Wildcards]:
    """Return the studied points whose mesh law is drawn beside the machine's own.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[Wildcards]
        Wildcards `{"case": id}` of each point of `law_points` but the machine itself.
    """
    return _cases(case, law_points(case))[1:]


def law_labels(case: Case) -> list[str]:
    """Return the labels in a figure of the laws of `law_points`.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[str]
        Name of the machine's mesh law, then the label of each point.
    """
    machine_label = str(case.values["mesh_stiffness"]["mesh_law"]).replace("_", "-")
    return [machine_label, *(label for _, _, label in law_points(case)[1:])]


def law_figures(case: Case) -> list[str]:
    """Return the names of the figures of loads in the table of the mesh law.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[str]
        `law_loads`, and `law_sweeps` where the machine's law is load-dependent and a study has another
        law.
    """
    has_comparison = conditions.load_dependent(case) and len(law_points(case)) > 1
    return ["law_loads", *(["law_sweeps"] if has_comparison else [])]


def friction_studied(case: Case) -> bool:
    """Whether a study changes the loss of the machine's meshes.

    `friction_points` then holds more than the machine itself.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return len(friction_points(case)) > 1


def contact_studied(case: Case) -> bool:
    """Whether a study changes the contact of the pair.

    `contact_points` then holds more than the machine itself.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return len(contact_points(case)) > 1


def contact_titles(case: Case) -> dict[str, str]:
    """Return name and title of each study that changes the contact.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    dict[str, str]
        Title of the study in the config, by its name.
    """
    study_names = {name for name, _, _ in contact_points(case)}
    return {study["name"]: study["title"] for study in case.values["studies"] if study["name"] in study_names}


def contact_figures(case: Case) -> list[str]:
    """Return the names of the figures of curves and patterns, for each study that changes the contact.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[str]
        For each study `contact_study_<name>` (curves) and `contact_pattern_study_<name>`.
    """
    prefixes = ("study_", "pattern_study_")
    return [f"contact_{kind}{name}" for name in contact_titles(case) for kind in prefixes]


def contact_torque(case: Case) -> float:
    """Return the torque at which figures compare contacts: `mesh_stiffness.torque_n_m`, or the largest
    solved if it is None or 0.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    float
        N m on the pinion.
    """
    stiffness_torque: Any = case.values["mesh_stiffness"]["torque_n_m"]
    return float(stiffness_torque or max(case.values["contact"]["torques_n_m"]))
