"""The summary of all studies holds the rows of each case, and says of how many the motion does not repeat;
over the numbers of a study stand the forces of its meshes."""

import numpy as np
import pandas as pd
from references import against, agrees

from facegear.build.load import load_config
from facegear.build.machine_layout import layout
from facegear.build.tooth_numbers import ToothNumbers
from facegear.io.files import write_part
from facegear.pipeline.stages.sharing import load_sharing_summary, study_forces
from facegear.pipeline.table import STAGES
from facegear.report.figures.sharing import study_forces_figures
from facegear.schema.base import parse
from facegear.schema.transmission import Transmission
from facegear.sharing.tables import force_table

POINTS = [("backlash", "0", "80 um"), ("backlash", "1", "120 um"), ("bearing", "0", "soft")]


@against(
    "manufactured",
    "tables of four cases",
    capability="load_sharing_summary",
    module="facegear.sharing.tables",
)
def test_each_case_stands_in_the_summary_with_its_own_numbers_and_in_its_own_study():
    means = [1.1, 1.2, 1.3, 1.4]
    summaries = [
        pd.DataFrame({"group": ["inputs", "idlers"], "mean": [mean, 1.0], "periodic": mean != 1.3})
        for mean in means
    ]
    curves = [pd.DataFrame({"cycle": [0.0, 0.5], "coefficient": 2 * [mean]}) for mean in means[1:]]
    outcome = load_sharing_summary(POINTS, summaries, curves)
    summary = outcome.content["summary"].set_index(["study", "label", "group"])["mean"]
    cases = [("nominal", "nominal"), *((study, label) for study, _, label in POINTS)]
    agrees("mean coefficient", [summary[(*case, "inputs")] for case in cases], means)
    backlash, bearing = outcome.content["studies"]
    agrees("coefficient over a cycle, first study", backlash["coefficient"], [1.2, 1.2, 1.3, 1.3])
    agrees("coefficient over a cycle, second study", bearing["coefficient"], [1.4, 1.4])
    assert outcome.summary == "4 cases, 1 of them not periodic"


PATHS = ("right input/lower", "right input/upper", "idler/lower", "tail/lower", "idler/upper", "tail/upper")
MEAN = (3000.0, 1000.0, 2000.0, 500.0, 700.0, 600.0)


@against(
    "manufactured",
    "forces of two cases",
    capability="load_sharing",
    module="facegear.sharing.tables",
)
def test_each_path_has_its_mean_part_of_what_its_group_carries_and_its_largest_force_beside_the_number():
    positions = [("right input", "input", 0.0), ("idler", "idler", 90.0), ("tail", "tail", 200.0)]
    plain = load_config("config/harmonics_only.yaml").model_dump(mode="json")["transmission"]
    pinions = [{"name": name, "role": role, "angle_deg": angle} for name, role, angle in positions]
    section = parse(Transmission, {**plain, "pinions": pinions, "single_pinions": {}, "single_meshes": {}})
    points = [("web", f"{n}", "web (mm)", "", "key", n) for n in (8.0, 10.0)]
    teeth = ToothNumbers.of_config(
        {"pinion_teeth": 23, "face_gear_teeth": 143, "module_mm": 3.75, "pressure_angle_deg": 25}
    )
    machine = layout(section, teeth)
    mean = np.array([dict(zip(PATHS, MEAN, strict=True))[path] for path in machine.mesh_names])
    tables = [force_table(machine, mean, scale * mean, "period-1") for scale in (2.0, 1.5)]
    forces = study_forces(points, tables).content["forces"]
    by_mesh = forces.set_index(["number", "mesh"])
    expected = {"right input/lower": 0.75, "right input/upper": 0.25, "idler/lower": 0.8, "tail/lower": 0.2}
    for number, scale in ((8.0, 2.0), (10.0, 1.5)):
        rows = by_mesh.loc[number]
        agrees(
            "part of the group's load", [rows["fraction"][path] for path in expected], list(expected.values())
        )
        agrees("largest force", [rows["largest_n"][path] for path in PATHS], [scale * mean for mean in MEAN])
        assert rows["fraction"][["idler/upper", "tail/upper"]].isna().all()


@against(
    "manufactured",
    "forces of two cases",
    capability="study_forces",
    module="facegear.pipeline.stages.sharing",
)
def test_the_forces_of_every_case_stand_beside_the_number_that_is_its_own():
    cases = [("web", name, "web (mm)", "", "key", value) for name, value in (("a", 8.0), ("b", 10.0))]
    tables = [pd.DataFrame({"mesh": ["m", "n"], "largest_n": [force, 2.0 * force]}) for force in (5.0, 7.0)]
    outcome = study_forces(cases, tables)
    forces = outcome.content["forces"].set_index(["number", "mesh"])["largest_n"]
    agrees(
        "largest force of a case",
        [forces[8.0, "m"], forces[8.0, "n"], forces[10.0, "m"], forces[10.0, "n"]],
        [5.0, 10.0, 7.0, 14.0],
    )
    assert outcome.summary == "largest force 14 N, on n at web (mm) = 10"


def points(curve):
    """Return the points of a curve."""
    return list(zip(curve.x, curve.y, strict=True))


def test_the_stored_forces_of_a_study_are_drawn_over_its_numbers(tmp_path):
    table = pd.DataFrame(
        {
            "study": "web",
            "point": "x",
            "axis": "web (mm)",
            "beside": "",
            "key": "web",
            "number": [12.0, 12.0, 8.0, 8.0],
            "mesh": ["a/lower", "b/lower", "a/lower", "b/lower"],
            "group": ["", "idlers", "", "idlers"],
            "fraction": [np.nan, 0.4, np.nan, 0.5],
            "mean_n": 1e3,
            "largest_n": [2e3, 3e3, 4e3, 5e3],
            "motion": ["period-1"] * 3 + ["chaotic"],
        }
    )
    write_part(str(tmp_path / "forces.csv"), table)
    stored = STAGES["study_forces"].files["forces"].read(tmp_path / "forces.csv")
    (figure,) = study_forces_figures(stored, {"web": "Web"})
    split, largest = ({mark.name: mark for mark in panel.marks if not mark.hollow} for panel in figure.panels)
    assert points(split["b/lower"]) == [(8.0, 50.0), (12.0, 40.0)]
    assert "a/lower" not in split
    assert points(largest["a/lower"]) == [(8.0, 4.0), (12.0, 2.0)]
    (hollow,) = [mark for mark in figure.panels[1].marks if mark.hollow]
    assert points(hollow) == [(8.0, 5.0)]
    assert figure.panels[1].x.label == "web (mm)"
    (stiff,) = study_forces_figures(
        stored.assign(axis="bearings (N/m)", number=1e6 * stored["number"]), {"web": "Web"}
    )
    assert stiff.panels[1].x.label == "bearings (N/µm)", "7,000,000,000 N/m stood below the axis"
    assert points(stiff.panels[0].marks[0]) == [(8.0, 50.0), (12.0, 40.0)]


def test_a_machine_without_studies_is_one_case():
    """Its line said: 1 cases."""
    frame = pd.DataFrame({"group": ["idlers"], "kind": "idlers", "periodic": [True]})
    assert load_sharing_summary([], [frame], []).summary == "1 case, all periodic"
