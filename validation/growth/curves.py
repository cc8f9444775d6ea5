"""Curves of time and memory against size: each prepares points of several sizes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from facegear.build.elastic_bodies import body_shape, contact_patch
from facegear.build.load import load_config
from facegear.build.plans import contact_plan
from facegear.build.tooth_pair import ToothPair, pair
from facegear.contact.gear_flank import contact_model
from facegear.contact.ltca import even_positions, loaded_contact
from facegear.motion.plan import Settings
from facegear.motion.steady_state.simulate import build_model
from facegear.motion.sweeps.sweep import run_speeds
from facegear.parts.gear_body import SolvedBody, reduced_body, solve_body
from facegear.pipeline.stages.studies import chunk_of
from facegear.schema.contact import Contact
from facegear.schema.gear_body import BodySection
from facegear.studies.sampled_machine import SampledMachine
from validation.contact.benchmark import Level, compliances, level
from validation.growth.machines import PERIODS, Running, bending, resized, shipped_machine

Call = Callable[[], Any]
PreparedPoint = tuple[float | None, Call]
"""The size of a point, or None if the call itself returns it, and the call to be measured."""
LEVEL, COARSER = "coarse_1x1x1", 1.5
"""Resolution of the contact, and by what its elements are larger: growth shows at any."""
SWEEP_QUANTITIES, TIGHT = 3e-5, 1e-8
"""Tolerances of sweeps, and of periods with bodies that bend."""
MODES_TO_HZ = 5000.0


@dataclass(frozen=True)
class Curve:
    """A curve: `values` to be prepared, what their sizes are and what is timed, `times` in one call, and why
    its logarithm is not a straight line.
    """

    size: str
    timed_task: str
    values: Sequence[Any]
    prepare: Callable[[Any], PreparedPoint]
    bent_by: str
    times: int = 1


def _pair() -> tuple[Any, Level, Any]:
    values = load_config("config/paper.yaml").model_dump(mode="json")
    teeth = pair(ToothPair.of_config(values["tooth_pair"]))
    plan = contact_plan(Contact.of_config(values["contact"]))
    base = level(LEVEL, teeth.design, plan)
    return teeth.design, _finer(base, COARSER), teeth.materials


def _finer(base: Level, factor: float) -> Level:
    """The level with its element sizes times a factor."""
    machine = {name: size for name, size in vars(base.sizes).items() if size is not None}
    return replace(base, sizes=replace(base.sizes, **{name: factor * size for name, size in machine.items()}))


def _contact(positions: int, torques: int) -> Call:
    design, base, materials = _pair()
    model = contact_model(design, *compliances(design, base, materials))
    loads = np.geomspace(max(base.plan.torques), min(base.plan.torques), torques)[::-1].tolist()
    loaded_contact(model, [0.3], loads, base.plan.options)
    return lambda: loaded_contact(model, even_positions(positions), loads, base.plan.options)


def _bodies(design: Any, base: Level, materials: Any) -> Call:
    return lambda: compliances(design, base, materials)


def _teeth(teeth: int) -> PreparedPoint:
    """The gear alone grows, with its radii."""
    design, base, materials = _pair()
    gear, scale = design.face_gear, teeth / design.face_gear.teeth
    radii = {name: scale * getattr(gear, name) for name in ("inner_radius", "outer_radius")}
    middle = 0.5 * (radii["inner_radius"] + radii["outer_radius"])
    half = 0.5 * (gear.outer_radius - gear.inner_radius)
    new_teeth = replace(gear, teeth=teeth, inner_radius=middle - half, outer_radius=middle + half)
    return teeth, _bodies(replace(design, face_gear=new_teeth), base, materials)


def _width(millimetres: float) -> PreparedPoint:
    """Both faces, about the gear's mean radius."""
    design, base, materials = _pair()
    gear, half = design.face_gear, 0.5e-3 * millimetres
    wider = replace(gear, inner_radius=design.mean_radius - half, outer_radius=design.mean_radius + half)
    pinion = replace(
        design.pinion, width=design.pinion.width + 2.0 * half - gear.outer_radius + gear.inner_radius
    )
    return millimetres, _bodies(replace(design, face_gear=wider, pinion=pinion), base, materials)


def _elements(factor: float) -> PreparedPoint:
    design, base, materials = _pair()
    return 1.0 / factor**3, _bodies(design, _finer(base, factor), materials)


def _pinions(count: int) -> PreparedPoint:
    return count, Running(resized(shipped_machine("config/paper.yaml"), count, 5), SWEEP_QUANTITIES)


def _harmonics(count: int) -> PreparedPoint:
    return count, Running(resized(shipped_machine("config/paper.yaml"), 5, count), SWEEP_QUANTITIES)


def _solve_gear_body(max_frequency: float, diameters: int) -> tuple[SolvedBody, Any, Any]:
    values = load_config("config/flexible.yaml").model_dump(mode="json")
    teeth = ToothPair.of_config(values["tooth_pair"])
    section = BodySection.of_config(values["transmission"]["face_gear"]["body"])
    body = solve_body(body_shape(section, teeth), max_frequency, diameters, teeth.face_gear_teeth)
    return body, section, contact_patch(section, teeth)


