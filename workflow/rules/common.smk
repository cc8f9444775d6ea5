import os
import re
import sys
from functools import cache
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.logging import logger

ROOT = Path(workflow.basedir)
sys.path.insert(0, str(ROOT))
os.environ.update(PYTHONPATH=str(ROOT), MPLBACKEND="Agg")
for name, module in list(sys.modules.items()):  # the profile may have imported a package installed elsewhere
    if name.partition(".")[0] == "facegear" and not Path(module.__file__).is_relative_to(ROOT):
        del sys.modules[name]

from facegear.config.cases import expand_cases
from facegear.config.load import extended, load_config
from facegear.config.notes import notes
from facegear.errors import FacegearError
from facegear.io.run_lock import hold
from facegear.machine_code import kept
from facegear.pipeline.needs import require_section, resolved_needs, shared_sources, value_at
from facegear.pipeline.rows.shared import MACHINE
from facegear.pipeline.stage import Case, From
from facegear.pipeline.table import STAGES
from paper.reproduction import read_reproduction
from facegear.provenance.fingerprint import fingerprint, recall, remember
from facegear.provenance.rebuild import rebuild_command
from workflow.process.engine import (
    before_planning,
    given_config,
    given_directory,
    run_scripts_by,
    write_parameters_without_pandas,
)
from workflow.process.forked_jobs import ForkedJobs
from workflow.process.jobs import Jobs, settle
from workflow.process.orphans import end_orphans
from workflow.process.terminal import quieten, stop_at_once

write_parameters_without_pandas()
DEFAULT_CONFIGFILE = ROOT / "config" / "paper.yaml"
CONFIGFILES = [Path(file) for file in workflow.configfiles] or [DEFAULT_CONFIGFILE]


def stop(message):
    """End before any work with the message alone, without a traceback."""
    print(message, file=sys.stderr, flush=True)
    os._exit(1)


try:
    CONFIG = load_config(CONFIGFILES, given_config(workflow))
    REPRODUCTION = read_reproduction(CONFIG.reproduction) if CONFIG.reproduction else None
    CASES = expand_cases(CONFIG)
    CASES[CONFIG.case]["reproduction"] = None  # read above; where its file lies decides nothing
except FacegearError as error:
    stop(str(error))

CASE = CONFIG.case
config["rebuild_command"] = rebuild_command(
    workflow.main_snakefile,
    workflow.configfiles,
    given_config(workflow),
    given_directory(workflow),
)


wildcard_constraints:
    case="|".join(re.escape(case) for case in CASES),


FORKED = ForkedJobs(lambda rule: MODULES.get(rule, ()), lambda rule: machine_code_of(rule))
if before_planning(workflow, FORKED.start):
    run_scripts_by(FORKED.run)
QUIET = quieten(workflow, logger)
RUN_LOCKS = []  # held until this process ends


# Only a run that is about to work comes here, no dry run, listing or report.
SOURCES = kept.folder().with_name("sources.json")
recall(SOURCES)


# Not on a dry run, which changes nothing on disk.
onstart:
    remember(SOURCES)
    RUN_LOCKS.append(hold(".snakemake/facegear.lock"))
    if RUN_LOCKS[-1] is None:
        raise WorkflowError(f"another run is working in {os.getcwd()}; wait for it or stop it first")
    try:
        orphans = end_orphans()
    except FacegearError as error:
        raise WorkflowError(str(error))
    # What there is to do was found out before: begin again from the command line.
    if settle(workflow) or orphans:
        os.execv(sys.executable, sys.orig_argv)
    logger.addHandler(Jobs(workflow))
    if any(path.is_file() for path in Path(".snakemake/incomplete").rglob("*")):
        print("resuming a run that was stopped: its unfinished jobs are made again", file=sys.stderr)
    for note in notes(CONFIG.model_dump(mode="json")):
        print(note, file=sys.stderr)
    stop_at_once(QUIET)


onsuccess:
    report = Path(f"results/{CASE}/report.html")
    print(f"done{f': {report}' if report.exists() else ''}", file=sys.stderr)


@cache
def sources(stage):
    """Of each case the one whose files of a stage it shares."""
    return shared_sources(CASES, stage)


def case_of(name):
    """A case among the cases of the config."""
    return Case(CASES[name], CASES, lambda stage, case: sources(stage)[case])


BASE = case_of(CASE)


def asked_case(stage, wildcards):
    """A case; ends the run where its config lacks the section that a stage is about."""
    try:
        require_section(stage, CASES[wildcards.case])
    except FacegearError as error:
        stop(f"{wildcards.case}: {error}")
    return case_of(wildcards.case)


def read_from(source, reader=None):
    """Function of the wildcards giving the files of an earlier stage that an argument of a reader is read from."""
    stage, several = STAGES[source.stage], source.each or STAGES[source.stage].files[source.file].each

    def files(wildcards):
        case = asked_case(reader, wildcards)
        places = source.places(case) if source.wanted(case) else []
        found = [path for place in places for path in paths({"case": wildcards.case, **place})]
        return found if several or not found else found[0]

    def paths(place):
        file = stage.files[source.file]
        texts = [{"each": text} for text in file.each(BASE)] if file.each else [{}]
        shared_by = sources(source.stage)[place["case"]]
        return [f"results/{shared_by}/{file.at({**place, **text})}" for text in texts]

    return files


def given(stage, argument):
    """Function of the wildcards giving the files that an argument of a stage is read from."""
    return read_from(STAGES[stage].upstream[argument], stage)


def needed(needs, reader=None):
    """Function of the wildcards giving values of the needs of a reader."""

    def values(wildcards):
        try:
            return resolved_needs(needs, asked_case(reader, wildcards))
        except FacegearError as error:
            stop(f"{wildcards.case}: {error}")

    return values


def value_of(key):
    """Function of the wildcards giving a value of a case's config; a dotted key reaches inside."""
    return lambda wildcards: value_at(CASES[wildcards.case], key)


def values_of(*keys, **renamed):
    """Config values as params: sections under their own names, dotted keys under the names given."""
    return {name: value_of(key) for name, key in {**dict(zip(keys, keys)), **renamed}.items()}


def sections(*keys):
    """Function of the wildcards giving these keys of a case's config, as a config of its own."""
    return lambda wildcards: {key: CASES[wildcards.case][key] for key in keys}


def shared(stage, file, **where):
    """Function of the wildcards giving a file of an earlier stage, shared by all cases alike up to it."""
    return read_from(From(stage, file, where))
