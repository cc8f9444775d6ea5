"""Points of measurement: jobs of the workflow and calls of a fresh process, with the unit of each time."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
SAMPLES, DESIGNS = 200, 4
"""Dynamic samples and designs of a call. 10 000 samples on two cores take 5000 times the time of one sample,
if memory is as fast for two processes as for one.
"""
EXAMPLE = "validation/ratios/example_3878ccc2.yaml"
"""The example machine of that commit stays as it was: irregular motion under a load-dependent stiffness."""


@dataclass(frozen=True)
class Point:
    """One measurement.

    Attributes
    ----------
    config, changes
        The case, a file of the present tree for both commits, and what is changed in it by dotted keys.
    unit, error
        Unit of the time, and where the numerical error of the numbers is stated.
    stage, wildcards
        The job of the workflow. What it takes of other stages is computed untimed, by each commit itself.
    calls
        Methods of a gearbox in place of a stage; none: `import facegear` and what that puts off until the
        first name is asked for.
    amount
        Into how many parts the time of a call is divided.
    scale
        Units in a second.
    whole_process
        Whether the start of the process counts, so that each call has one of its own.
    """

    config: str
    unit: str
    error: str
    stage: str = ""
    wildcards: Mapping[str, str] = field(default_factory=dict)
    calls: tuple[str, ...] = ()
    amount: int = 1
    scale: float = 1.0
    changes: Mapping[str, Any] = field(default_factory=dict)
    whole_process: bool = False

    @property
    def job(self) -> dict[str, Any]:
        """Request to a process, in plain values."""
        return {
            "config": str(ROOT / self.config),
            "changes": dict(self.changes),
            "stage": self.stage,
            "wildcards": dict(self.wildcards),
            "calls": list(self.calls),
        }


def _body(name: str) -> Point:
    return Point(
        "config/paper.yaml",
        "s a body, its process started",
        "docs/explanation/contact.md, resolution",
        "compliance",
        wildcards={"body": name},
        whole_process=True,
    )


def _sample(law: str) -> Point:
    changes = {"mesh_stiffness.mesh_law": law, "tolerances.model": "dynamic"}
    return Point(
        "config/tolerances.yaml",
        "ms a dynamic sample",
        "docs/how_to/tolerances.md, accuracy",
        "tolerances_chunk",
        amount=SAMPLES,
        scale=1e3,
        changes=changes,
        wildcards={"design": "samples", "first": "0", "last": str(SAMPLES - 1)},
    )


def _sweep(direction: str, config: str = "config/paper.yaml", speeds: int = 400) -> Point:
    return Point(
        config,
        f"s a sweep of {speeds} speeds",
        "docs/explanation/dynamics.md, convergence of the sweep",
        "dynamics_sweep_chunk",
        wildcards={"direction": direction, "number": "0"},
    )


def _fresh(*calls: str) -> Point:
    return Point(
        "facegear/example.yaml",
        "s a fresh process",
        "docs/explanation/dynamics.md, integration",
        calls=calls,
        whole_process=True,
    )


POINTS: Mapping[str, Point] = {
    "pinion": _body("pinion"),
    "face_gear": _body("face_gear"),
    "contact": Point(
        "config/paper.yaml",
        "ms a contact with its pressure",
        "docs/explanation/contact.md, resolution",
        "contact",
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
        "config/paper.yaml",
        "s the machine's load sharing",
        "docs/explanation/load_sharing.md",
        "load_sharing",
    ),
    "microgeometry": Point(
        "config/microgeometry.yaml",
        "s a design",
        "docs/how_to/tolerances.md, accuracy",
        "tolerances_chunk",
        amount=DESIGNS,
        wildcards={"design": "samples", "first": "0", "last": str(DESIGNS - 1)},
    ),
    "fresh_import": _fresh(),
    "fresh_response": _fresh("modes", "statics", "response"),
    "fresh_contact": _fresh("contact"),
}
