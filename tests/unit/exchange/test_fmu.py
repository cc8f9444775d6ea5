"""An exported machine moves in another program as it does here."""

import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu
from hypothesis import example, given
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine
from recorded_motion import record

import facegear
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.mesh_samples import by_mesh, each_deflection
from facegear.dynamics.steady_state.simulate import build_model, static_start
from facegear.errors import FacegearError
from facegear.exchange.fmu import IDENTIFIER, unique_words, write_fmu
from facegear.transmission.flanks import mesh_contacts
from facegear.transmission.machine import OpenFlanks
from facegear.transmission.statics import static_bearing_forces
from facegear.transmission.teeth import GEOMETRIC

CONFIG = Path(__file__).parents[3] / "config" / "harmonics_only.yaml"
COMPILER = shutil.which("cc")
needs_compiler = pytest.mark.skipif(COMPILER is None, reason="an FMU of C sources needs a C compiler")
SPEED, PERIODS, SAMPLES = 7500.0, 3, 16
PERIOD = 60.0 / (23 * SPEED)


def machine(kind):
    if kind == "printed":
        return make_machine()
    built = make_machine(make_layout(kinematics=GEOMETRIC))
    return replace(built, damping=replace(built.damping, open_flanks=OpenFlanks(kind)))


def compiled(folder, exported):
    """An unpacked FMU with its binary for this computer, and the archive itself."""
    path = write_fmu(folder / "machine.fmu", exported, SPEED)
    with ZipFile(path) as archive:
        archive.extractall(folder / "fmu")
    binaries = folder / "fmu" / "binaries" / "x86_64-linux"
    binaries.mkdir(parents=True)
    strict = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-Wno-unused-parameter")
    out = ("-O2", "-shared", "-fPIC", "-o", str(binaries / f"{IDENTIFIER}.so"))
    subprocess.run([COMPILER, *strict, *out, str(folder / "fmu" / "sources" / "fmu.c"), "-lm"], check=True)
    return folder / "fmu"


def run_elsewhere(folder, torque_factor=1.0):
    """Results of fmpy over PERIODS mesh periods."""
    variables = read_model_description(str(folder)).modelVariables
    torques = {one.name: float(one.start) for one in variables if one.name.startswith("torque_")}
    starts = {name: torque_factor * torque for name, torque in torques.items()}
    return simulate_fmu(
        str(folder),
        start_values=starts,
        stop_time=PERIODS * PERIOD,
        step_size=PERIOD / SAMPLES,
        output_interval=PERIOD / SAMPLES,
    )


def own_deflections(moved, begun, times):
    """Deflections (K, contacts) of a machine that begins at the rest of another, by our own integrator."""
    model = build_model(moved)
    omega = 2.0 * np.pi / PERIOD
    run = record(model.system, omega, static_start(build_model(begun)), PERIODS, Settings(tolerance=1e-12))
    phases = np.minimum(times * omega, run.starts[-1] + run.lengths[-1])
    errors = [error(phases / (2.0 * np.pi)) for error in mesh_contacts(moved).error]
    return run.at(phases)[0] @ model.system.mesh_jacobian.T - np.array(errors).T


def outputs(results, kind):
    return np.array([results[name] for name in results.dtype.names if name.startswith(f"{kind}_")]).T


@needs_compiler
@pytest.mark.parametrize("kind", ["printed", "contact_only", "push_only"])
def test_deflections_in_fmpy_are_those_of_our_own_integrator(tmp_path, kind):
    exported = machine(kind)
    results = run_elsewhere(compiled(tmp_path, exported))
    found, expected = outputs(results, "deflection"), own_deflections(exported, exported, results["time"])
    assert len(found) == PERIODS * SAMPLES + 1
    assert (np.diff(np.sign(expected), axis=0) != 0).any(), "some flank parts or meets"
    assert np.abs(found - expected).max() < 1e-8 * np.abs(expected).max()


@needs_compiler
def test_torques_and_bearing_forces_are_those_of_the_machine(tmp_path):
    exported = machine("printed")
    folder = compiled(tmp_path, exported)
    results = run_elsewhere(folder, 1.5)
    expected = own_deflections(replace(exported, torques=1.5 * exported.torques), exported, results["time"])
    assert np.abs(outputs(results, "deflection") - expected).max() < 1e-8 * np.abs(expected).max()
    at_rest = static_bearing_forces(exported).ravel()
    np.testing.assert_allclose(outputs(results, "bearing")[0], at_rest, atol=1e-8 * np.abs(at_rest).max())


def test_the_description_is_valid_and_names_units_and_starts(tmp_path):
    path = str(write_fmu(tmp_path / "machine.fmu", machine("printed"), SPEED))
    assert validate_fmu(path) == []
    variables = {one.name: one for one in read_model_description(path).modelVariables}
    assert (variables["speed"].unit, float(variables["speed"].start)) == ("rpm", SPEED)
    assert variables["force_right_input_upper"].unit == "N"
    assert sum(name.startswith("torque_") for name in variables) == 7


