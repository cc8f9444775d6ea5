"""What is watched of a motion as a course of stretches, each of which depends on what the last has shown.

A course asks for a stretch by yielding it and is given its run. The same code watches one machine alone
and many whose stretches run side by side.
"""

from collections import defaultdict
from collections.abc import Generator, Mapping, Sequence
from typing import TypeAlias, TypeVar

from facegear.dynamics.integrator.integrator import RunResult
from facegear.dynamics.side_by_side import run_stretches
from facegear.dynamics.stretch import Stretch
from facegear.errors import NotConverged

T = TypeVar("T")


Course: TypeAlias = Generator[Stretch, RunResult, T]
"""A NotConverged of a stretch is raised where it was asked for."""


def alone(course: Course[T]) -> T:
    """What a course comes to when each of its stretches runs by itself. Raises NotConverged."""
    return side_by_side([course])[0]


def side_by_side(courses: Sequence[Course[T]]) -> list[T]:
    """What each of many courses comes to; stretches of one kind run in lanes where they can, whatever their
    lengths.

    The kind that most courses ask for at a time is run, while the others wait for more of their own: so lanes
    are as full as they can be. Raises NotConverged if any of the courses does.
    """
    ended: dict[int, T] = {}
    asked: dict[int, Stretch] = {}
    answers: dict[int, RunResult | NotConverged | None] = dict.fromkeys(range(len(courses)))
    while answers:
        for number, answer in answers.items():
            try:
                asked[number] = _next_of(courses[number], answer)
            except StopIteration as end:
                ended[number] = end.value
        alike = _largest_group(asked)
        answers = dict(zip(alike, run_stretches([asked.pop(number) for number in alike]), strict=True))
    return [ended[number] for number in range(len(courses))]


def _largest_group(asked: Mapping[int, Stretch]) -> list[int]:
    """Numbers of the courses in the largest group that asks for stretches of one kind."""
    groups: dict[tuple[object, ...], list[int]] = defaultdict(list)
    for number, stretch in asked.items():
        groups[stretch.asks].append(number)
    return max(groups.values(), key=len, default=[])


def _next_of(course: Course[T], answer: RunResult | NotConverged | None) -> Stretch:
    """The stretch that a course asks for after an answer. Raises StopIteration at its end."""
    if isinstance(answer, NotConverged):
        return course.throw(answer)
    return next(course) if answer is None else course.send(answer)
