"""No argument crashes a kernel: what does not fit ends in an exception."""

import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
RECORDED = (
    "tests/unit/test_kernel_vectors.py",
    "tests/unit/test_flank_and_small_kernels.py",
    "tests/unit/bearings/test_rolling_response.py",
    "tests/unit/contact/test_contact_kernels.py",
    "tests/unit/contact/test_contact_solver.py",
    "tests/unit/contact/test_contact_candidates.py",
    "--deselect=tests/unit/contact/test_contact_candidates.py::test_screening_by_coarse_probes_loses_no_hat",
    "tests/unit/meshing/test_linear_law.py",
    "tests/unit/motion/test_motion_kernels.py",
    "tests/unit/motion/test_load_dependent_motion.py",
    "tests/unit/motion/test_dynamics_convergence.py",
    "tests/unit/motion/test_moving_places.py",
)
CALLS = 150
"""Changed calls of each kernel; `python -m validation.kernels_fuzz` makes more of them."""


def test_changed_arguments_end_in_answers_or_exceptions_and_never_in_a_crash(tmp_path):
    log = tmp_path / "last_call"
    done = subprocess.run(
        [sys.executable, "-m", "validation.kernels_fuzz", str(CALLS), "51", str(log), *RECORDED],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    last = log.read_text() if log.exists() else "nothing was called"
    assert done.returncode == 0, f"{last}{done.stdout[-2000:]}{done.stderr[-2000:]}"
    counts = json.loads(done.stdout.splitlines()[-1])
    assert all(one["recorded"] for one in counts.values()), counts
    assert all(one["raised"] for one in counts.values()), counts
