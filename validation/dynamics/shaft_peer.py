"""Shafts by ROSS and torsional springs by openTorsion: the same static and dynamic numbers as ours.

Both run in an environment that uv makes.
"""

import json
import os
import shutil
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.errors import FacegearError
from facegear.harmonics import Harmonics
from facegear.machine.drive_line import DriveLine, Seat, TurningMass
from facegear.machine.kinematics import KINEMATICS
from facegear.machine.layout import Body, FaceGear, Layout, Pinion, Role, Side
from facegear.machine.linear_model import LinearModel
from facegear.machine.machine import Damping, Machine
from facegear.machine.modes import modes_of
from facegear.machine.shaft_tables import chain_frequencies
from facegear.parts.shafts import Bearing, CondensedShaft, Elasticity, Segment, Shaft, condense_shaft
from validation.contact.process import run_alone

ROSS, OPENTORSION = "2.3.0", "0.3.2"
PACKAGES = (f"ross-rotordynamics=={ROSS}", f"opentorsion=={OPENTORSION}", "plotly<6.1")
"""Requirements of the environment that uv makes."""
YOUNG, POISSON = 206e9, 0.3
"""Young's modulus, Pa, and Poisson's ratio of the shafts."""
MASS, DIAMETRAL, POLAR = 1.199, 1.5e-3, 2e-3
"""Mass, kg, and diametral and polar inertia, kg m2, of the pinion."""
SPEEDS_RPM = (0.0, 20000.0, 60000.0)
NAMES = ("x", "y", "z", "tilt_x", "tilt_y")
"""Coordinates of a node."""
SHAFTS: dict[str, dict[str, Any]] = {
    "between bearings": {
        "segments": [[0.12, 0.04, 0.0]],
        "pinion": 0.05,
        "bearings": [(0.0, 1.5e8, 1e8), (0.12, 2.5e8, 0.0)],
    },
    "overhung": {
        "segments": [[0.135, 0.036, 0.0]],
        "pinion": 0.135,
        "bearings": [(0.0, 2e8, 1e8), (0.09, 3e8, 0.0)],
    },
    "stepped and hollow, three bearings": {
        "segments": [[0.04, 0.04, 0.02], [0.05, 0.05, 0.02], [0.06, 0.036, 0.0]],
        "pinion": 0.06,
        "bearings": [(0.01, 4e8, 1e8), (0.09, 2e8, 0.0), (0.14, 6e8, 0.0)],
    },
}
"""Shafts by name: segments (length, outer and inner diameter, m), position of the pinion, m, and bearings
(position, m, radial and axial stiffness, N/m)."""
CHAINS: dict[str, tuple[list[float], list[float]]] = {
    "engine and pinion": ([0.002, 0.08], [2.5e4]),
    "three masses in a row": ([0.9, 0.002, 0.08], [6e5, 2.5e4]),
    "six masses in a row": ([0.54, 3.0, 0.4, 0.02, 1.5, 0.006], [5e6, 2e6, 3e5, 8e4, 9e5]),
}
"""Chains by name: inertias, kg m2, and stiffnesses between them, N m/rad."""


def shaft_peer(folder: Path) -> pd.DataFrame:
    """Compare our numbers with those of ROSS and openTorsion.

    Parameters
    ----------
    folder : Path
        Folder for the files of the programs.

    Returns
    -------
    DataFrame
        Columns case, program, quantity, ours, theirs, difference (over the largest of its kind).

    Raises
    ------
    FacegearError
        If uv is missing or a program fails.
    """
    result = _solve(folder)
    rows: list[tuple[str, str, str, float, float, float]] = []
    for (name, shaft_data), ross_result in zip(SHAFTS.items(), result["shafts"], strict=True):
        shaft = condensed_shaft(shaft_data)
        rows += _compliances(name, shaft, np.array(ross_result["compliance"]))
        for speed, frequencies in zip(SPEEDS_RPM, ross_result["frequencies"], strict=True):
            our_frequencies = whirling_frequencies(shaft, speed)
            rows += [
                (name, f"ROSS {ROSS}", f"frequency {i + 1} at {speed:g} rpm, Hz", a, b, a / b - 1.0)
                for i, (a, b) in enumerate(zip(our_frequencies, frequencies, strict=True))
            ]
    for (name, (inertias, springs)), frequencies in zip(CHAINS.items(), result["chains"], strict=True):
        rows += [
            (name, f"openTorsion {OPENTORSION}", f"frequency {i + 1}, Hz", a, b, a / b - 1.0)
            for i, (a, b) in enumerate(
                zip(torsional_frequencies(inertias, springs), frequencies, strict=True)
            )
        ]
    return pd.DataFrame(rows, columns=["case", "program", "quantity", "ours", "theirs", "difference"])


def _compliances(name: str, shaft: CondensedShaft, ross_compliance: Array) -> list[tuple[Any, ...]]:
    """Entries that are not zero of the upper triangle."""
    size = np.sqrt(np.outer(ross_compliance.diagonal(), ross_compliance.diagonal()))
    return [
        (
            name,
            f"ROSS {ROSS}",
            f"{NAMES[i]} by load {NAMES[j]}, SI",
            shaft.compliance[i, j],
            ross_compliance[i, j],
            (shaft.compliance[i, j] - ross_compliance[i, j]) / size[i, j],
        )
        for i in range(5)
        for j in range(i, 5)
        if abs(ross_compliance[i, j]) > 1e-6 * size[i, j]
    ]


