"""Rules are complete, formatted and lint clean."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
RULE_FILES = sorted((ROOT / "workflow" / "rules").glob("*.smk"))
RULES = [
    (path.name, *match)
    for path in RULE_FILES
    for match in re.findall(r"^rule (\w+):\n((?:    .*\n|\n)+)", path.read_text() + "\n", re.M)
]


@pytest.mark.parametrize(("file", "name", "body"), RULES, ids=[f"{rule[0]}:{rule[1]}" for rule in RULES])
def test_rule_has_log_benchmark_threads_memory_and_runtime(file, name, body):
    if "output:" not in body:
        return
    missing = [
        key
        for key in ("log:", "benchmark:", "threads:", "mem_mb=", "runtime=", "message:", "code=")
        if key not in body
    ]
    assert missing == []
    assert ".provenance.json" in body


def test_rules_are_formatted():
    command = [sys.executable, "-m", "snakefmt", "--check", "Snakefile", "workflow"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_snakemake_lint_is_clean(tmp_path):
    command = [sys.executable, "-m", "snakemake", "--lint", "--snakefile", str(ROOT / "Snakefile")]
    done = subprocess.run(
        [*command, "--directory", str(tmp_path)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "Congratulations" in done.stdout + done.stderr


def test_scripts_only_adapt():
    for script in (ROOT / "workflow" / "scripts").glob("*.py"):
        text = script.read_text()
        assert len(text.splitlines()) <= 45, script
        assert "with stage(snakemake)" in text, script
