import os
import re
import shutil
import sys
from pathlib import Path

ROOT = Path(workflow.basedir)
sys.path.insert(0, str(ROOT))
os.environ.update(PYTHONPATH=str(ROOT), MPLBACKEND="Agg")

from facegear.config.cases import expand_cases, shared_source
from facegear.config.load import load_values
from facegear.errors import FacegearError
from facegear.io.run_lock import hold
from facegear.paper.config.reproduction import design_cases, read_reproduction
from facegear.provenance.fingerprint import fingerprint as _fingerprint

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
    CASES |= design_cases(CONFIG, REPRODUCTION.identify if REPRODUCTION else None)
except FacegearError as error:
    stop(str(error))

CASE = CONFIG["case"]
DRY_RUN = bool({"-n", "--dry-run", "--dryrun"} & set(sys.argv))
config["rebuild_command"] = (
    "snakemake --cores 2"
    + "".join(f" --configfile {os.path.relpath(file)}" for file in workflow.configfiles)
    + " --force"
)


wildcard_constraints:
    case="|".join(re.escape(case) for case in CASES),


# A killed run leaves Snakemake's own lock and marks of half-made jobs behind. Both can go at the next start: the
# kernel's lock below proves that nobody is working here, and a half-made job lacks its manifest, so it is made again.
if workflow.exec_mode.name == "DEFAULT":
    RUN_LOCK = hold(".snakemake/facegear.lock")
    if RUN_LOCK is not None:
        shutil.rmtree(".snakemake/locks", ignore_errors=True)
        Path(".snakemake/locks").mkdir(parents=True, exist_ok=True)
        unfinished = [path for path in Path(".snakemake/incomplete").rglob("*") if path.is_file()]
        if unfinished and not DRY_RUN:
            print("resuming a run that was stopped: its unfinished jobs are made again", file=sys.stderr)
        for marker in unfinished:
            marker.unlink()
    elif not DRY_RUN:
        stop(f"another run is working in {os.getcwd()}; wait for it or stop it first")


def fingerprint(script):
    """Hash of the code a script reaches; a rule reruns when it changes."""
    return _fingerprint(ROOT / "workflow" / "scripts" / script, ROOT)


def config_slice(*keys):
    """Function of the wildcards giving the named config values of a case (dotted keys reach inside)."""

    def values(wildcards):
        found = {}
        for key in keys:
            value = CASES[wildcards.case]
            for part in key.split("."):
                value = value[part] if value is not None else None
            found[key] = value
        return found[keys[0]] if len(keys) == 1 else found

    return values


def upstream(stage, path):
    """Function of the wildcards giving a file of an earlier stage, shared by all cases alike up to it."""
    return lambda wildcards: f"results/{shared_source(CASES, wildcards.case, stage)}/{path}"
