"""Without an extra the core goes on working, and what needs it says which one in one line."""

import os
import sys

import pytest
from forked_python import run_together

import facegear
from facegear import __main__ as command_line

SOURCES = "in the folder of facegear's sources)"
MEAN = {"mesh_stiffness.mesh_law": "constant_load", "modal.stiffness": "average"}
"""Values with which modes take no contact."""


def message(module, call):
    """Return the message of a call in a process without the package, in which `module` cannot be imported."""
    script = f"""
import sys
sys.modules[{module!r}] = None
import facegear
from facegear.errors import MissingExtra
gearbox = facegear.example()
try:
    {call}
except MissingExtra as error:
    print(error)
"""
    (done,) = run_together([script], {"PYTHONPATH": os.pathsep.join(sys.path)})
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_a_machine_of_given_stiffness_is_answered_without_any_extra():
    """Statics asked for finite elements once, as a module held stages of contact beside others."""
    script = """
import sys
from facegear.errors import EXTRAS
for library in set(EXTRAS) - {"pyarrow"}:  # pandas holds it in the process that is forked
    sys.modules[library] = None
import facegear
gearbox = facegear.load("config/harmonics_only.yaml", None)
for name in ("modes", "statics", "response", "load_sharing", "sensitivity", "hunting"):
    getattr(gearbox, name)()
pair = facegear.load("config/teeth_only.yaml", None)
pair.geometry(), pair.topography()
print("answered")
"""
    (done,) = run_together([script], {"PYTHONPATH": os.pathsep.join(sys.path)})
    assert done.stdout.strip() == "answered", done.stderr


@pytest.mark.parametrize("call", ["contact()", "load_sharing()"])
def test_teeth_without_finite_elements_name_the_extra(call):
    line = 'skfem is not installed; get it with: pip install ".[fe]" (' + SOURCES
    assert message("skfem", f"gearbox.{call}") == line


def test_modes_of_a_given_mean_stiffness_need_no_extra():
    assert message("skfem", f"print(len(gearbox.with_values({MEAN}).modes().table()) > 6)") == "True"


def test_a_report_without_its_template_engine_names_the_extra():
    line = 'jinja2 is not installed; get it with: pip install ".[workflow]" (' + SOURCES
    assert message("jinja2", "import facegear.report.page") == line


@pytest.mark.parametrize("missing", ["snakemake", "Snakefile"])
def test_run_says_what_it_lacks_for_single_files(tmp_path, monkeypatch, capsys, missing):
    """From the wheel it ended in the error of a missing module."""
    (tmp_path / "own.yaml").write_text("case: own\n")
    if missing == "snakemake":
        monkeypatch.setattr(command_line, "find_spec", lambda name: None)
    else:
        monkeypatch.setattr(command_line, "ROOT", tmp_path)
    assert command_line.main(("run", str(tmp_path / "own.yaml"), "-n")) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert ('pip install ".[workflow]"' if missing == "snakemake" else "from its repository") in line


def test_a_workbook_without_its_library_names_the_extra():
    line = 'openpyxl is not installed; get it with: pip install ".[excel]" (' + SOURCES
    assert message("openpyxl", f"gearbox.with_values({MEAN}).modes().to_excel('modes.xlsx')") == line


def test_a_library_of_no_extra_fails_as_python_says():
    with pytest.raises(ModuleNotFoundError, match="nowhere"), facegear.errors.extras_named():
        import nowhere  # noqa: F401
