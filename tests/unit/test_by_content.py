"""Common parts of the machines of one study are computed once, and nothing else counts as common."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from lumped_machines import make_layout, make_machine

from facegear.by_content import content, kept_by_content
from facegear.harmonics import Harmonics
from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.motion.integrator.reduction import reduce
from facegear.motion.steady_state.simulate import build_model


def test_a_pure_function_is_evaluated_once_for_arguments_that_say_the_same():
    calls = []

    @kept_by_content(2)
    def total(values, names):
        calls.append(names)
        return values.sum()

    assert total(np.arange(3.0), ("a",)) == total(np.arange(3.0), ("a",)) == 3.0
    assert len(calls) == 1
    assert total(np.array([0.0, 1.0, 3.0]), ("a",)) == 4.0
    total(np.arange(3.0), ("b",))
    assert len(calls) == 3


@pytest.mark.parametrize(
    "other",
    [
        Harmonics(np.array([0.0, 1.0]), np.array([2.0, np.nextafter(3.0, 4.0)])),
        Harmonics(np.array([0.0, 1.0, 0.0]), np.array([2.0, 3.0, 0.0])),
        (np.array([0.0, 1.0]), np.array([2.0, 3.0])),
    ],
)
def test_a_number_a_shape_or_a_type_that_differs_makes_another_content(other):
    series = Harmonics(np.array([0.0, 1.0]), np.array([2.0, 3.0]))
    assert content(series) == content(Harmonics(series.sine.copy(), series.cosine.copy()))
    assert content(series) != content(other)


@dataclass(frozen=True, eq=False)
class Table:
    """Numbers in a frozen dataclass."""

    values: np.ndarray


def test_content_is_kept_of_what_cannot_change_and_of_nothing_else():
    open_, closed = np.arange(3.0), np.arange(3.0)
    closed.flags.writeable = False
    loose, fixed = Table(open_), Table(closed)
    assert content(loose) == content(fixed)
    assert content((fixed,))[1][0] is content(fixed)
    open_[0] = 5.0
    assert content(loose) != content(fixed), "what is written into an array is seen"
    assert content(Table((1.0, loose.values))) != content(Table((1.0, closed)))


def test_content_of_a_read_only_view_is_seen_to_change_with_what_it_is_a_view_of():
    """It was kept as that of what nothing can change."""
    numbers = np.arange(3.0)
    view = numbers[...]
    view.flags.writeable = False
    table = Table(view)
    before = content(table)
    numbers[0] = 5.0
    assert content(table) != before


def test_machines_of_one_layout_share_what_no_error_changes():
    layout = make_layout(kinematics=GEOMETRIC)
    models = [
        build_model(make_machine(layout, imperfections=replace(perfect(layout), position=at)))
        for at in np.array([0.0, 1e-6])[:, None, None] * np.ones((len(layout.pinions), 2))
    ]
    first, second = (model.machine.linear for model in models)
    for name in ("mass", "stiffness", "rows", "lengths", "translations"):
        assert getattr(first, name) is getattr(second, name)
    assert (models[0].system.upper != models[1].system.upper).any()
    assert models[0].system.error is models[1].system.error


def test_machines_of_a_series_have_one_machine_without_errors_and_no_other_machine_has_it():
    layout = make_layout(kinematics=GEOMETRIC)
    flaws = replace(perfect(layout), bearing_clearance=np.full(len(layout.pinions), 1e-5))
    first = make_machine(layout, imperfections=flaws)
    moved = replace(
        flaws,
        error=flaws.error + 1e-6,
        position=flaws.position + 1e-6,
        bearing_clearance=2.0 * flaws.bearing_clearance,
    )
    assert (
        replace(first, half_backlash=2.0 * first.half_backlash, imperfections=moved).without_errors
        is first.without_errors
    )
    for name, value in (
        ("stiffness", 2.0 * flaws.stiffness),
        ("clocking", flaws.clocking + 0.1),
        ("bearing_clearance", 0.0 * flaws.bearing_clearance),
    ):
        other = replace(first, imperfections=replace(flaws, **{name: value}))
        assert other.without_errors is not first.without_errors, name
    assert replace(first, torques=2.0 * first.torques).without_errors is not first.without_errors


def test_machines_that_differ_in_errors_and_clearances_share_reduction_and_law_and_nothing_that_differs():
    layout = make_layout(kinematics=GEOMETRIC)
    models = []
    for clearance in (0.0, 10e-6, 20e-6):
        flaws = replace(
            perfect(layout),
            bearing_clearance=np.full(len(layout.pinions), clearance),
            position=np.full((len(layout.pinions), 2), 0.1 * clearance),
        )
        models.append(build_model(make_machine(layout, imperfections=flaws)))
    tight, narrow, wide = models
    assert narrow.reduction is wide.reduction and narrow.system.law is wide.system.law
    assert tight.reduction is not wide.reduction
    assert (wide.system.ring_clearance == 20e-6).all() and (narrow.system.ring_clearance == 10e-6).all()
    assert (wide.system.upper != narrow.system.upper).any()
    for model in models:
        machine = model.machine
        alone = reduce(machine.linear, layout.contacts, machine.pushes)
        for name in ("basis", "mesh_jacobian", "omega_squared", "damping", "load"):
            assert np.array_equal(getattr(alone, name), getattr(model.reduction, name)), name
