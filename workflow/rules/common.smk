import os
import re
import sys
from functools import cache
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.persistence import PersistenceBase

ROOT = Path(workflow.basedir)
sys.path.insert(0, str(ROOT))
os.environ.update(PYTHONPATH=str(ROOT), MPLBACKEND="Agg")

from facegear.config.cases import expand_cases, shared_sources
from facegear.config.load import load_values
from facegear.config.needs import NEEDS, loads_from_machine, many_contacts, stage_needs
from facegear.config.notes import notes, turns
from facegear.errors import FacegearError
from facegear.io.run_lock import hold
from paper.reproduction import read_reproduction
from facegear.provenance.fingerprint import fingerprint, recall, remember

if hasattr(PersistenceBase, "_serialize_param_builtin"):
    # Snakemake imports pandas, 0.5 s of every start, only to ask whether a parameter is a table; none is here.
    PersistenceBase._serialize_param = PersistenceBase._serialize_param_builtin

DEFAULT_CONFIGFILE = ROOT / "config" / "paper.yaml"
CONFIGFILES = [Path(file) for file in workflow.configfiles] or [DEFAULT_CONFIGFILE]


def stop(message):
    """End before any work with the message alone, without a traceback."""
    print(message, file=sys.stderr, flush=True)
    os._exit(1)


try:
    CONFIG = load_values(CONFIGFILES, workflow.config_settings.config)
    REPRODUCTION = read_reproduction(CONFIG["reproduction"]) if CONFIG["reproduction"] else None
    CASES = expand_cases(CONFIG)
    CASES[CONFIG["case"]]["reproduction"] = None  # read above; where its file lies decides nothing
except FacegearError as error:
    stop(str(error))

CASE = CONFIG["case"]
config["rebuild_command"] = (
    "snakemake --cores 2"
    + "".join(f" --configfile {os.path.relpath(file)}" for file in workflow.configfiles)
    + " --force"
)


wildcard_constraints:
    case="|".join(re.escape(case) for case in CASES),


include: "functions/terminal.smk"
include: "functions/jobs.smk"
include: "functions/orphans.smk"


if workflow.exec_mode.name == "DEFAULT":
    quieten()
RUN_LOCKS = []  # held until this process ends


# Only a run that is about to work comes here, no dry run, listing or report.
SOURCES = Path(".snakemake/facegear_sources.json")
recall(SOURCES)


# Not on a dry run, which changes nothing on disk.
onstart:
    remember(SOURCES)
    RUN_LOCKS.append(hold(".snakemake/facegear.lock"))
    if RUN_LOCKS[-1] is None:
        raise WorkflowError(f"another run is working in {os.getcwd()}; wait for it or stop it first")
    orphans = end_orphans()
    if settle() or orphans:  # what there is to do was found out before: begin again from the command line
        os.execv(sys.executable, sys.orig_argv)
    logger.addHandler(Jobs())
    if any(path.is_file() for path in Path(".snakemake/incomplete").rglob("*")):
        print("resuming a run that was stopped: its unfinished jobs are made again", file=sys.stderr)
    for note in notes(CONFIG):
        print(note, file=sys.stderr)
    stop_at_once()


onsuccess:
    report = Path(f"results/{CASE}/report.html")
    print(f"done{f': {report}' if report.exists() else ''}", file=sys.stderr)


def has_contact(case):
    """Whether the case solves the loaded contact itself."""
    values = CASES[case]
    return values["mesh_stiffness"]["source"] != "harmonics" or values["contact"]["root_stress"]


def value_of(key):
    """Function of the wildcards giving a value of a case's config; a dotted key reaches inside."""

    def value(wildcards):
        found = CASES[wildcards.case]
        for part in key.split("."):
            found = found[part] if found is not None else None
        return found

    return value


def values_of(*keys, **renamed):
    """Config values as params: sections under their own names, dotted keys under the names given."""
    return {name: value_of(key) for name, key in {**dict(zip(keys, keys)), **renamed}.items()}


def needs(rule):
    """Function of the wildcards giving all that a stage takes from a case's config."""

    def values(wildcards):
        try:
            return stage_needs(rule, CASES[wildcards.case])
        except FacegearError as error:
            stop(f"{error} of {wildcards.case}")

    return values


def sections(*keys):
    """Function of the wildcards giving these keys of a case's config, as a config of its own."""
    return lambda wildcards: {key: CASES[wildcards.case][key] for key in keys}


@cache
def sources(rule):
    """Of each case the one whose results of a rule it shares."""
    return shared_sources(CASES, rule)


def shared(rule, output):
    """Function of the wildcards giving an output of an earlier rule, shared by all cases alike up to it."""
    return lambda wildcards: str(getattr(rules, rule).output[output]).format(
        case=sources(rule)[wildcards.case]
    )


def shown(name, caption):
    """The svg of a figure, marked for Snakemake's report."""
    category = caption.replace("_", " ").capitalize()
    file, text = f"results/{{case}}/figures/{name}.svg", f"../report/{caption}.rst"
    return report(file, caption=text, category=category, labels={"figure": name})


def picture_lists(caption, names):
    """Output lists `svg` and `png` where the named figures are drawn, however many they are."""
    svg = [shown(name, caption) for name in names]
    return {"svg": svg, "png": [f"results/{{case}}/figures/{name}.png" for name in names]}


def pictures(caption, *names):
    """Output files `svg` and `png` where the named figures are drawn: a path for one, a list for several."""
    lists = picture_lists(caption, names)
    return {kind: paths[0] for kind, paths in lists.items()} if len(names) == 1 else lists
