"""The machine of config/harmonics_only.yaml, whose left and right idlers are alike, and sweeps of it."""

from dataclasses import replace
from functools import cache

import facegear
from facegear.config.dynamics import sweep_plan
from facegear.config.machine_layout import ToothNumbers
from facegear.config.machines import wired_machine
from facegear.dynamics.steady_state.simulate import build_model


@cache
def load_gearbox():
    return facegear.load("config/harmonics_only.yaml")


@cache
def build_symmetric_model():
    config, values = load_gearbox().config, load_gearbox().values
    teeth = ToothNumbers.of_config(values["tooth_pair"])
    harmonics = load_gearbox().stiffness().content["harmonics"]
    return build_model(wired_machine(config.transmission, teeth, harmonics))


def make_plan(direction, grid, chunks=1):
    first, last, points = grid
    plan = sweep_plan(load_gearbox().config.dynamics.sweep)
    return replace(
        plan,
        first_rpm=first,
        last_rpm=last,
        points=points,
        directions=(direction,),
        chunks=chunks,
        overlap=1 if chunks > 1 else 0,
    )
