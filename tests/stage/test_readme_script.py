"""The README's first script does what it says, from a folder that holds nothing."""

import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text()
(SCRIPT,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)


def test_readme_script_has_at_most_twelve_lines_and_stands_on_the_first_screen():
    assert len([line for line in SCRIPT.splitlines() if line]) <= 12
    assert README.index(SCRIPT) < 2500


def test_readme_script_runs_in_an_empty_folder(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "rigid body" in done.stdout
    pictures = {path.name: path.read_bytes()[:4] for path in tmp_path.iterdir()}
    assert pictures == dict.fromkeys(("contact_pattern.png", "load_sharing.png"), b"\x89PNG")
