"""The kernels compiled once for all processes that start together."""

import fcntl
import hashlib
import sys
from functools import cache
from pathlib import Path

import numpy as np

from facegear.dynamics.integrator.compiled import TAU, pack
from facegear.dynamics.integrator.periods import disturbance_step, make_log, run_periods
from facegear.dynamics.integrator.system import System
from facegear.dynamics.integrator.work import make_work


@cache
def prepare(play: bool = False) -> None:
    """Load the stored machine code of the time integration, or compile and store it while others wait.

    play: that of machines with play in their bearings. Without this, jobs that start at once on a fresh
    checkout each compile the same for several seconds.
    """
    folder = Path(run_periods._cache.cache_path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with open(folder / "compiling.lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            _compile(folder / f"compiled-{_text()[:16]}{'-play' if play else ''}", play)
    except OSError:
        # A folder that cannot be written keeps no machine code either: each process compiles its own.
        return


def _text() -> str:
    """Hash of all that is compiled."""
    sources = sorted(Path(make_work.__code__.co_filename).parent.glob("*.py"))
    return hashlib.sha256(b"".join(path.read_bytes() for path in sources)).hexdigest()


def _compile(done: Path, play: bool) -> None:
    if not done.exists():
        print("compiling the time integration once, some 15 s", file=sys.stderr, flush=True)
    packed = pack(_smallest(play), 1.0)
    work = make_work(packed, 6)
    state, none = np.zeros((2, 4)), np.zeros((0, 2, 4))
    run_periods(packed, work, state[0], state[1], none, 1, 0, 1e-2, make_log(packed, 1), TAU)
    disturbance_step(packed, 6, 1e-2)
    done.touch()


def _smallest(play: bool) -> System:
    """One coordinate and one mesh, with a ring or without: the types are those of any such machine."""
    rings = np.ones(int(play))
    one, rows, nothing = np.ones(1), np.ones(1 + 3 * rings.size), np.zeros((1, 2, 1))
    kinds = np.zeros(rows.size, dtype=np.int64)
    return System(
        mesh_jacobian=rows[:, None],
        omega_squared=one,
        damping=one,
        mesh_damping=rows,
        lower=-rows,
        upper=rows,
        stiffness=nothing + 1.0,
        stiffness_kind=kinds,
        error=nothing,
        error_kind=kinds,
        load=nothing,
        ring_stiffness=rings,
        ring_play=rings,
        damping_when_open=True,
        scale=1.0,
    )
