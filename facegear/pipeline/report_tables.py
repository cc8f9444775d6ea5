"""Tables that the report of a case reads, and how long they take to compute.

Estimates of the processor time of a report, before any of its stages runs. They are rough: within a factor of
three on one core of a processor of 2020 (docs/reference/speed.md). Stages that take a second or less are left
out.
"""

from collections.abc import Callable, Mapping, Sequence
from math import ceil
from pathlib import Path
from typing import TYPE_CHECKING, Any

from facegear.arrays import Arrays
from facegear.build.tooth_pair import ToothPair, contact_setup, pair_design
from facegear.number_format import count_noun
from facegear.pipeline.arguments import typed_arguments
from facegear.pipeline.conditions import CONTACT
from facegear.pipeline.needs import stages_before
from facegear.pipeline.stage import Case, Stage
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
    "root_stress": ["summary", "by_flank"],
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
    "bearing_life": ["loads", "stiffness", "life"],
    "casing": ["modes"],
    "casing_loads": ["seats", "feet", "sharing", "modes"],
    "casing_response": ["sensors"],
}
"""Tables of each stage that the report reads."""
OWN_NAMES = ("shafts", "poses", "bearings", "casing")
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
        Name of the stage and name of the file in its row, for each table of a stage that a plain run
        makes.
    """
    return [(name, file) for name, files in REPORT_TABLES.items() for file in files if asked_for(name, case)]


def asked_for(stage: str, case: Case) -> bool:
    """Whether a plain run of a case makes a stage, by the condition of its row; a stage without one is
    not.

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
    """Build the interactive view of the pair in mesh, with loads, stress and friction on its flanks.

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
    from facegear.report.viewers import pair_view  # the viewers need the template engine, an extra

    design = pair_design(ToothPair.of_config(values["tooth_pair"]))
    return pair_view(design, loads, ltca, stress, friction)


START = 5.0
"""Seconds for imports and the page itself."""
FIGURE = 0.7
"""Seconds a figure, drawn as svg and interactive."""
COMPLIANCE = 25.0
"""Seconds for both bodies by GB of their estimated memory (docs/reference/speed.md: 15 s at 0.55 GB)."""
POSITION = 2.5e-3
"""Seconds a position and torque of the contact analysis (docs/reference/speed.md)."""
SPEED = 2e-3
"""Seconds a speed and mesh of a sweep, in each direction: 14 s for 800 speeds of 10 meshes."""
MOTION = 1.0
"""Seconds a steady state with its averages, of load sharing and of each case of a study."""
SHARED_SPEED = 0.2
"""Seconds a speed of the range over which load sharing is drawn."""
BRANCHES = 300.0
"""Seconds to follow the branches of a machine."""
SAMPLE, DESIGN = 5e-3, 0.6
"""Seconds a dynamic sample, and a design of a search over teeth (docs/reference/speed.md)."""

Values = Mapping[str, Any]


def outlook_in_words(case: Case, stages: Sequence[Stage]) -> str:
    """Number of stages of a case and about how long they will take, as text.

    Parameters
    ----------
    case : Case
        The case among those of its config.
    stages : sequence of Stage
        Stages that are shown; those that they need are counted as well.

    Returns
    -------
    str
        Such as ``12 stages, about 2 min of processor time``.
    """
    seconds = estimated_seconds(case, stages)
    about = f"{ceil(seconds / 10.0) * 10:d} s" if seconds < 90.0 else f"{ceil(seconds / 60.0):d} min"
    return (
        f"{count_noun(len(stages), 'stage')}, about {about} of processor time; a minute more the first time, "
        "less where results are stored"
    )


def estimated_seconds(case: Case, stages: Sequence[Stage]) -> float:
    """Estimate the time that stages, those before them, their figures and the page take on one core, by
    rules of thumb.

    Parameters
    ----------
    case : Case
        The case among those of its config.
    stages : sequence of Stage
        Stages that are shown.

    Returns
    -------
    float
        Processor time, s, without compilation.
    """
    before = {name for stage in stages for name in stages_before(stage.name, case.values)}
    figures = sum(len(stage.figures.figure_names(case)) for stage in stages if stage.figures)
    return START + FIGURE * figures + sum(ESTIMATES[name](case) for name in before & set(ESTIMATES))


def _compliance(case: Case) -> float:
    """Estimate the seconds for the compliance of both bodies, in proportion to the memory that it
    needs.
    """
    setup = contact_setup(**typed_arguments(contact_setup, {key: case.values[key] for key in CONTACT}))
    return 1e-9 * COMPLIANCE * setup.memory


def _contact(case: Case) -> float:
    """Estimate the seconds for the contact analysis: positions times torques, twice as long with root
    stress.
    """
    contact = case.values["contact"]
    gauges = 2.0 if contact["root_stress"] else 1.0
    return gauges * POSITION * contact["positions_per_pitch"] * len(contact["torques_n_m"])


def _sweep(case: Case) -> float:
    """Estimate the seconds for the sweep: speeds times directions times meshes."""
    sweep, machine = case.values["dynamics"]["sweep"], case.values["transmission"]
    meshes = len(machine["pinions"]) * len(machine["face_gears"])
    return SPEED * sweep["points"] * len(sweep["directions"]) * meshes


def _sharing(case: Case) -> float:
    """Estimate the seconds for load sharing of all cases of the config and over its range of speeds."""
    speeds = case.values["load_sharing"]["speed_range"]
    return MOTION * len(case.cases) + SHARED_SPEED * speeds["points"]


def _samples(case: Case) -> float:
    """Estimate the seconds for the random samples of tolerances, in proportion to their number."""
    return SAMPLE * float(case.values["tolerances"]["samples"])


def _search(case: Case) -> float:
    """Estimate the seconds for the search: generations times population times seeds."""
    section = case.values["search"]
    return DESIGN * section["generations"] * section["population"] * len(section["seeds"])


ESTIMATES: Mapping[str, Callable[[Case], float]] = {
    "compliance": _compliance,
    "contact": _contact,
    "dynamics_sweep_chunk": _sweep,
    "load_sharing": _sharing,
    "branches": lambda case: BRANCHES,
    "tolerances_chunk": _samples,
    "search_island": _search,
}
"""Seconds of the dear stages, by name."""
