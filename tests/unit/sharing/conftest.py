from pathlib import Path

import numpy as np
import pytest

from facegear.build.load import load_config
from facegear.build.machine import MachineInputs
from facegear.harmonics import Harmonics

CONFIG = Path(__file__).parents[3] / "config" / "paper.yaml"
MEAN = 4.1e8


@pytest.fixture(scope="session")
def paper_machine():
    """The paper's machine with a made-up mesh stiffness of 10 % and 3 % harmonics."""
    values = load_config(CONFIG).model_dump(mode="json")
    stiffness = Harmonics(MEAN * np.array([0.0, 0.1, 0.0]), MEAN * np.array([1.0, 0.0, 0.03]))
    return MachineInputs.of_config(values, stiffness).build()
