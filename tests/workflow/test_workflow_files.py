"""Rules are complete, take what they use, and are formatted and lint clean."""

import ast
import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from projects import ROOT, SCRIPTS, Project, copy_sources, dry_run

from facegear.build.load import load_config
from facegear.pipeline.stage import FIGURES
from facegear.pipeline.table import STAGES as TABLE
from facegear.report.machine import inputs_in_words
from facegear.schema.yaml_file import read_yaml

pytestmark = pytest.mark.xdist_group("workflow_files")
STAGES = sorted((ROOT / "facegear" / "pipeline" / "stages").glob("*.py"))
RULES_AS_JSON = """
import json
from types import SimpleNamespace

def record(rule):
    values = rule.params.get("values")
    return {
        "log": list(rule.log), "benchmark": rule.benchmark, "threads": rule.resources["_cores"].value,
        "memory": "mem_mb" in rule.resources, "runtime": "runtime" in rule.resources,
        "docstring": rule.docstring,
        "environment": rule.conda_env, "code": rule.params["code"](None), "script": rule.script,
        "outputs": [str(file) for file in rule.output],
        "taken": [list(rule.input.keys()), sorted({*rule.params.keys()} - {"code"})],
        "sections": [*values(SimpleNamespace(case=CASE))] if values else ["none"],
    }

Path("rules.json").write_text(json.dumps({rule.name: record(rule) for rule in workflow.rules if rule.output}))
"""


@pytest.fixture(scope="module")
def rules(tmp_path_factory):
    """Return Snakemake's attributes of every rule that writes files, with the profile that is the default."""
    folder = tmp_path_factory.mktemp("rules")
    sources = copy_sources(folder)
    with open(sources / "workflow" / "Snakefile", "a") as stream:
        stream.write(RULES_AS_JSON)
    Project(folder, sources).run("-n", "--quiet")
    return json.loads((folder / "rules.json").read_text())


def test_every_rule_has_log_benchmark_threads_memory_time_docstring_environment_and_code(rules):
    assert len(rules) >= 25
    for name, rule in rules.items():
        assert [key for key, value in rule.items() if not value] == [], name
        assert any(file.endswith(".provenance.json") for file in rule["outputs"]), name


def test_rules_share_no_log_and_no_benchmark(rules):
    for key in ("log", "benchmark"):
        assert len({str(rule[key]) for rule in rules.values()}) == len(rules)


def of_stages(rules):
    """Rules of the table of stages: one for each stage, and one for some cases of studies."""
    studied = {name for name in rules if re.search(r"_studies_\d+$", name)}
    assert studied, "the paper's case has studies"
    return set(TABLE) | studied


def test_stages_and_figures_have_one_script_each_and_every_other_rule_one_of_its_name(rules):
    used = {name: Path(rule["script"]).stem for name, rule in rules.items()}
    shared = {"stage": of_stages(rules), "figures": {name for name in used if name.endswith(FIGURES)}}
    for script, names in shared.items():
        assert {name for name, stem in used.items() if stem == script} == names
    own = set(used) - set().union(*shared.values())
    assert {used[name] for name in own} == own
    assert sorted(script.stem for script in SCRIPTS) == sorted({*own, *shared})


def test_no_two_rules_write_the_same_file(rules):
    written = [file for rule in rules.values() for file in rule["outputs"]]
    assert len(set(written)) == len(written)


def test_every_input_and_parameter_of_a_rule_is_used_by_its_script(rules):
    """Names in a script are attributes or texts in it; scripts that take all by `items()` name none."""
    for name in set(rules) - of_stages(rules) - {name for name in rules if name.endswith(FIGURES)}:
        rule = rules[name]
        words = {word for node in ast.walk(_script(name)) for word in _words(node)}
        inputs, parameters = rule["taken"]
        assert set(parameters) <= words, name
        assert set(inputs) <= words or "items" in words, name


def test_no_script_reads_a_file_and_drops_what_it_read():
    for script in SCRIPTS:
        for node in ast.walk(ast.parse(script.read_text())):
            if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
                assert "read" not in _words(node.value.func), script


