"""The notebook in examples/ runs as it stands and still prints what it shows."""

import contextlib
import io
import json
from pathlib import Path

import matplotlib
import matplotlib.pyplot as plt

NOTEBOOK = Path(__file__).parents[2] / "examples" / "load_sharing.ipynb"


def test_example_notebook_prints_what_it_shows(monkeypatch):
    matplotlib.use("Agg")
    monkeypatch.chdir(NOTEBOOK.parent)
    names: dict[str, object] = {}
    compared = 0
    for cell in json.loads(NOTEBOOK.read_text())["cells"]:
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
    assert compared == 1
    assert len(plt.gca().lines) == 3
    plt.close("all")
