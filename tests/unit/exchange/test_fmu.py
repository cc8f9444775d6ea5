"""An exported machine moves in another program as it does here."""

import os
import re
import shutil
from dataclasses import replace
from functools import cache
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.build import build_platform_binary
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu
from force_tables import power_table
from hypothesis import example, given
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine
from recorded_motion import record

import facegear
from facegear.door.outputs import machine_of
from facegear.exchange.fmu import IDENTIFIER, unique_words, write_fmu
from facegear.machine.disturbances import PARTS, Excitation, MeshFriction
from facegear.machine.flanks import mesh_contacts
from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.machine import FlankTables, OpenFlanks
from facegear.machine.statics import static_bearing_forces
from facegear.meshing.law import beyond_edges
from facegear.motion.bearing_forces import bearing_history
from facegear.motion.plan import Settings
from facegear.motion.steady_state.mesh_samples import by_mesh, each_deflection
from facegear.motion.steady_state.simulate import build_model, simulate, static_start

CONFIG = Path(__file__).parents[3] / "config" / "harmonics_only.yaml"
COMPILER = os.environ.get("CXX") or shutil.which("c++")
"""Compiler that CMake finds: `.ci/release` runs these tests with zig in place of the machine's own."""
needs_compiler = pytest.mark.skipif(COMPILER is None, reason="an FMU of C++ sources needs a C++ compiler")
STRICT = "-O1 -pedantic -Wall -Wextra -Werror"
SPEED, PERIODS, SAMPLES = 7500.0, 3, 16
PERIOD = 60.0 / (23 * SPEED)
SETTLED = 120
"""Mesh periods after which the motion from rest repeats."""


RATIOS = 0.05 * np.random.default_rng(11).normal(size=(10, len(PARTS), 2, 3))
RATIOS[:, :, 0, 0] = 0.0
TABLES = 2 * (FlankTables(*(power_table(9, depth, 2e-6, 4e-4, 2.4e10) for depth in (0.2, 0.1))),)


def machine(kind):
    """A machine with one law or element of each kind; its flanks part and meet within a few periods."""
    if kind == "printed":
        return make_machine()
    layout = make_layout(kinematics=GEOMETRIC)
    if kind == "clearance":
        clearance = replace(perfect(layout), bearing_clearance=np.full(5, 1e-5))
        return make_machine(layout, torque=100.0, imperfections=clearance)
    if kind == "coupled":
        return machine_of(facegear.load("config/shafts.yaml", None))
    if kind == "excited":
        return replace(make_machine(layout), excitations=(Excitation(1, 46.0, 23, 400.0, 0.4),))
    flanks = OpenFlanks(kind) if kind in set(OpenFlanks) else OpenFlanks.CONTACT_ONLY
    built = make_machine(layout, open_flanks=flanks)
    friction = MeshFriction(RATIOS) if "friction" in kind else None
    return replace(built, friction=friction, tables=TABLES if "tables" in kind else built.tables)


KINDS = (
    "printed",
    "contact_only",
    "push_only",
    "tables",
    "friction",
    "tables and friction",
    "clearance",
    "excited",
)


@pytest.fixture(scope="module")
def folder_of(tmp_path_factory):
    """Unpacked FMU of a kind of machine with its binary for this computer, compiled once."""

    @cache
    def build(kind):
        return compiled(tmp_path_factory.mktemp("fmu"), machine(kind))

    return build


def compiled(folder, exported, speed=SPEED):
    """An unpacked FMU, with the binary for this computer that FMPy compiles of its sources."""
    path = write_fmu(folder / "machine.fmu", exported, speed)
    with ZipFile(path) as archive:
        archive.extractall(folder / "fmu")
    options = {
        "CMAKE_CXX_FLAGS:STRING": STRICT,
        "CMAKE_CXX_EXTENSIONS:BOOL": "OFF",
        "CMAKE_TRY_COMPILE_TARGET_TYPE:STRING": "STATIC_LIBRARY",  # to link a program takes zig long
    }
    build_platform_binary(folder / "fmu", configuration=None, cmake_options=options)
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


def started(folder):
    """An instance of an unpacked FMU that is ready for its first step."""
    description = read_model_description(str(folder))
    slave = FMU3Slave(
        guid=description.guid, unzipDirectory=str(folder), modelIdentifier=IDENTIFIER, instanceName="one"
    )
    slave.instantiate()
    slave.enterInitializationMode(startTime=0.0)
    slave.exitInitializationMode()
    return slave


def own_deflections(moved, begun, times):
    """Deflections (K, contacts) of a machine that begins at the rest of another, by our own integrator."""
    model = build_model(moved)
    omega = 2.0 * np.pi / PERIOD
    run = record(model.system, omega, static_start(build_model(begun)), PERIODS, Settings(tolerance=1e-12))
    phases = np.minimum(times * omega, run.starts[-1] + run.lengths[-1])
    errors = [error(phases / (2.0 * np.pi)) for error in mesh_contacts(moved).error]
    return run.at(phases)[0] @ model.system.mesh_jacobian[: len(errors)].T - np.array(errors).T


