"""What of each stage the report of a case reads."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from facegear.arrays import Arrays
from facegear.pipeline.stage import Case
from facegear.pipeline.table import STAGES

if TYPE_CHECKING:
    import pandas as pd

REPORTED = {
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
"""Folders with tables that are called like others of the machine."""


def table_name(path: str | Path) -> str:
    """What the report calls a table: its file's name, behind that of a folder of OWN_NAMES."""
    path = Path(path)
    return f"{path.parent.name}_{path.stem}" if path.parent.name in OWN_NAMES else path.stem


def reported_tables(case: Case) -> list[tuple[str, str]]:
    """Stage and file of every table that the report of a case reads."""
    return [(name, file) for name, files in REPORTED.items() for file in files if asked_for(name, case)]


def asked_for(stage: str, case: Case) -> bool:
    """Whether a plain run of a case makes a stage."""
    wanted = STAGES[stage].asked
    return wanted is not None and wanted(case)


def shown_pair(
    values: Mapping[str, Any],
    ltca: "pd.DataFrame",
    loads: Arrays,
    stress: Arrays | None,
    friction: Arrays | None,
) -> Any:
    """The pair in mesh as the report shows it (`facegear.report.page.View`), from what the contact gave."""
    from facegear.config.tooth_pair import ToothPair, pair_design
    from facegear.report.pair_view import pair_view

    design = pair_design(ToothPair.of_config(values["tooth_pair"]))
    return pair_view(design, loads, ltca, stress, friction)
