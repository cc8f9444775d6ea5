"""Cases of a config's studies that stages set side by side, and their names."""

from facegear.build.cases import find_numeric_axis, study_points
from facegear.build.machine_layout import split_kinds
from facegear.pipeline import conditions, machine_conditions
from facegear.pipeline.stage import Case, Wildcards
from facegear.report.table import unit_of
from facegear.schema.studies import Study

NOMINAL = ("nominal", "nominal", "as configured")
"""Study, point and label of the machine itself."""
Points = list[tuple[str, str, str]]


def points(case: Case) -> Points:
    """Return every point of the studies of the config; a point is one changed machine, a case of its
    own.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    Points
        Study, point (both as folder names) and label in words, study by study.
    """
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
        Wildcards `{"case": id}` of each point, in the order of `points`.
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
        Wildcards `{"case": id}`, the case itself first.
    """
    return [{"case": str(case.values["case"])}, *every_point(case)]


def numbered_points(case: Case) -> list[tuple[str, str, str, str, str, float]]:
    """Return the points of studies whose first axis of numbers has three values or more, so that
    results can be drawn over it.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[tuple[str, str, str, str, str, float]]
        For each point: study, point, label of the axis with its unit, label of the point on the other
        axis, config key of the axis, and its number in the unit of that key.
    """
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
    """Return the cases of the study points whose axis is a number.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[Wildcards]
        Wildcards `{"case": id}` of each, in the order of `numbered_points`.
    """
    return [{"case": _id(case, *point[:2])} for point in numbered_points(case)]


def over_numbers(case: Case) -> bool:
    """Whether a study changes a number of a machine three times or more.

    Results are then drawn over that number.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    return conditions.machine(case) and bool(numbered_points(case))


def force_figures(case: Case) -> list[str]:
    """Return the names of the figures of forces, one for each study over numbers.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[str]
        `study_<name>_forces` for each study of `numbered_points`.
    """
    return [f"study_{name}_forces" for name in dict.fromkeys(point[0] for point in numbered_points(case))]


def names(case: Case) -> list[str]:
    """Return the names of the studies of the config.

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
        `study_<name>_<kind>` for each study, and each kind of group that splits a load.
    """
    return [f"study_{name}_{kind}" for name in names(case) for kind in kinds_of_groups(case)]


def kinds_of_groups(case: Case) -> list[str]:
    """Return the kinds of groups of meshes that split a load, `idlers` or `inputs`; none without a
    machine.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[str]
        The kinds.
    """
    return split_kinds(case.values) if conditions.machine(case) else []


def titles(case: Case) -> list[str]:
    """Return the title of each study of the config, in its order.

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
    return machine_conditions.has_groups_of_pinions(case) and bool(case.values["studies"])


def _id(case: Case, study: str, point: str) -> str:
    """Return the id of a study point as a case: `<case>/studies/<study>/<point>`."""
    return f"{case.values['case']}/studies/{study}/{point}"