def outputs(results, kind):
    return np.array([results[name] for name in results.dtype.names if name.startswith(f"{kind}_")]).T


@needs_compiler
@pytest.mark.parametrize("kind", [*KINDS, "coupled"])
def test_deflections_and_forces_in_fmpy_are_those_of_our_own_integrator(folder_of, kind):
    exported = machine(kind)
    results = run_elsewhere(folder_of(kind))
    found, expected = outputs(results, "deflection"), own_deflections(exported, exported, results["time"])
    assert len(found) == PERIODS * SAMPLES + 1
    contacts = mesh_contacts(exported)
    beyond = beyond_edges(expected, contacts.lower, contacts.upper)
    assert kind == "coupled" or (np.diff(beyond != 0.0, axis=0)).any(), "some flank parts or meets"
    assert np.abs(found - expected).max() < 1e-8 * np.abs(expected).max()
    forces = contacts.law.force(results["time"] / PERIOD, beyond)
    assert np.abs(outputs(results, "force") - forces).max() < 1e-7 * np.abs(forces).max()


@needs_compiler
@pytest.mark.parametrize("changes", [{}, {"transmission.pinion.clearance_um": 20}])
def test_bearing_forces_settle_to_those_of_the_response(tmp_path, changes):
    gearbox = facegear.load("config/branches.yaml", None).with_values(changes)
    model, speed = build_model(machine_of(gearbox)), gearbox.values["dynamics"]["speed_rpm"]
    response = simulate(model, speed, Settings(tolerance=1e-10))
    assert response.label == "period-1" and response.orbit.spectral_radius**SETTLED < 1e-6
    expected = bearing_history(model, response).reshape(response.per_period, -1)
    period = 2.0 * np.pi / response.frequency
    step = period / response.per_period
    results = simulate_fmu(
        str(compiled(tmp_path, model.machine, speed)),
        stop_time=SETTLED * period,
        step_size=step,
        output_interval=step,
    )
    found = outputs(results, "bearing")[-response.per_period - 1 : -1]
    assert np.abs(found - expected).max() < 1e-3 * np.abs(expected).max()
    assert np.abs(found[0] - found[-1]).max() > 0.01 * np.abs(expected).max(), "it moves"


@needs_compiler
def test_torques_and_bearing_forces_are_those_of_the_machine(folder_of):
    exported, folder = machine("printed"), folder_of("printed")
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


def test_sources_are_those_of_the_kernels_and_all_that_they_include(tmp_path):
    path = write_fmu(tmp_path / "machine.fmu", machine("printed"), SPEED)
    kernels = Path(facegear.__file__).parent / "_kernels" / "src"
    with ZipFile(path) as archive:
        texts = {name: archive.read(name).decode() for name in archive.namelist()}
    headers = {name for name in texts if name.startswith("sources/motion/")}
    for name in {*headers, "sources/simd.hpp"}:
        assert texts[name] == (kernels / name.removeprefix("sources/")).read_text(encoding="utf-8")
    included = {include for text in texts.values() for include in re.findall(r'^#include "(.+)"', text, re.M)}
    assert {f"sources/{name}" for name in included} <= set(texts)
    build = texts["sources/buildDescription.xml"]
    assert 'language="C++17"' in build and texts["sources/fmu.cpp"].index("#define FACEGEAR_SCALAR") < 800


@needs_compiler
def test_a_speed_below_one_turn_a_minute_is_an_error(folder_of):
    folder = folder_of("printed")
    variables = {one.name: one for one in read_model_description(str(folder)).modelVariables}
    assert float(variables["speed"].min) == 1.0
    slave = started(folder)
    slave.setFloat64([variables["speed"].valueReference], [2.0 * SPEED])
    slave.doStep(0.0, PERIOD)
    with pytest.raises(FMICallException, match="fmi3SetFloat64"):
        slave.setFloat64([variables["speed"].valueReference], [0.0])
    slave.freeInstance()


@needs_compiler
def test_motion_does_not_depend_on_where_the_importing_program_stops(folder_of):
    folder = folder_of("contact_only")
    names = [one.name for one in read_model_description(str(folder)).modelVariables]
    forces = [number for number, name in enumerate(names) if name.startswith("force_")]
    ends = []
    for count in (1, 7, 200):
        slave = started(folder)
        for step in range(count):
            slave.doStep(step * PERIOD / count, PERIOD / count)
        ends.append(slave.getFloat64(forces))
        slave.freeInstance()
    assert np.abs(np.subtract(ends, ends[0])).max() < 1e-8 * np.abs(ends[0]).max() > 0.0


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
def test_a_step_that_does_not_go_forward_is_an_error(folder_of, step):
    slave = started(folder_of("printed"))
    slave.doStep(0.0, PERIOD)
    with pytest.raises(FMICallException, match="fmi3DoStep"):
        slave.doStep(PERIOD, step)
    slave.freeInstance()


@needs_compiler
def test_flank_deflections_and_edges_give_the_deflection_of_the_tables(folder_of):
    exported, folder = machine("contact_only"), folder_of("contact_only")
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
