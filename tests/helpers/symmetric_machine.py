"""The machine of config/harmonics_only.yaml, whose left and right idlers are alike, and sweeps of it."""

from dataclasses import replace
from functools import cache

import facegear
from facegear.build.machine import MachineInputs
from facegear.build.plans import sweep_plan
from facegear.build.tooth_numbers import ToothNumbers
from facegear.motion.steady_state.simulate import build_model


@cache
def load_gearbox():
    return facegear.load("config/harmonics_only.yaml")


@cache
def build_symmetric_model():
    config, values = load_gearbox().config, load_gearbox().values
    teeth = ToothNumbers.of_config(values["tooth_pair"])
    harmonics = load_gearbox().stiffness().content["harmonics"]
    return build_model(
        MachineInputs(transmission=config.transmission, teeth=teeth, harmonics=harmonics).build()
    )


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
