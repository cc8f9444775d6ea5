import os
import re
import sys
from functools import cache
from pathlib import Path

from filelock import FileLock, Timeout

ROOT = Path(workflow.basedir).parent
sys.path.insert(0, str(ROOT))
os.environ.update(PYTHONPATH=str(ROOT), MPLBACKEND="Agg")
imported = sys.modules.get("facegear")  # the profile may have imported a package installed elsewhere
if imported is not None and not Path(imported.__file__).is_relative_to(ROOT):
    for name in [name for name in sys.modules if name.partition(".")[0] == "facegear"]:
        del sys.modules[name]

from facegear.build.cases import expand_cases
from facegear.build.load import base_path, load_config
from facegear.build.notes import notes
from facegear.errors import FacegearError
from facegear.pipeline.needs import require_section, resolved_needs, shared_sources, value_at
from facegear.pipeline.rows.common_needs import MACHINE
from facegear.pipeline.stage import FIGURES, Case, From
from facegear.pipeline.table import STAGES
from facegear.pipeline.provenance.fingerprint import fingerprint
from facegear.pipeline.provenance.manifest import rebuild_command
from facegear.pipeline.provenance.sources import recall, remember
from paper.reproduction import read_reproduction

DEFAULT_CONFIGFILE = ROOT / "config" / "paper.yaml"
CONFIGFILES = [Path(file) for file in workflow.configfiles] or [DEFAULT_CONFIGFILE]
GIVEN = workflow.config_settings.config

try:
    CONFIG = load_config(CONFIGFILES, GIVEN)
    REPRODUCTION = read_reproduction(CONFIG.reproduction) if CONFIG.reproduction else None
    CASES = expand_cases(CONFIG)
    CASES[CONFIG.case]["reproduction"] = None  # read above; where its file lies decides nothing
except FacegearError as error:
    sys.exit(str(error))

CASE = CONFIG.case
config["rebuild_command"] = rebuild_command(
    workflow.main_snakefile, workflow.configfiles, GIVEN, workflow.overwrite_workdir
)
SOURCES = ROOT / ".snakemake" / "sources.json"
recall(SOURCES)


wildcard_constraints:
    case="|".join(re.escape(case) for case in CASES),


include: "functions/cases.smk"
include: "functions/runs.smk"


require_folder()


# Only a run that has work to do comes here, no dry run, listing or report.
onstart:
    hold_folder()
    remember(SOURCES)
    for note in notes(CONFIG.model_dump(mode="json")):
        print(note, file=sys.stderr)


onsuccess:
    report = Path(f"results/{CASE}/report.html")
    print(f"done{f': {report}' if report.exists() else ''}", file=sys.stderr)


onerror:
    print("the run has ended early; the same command goes on from here", file=sys.stderr)
