"""What is measured: jobs of the workflow, and into how many parts the time of each is divided."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

SAMPLES, DESIGNS = 200, 4
EXAMPLE = "validation/ratios/example_3878ccc2.yaml"
"""The example machine of that commit stays as it was: irregular motion under a load-dependent stiffness."""


@dataclass(frozen=True)
class Point:
    """One measurement.

    Attributes
    ----------
    config, changes
        The case, and what is changed in it by dotted keys.
    stage, wildcards
        The job. What it takes of other stages is computed once, and both commits are given the same.
    amount, unit
        Into how many parts the time of a call is divided, and what the number is then.
    scale
        Units in a second.
    error
        Where the numerical error of the stage's numbers is stated.
    whole_process
        Whether the start of the process counts, so that each call has one of its own.
    """

    config: str
    stage: str
    unit: str
    error: str
    amount: int = 1
    scale: float = 1.0
    changes: Mapping[str, Any] = field(default_factory=dict)
    wildcards: Mapping[str, str] = field(default_factory=dict)
    whole_process: bool = False


def _body(name: str) -> Point:
    return Point(
        "config/paper.yaml",
        "compliance",
        "s a body, its process started",
        "docs/contact.md, resolution",
        wildcards={"body": name},
        whole_process=True,
    )


def _sample(law: str) -> Point:
    changes = {"mesh_stiffness.mesh_law": law, "tolerances.model": "dynamic"}
    return Point(
        "config/tolerances.yaml",
        "tolerances_chunk",
        "ms a dynamic sample",
        "docs/tolerances.md, accuracy",
        amount=SAMPLES,
        scale=1e3,
        changes=changes,
        wildcards={"design": "samples", "first": "0", "last": str(SAMPLES - 1)},
    )


def _sweep(direction: str, config: str = "config/paper.yaml", speeds: int = 400) -> Point:
    return Point(
        config,
        "dynamics_sweep_chunk",
        f"s a sweep of {speeds} speeds",
        "docs/dynamics.md, convergence of the sweep",
        wildcards={"direction": direction, "number": "0"},
    )


POINTS: Mapping[str, Point] = {
    "pinion": _body("pinion"),
    "face_gear": _body("face_gear"),
    "contact": Point(
        "config/paper.yaml",
        "contact",
        "ms a contact with its pressure",
        "docs/contact.md, resolution",
        amount=160,
        scale=1e3,
    ),
    "sweep_up": _sweep("up"),
    "sweep_down": _sweep("down"),
    "example_up": _sweep("up", EXAMPLE, 24),
    "example_down": _sweep("down", EXAMPLE, 24),
    "sample_with_law": _sample("load_dependent"),
    "sample_without_law": _sample("constant_load"),
    "load_sharing": Point(
        "config/paper.yaml", "load_sharing", "s the machine's load sharing", "docs/load_sharing.md"
    ),
    "microgeometry": Point(
        "config/microgeometry.yaml",
        "tolerances_chunk",
        "s a design",
        "docs/tolerances.md, accuracy",
        amount=DESIGNS,
        wildcards={"design": "samples", "first": "0", "last": str(DESIGNS - 1)},
    ),
}
