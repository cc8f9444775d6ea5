"""Importing the figures chooses no backend: a notebook goes on showing what it draws."""

import os
import subprocess
import sys

import pytest

CODE = (
    "from facegear.report.figures import {module}; import matplotlib.pyplot as plt; print(plt.get_backend())"
)


@pytest.mark.parametrize("module", ["contact", "sharing"])
def test_a_backend_that_shows_figures_stays(module):
    environment = {**os.environ, "MPLBACKEND": "svg"}
    done = subprocess.run(
        [sys.executable, "-c", CODE.format(module=module)],
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.strip() == "svg"
