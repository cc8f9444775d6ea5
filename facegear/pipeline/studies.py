"""Stages that set the cases of a config's studies side by side: which cases, and what they are called."""

from collections.abc import Callable
from typing import Any

from facegear.pipeline import asked
from facegear.pipeline.stage import Case, Wildcards

NOMINAL = ("nominal", "nominal", "as configured")
"""Study, point and label of the machine itself."""
Points = list[tuple[str, str, str]]


def points(case: Case) -> Points:
    """Study, point and label of every point of the studies."""
    from facegear.config.cases import study_points
    from facegear.config.studies import Study

    studies = [Study.of_config(study) for study in case.values["studies"]]
    return [
        (planned.name, name, point.label)
        for planned in studies
        for name, point in study_points(planned).items()
    ]


def every_point(case: Case) -> list[Wildcards]:
    """The case of every point."""
    return [{"case": _id(case, *point[:2])} for point in points(case)]


def nominal_and_every_point(case: Case) -> list[Wildcards]:
    """The machine itself and the case of every point."""
    return [{"case": str(case.values["case"])}, *every_point(case)]


def numbered_points(case: Case) -> list[tuple[str, str, str, str, str, float]]:
    """Study, point, label of the number with its unit, label on the other axis, key and number of every point
    of the studies over numbers.
    """
    from facegear.config.cases import find_numeric_axis
    from facegear.config.studies import Study
    from facegear.report.units import unit_of

    listed = []
    for study in (Study.of_config(study) for study in case.values["studies"]):
        if (axis := find_numeric_axis(study)) is not None:
            unit = next(filter(None, map(unit_of, reversed(axis.key.split(".")))), "")
            label = f"{axis.label} ({unit})" if unit and not axis.label.endswith(")") else axis.label
            listed += [
                (study.name, point, label, other, axis.key, value)
                for point, (value, other) in axis.points.items()
            ]
    return listed


def numbered_cases(case: Case) -> list[Wildcards]:
    """The cases of `numbered_points`."""
    return [{"case": _id(case, *point[:2])} for point in numbered_points(case)]


def over_numbers(case: Case) -> bool:
    """Whether a study changes a number of a machine three times or more."""
    return asked.machine(case) and bool(numbered_points(case))


def force_figures(case: Case) -> list[str]:
    """A figure a study over numbers."""
    return [f"study_{name}_forces" for name in dict.fromkeys(point[0] for point in numbered_points(case))]


def names(case: Case) -> list[str]:
    """Names of the studies."""
    return [str(study["name"]) for study in case.values["studies"]]


def sharing_figures(case: Case) -> list[str]:
    """A figure a study and kind of group."""
    return [f"study_{name}_{kind}" for name in names(case) for kind in kinds_of_groups(case)]


def kinds_of_groups(case: Case) -> list[str]:
    """Kinds of groups that split a load; none without a machine."""
    from facegear.config.sharing_groups import split_kinds

    return split_kinds(case.values) if asked.machine(case) else []


def titles(case: Case) -> list[str]:
    """Title of each study."""
    return [str(study["title"]) for study in case.values["studies"]]


def titles_by_name(case: Case) -> dict[str, str]:
    """Title of each study by its name."""
    return {str(study["name"]): str(study["title"]) for study in case.values["studies"]}


def contact_points(case: Case) -> Points:
    """The machine itself and all points that stand side by side with it.

    Those of a study are its points with a contact of their own, if one of them has another contact than the
    machine.
    """
    return _with_own(case, "contact", asked.contact)


def friction_points(case: Case) -> Points:
    """The machine itself and the points of every study that changes the loss of its meshes."""
    return _with_own(case, "machine_loss", asked.machine_friction)


def _with_own(case: Case, stage: str, has: Callable[[Case], bool]) -> Points:
    """The machine itself and the points with a stage, of studies of which one point has one of its own."""
    if not has(case) or not case.values["studies"]:
        return [NOMINAL]
    chosen: Points = []
    for name in names(case):
        own = [point for point in points(case) if point[0] == name]
        solved = [point for point in own if has(Case(case.cases[_id(case, *point[:2])]))]
        if any(case.source(stage, _id(case, *point[:2])) != case.values["case"] for point in solved):
            chosen += solved
    return [NOMINAL, *chosen]


def contact_cases(case: Case) -> list[Wildcards]:
    """The cases of `contact_points`."""
    return _cases(case, contact_points(case))


def friction_cases(case: Case) -> list[Wildcards]:
    """The cases of `friction_points`."""
    return _cases(case, friction_points(case))


def _cases(case: Case, chosen: Points) -> list[Wildcards]:
    others = ({"case": _id(case, *point[:2])} for point in chosen[1:])
    return [{"case": str(case.values["case"])}, *others]


def law_points(case: Case) -> Points:
    """The machine itself and the points whose mesh law is another one."""
    own = case.values["mesh_stiffness"]["mesh_law"]
    others = [
        point
        for point in points(case)
        if case.cases[_id(case, *point[:2])]["mesh_stiffness"]["mesh_law"] != own
    ]
    return [NOMINAL, *others]


def other_laws(case: Case) -> list[Wildcards]:
    """The cases of `law_points` but for the machine itself."""
    return _cases(case, law_points(case))[1:]


def law_labels(case: Case) -> list[str]:
    """What the laws of `law_points` are called in a figure."""
    own = str(case.values["mesh_stiffness"]["mesh_law"]).replace("_", "-")
    return [own, *(label for _, _, label in law_points(case)[1:])]


def law_figures(case: Case) -> list[str]:
    """Loads in the table, and sweeps with several laws where a study has them."""
    compared = asked.load_dependent(case) and len(law_points(case)) > 1
    return ["law_loads", *(["law_sweeps"] if compared else [])]


def friction_studied(case: Case) -> bool:
    """Whether a study changes the loss of the machine's meshes."""
    return len(friction_points(case)) > 1


def contact_studied(case: Case) -> bool:
    """Whether a study changes the contact."""
    return len(contact_points(case)) > 1


def contact_titles(case: Case) -> dict[str, str]:
    """Name and title of each study that changes the contact."""
    shown = {name for name, _, _ in contact_points(case)}
    return {study["name"]: study["title"] for study in case.values["studies"] if study["name"] in shown}


def contact_figures(case: Case) -> list[str]:
    """Curves and patterns of each study that changes the contact."""
    both = ("study_", "pattern_study_")
    return [f"contact_{kind}{name}" for name in contact_titles(case) for kind in both]


def contact_torque(case: Case) -> float:
    """The torque that the figures show: that of the mesh stiffness, else the largest solved."""
    own: Any = case.values["mesh_stiffness"]["torque_n_m"]
    return float(own or max(case.values["contact"]["torques_n_m"]))


def studied(case: Case) -> bool:
    """Whether there are studies of a machine with several pinions that do the same."""
    return asked.grouped(case) and bool(case.values["studies"])


def _id(case: Case, study: str, point: str) -> str:
    return f"{case.values['case']}/studies/{study}/{point}"