def _coordinates(max_frequency: float | None) -> PreparedPoint:
    """Prepare the whole machine, with rigid gears for None."""
    body = None
    if max_frequency is not None:
        solution, section, patch = _solve_gear_body(max_frequency, 12)
        body = reduced_body(solution, patch, *section.damping)
    running = Running(bending(body), TIGHT)
    return running.integrator.size, running


def _body_modes(max_frequency: float) -> PreparedPoint:
    def count() -> int:
        return sum(modes.frequencies.size for modes in _solve_gear_body(max_frequency, 8)[0].orders)

    return None, count


def _diameters(last: int) -> PreparedPoint:
    return last, lambda: _solve_gear_body(MODES_TO_HZ, last)


def _samples(count: int) -> PreparedPoint:
    import facegear

    tolerances = load_config("config/tolerances.yaml").model_dump(mode="json")
    inputs = facegear.load("config/harmonics_only.yaml", results=None).with_values(
        {
            "transmission.mesh_kinematics": "geometric",
            "transmission.face_gear.mesh_radius_mm": None,
            "tolerances": {
                "samples": 512,
                "chunk_samples": 512,
                "causes": [
                    cause
                    for cause in tolerances["tolerances"]["causes"]
                    if all(".position_um." in key for key in cause["moves"])
                ],
            },
        }
    )
    sampled_machine = SampledMachine.of_stage(**inputs._chain.arguments("tolerances_chunk"))
    chunk_of(sampled_machine, "samples", 512, 520)
    return count, lambda: chunk_of(sampled_machine, "samples", 0, count - 1)


def _speeds(count: int) -> PreparedPoint:
    model = build_model(shipped_machine("config/paper.yaml"))
    speeds = np.linspace(6000.0, 12000.0, count)
    settings = Settings(tolerance=SWEEP_QUANTITIES, extensions=0)
    list(run_speeds(model, speeds[:1], settings, None))
    return count, lambda: list(run_speeds(model, speeds, settings, None))


CURVES = {
    "positions": Curve(
        "contact positions",
        "contact at 4 torques",
        (8, 16, 32, 64),
        lambda n: (n, _contact(n, 4)),
        "Every position is solved by itself, and hands on no more than a first guess of the largest turn; "
        "what is prepared once for all is little.",
    ),
    "torques": Curve(
        "torques",
        "contact at 16 positions",
        (1, 2, 5, 12),
        lambda n: (n, _contact(16, n)),
        "Pairs in reach, gaps and influence of a position are computed once, for the largest torque; only "
        "the active sets are solved for each.",
    ),
    "teeth": Curve(
        "teeth of the face gear",
        "compliance of both bodies",
        (143, 220, 350, 572),
        _teeth,
        "One tooth is factorised whatever their number, and teeth without load are joined by doubling: what "
        "grows is the logarithm.",
    ),
    "face_width": Curve(
        "face width, mm",
        "compliance of both bodies",
        (6.0, 10.0, 17.0, 28.0),
        _width,
        "Elements and loaded flank nodes both grow with the width, so that right-hand sides times unknowns "
        "grow with its square, over a part that does not grow.",
    ),
    "mesh": Curve(
        "elements over those of the other curves",
        "compliance of both bodies",
        (1.25, 1.0, 0.8, 0.65),
        _elements,
        "Sizes are rounded to whole elements; flank nodes grow with the power 2/3 of the elements, and the "
        "compliance with flank nodes times unknowns.",
    ),
    "pinions": Curve(
        "pinions",
        "mesh period at 3e-5",
        (1, 2, 5, 10, 20, 40),
        _pinions,
        "Every pinion brings coordinates and flanks, whose product is quadratic; every flank that opens or "
        "closes ends a step for all.",
        PERIODS,
    ),
    "harmonics": Curve(
        "harmonics of k",
        "mesh period at 3e-5",
        (1, 5, 10, 20, 40, 80),
        _harmonics,
        "The part of a step that does not know k hides few harmonics; many of them shorten the step.",
        PERIODS,
    ),
    "coordinates": Curve(
        "coordinates of a machine whose gears bend",
        "mesh period at 1e-8",
        (None, 1000.0, 2000.0, 5000.0, 7700.0, 12000.0),
        _coordinates,
        "The law and the search for switches cost the same for all; modes of one order couple with each "
        "other, so that their products grow with the square of their number in an order.",
        PERIODS,
    ),
    "body_modes": Curve(
        "modes of a body",
        "body of 0 to 8 nodal diameters",
        (2500.0, 10000.0, 20000.0, 40000.0),
        _body_modes,
        "Static compliances of all orders cost the same; beside them, steps for eigenvalues grow with the "
        "modes.",
    ),
    "nodal_diameters": Curve(
        "nodal diameters",
        "body with its modes to 5 kHz",
        (2, 8, 16, 32),
        _diameters,
        "Every order has an eigenproblem of its own, over the static orders that are computed anyhow.",
    ),
    "samples": Curve(
        "samples",
        "tolerances at rest",
        (64, 128, 256, 512),
        _samples,
        "The first samples are computed over the whole hunting cycle as a check.",
    ),
    "speeds": Curve(
        "speeds",
        "sweep in one direction",
        (10, 20, 40, 80),
        _speeds,
        "A nearer neighbour is a better start; what counts is how many speeds are irregular.",
    ),
}
