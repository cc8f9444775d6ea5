"""Run plans: computations made of runs, each of which depends on what the last one has shown.

A run plan requests a run by yielding it and receives its result. The same code watches one machine alone and
many whose runs are integrated side by side.
"""

from collections import defaultdict
from collections.abc import Generator, Mapping, Sequence
from typing import TypeAlias, TypeVar

from facegear.dynamics.integrator.integrator import RunResult
from facegear.dynamics.side_by_side import run_stretches
from facegear.dynamics.stretch import RunRequest
from facegear.errors import NotConverged

T = TypeVar("T")


RunPlan: TypeAlias = Generator[RunRequest, RunResult, T]
"""Computation that yields RunRequests, receives their results, and returns a value.

A NotConverged of a run is raised where it was requested.
"""


def alone(plan: RunPlan[T]) -> T:
    """Run a single plan to completion.

    Parameters
    ----------
    plan : RunPlan
        Computation.

    Returns
    -------
    T
        Value that the plan returns.

    Raises
    ------
    NotConverged
        If the plan raises it.
    """
    return side_by_side([plan])[0]


def side_by_side(plans: Sequence[RunPlan[T]]) -> list[T]:
    """Run many plans to completion; requests of one kind are integrated together, whatever their lengths.

    The kind that most plans request at a time is run, while the others wait for more of their own. So lanes
    are as full as they can be.

    Parameters
    ----------
    plans : sequence of RunPlan
        Computations.

    Returns
    -------
    list of T
        Value that each plan returns.

    Raises
    ------
    NotConverged
        If any of the plans raises it.
    """
    results: dict[int, T] = {}
    requests: dict[int, RunRequest] = {}
    answers: dict[int, RunResult | NotConverged | None] = dict.fromkeys(range(len(plans)))
    while answers:
        for number, answer in answers.items():
            try:
                requests[number] = _next_of(plans[number], answer)
            except StopIteration as end:
                results[number] = end.value
        group = _largest_group(requests)
        answers = dict(zip(group, run_stretches([requests.pop(number) for number in group]), strict=True))
    return [results[number] for number in range(len(plans))]


def _largest_group(requests: Mapping[int, RunRequest]) -> list[int]:
    """Numbers of the plans in the largest group that requests runs of one kind."""
    groups: dict[tuple[object, ...], list[int]] = defaultdict(list)
    for number, stretch in requests.items():
        groups[stretch.kind].append(number)
    return max(groups.values(), key=len, default=[])


def _next_of(plan: RunPlan[T], answer: RunResult | NotConverged | None) -> RunRequest:
    """Return the run that a plan requests after an answer. Raises StopIteration at its end."""
    if isinstance(answer, NotConverged):
        return plan.throw(answer)
    return next(plan) if answer is None else plan.send(answer)
