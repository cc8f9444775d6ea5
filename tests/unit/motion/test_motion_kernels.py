"""The kernels of motion refuse arrays that do not fit, and read nothing beyond their ends."""

import signal
import subprocess
import sys

import numpy as np
import pytest
from oscillators import backlash_oscillator, mathieu, meissner
from test_bending_gears import machine as bending_gears

from facegear._kernels import motion
from facegear.errors import NotConverged
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import make_runner, packed_system
from facegear.motion.steady_state.simulate import build_model


def of_system(**changes):
    """Arguments of a system of two coordinates, three contacts and nothing else."""
    return {
        "jacobian": np.ones((3, 2)),
        **dict.fromkeys(("omega_squared", "damping", "weights"), np.ones(2)),
        **dict.fromkeys(("mesh_damping", "lower", "upper", "leverage"), np.zeros(3)),
        "law": motion.linear_law(np.ones((1, 2, 2)), np.zeros(3, int), np.zeros(0), np.zeros((0, 0, 3))),
        "error": np.zeros((1, 2, 1)),
        "error_kind": np.zeros(3, int),
        "load": np.zeros((2, 2, 1)),
        "damping_when_open": True,
        "push_only": False,
        "pairs": 0,
        "scale": 1.0,
        **dict.fromkeys(("ring_stiffness", "ring_clearance"), np.zeros(0)),
        "ring_lag": 0.0,
        "rubbing_flank": np.zeros(0, int),
        "rubbing_ratios": np.zeros((0, 2, 1)),
        "rubbing_directions": np.zeros((0, 2)),
        "coupling": np.zeros((0, 2, 2)),
        **changes,
    }


BAD = {
    "jacobian": [np.ones((0, 2)), np.ones((3, 0)), np.ones(3), np.ones((4, 2))],
    "omega_squared": [np.ones(3), np.ones((2, 1)), np.ones(2, complex)],
    "lower": [np.zeros(2), np.zeros(0)],
    "law": [None, motion.power_law(np.ones((1, 2, 1)), 1.0, 1.5, 1e-3, 2)],
    "error": [np.zeros((1, 3, 1)), np.zeros((1, 2, 0)), np.zeros((0, 2, 1))],
    "error_kind": [np.zeros(2, int), np.ones(3, int), -np.ones(3, int)],
    "load": [np.zeros((3, 2, 1)), np.zeros((2, 2))],
    "pairs": [2, -1],
    "ring_stiffness": [np.ones(1)],
    "rubbing_flank": [np.zeros(1, int)],
    "rubbing_directions": [np.zeros((1, 2))],
    "coupling": [np.zeros((4, 2, 3)), np.zeros((3, 2, 2))],
}


@pytest.mark.parametrize(
    ("name", "number"), [(name, i) for name, all_ in BAD.items() for i in range(len(all_))]
)
def test_a_system_whose_arrays_do_not_fit_is_refused(name, number):
    assert isinstance(motion.system(**of_system()), motion.System)
    with pytest.raises((TypeError, ValueError)):
        motion.system(**of_system(**{name: BAD[name][number]}))


@pytest.mark.parametrize(
    ("make", "arrays"),
    [
        (motion.linear_law, (np.ones((1, 2, 0)), np.zeros(1, int), np.zeros(0), np.zeros((0, 0, 1)))),
        (motion.linear_law, (np.ones((1, 2, 1)), np.ones(1, int), np.zeros(0), np.zeros((0, 0, 1)))),
        (motion.linear_law, (np.ones((1, 2, 1)), np.zeros(1, int), np.array([0.0, 1.0]), np.ones((1, 2, 1)))),
        (motion.linear_law, (np.ones((1, 2, 1)), np.zeros(1, int), np.array([0.0, 7.0]), np.ones((2, 2, 1)))),
        (motion.load_dependent_law, (np.ones((1, 0, 1, 2, 4)), np.ones((1, 0)), np.zeros(1, int))),
        (motion.load_dependent_law, (np.ones((1, 2, 1, 2, 4)), np.ones((1, 3)), np.zeros(1, int))),
        (motion.load_dependent_law, (np.ones((1, 2, 1, 2, 4)), np.ones((1, 2)), np.full(1, 2))),
        (motion.power_law, (np.ones((1, 2, 1)), 1.0, 0.5, 1e-3, 1)),
    ],
)
def test_a_law_whose_arrays_do_not_fit_is_refused(make, arrays):
    with pytest.raises((TypeError, ValueError)):
        make(*arrays)


