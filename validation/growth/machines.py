"""Machines of any number of pinions, harmonics and coordinates of bodies, and what their motion costs."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from facegear.build.load import load_config
from facegear.build.machine import MachineInputs
from facegear.harmonics import Harmonics
from facegear.machine.elastic_gears import ElasticGears
from facegear.machine.imperfections import perfect
from facegear.machine.layout import Layout, Role
from facegear.machine.machine import Machine, OpenFlanks, mesh_frequency
from facegear.machine.torques import balanced_torques
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.steady_state.simulate import Model, build_model, static_start
from facegear.parts.reduced_body import ReducedBody

SPEED_RPM = 7500.0
"""Speed of the pinion, rpm."""
PERIODS = 400
"""Mesh periods of a run."""


def resized(machine: Machine, count: int, harmonics: int) -> Machine:
    """Return a machine with another number of pinions, evenly spread, half of them driving.

    Parameters
    ----------
    machine : Machine
        The original.
    count : int
        Number of pinions.
    harmonics : int
        Number of harmonics of k.

    Returns
    -------
    Machine
        The machine.
    """
    old = machine.layout
    pinions = tuple(
        replace(
            old.pinions[0],
            name=f"pinion {i}",
            role=Role.INPUT if i % 2 == 0 else Role.IDLER,
            pitches=round(2.0 * i * old.gear_teeth / count) / 2.0,
        )
        for i in range(count)
    )
    layout: Layout = replace(old, pinions=pinions)
    torque = np.where(np.arange(count) % 2 == 0, np.abs(machine.torques).max() / 20.0, 0.0)
    return replace(
        machine,
        layout=layout,
        torques=balanced_torques(layout, torque),
        stiffness=decaying_harmonics(machine.stiffness, harmonics),
        error_lags=None if machine.error_lags is None else np.zeros(len(layout.meshes)),
        half_backlash=np.full(len(layout.meshes), machine.half_backlash.max()),
        imperfections=perfect(layout),
        forces=np.zeros((len(layout.bodies), 3)),
    )


def decaying_harmonics(stiffness: Harmonics, harmonics: int) -> Harmonics:
    """Return mean and first amplitude of a series, with harmonics that fall with their number's square.

    Parameters
    ----------
    stiffness : Harmonics
        The series.
    harmonics : int
        Number of harmonics.

    Returns
    -------
    Harmonics
        The new series.
    """
    size = np.r_[0.0, stiffness.amplitudes[1:].max() / np.arange(1, harmonics + 1) ** 2]
    return Harmonics(size, np.r_[stiffness.mean, np.zeros(harmonics)])


def shipped_machine(config: str, changes: Mapping[str, Any] | None = None) -> Machine:
    """Return the machine of a config, rigid, with five harmonics of mesh stiffness.

    Parameters
    ----------
    config : str
        Path of the config.
    changes : Mapping[str, Any] or None
        Changes of its keys.

    Returns
    -------
    Machine
        The machine.
    """
    values = load_config("config/harmonics_only.yaml").model_dump(mode="json")
    stiffness = Harmonics(np.r_[0.0, 2e7], np.r_[values["mesh_stiffness"]["mean_n_per_m"], 0.0])
    return MachineInputs.of_config(
        load_config(config, changes).model_dump(mode="json"), decaying_harmonics(stiffness, 5)
    ).build()


def bending(body: ReducedBody | None) -> Machine:
    """Return the machine of config/flexible.yaml with both gears of one body, or rigid, and 20 harmonics of
    k.

    Parameters
    ----------
    body : ReducedBody or None
        Reduced body of both gears, None for rigid gears.

    Returns
    -------
    Machine
        The machine.
    """
    machine = shipped_machine(
        "config/flexible.yaml", {"transmission": {"transmission_error": {"amplitude_um": 2.0}}}
    )
    machine = replace(
        machine,
        stiffness=decaying_harmonics(machine.stiffness, 20),
        imperfections=perfect(machine.layout),
        damping=replace(machine.damping, open_flanks=OpenFlanks.CONTACT_ONLY),
    )
    if body is None:
        return machine
    elastic = ElasticGears(machine.layout, dict.fromkeys(range(len(machine.layout.gears)), body))
    return replace(machine, bodies=elastic, softening=elastic.softening())


class Running:
    """A machine that runs at SPEED_RPM from rest at its static load."""

    def __init__(self, machine: Machine, tolerance: float) -> None:
        self.model: Model = build_model(machine)
        frequency = TAU * mesh_frequency(machine.layout, SPEED_RPM)
        self.integrator = Integrator(self.model.system, frequency, tolerance)
        start = self.integrator.by_phase(static_start(self.model))
        self.state = self.integrator.run(start, 50).state

    def __call__(self) -> None:
        """Run PERIODS mesh periods."""
        self.integrator.run(self.state, PERIODS)