def whirling_frequencies(shaft: CondensedShaft, speed_rpm: float) -> list[float]:
    """Return the frequencies of a pinion on a shaft across it, meshes open.

    Parameters
    ----------
    shaft : CondensedShaft
        The shaft.
    speed_rpm : float
        Speed, rpm.

    Returns
    -------
    list of float
        Frequencies, Hz.
    """
    bearing = 1.0 / np.diagonal(shaft.compliance)[:3]
    linear = _linear(Body(MASS, POLAR, (bearing[0], bearing[1], bearing[2])), shaft)
    coordinates = np.array([0, 1, *range(linear.size - 2, linear.size)])
    modes = modes_of(linear, np.zeros_like(linear.mass), speed_rpm * np.pi / 30.0)
    energy = np.abs(modes.shapes) ** 2 * linear.mass.diagonal()[:, None]
    inside = energy[coordinates].sum(axis=0) > 0.5 * energy.sum(axis=0)
    return modes.frequencies[inside].tolist()


def torsional_frequencies(inertias: list[float], springs: list[float]) -> list[float]:
    """Return the frequencies of masses in a row, the first of them a pinion.

    Parameters
    ----------
    inertias : list[float]
        Inertias, kg m2.
    springs : list[float]
        Stiffnesses between them, N m/rad.

    Returns
    -------
    list of float
        Frequencies, Hz.
    """
    masses = tuple(
        TurningMass(f"mass_{i}", k, j) for i, (k, j) in enumerate(zip(springs, inertias[1:], strict=True))
    )
    layout = _layout(Body(MASS, inertias[0], (1e8, 1e8, 1e8)))
    return chain_frequencies(DriveLine(layout, {}, {0: masses}), 0, masses).tolist()


def _layout(pinion: Body) -> Layout:
    arm = 3.75e-3 * 11.5 * float(np.cos(np.radians(25.0)))
    return Layout(
        pinions=(Pinion("pinion", Role.INPUT, 0.0, pinion),),
        gears=(FaceGear(Side.UPPER, Body(7.8, 0.54, (8.7e9, 8.7e9, 8.7e9))),),
        pinion_teeth=23,
        gear_teeth=143,
        pressure_angle=float(np.radians(25.0)),
        pinion_radius=arm,
        gear_radius=arm * 143.0 / 23.0,
        kinematics=KINEMATICS["geometric"],
    )


def _linear(pinion: Body, shaft: CondensedShaft) -> LinearModel:
    layout = _layout(pinion)
    constant = Harmonics(np.zeros(1), np.array([4.1e8]))
    machine = Machine(
        layout,
        np.zeros(2),
        constant,
        Harmonics(np.zeros(1), np.zeros(1)),
        np.array([5e-5]),
        Damping(0.0, 0.0, 0.0),
    )
    return DriveLine(layout, {0: Seat(shaft, DIAMETRAL)}, {})(machine.lumped_model)


def condensed_shaft(shaft: dict[str, Any]) -> CondensedShaft:
    """Condense one of SHAFTS to the pinion.

    Parameters
    ----------
    shaft : dict[str, Any]
        Its data.

    Returns
    -------
    CondensedShaft
        The condensed shaft.
    """
    bearings = tuple(
        Bearing(position, np.diag([radial, radial, axial, 0.0, 0.0]))
        for position, radial, axial in shaft["bearings"]
    )
    segments = tuple(Segment(*segment) for segment in shaft["segments"])
    return condense_shaft(Shaft(segments, Elasticity(YOUNG, POISSON), bearings, shaft["pinion"]))


def _solve(folder: Path) -> dict[str, Any]:
    uv = shutil.which("uv") or shutil.which("uv", path=str(Path(sys.executable).parent))
    if uv is None:
        raise FacegearError("uv is not installed, which makes the environment of ROSS (make tools)")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "problem.json").write_text(json.dumps(_problem()), encoding="utf-8")
    packages = [argument for name in (*PACKAGES, "numpy") for argument in ("--with", name)]
    options = "run", "--no-project", "--isolated", "--python", sys.executable
    command = [uv, *options, *packages, "python", str(Path(__file__).with_name("shaft_run.py"))]
    log = folder / "peers.log"
    if run_alone(command, folder, log, os.environ, 1800.0).code != 0:
        raise FacegearError(f"ROSS or openTorsion failed: see {log}")
    result: dict[str, Any] = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    return result


def _problem() -> dict[str, Any]:
    common = {"young": YOUNG, "poisson": POISSON, "mass": MASS, "diametral": DIAMETRAL, "polar": POLAR}
    speeds = [speed * np.pi / 30.0 for speed in SPEEDS_RPM]
    shafts = [
        {
            **common,
            "segments": shaft["segments"],
            "pinion": shaft["pinion"],
            "bearings": [
                {"position": position, "radial": radial, "axial": axial}
                for position, radial, axial in shaft["bearings"]
            ],
            "speeds": speeds,
        }
        for shaft in SHAFTS.values()
    ]
    chains = [{"inertia": inertias, "stiffness": springs} for inertias, springs in CHAINS.values()]
    return {"shafts": shafts, "chains": chains}
