"""The answers of the quick case are those that the package stores."""

import subprocess
import sys

from projects import ROOT

RENEW = (
    "where this is meant: python -m facegear.report.compare.answers current results/quick (CONTRIBUTING.md)"
)


def test_the_quick_case_gives_the_stored_answers(quick):
    results = quick.folder / "results" / "quick"
    command = [sys.executable, "-m", "facegear", "compare", "current/quick", str(results)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{done.stdout[-5000:]}\n{done.stderr[-2000:]}\n{RENEW}"
