"""The notebooks in examples/ run as they stand, from an empty folder, and still print what they show."""

import contextlib
import io
import json
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

NOTEBOOKS = sorted((Path(__file__).parents[2] / "examples").glob("*.ipynb"))


def test_there_is_a_notebook_for_each_first_question():
    names = {"tooth_contact", "own_gearbox", "speed_sweep", "load_sharing", "tolerances"}
    assert names <= {path.stem for path in NOTEBOOKS}


@pytest.mark.xdist_group("notebooks")  # they share the example's contact analysis
@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_prints_what_it_shows(notebook, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    compared = 0
    for cell in json.loads(notebook.read_text())["cells"]:
        if cell["cell_type"] != "code":
            continue
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec("".join(cell["source"]), names)
        shown = "".join(
            line for out in cell["outputs"] if out["output_type"] == "stream" for line in out["text"]
        )
        assert printed.getvalue() == shown
        compared += bool(shown)
    assert compared >= 1
    plt.close("all")