def of_run(integrator, **changes):
    n, m = integrator.size, integrator.rows
    return {
        "starts": np.zeros((1, 2, n)),
        "periods": np.ones(1, int),
        "tangents": np.zeros((1, 0, 2, n)),
        "longest": np.full(1, np.inf),
        "begin": 0.0,
        "drift": np.zeros((0, m)),
        **dict.fromkeys(("samples", "batches", "kept", "steps", "turns"), 0),
        **dict.fromkeys(("growth", "fine"), False),
        **changes,
    }


@pytest.mark.parametrize(
    "change",
    [
        {"starts": np.zeros((1, 2, 2))},
        {"starts": np.zeros((2, 2, 1))},
        {"periods": np.zeros(1, int)},
        {"periods": np.ones(2, int)},
        {"tangents": np.zeros((1, 1, 2, 2))},
        {"longest": np.zeros(1)},
        {"longest": np.full(1, np.nan)},
        {"drift": np.zeros((1, 2))},
        {"drift": np.zeros((90, 1))},
        {"begin": 7.0},
        {"begin": 1.0, "samples": 4},
        {"growth": True},
        {"batches": 2},
        {"samples": -1},
        {"kept": -1},
        {"periods": np.full(1, 2**40), "samples": 2**31},
        {"turns": 2**62},
        {"steps": 2**62},
    ],
)
def test_a_run_that_is_asked_for_what_does_not_fit_is_refused(change):
    integrator = Integrator(backlash_oscillator(0.75), 0.75)
    motion.run(integrator.work, [integrator.machine], **of_run(integrator))
    with pytest.raises((TypeError, ValueError, MemoryError)):
        motion.run(integrator.work, [integrator.machine], **of_run(integrator, **change))


STOPPED = """
import signal, sys
sys.path[:0] = {path!r}
import numpy as np
from oscillators import backlash_oscillator
from test_motion_kernels import of_run
from facegear._kernels import motion
from facegear.motion.integrator.integrator import Integrator

integrator = Integrator(backlash_oscillator(0.75), 0.75)
signal.signal(signal.SIGALRM, signal.default_int_handler)
signal.setitimer(signal.ITIMER_REAL, 0.2)
try:
    motion.run(integrator.work, [integrator.machine], **of_run(integrator, periods=np.full(1, 2**40)))
except KeyboardInterrupt:
    motion.run(integrator.work, [integrator.machine], **of_run(integrator))
    print("stopped, and ran once more")
"""
"""A run of a million million periods, and the signal that Python's handler of Ctrl-C answers."""


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="this system has no interval timer")
def test_ctrl_c_ends_a_run_of_any_length_and_leaves_its_runner_usable():
    code = STOPPED.format(path=[path for path in sys.path if path])
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stdout == "stopped, and ran once more\n", done.stderr


def test_machines_of_another_structure_do_not_fit_a_runner():
    one, other = Integrator(backlash_oscillator(0.75), 0.75), Integrator(meissner(0.05), 0.8)
    bent = build_model(bending_gears()).system
    assert not packed_system(one.system).fits(packed_system(other.system))
    assert packed_system(bent).fits(packed_system(build_model(bending_gears(torque=100.0)).system))
    with pytest.raises(ValueError, match="structure"):
        motion.run(one.work, [other.machine], **of_run(one))


@pytest.mark.parametrize("order", [2, 200])
def test_an_order_that_steps_cannot_have_is_refused(order):
    with pytest.raises(ValueError, match="order"):
        make_runner(backlash_oscillator(0.75), order)


def test_a_motion_that_only_grows_ends_before_its_steps_become_many():
    """The load-free Mathieu oscillator in its first parametric resonance."""
    integrator = Integrator(mathieu(0.8), 2.0, 1e-14)
    with pytest.raises(NotConverged, match="beyond all bounds"):
        integrator.run(np.array([[1.0], [0.0]]), 10**6)
