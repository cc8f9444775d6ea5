"""Machines put together and judged again and again: what samples and designs have in common."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from facegear.config.base import parse
from facegear.config.buildable import require_buildable
from facegear.config.dynamics import Accuracy, settings
from facegear.config.load_sharing import LoadSharing, sharing_options
from facegear.config.lumped_model import machine
from facegear.config.transmission import Transmission
from facegear.dynamics.steady_state.simulate import build_model
from facegear.dynamics.sweeps.jump_margin import jump_margin
from facegear.dynamics.sweeps.plan import JumpRange
from facegear.load_sharing.quantities import dynamic_quantities, quasi_static_quantities
from facegear.load_sharing.quantity_names import JUMP_MARGIN, PEAK
from facegear.stages.tooth_meshes import Meshes

Judge = Callable[[Mapping[str, Any]], dict[str, float]]
"""What a machine is judged by, by column name, given the values of `facegear.config.variants.variable_part`.

Raises the error that a config gets for a machine that cannot be built, NotConverged."""


@dataclass(frozen=True)
class Question:
    """How machines are judged: by loads over `cycles` mesh cycles of the hunting cycle, or of the motion.

    `model`: quasi_static or dynamic; `accuracy`, `options`: sections dynamics.accuracy and load_sharing;
    `jumps`: where the nearest jump is looked for, None if it is not asked for.
    """

    model: str
    cycles: int
    accuracy: Mapping[str, Any]
    options: Mapping[str, Any]
    jumps: JumpRange | None = None

    @property
    def dynamic(self) -> bool:
        """Whether the motion is asked for."""
        return self.model == "dynamic"


def judge(question: Question, meshes: Meshes, told: str) -> Judge:
    """`told` names the machine in errors."""
    ask = _ask(question)

    def judged(values: Mapping[str, Any]) -> dict[str, float]:
        mesh = meshes(values["tooth_pair"])
        section = parse(Transmission, mesh.in_machine(values["transmission"]), told)
        require_buildable(section, mesh.numbers)
        built = machine(section, mesh.numbers, mesh.stiffness, mesh.unloaded)
        speed = values["dynamics"]["speed_rpm"]
        found = ask(built, speed)
        found |= mesh.quantities(found[PEAK])
        if question.jumps is not None:
            found[JUMP_MARGIN] = jump_margin(build_model(built), speed, question.jumps)
        return found

    return judged


def _ask(question: Question) -> Callable[[Any, float], dict[str, float]]:
    if not question.dynamic:
        return lambda built, speed: quasi_static_quantities(built, question.cycles)
    precise = settings(parse(Accuracy, question.accuracy))
    one_start = replace(sharing_options(parse(LoadSharing, question.options)), starts=1)
    return lambda built, speed: dynamic_quantities(built, speed, precise, one_start)
