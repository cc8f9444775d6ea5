"""Rules are complete, formatted and lint clean."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from projects import ROOT, Project

from facegear.config.yaml_file import read_yaml

SCRIPTS = sorted((ROOT / "workflow" / "scripts").glob("*.py"))
TOLD = """
import json

def told(rule):
    return {
        "log": list(rule.log), "benchmark": rule.benchmark, "threads": rule.resources["_cores"].value,
        "memory": "mem_mb" in rule.resources, "runtime": "runtime" in rule.resources, "message": rule.message,
        "environment": rule.conda_env, "code": rule.params.get("code"), "script": rule.script,
        "outputs": [str(file) for file in rule.output],
    }

Path("rules.json").write_text(json.dumps({rule.name: told(rule) for rule in workflow.rules if rule.output}))
"""


@pytest.fixture(scope="module")
def rules(tmp_path_factory):
    """What Snakemake knows of every rule that writes files, with the profile that loads by itself."""
    folder = tmp_path_factory.mktemp("rules")
    for name in ("workflow", "facegear", "config", "profiles"):
        (folder / name).symlink_to(ROOT / name)
    (folder / "Snakefile").write_text((ROOT / "Snakefile").read_text() + TOLD)
    Project(folder, folder).run("-n", "--quiet")
    return json.loads((folder / "rules.json").read_text())


def test_every_rule_has_log_benchmark_threads_memory_time_message_environment_and_code(rules):
    assert len(rules) >= 25
    for name, rule in rules.items():
        assert [key for key, value in rule.items() if not value] == [], name
        assert any(file.endswith(".provenance.json") for file in rule["outputs"]), name


def test_rules_share_no_log_and_no_benchmark(rules):
    for key in ("log", "benchmark"):
        assert len({str(rule[key]) for rule in rules.values()}) == len(rules)


def test_every_script_has_the_name_of_its_rule(rules):
    assert {name: Path(rule["script"]).stem for name, rule in rules.items()} == {name: name for name in rules}
    assert sorted(rules) == [script.stem for script in SCRIPTS]


def test_the_profile_names_rules_that_exist(rules):
    profile = read_yaml(ROOT / "workflow" / "profiles" / "default" / "config.yaml")
    assert set(profile["set-threads"]) | set(profile["set-resources"]) <= set(rules)
    assert {name for name, rule in rules.items() if rule["threads"] > 1} == set(profile["set-threads"])


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
    for script in SCRIPTS:
        text = script.read_text()
        assert len(text.splitlines()) <= 45, script
        assert "with stage(snakemake)" in text, script
