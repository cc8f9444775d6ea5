"""Packages that `.ci/run` installs on a new machine; a few small scripts stand in for Debian."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / ".ci" / "run"
PLAYED = {
    "id": "echo 0",
    "sleep": "true",
    "python3": '[ -e "$STATE/libglu1-mesa" ]',
    "make": 'echo "make $*"',
    "dpkg": '[ -e "$STATE/locked" ] || rm -f "$STATE/interrupted"',
    "apt-get": """
if [ -e "$STATE/locked" ]; then rm "$STATE/locked"; echo "E: Could not get lock" >&2; exit 100; fi
case " $* " in *" update "*) exit 0;; esac
if [ -e "$STATE/interrupted" ]; then echo "E: dpkg was interrupted" >&2; exit 100; fi
for word; do
    case "$word" in
        g++ | calculix-ccx | chromium | slurm-wlm) [ ! -e "$STATE/absent" ] || exit 100;;
    esac
    case "$word" in
        g++) set -- g++;;
        calculix-ccx) set -- ccx;;
        chromium) set -- chromium;;
        slurm-wlm) set -- slurmctld slurmd sbatch munged;;
        libglu1-mesa) : > "$STATE/$word"; continue;;
        *) continue;;
    esac
    for program; do printf '#!/bin/sh\n' > "$PLAYED/$program"; chmod +x "$PLAYED/$program"; done
done
""",
}
"""A folder of programs stands for the machine; files of these names in $STATE say what is wrong with it."""


@pytest.fixture
def ci(tmp_path):
    """Runs the script on a machine with some programs and something wrong.

    Returns its lines, and what the machine then has.
    """
    programs, state = tmp_path / "programs", tmp_path / "state"
    programs.mkdir()
    state.mkdir()
    for name in ("dirname", "rm", "chmod"):
        (programs / name).symlink_to(str(shutil.which(name)))

    def run(*wrong, programs_there=()):
        for name in wrong:
            (state / name).touch()
        for name, text in {**PLAYED, **dict.fromkeys(programs_there, "")}.items():
            (programs / name).write_text(f"#!/bin/sh\n{text}\n")
            (programs / name).chmod(0o755)
        done = subprocess.run(
            [str(shutil.which("bash")), str(SCRIPT)],
            env={"PATH": str(programs), "STATE": str(state), "PLAYED": str(programs)},
            capture_output=True,
            text=True,
            check=True,
        )
        return done.stdout.splitlines(), {*os.listdir(programs), *os.listdir(state)}

    return run


@pytest.mark.parametrize("wrong", [(), ("interrupted",), ("locked",), ("interrupted", "locked")])
def test_a_machine_gets_what_it_lacks_whatever_became_of_its_last_installation(ci, wrong):
    """After a killed apt-get, `dpkg was interrupted` left CI without Slurm, and its tests were skipped."""
    printed, found = ci(*wrong)
    assert printed == ["make ci"]
    assert {"libglu1-mesa", "g++", "ccx", "chromium", "slurmctld", "slurmd", "munged"} <= found


def test_half_a_slurm_is_completed(ci):
    assert "slurmd" in ci(programs_there=["slurmctld", "munged"])[1]


def test_a_machine_with_clang_gets_no_second_compiler(ci):
    assert "g++" not in ci(programs_there=["clang++"])[1]


def test_without_the_packages_the_checks_run_and_say_what_is_skipped(ci):
    printed, found = ci("absent")
    assert printed[-1] == "make ci" and "libglu1-mesa" in found
    assert [line.split()[0] for line in printed[:-1]] == ["A", "CalculiX", "Chromium", "Slurm"]
