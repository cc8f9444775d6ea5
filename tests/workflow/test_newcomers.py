"""Machines and mistakes of people who run facegear for the first time."""

import os
import signal
import subprocess
import sys
import time

import pandas as pd
import psutil
import pytest
from projects import ROOT, Project, copy_sources, environment, rules_in

pytestmark = [pytest.mark.workflow, pytest.mark.xdist_group("newcomers")]

PLAINEST = """
case: plain
tooth_pair: {pinion_teeth: 23, face_gear_teeth: 143, module_mm: 3.75, pressure_angle_deg: 25}
mesh_stiffness: {source: harmonics, table: [{order: 0, cos_n_per_m: 4.1e8}, {order: 1, sin_n_per_m: 2.0e7}]}
transmission:
  pinions: [{name: input, role: input, angle_deg: 0}]
  face_gears: [upper]
  pinion: {mass_kg: 1.2, inertia_kg_m2: 0.002, bearing_stiffness_n_per_m: {x: 6.5e7, y: 6.5e7, z: 0}}
  face_gear:
    mass_kg: 7.8
    inertia_kg_m2: 0.54
    bearing_stiffness_n_per_m: {x: 8.7e9, y: 8.7e9, z: 8.7e9}
  damping: {mesh_n_s_per_m: 1200, mass_per_s: 800, bearing_s: 2.0e-6}
  backlash_um: 100
  transmission_error: {amplitude_um: 5}
  torque: {per_input_n_m: 600, tail_share: 0}
dynamics:
  accuracy: {tolerance: 1.0e-6, dwell_periods: 32, settle_periods: 16, window_periods: 16, extensions: 0}
  sweep: {points: 4, from_rpm: 3000, directions: [up], chunks: 1}
load_sharing: {cycles: 20, starts: 2, samples_per_cycle: 32, speed_range: {from_rpm: 3000, points: 2}}
"""


def test_the_plainest_machine_runs_to_its_report(tmp_path):
    """One input pinion on one face gear ended in `No objects to concatenate`, after all the contact work.

    A stage, its figures and the report are jobs of plain Python here, as those of a user are.
    """
    config = tmp_path / "plain.yaml"
    config.write_text(PLAINEST)
    asked = ("--configfile", str(config))
    Project(tmp_path).run(*asked, "--omit-from", "modal", "report")
    Project(tmp_path).run(*asked)
    results = tmp_path / "results" / "plain"
    page = (results / "report.html").read_text()
    assert "1 pinion of 23 teeth and 1 face gear" in page and "<img src='data:image" in page
    assert pd.read_csv(results / "dynamics" / "response.csv")["deflection_um"].notna().all()


def test_teeth_alone_plan_geometry_contact_stiffness_and_a_report(tmp_path):
    config = str(ROOT / "config" / "teeth_only.yaml")
    planned = Project(tmp_path).planned("--configfile", config)
    assert {"geometry", "contact", "stiffness", "report"} <= planned
    assert not {"modal", "dynamics_response", "load_sharing", "contact_studies"} & planned
    asked = ("-n", "--configfile", config, "--", "results/teeth_only/modal/frequencies.csv")
    done = Project(tmp_path).run(*asked, check=False)
    assert done.returncode == 1
    message = done.stderr.splitlines()[-1]
    assert message.startswith("teeth_only: transmission = None: must be given for modes, dynamics")


def test_a_target_without_its_section_in_the_config_ends_in_one_line(tmp_path):
    """It ended in a TypeError."""
    for target, section in (
        ("branches/branches.csv", "branches"),
        ("tolerances/fractions.csv", "tolerances"),
    ):
        asked = ("-n", "--configfile", str(ROOT / "config" / "harmonics_only.yaml"), "--")
        done = Project(tmp_path).run(*asked, f"results/harmonics_only/{target}", check=False)
        assert done.returncode == 1 and "Traceback" not in done.stderr
        message = done.stderr.splitlines()[-1]
        assert message.startswith(f"harmonics_only: {section} = None: must be given, as rule {section}")


def test_misalignments_of_a_machine_without_load_sharing_are_studied(tmp_path):
    """A study of one pinion's contact was accepted and left out without a word."""
    planned = Project(tmp_path).planned(
        "--configfile", str(ROOT / "examples" / "machines" / "misaligned.yaml")
    )
    assert "contact_studies" in planned


def interrupted(command, begun):
    """Return the output of a run that gets Ctrl-C as soon as the file `begun` is there."""
    process = subprocess.Popen(
        command, env=environment(), stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    while not begun.exists() and process.poll() is None:
        time.sleep(0.02)
    assert process.poll() is None, process.communicate()[1]
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does
    message = process.communicate(timeout=60)[1]
    assert process.returncode == 1, message
    return message.splitlines()


def test_an_interrupted_run_ends_its_jobs_and_says_so_in_one_line(tmp_path):
    """It ended in some 500 lines of tracebacks, the jobs' own among them."""
    config = str(ROOT / "config" / "harmonics_only.yaml")
    target = "results/harmonics_only/dynamics/sweep.csv"
    log = tmp_path / "results" / "harmonics_only" / "logs" / "stiffness.log"
    message = interrupted(Project(tmp_path).command("--configfile", config, "--", target), log)
    assert message[-1] == "the run has ended early; the same command goes on from here"
    assert len(message) <= 5, message
    assert not [one for one in psutil.process_iter() if str(tmp_path) in " ".join(one.cmdline())]
    assert not list((tmp_path / "results").rglob(".[0-9]*"))


def test_a_moved_checkout_has_nothing_to_do(tmp_path):
    here, there = copy_sources(tmp_path / "here"), tmp_path / "there"
    asked = ("--", "results/harmonics_only/modal/frequencies.csv")
    Project(here, here).run("--configfile", str(here / "config" / "harmonics_only.yaml"), *asked)
    here.rename(there)
    moved = Project(there, there)
    done = moved.run("-n", "--configfile", str(there / "config" / "harmonics_only.yaml"), *asked)
    assert "Nothing to be done" in done.stdout + done.stderr


def test_run_hands_a_config_and_its_targets_over_to_snakemake(tmp_path):
    """A target after `--configfile` was taken for another config."""
    config = str(ROOT / "config" / "harmonics_only.yaml")
    target = "results/harmonics_only/modal/frequencies.csv"
    done = subprocess.run(
        [sys.executable, "-m", "facegear", "run", config, target, "-n", "--directory", str(tmp_path)],
        cwd=ROOT,
        env=environment(),
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert rules_in(done.stdout + done.stderr) == {"modal"}
    assert not (tmp_path / "results").exists()