def test_every_stage_uses_all_that_it_is_given():
    functions = [node for path in STAGES for node in ast.parse(path.read_text()).body]
    for function in (node for node in functions if isinstance(node, ast.FunctionDef)):
        read = {node.id for node in ast.walk(function) if isinstance(node, ast.Name)}
        assert {argument.arg for argument in function.args.args} <= read, function.name


def test_no_rule_is_handed_the_whole_config(rules):
    whole = set(load_config(ROOT / "config" / "paper.yaml").model_dump(mode="json"))
    for name, rule in rules.items():
        assert set(rule["sections"]) < whole | {"none"}, name


def test_the_scorecard_is_handed_the_sections_that_its_caption_tells_of(rules):
    read = set()

    class Recorded(dict):
        def __getitem__(self, key):
            read.add(key)
            return super().__getitem__(key)

    inputs_in_words(Recorded(load_config(ROOT / "config" / "paper.yaml").model_dump(mode="json")))
    assert set(rules["scorecard"]["sections"]) == read


def _script(name):
    (script,) = [script for script in SCRIPTS if script.stem == name]
    return ast.parse(script.read_text())


def _words(node):
    """Attribute names and texts at a node."""
    if isinstance(node, ast.Attribute):
        return {node.attr}
    return {node.value} if isinstance(node, ast.Constant) else set()


def test_every_profile_says_what_the_one_says_that_loads_by_itself():
    folder = ROOT / "workflow" / "profiles"
    default, *others = (read_yaml(folder / name / "config.yaml") for name in ("default", "local", "slurm"))
    for other in others:
        assert {key: other[key] for key in default} == default


def test_rules_are_formatted():
    folders = ("workflow/Snakefile", "workflow", "paper", "validation")
    command = [sys.executable, "-m", "snakefmt", "--check", *folders]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_snakemake_lint_is_clean(tmp_path):
    done = Project(tmp_path).run("--lint", check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "Congratulations" in done.stdout + done.stderr


def test_the_picture_of_the_rules_shows_the_rules_of_today(tmp_path):
    """`snakemake --cores 2 --rulegraph dot | dot -Tsvg > docs/img/rules.svg` renews it."""
    graph = Project(tmp_path).run("--rulegraph", "dot").stdout
    drawn = re.findall(r"<text [^>]*>(\w+)</text>", (ROOT / "docs" / "img" / "rules.svg").read_text())
    assert sorted(drawn) == sorted(re.findall(r'\[label = "(\w+)"', graph)) != []


def test_scripts_only_adapt():
    for script in SCRIPTS:
        text = script.read_text()
        assert len(text.splitlines()) <= 45, script
        assert "with stage(snakemake)" in text or "with job(snakemake)" in text, script


def test_every_file_of_a_rule_lies_beside_a_manifest(rules):
    """Readers look for the manifest in the folder of a file: one that drew elsewhere stopped the report."""
    for name in {*of_stages(rules), "report", "scorecard", *(n for n in rules if n.endswith(FIGURES))}:
        files = rules[name]["outputs"]
        covered = {Path(file).parent for file in files if file.endswith(".provenance.json")}
        assert {Path(file).parent for file in files} == covered


def test_figures_are_one_job_for_each_chapter_of_the_report(rules):
    drawn = {name.removesuffix(FIGURES) for name in rules if name.endswith(FIGURES)}
    assert drawn == {"teeth", "contact", "mesh_stiffness", "modes", "dynamics", "load_sharing"}


def test_the_paper_s_case_is_at_most_28_jobs():
    planned = dry_run()
    assert int(re.search(r"^total +(\d+)$", planned.stdout + planned.stderr, re.M)[1]) <= 28


def test_the_repository_has_what_the_workflow_catalog_asks_for():
    usage = read_yaml(ROOT / ".snakemake-workflow-catalog.yml")["usage"]
    assert usage["software-stack-deployment"]["conda"]
    assert (ROOT / "workflow" / "Snakefile").is_file() and (ROOT / "config" / "README.md").is_file()
