"""Tables and view of each stage that the report of a case reads."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from facegear.arrays import Arrays
from facegear.pipeline.stage import Case
from facegear.pipeline.table import STAGES

if TYPE_CHECKING:
    import pandas as pd

REPORT_TABLES = {
    "stiffness": ["harmonics"],
    "ratings": ["ratings", "bodies", "meshes"],
    "modal": ["frequencies", "contacts"],
    "dynamics_sweep": ["jumps", "sweep"],
    "dynamics_response": ["bearings"],
    "load_sharing": ["forces"],
    "load_sharing_summary": ["summary"],
    "hunting": ["groups"],
    "sharing_map": ["curves", "inputs", "points", "advice", "reasons"],
    "following": ["groups"],
    "contact": ["ltca", "by_torque"],
    "root_stress": ["summary"],
    "contact_studies": ["table"],
    "tolerances": ["percentiles", "fractions", "sampling"],
    "lubrication": ["by_torque", "limits"],
    "machine_loss": ["machine", "meshes", "bodies"],
    "friction_studies": ["table"],
    "rating": ["safety", "rating"],
    "dynamic_root_stress": ["dynamic_stress"],
    "stress_over_speed": ["stress_over_speed"],
    "operating_pose": ["meshes", "loads", "leaving", "check"],
    "posed_stress": ["by_mesh"],
    "shafts": ["seats", "bearings", "torsion"],
}
"""Tables of each stage that the report reads."""
OWN_NAMES = ("shafts", "poses")
"""Folders with tables that have the same names as others of the machine."""


def table_name(path: str | Path) -> str:
    """Return the report's name of a table: the name of its file, behind that of a folder of OWN_NAMES.

    Parameters
    ----------
    path : str or Path
        Path of the file.

    Returns
    -------
    str
        The name.
    """
    path = Path(path)
    return f"{path.parent.name}_{path.stem}" if path.parent.name in OWN_NAMES else path.stem


def reported_tables(case: Case) -> list[tuple[str, str]]:
    """Return stage and file of every table that the report of a case reads.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    list[tuple[str, str]]
        Stage and file of each table.
    """
    return [(name, file) for name, files in REPORT_TABLES.items() for file in files if asked_for(name, case)]


def asked_for(stage: str, case: Case) -> bool:
    """Whether a plain run of a case makes a stage.

    Parameters
    ----------
    stage : str
        Name of the stage.
    case : Case
        The case.

    Returns
    -------
    bool
        True if so.
    """
    is_made = STAGES[stage].condition
    return is_made is not None and is_made(case)


def shown_pair(
    values: Mapping[str, Any],
    ltca: "pd.DataFrame",
    loads: Arrays,
    stress: Arrays | None,
    friction: Arrays | None,
) -> Any:
    """Return the pair in mesh as the report shows it.

    Parameters
    ----------
    values : Mapping[str, Any]
        Plain values of the case.
    ltca : 'pd.DataFrame'
        Table `ltca` of stage contact.
    loads : Arrays
        Arrays `loads` of stage contact.
    stress : Arrays or None
        Arrays of stage root_stress, None if there are none.
    friction : Arrays or None
        Arrays `local` of stage lubrication, None if there are none.

    Returns
    -------
    Any
        View (`facegear.report.page.View`).
    """
    from facegear.config.tooth_pair import ToothPair, pair_design
    from facegear.report.pair_view import pair_view

    design = pair_design(ToothPair.of_config(values["tooth_pair"]))
    return pair_view(design, loads, ltca, stress, friction)
