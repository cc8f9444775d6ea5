"""The table of stages is whole: every file once, every argument from somewhere, every page in step."""

import inspect
import re
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path

import pytest

import facegear
from facegear.build.cases import expand_cases
from facegear.build.load import load_config
from facegear.build.machine import MachineInputs
from facegear.pipeline.arguments import typed_arguments
from facegear.pipeline.needs import resolved_needs, stage_needs, stages_before
from facegear.pipeline.provenance.fingerprint import reached_functions
from facegear.pipeline.report_tables import REPORT_TABLES, table_name
from facegear.pipeline.stage import FIGURES, Case, load
from facegear.pipeline.table import STAGES, listing
from facegear.report.chapter_tables import SHAFT_TABLES

ROOT = Path(__file__).parents[3]
DRAWN = [stage for stage in STAGES.values() if stage.figures]
RESUMED = {"partial", "code"}
MACHINE_FIELDS = {field.name for field in fields(MachineInputs)}
"""Arguments of a stage that goes on where it was killed."""


def arguments(reference):
    """Names that a function asks for, those it may be given, and whether it passes others on."""
    given = inspect.signature(load(reference)).parameters.values()
    named = [one for one in given if one.kind is not one.VAR_KEYWORD]
    needed = {one.name for one in named if one.default is one.empty}
    return needed, {one.name for one in named}, len(named) < len(given)


def accepts(reference, offered, optional=frozenset()):
    needed, known, passes_on = arguments(reference)
    missing = needed - (offered - optional)
    return not missing and (passes_on or offered <= known)


def test_every_file_of_every_rule_is_declared_once():
    stages = [path for stage in STAGES.values() for path in (stage.manifest, *paths(stage))]
    figures = [name for stage in DRAWN if not callable(stage.figures.names) for name in stage.figures.names]
    assert len(set(stages)) == len(stages) and len(set(figures)) == len(figures)


@pytest.mark.parametrize("stage", STAGES.values(), ids=lambda stage: stage.name)
def test_sections_of_the_config_reach_a_stage_as_objects(stage):
    cases = expand_cases(load_config("config/concentric.yaml"))
    plain = resolved_needs(stage.needs, Case(cases["concentric"], cases))
    function = load(stage.function)
    passes_on = arguments(stage.function)[2]  # machines among many: keys of a section are changed by name
    if stage.machine:
        section = {name: value for name, value in plain.items() if name in MACHINE_FIELDS}
        inputs = MachineInputs(**typed_arguments(MachineInputs, section))
        assert not isinstance(inputs.transmission, Mapping) and not isinstance(inputs.teeth, Mapping)
        plain = {name: value for name, value in plain.items() if name not in section}
    for name, value in typed_arguments(function, plain).items():
        assert passes_on or not isinstance(value, Mapping), name


def paths(stage):
    return [file.path for file in stage.files.values()]


@pytest.mark.parametrize("stage", STAGES.values(), ids=lambda stage: stage.name)
def test_a_stage_is_given_what_its_function_asks_for(stage):
    optional = {name for name, source in stage.upstream.items() if source.when}
    offered = {*stage.needs, *stage.upstream, *stage.wildcards, *(RESUMED if stage.resumable else ())}
    assert len(offered) == len(stage.needs) + len(stage.upstream) + len(stage.wildcards) + (
        2 if stage.resumable else 0
    )
    if stage.machine:
        assert {"transmission", "teeth", "harmonics"} <= offered
        offered = (offered - MACHINE_FIELDS) | {stage.machine}
    assert accepts(stage.function, offered, optional - MACHINE_FIELDS)


@pytest.mark.parametrize("stage", DRAWN, ids=lambda stage: stage.name)
def test_figures_are_given_what_their_function_asks_for(stage):
    assert accepts(stage.figures.draw, {*stage.figures.needs, *stage.figures.upstream})


def test_what_is_taken_from_a_stage_is_a_file_of_it_that_is_read_again_and_stands_before():
    order = list(STAGES)
    for stage in STAGES.values():
        for source in stage.upstream.values():
            assert order.index(source.stage) < order.index(stage.name), (stage.name, source)
        drawn = stage.figures.upstream if stage.figures else {}
        for source in (*stage.upstream.values(), *drawn.values()):
            file = STAGES[source.stage].files[source.file]
            assert file.readable or file.each_text, (stage.name, source)
            assert source.each_wildcards or set(source.wildcards) == set(STAGES[source.stage].wildcards)


def test_the_files_of_a_stage_lie_beside_its_manifest_and_hold_its_wildcards():
    """Readers look for the manifest in the folder of a file."""
    for stage in STAGES.values():
        assert {str(Path(path).parent) for path in paths(stage)} <= {str(Path(stage.manifest).parent)}
        for path in (stage.manifest, *paths(stage)):
            assert all(f"{{{name}}}" in path for name in stage.wildcards)


def test_columns_and_views_that_are_named_exist():
    for stage in STAGES.values():
        for name, file in stage.files.items():
            if isinstance(file.holds, str):
                assert load(file.holds), name
            if file.view:
                assert callable(load(file.view)) and file.of in stage.files


STAGE_CODE = ("facegear.pipeline.stages", "facegear.pipeline.outcome")
"""Modules of the pipeline that belong to the code of a stage."""


@pytest.mark.parametrize("stage", STAGES.values(), ids=lambda stage: stage.name)
def test_no_stage_is_made_again_because_the_table_got_another_row(stage):
    """Its fingerprint holds neither the table nor what only rules and the door need."""
    reached = reached_functions(stage.functions, ROOT)
    assert reached
    others = {name for name in reached if name.startswith("facegear.pipeline.")}
    assert not {name for name in others if not name.startswith(STAGE_CODE)}


def test_each_figure_has_one_chapter_with_a_caption():
    captions = {path.stem for path in (ROOT / "workflow" / "report").glob("*.rst")}
    assert {stage.figures.chapter for stage in DRAWN} == captions
    assert not any(name.endswith(FIGURES) for name in STAGES)


def test_what_a_stage_depends_on_reaches_back_to_the_teeth():
    values = facegear.example().values
    assert set(stages_before("load_sharing", values)) == {
        "load_sharing",
        "stiffness",
        "mesh_law",
        "contact",
        "compliance",
    }


def test_the_page_shows_the_table_as_it_is():
    """Renewed by `python -m facegear.pipeline.table`."""
    assert listing() in (ROOT / "docs" / "reference" / "stages.md").read_text()


def test_the_report_is_given_every_table_that_its_chapters_read():
    reported = [STAGES[stage].files[file] for stage, files in REPORT_TABLES.items() for file in files]
    stems = [table_name(file.path) for file in reported]
    assert len(set(stems)) == len(stems)
    sources = [path.read_text() for path in (ROOT / "facegear/report").glob("*.py")]
    read = {name for text in sources for name in re.findall(r'\btables\["(\w+)"\]', text)}
    read |= set(SHAFT_TABLES)
    assert len(read) > 20
    assert read <= {*stems, "duty_loads", "scorecard"}


def test_the_limit_of_load_sharing_makes_no_stage_run_again():
    """It only judges; the dynamics took minutes again."""
    values = facegear.example().values
    limited = facegear.example().with_values({"load_sharing.required_k_gamma": 1.3}).values
    assert limited["load_sharing"]["required_k_gamma"] == 1.3
    for name in ("load_sharing", "load_sharing_reference"):
        assert stage_needs(name, values) == stage_needs(name, limited)
