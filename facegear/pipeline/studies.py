"""Cases of a config's studies that stages set side by side, and their names."""

from collections.abc import Callable
from typing import Any

from facegear.pipeline import asked
from facegear.pipeline.stage import Case, Wildcards

NOMINAL = ("nominal", "nominal", "as configured")
"""Study, point and label of the machine itself."""
Points = list[tuple[str, str, str]]


def points(case: Case) -> Points:
    """Return study, point and label of every point of the studies.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    Points
        The points, study by study.
    """
    from facegear.config.cases import study_points
    from facegear.config.studies import Study

    studies = [Study.of_config(study) for study in case.values["studies"]]
    return [
        (study.name, name, point.label) for study in studies for name, point in study_points(study).items()
    ]


def every_point(case: Case) -> list[Wildcards]:
    """Return the case of every point.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[Wildcards]
        `case` of each point.
    """
    return [{"case": _id(case, *point[:2])} for point in points(case)]


def nominal_and_every_point(case: Case) -> list[Wildcards]:
    """Return the machine itself and the case of every point.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[Wildcards]
        `case` of each.
    """
    return [{"case": str(case.values["case"])}, *every_point(case)]


def numbered_points(case: Case) -> list[tuple[str, str, str, str, str, float]]:
    """Return the points of the studies over numbers.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[tuple[str, str, str, str, str, float]]
        Study, point, label of the number with its unit, label on the other axis, key and number of each
        point; the number has the unit of its key.
    """
    from facegear.config.cases import find_numeric_axis
    from facegear.config.studies import Study
    from facegear.report.units import unit_of

    rows = []
    for study in (Study.of_config(study) for study in case.values["studies"]):
        if (axis := find_numeric_axis(study)) is not None:
            unit = next(filter(None, map(unit_of, reversed(axis.key.split(".")))), "")
            label = f"{axis.label} ({unit})" if unit and not axis.label.endswith(")") else axis.label
            rows += [
                (study.name, point, label, other_label, axis.key, value)
                for point, (value, other_label) in axis.points.items()
            ]
    return rows


def numbered_cases(case: Case) -> list[Wildcards]:
    """Return the cases of `numbered_points`.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[Wildcards]
        `case` of each.
    """
    return [{"case": _id(case, *point[:2])} for point in numbered_points(case)]


def over_numbers(case: Case) -> bool:
    """Whether a study changes a number of a machine three times or more.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return asked.machine(case) and bool(numbered_points(case))


def force_figures(case: Case) -> list[str]:
    """Return the names of the figures of forces, one for each study over numbers.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[str]
        The names.
    """
    return [f"study_{name}_forces" for name in dict.fromkeys(point[0] for point in numbered_points(case))]


def names(case: Case) -> list[str]:
    """Return the names of the studies.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[str]
        The names.
    """
    return [str(study["name"]) for study in case.values["studies"]]


def sharing_figures(case: Case) -> list[str]:
    """Return the names of the figures of load sharing, one for each study and kind of group.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[str]
        The names.
    """
    return [f"study_{name}_{kind}" for name in names(case) for kind in kinds_of_groups(case)]


def kinds_of_groups(case: Case) -> list[str]:
    """Return the kinds of groups that split a load; none without a machine.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[str]
        The kinds.
    """
    from facegear.config.sharing_groups import split_kinds

    return split_kinds(case.values) if asked.machine(case) else []


def titles(case: Case) -> list[str]:
    """Return the title of each study.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[str]
        The titles.
    """
    return [str(study["title"]) for study in case.values["studies"]]


def titles_by_name(case: Case) -> dict[str, str]:
    """Return the title of each study by its name.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    dict[str, str]
        Title by name.
    """
    return {str(study["name"]): str(study["title"]) for study in case.values["studies"]}


def contact_points(case: Case) -> Points:
    """Return the machine itself and all points that are compared with it by their contact.

    Of a study these are its points with a contact of their own, if one of them has another contact than the
    machine.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    Points
        Study, point and label of each, NOMINAL first.
    """
    return _with_own(case, "contact", asked.contact)


def friction_points(case: Case) -> Points:
    """Return the machine itself and the points of every study that changes the loss of its meshes.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    Points
        Study, point and label of each, NOMINAL first.
    """
    return _with_own(case, "machine_loss", asked.machine_friction)


def _with_own(case: Case, stage: str, has: Callable[[Case], bool]) -> Points:
    """Machine itself and the points with a stage, of studies with at least one point that shares no files of
    it.
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
    """Return the cases of `contact_points`.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[Wildcards]
        `case` of each.
    """
    return _cases(case, contact_points(case))


def friction_cases(case: Case) -> list[Wildcards]:
    """Return the cases of `friction_points`.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[Wildcards]
        `case` of each.
    """
    return _cases(case, friction_points(case))


def _cases(case: Case, selection: Points) -> list[Wildcards]:
    point_cases = ({"case": _id(case, *point[:2])} for point in selection[1:])
    return [{"case": str(case.values["case"])}, *point_cases]


def law_points(case: Case) -> Points:
    """Return the machine itself and the points with another mesh law.

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
    """Return the cases of `law_points` without the machine itself.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[Wildcards]
        `case` of each.
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
        A label for each point.
    """
    machine_label = str(case.values["mesh_stiffness"]["mesh_law"]).replace("_", "-")
    return [machine_label, *(label for _, _, label in law_points(case)[1:])]


def law_figures(case: Case) -> list[str]:
    """Return the names of the figures of the mesh law: loads in the table, and sweeps where a study has
    several laws.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[str]
        `law_loads`, and `law_sweeps` where there are laws to compare.
    """
    has_comparison = asked.load_dependent(case) and len(law_points(case)) > 1
    return ["law_loads", *(["law_sweeps"] if has_comparison else [])]


def friction_studied(case: Case) -> bool:
    """Whether a study changes the loss of the machine's meshes.

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
    """Whether a study changes the contact.

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
        Title by name.
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
        The names.
    """
    prefixes = ("study_", "pattern_study_")
    return [f"contact_{kind}{name}" for name in contact_titles(case) for kind in prefixes]


def contact_torque(case: Case) -> float:
    """Return the torque that the figures show: that of the mesh stiffness, else the largest one solved.

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


def has_studies(case: Case) -> bool:
    """Whether there are studies of a machine with several pinions that have the same function.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return asked.has_groups_of_pinions(case) and bool(case.values["studies"])


def _id(case: Case, study: str, point: str) -> str:
    return f"{case.values['case']}/studies/{study}/{point}"
