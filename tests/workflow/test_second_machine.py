"""The second machine of the docs goes through the whole chain."""

import pandas as pd
import pytest
from projects import ROOT, Project

pytestmark = [pytest.mark.workflow, pytest.mark.xdist_group("second_machine")]

COARSER = """
mesh: {resolution: {profile_mm: 2, width_mm: 8, thickness_mm: 5}}
contact: {torques_n_m: [600, 1200], positions_per_pitch: 6, refinement: {depth: 1}}
dynamics: {sweep: {points: 4, directions: [up], chunks: 1}}
load_sharing: {cycles: 50, starts: 2, speed_range: {points: 4}}
"""
HALF = "studies/second_engine/half__120"
READ = (
    "modal/frequencies.csv",
    "load_sharing/forces.csv",
    f"{HALF}/load_sharing/forces.csv",
    f"{HALF}/load_sharing/nominal_summary.csv",
    "contact/ltca.csv",
)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    project = Project(tmp_path_factory.mktemp("second"))
    coarser = project.folder / "coarser.yaml"
    coarser.write_text(COARSER)
    files = [f"results/two_pinion/{name}" for name in READ]
    configs = (str(ROOT / "config" / "two_pinion.yaml"), str(coarser))
    project.run("--configfile", *configs, "--", *files)
    return project.folder / "results" / "two_pinion"


def test_the_engine_that_is_out_turns_free_and_axial_bearings_of_the_pinions(results):
    modes = pd.read_csv(results / "modal" / "frequencies.csv")
    assert (modes["frequency_hz"] == 0).sum() == 2
    axial = modes[modes["symbols"].str.contains("input A")]
    assert axial["frequency_hz"].to_list() == pytest.approx(
        2 * [(5.0e7 / 3.4) ** 0.5 / 6.283185307], rel=1e-6
    )


def test_engine_out_leaves_all_load_to_the_other_but_what_its_pinion_takes_where_it_rattles(results):
    """Rest and irregular rattles coexist, and rounding decides which of them a start comes to.

    A pinion without torque that rattles is out of contact for most of the time, and carries less than a
    twentieth of the load meanwhile: 0.6 and 2 % were met.
    """
    engine_a, engine_b = pd.read_csv(results / "load_sharing" / "forces.csv")["mean_n"]
    assert engine_b < 0.05 * engine_a


def test_torques_of_the_engines_alone_set_the_mean_loads_of_their_meshes(results):
    """Their ratio is a ratio of torques, so no load-sharing coefficient is printed."""
    forces = pd.read_csv(results / HALF / "load_sharing" / "forces.csv")
    assert forces["mean_n"][0] / forces["mean_n"][1] == pytest.approx(600 / 300, rel=0.05)
    assert pd.read_csv(results / HALF / "load_sharing" / "nominal_summary.csv").empty


def test_contact_is_balanced_and_loaded_pairs_are_two_or_three(results):
    ltca = pd.read_csv(results / "contact" / "ltca.csv")
    assert ltca["kkt_residual"].max() < 1e-12
    assert ltca["torque_residual"].max() < 1e-10
    assert set(ltca["pairs_in_contact"]) <= {1, 2, 3}


def test_report_of_the_machine_is_planned_with_the_figures_of_all_its_stages(tmp_path):
    planned = Project(tmp_path).planned("--configfile", str(ROOT / "config" / "two_pinion.yaml"))
    chapters = {"teeth", "contact", "mesh_stiffness", "modes", "dynamics", "load_sharing"}
    assert {"report", *(f"{chapter}_figures" for chapter in chapters)} <= planned
