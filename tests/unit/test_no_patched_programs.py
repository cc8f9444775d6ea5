"""Programs of others are used as they come: no private names of theirs, nothing of theirs replaced."""

import re
from pathlib import Path

import pytest
from foreign import OURS, complaints, own_names

ROOT = Path(__file__).parents[2]
EXCEPTED = {
    "validation/contact/kratos_run.py": "Kratos has users override these methods of its analyses",
}
"""Files that may do so, and why. This list may only shrink."""


def read_sources(*endings: str) -> dict[str, str]:
    """Text of our files by path from the root, but for tests."""
    folders = (*OURS, ".ci")
    paths = [path for folder in folders for ending in endings for path in (ROOT / folder).rglob(f"*{ending}")]
    return {
        str(path.relative_to(ROOT)): path.read_text(encoding="utf-8")
        for path in paths
        if "tests" not in path.parts
    }


def find_complaints() -> dict[str, list[str]]:
    """Complaints by file, for files with any."""
    sources = read_sources(".py", "functions/*.smk")
    known = set().union(*map(own_names, sources.values()))
    found = {name: complaints(text, known) for name, text in sources.items()}
    return {name: lines for name, lines in found.items() if lines}


def test_no_file_uses_private_names_of_others_or_replaces_what_is_theirs():
    found = find_complaints()
    assert {name: lines for name, lines in found.items() if name not in EXCEPTED} == {}
    assert [name for name in EXCEPTED if name not in found] == []


def test_no_rule_uses_a_private_name():
    for name, text in read_sources("Snakefile", ".smk").items():
        assert re.findall(r"\._[a-z]\w*", text) == [], name


@pytest.mark.parametrize(
    "source",
    [
        "import os\nos._exit(1)",
        "import threading\nthreading._shutdown()",
        "from os import _exit",
        "import scipy.sparse._index",
        "import importlib\nwriter = importlib.import_module('snakemake').Base\nwriter._write()",
        "import importlib\nwriter = importlib.import_module('snakemake').Base\nwriter.write = print",
        "from snakemake.script import PythonScript\nPythonScript.execute_script = print",
        "from snakemake.script import PythonScript as script\nlater = script\nlater.execute_script = print",
        "def f(workflow):\n    return getattr(workflow, '_build_dag', None)",
        "def f(workflow):\n    workflow._build_dag = print",
        "def f(workflow):\n    return hasattr(workflow, 'dag._jobs')",
        "import sys\nsys.stderr = None",
        "import sys\nsys.stdout, other = None, 1",
        "import signal\nsetattr(signal, 'signal', print)",
        "import gc\ndel gc.freeze",
        "from matplotlib.axis import Axis\nfrom unittest.mock import patch\npatch.object(Axis, 'a', 1)",
        "from unittest import mock\nmock.patch('os.getcwd')",
        "from matplotlib.text import Text\n\ndef f(text: Text):\n    return text._linespacing",
    ],
)
def test_a_patch_of_another_program_is_found(source):
    assert complaints(source)


@pytest.mark.parametrize(
    "source",
    [
        "class A:\n    def __init__(self, other):\n        self._kept = other._kept",
        "from facegear.schema import load\nload._cache = 1",
        "from collections import namedtuple\nPoint = namedtuple('Point', 'x')\nPoint(1)._replace(x=2)",
        "import numpy as np\nx = np.zeros(3)\nx.shape = (3, 1)\nx[0] = 1",
        "import os\nos.environ['A'] = '1'",
        "import sys\nsys.__stderr__.flush()",
        "_private = 1\nprint('_build_dag')",
    ],
)
def test_what_is_ours_or_documented_is_left_alone(source):
    assert complaints(source, known={"_cache"}) == []