def test_the_same_machine_gives_the_same_bytes(tmp_path):
    first, second = (write_fmu(tmp_path / name, machine("printed"), SPEED) for name in ("a.fmu", "b.fmu"))
    assert first.read_bytes() == second.read_bytes()


def test_what_an_fmu_cannot_hold_is_refused_by_name_and_nothing_written(tmp_path):
    teeth = {"transmission.mesh_kinematics": "geometric", "transmission.face_gear.mesh_radius_mm": None}
    clearance = {"transmission.pinion.clearance_um": 20}
    gearbox = facegear.load(CONFIG, None).with_values({**teeth, **clearance})
    with pytest.raises(FacegearError, match="an FMU cannot hold bearing clearance"):
        gearbox.export(tmp_path / "machine.fmu")
    assert not list(tmp_path.iterdir())


def test_the_door_exports_by_the_ending(tmp_path):
    gearbox = facegear.load(CONFIG, None)
    assert validate_fmu(str(gearbox.export(tmp_path / "machine.fmu"))) == []


def renamed(machine, names):
    """The machine with its first pinions under other names."""
    layout = machine.layout
    pinions = [replace(pinion, name=name) for pinion, name in zip(layout.pinions, names, strict=False)]
    return replace(machine, layout=replace(layout, pinions=(*pinions, *layout.pinions[len(names) :])))


def test_bodies_that_differ_in_punctuation_alone_make_a_valid_fmu(tmp_path):
    exported = renamed(machine("contact_only"), ["one side", "one-side", "one.side"])
    path = str(write_fmu(tmp_path / "machine.fmu", exported, SPEED))
    assert validate_fmu(path) == []
    names = {one.name for one in read_model_description(path).modelVariables}
    assert {"torque_one_side", "torque_one_side_2", "torque_one_side_3"} <= names


@given(st.lists(st.text("ab_2 .-", max_size=6), max_size=12))
@example(["a-b", "a b", "a_b_2", "a.b"])
def test_words_made_of_any_names_are_unique_and_keep_their_order(names):
    words = unique_words(names)
    assert len(set(words)) == len(words) == len(names)
    first = {}
    for name, word in zip(names, words, strict=True):
        first.setdefault(re.sub(r"\W+", "_", name), word)
    assert all(word == plain for plain, word in first.items())


def test_an_importing_program_is_offered_an_experiment_of_whole_mesh_periods(tmp_path):
    path = str(write_fmu(tmp_path / "machine.fmu", machine("printed"), SPEED))
    experiment = read_model_description(path).defaultExperiment
    assert float(experiment.startTime) == 0.0
    assert float(experiment.stopTime) / PERIOD == pytest.approx(64, rel=1e-12)
    assert PERIOD / float(experiment.stepSize) == pytest.approx(64, rel=1e-12)
    assert float(experiment.tolerance) == 1e-12


@needs_compiler
@pytest.mark.parametrize("step", [0.0, -1e-6, np.nan, np.inf])
def test_a_step_that_does_not_go_forward_is_an_error(tmp_path, step):
    folder = compiled(tmp_path, machine("printed"))
    description = read_model_description(str(folder))
    slave = FMU3Slave(
        guid=description.guid, unzipDirectory=str(folder), modelIdentifier=IDENTIFIER, instanceName="one"
    )
    slave.instantiate()
    slave.enterInitializationMode(startTime=0.0)
    slave.exitInitializationMode()
    slave.doStep(0.0, PERIOD)
    with pytest.raises(FMICallException, match="fmi3DoStep"):
        slave.doStep(PERIOD, step)
    slave.freeInstance()


@needs_compiler
def test_flank_deflections_and_edges_give_the_deflection_of_the_tables(tmp_path):
    exported = machine("contact_only")
    folder = compiled(tmp_path, exported)
    results = run_elsewhere(folder)
    described = {one.name: one.description for one in read_model_description(str(folder)).modelVariables}
    model = build_model(exported)
    run = record(model.system, 2 * np.pi / PERIOD, static_start(model), PERIODS, Settings(tolerance=1e-12))
    phases = np.minimum(results["time"] * 2 * np.pi / PERIOD, run.starts[-1] + run.lengths[-1])
    samples = each_deflection(model.system, run.at(phases)[0][:-1], SAMPLES)
    tables = by_mesh(model.system, samples)
    for column, mesh in zip(tables.T, exported.layout.mesh_names, strict=True):
        word = mesh.replace(" ", "_").replace("/", "_")
        beyond = [
            results[f"deflection_{word}_{flank}"] - edge_of(described[f"deflection_{word}_{flank}"])
            for flank in ("drive", "back")
        ]
        found = 0.5 * (beyond[0] - beyond[1])[:-1]
        assert np.abs(found - column).max() < 1e-8 * np.abs(tables).max()


def edge_of(description):
    """Deflection (m) above which a flank touches, as its variable says."""
    return float(re.search(r"above (\S+) m", description).group(1))
