"""Compiles for the commonest processors what first calls need: .ci/ship_machine_code.py SOURCES.

The archive lies in the package below the folder SOURCES, from which a wheel is built; see
facegear/machine_code/shipped.py. It serves the version of Python that runs this.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

FIRST_CALLS = """
import facegear
from facegear.dynamics.steady_state.prepare import prepare, prepare_abreast

gearbox = facegear.example()
for answer in ("modes", "statics", "response", "load_sharing", "root_stress"):
    getattr(gearbox, answer)()
prepare(load_dependent=False)
prepare_abreast()
"""


def main(sources: Path) -> None:
    """Fill an empty cache in a process of its own, and pack it."""
    sys.path.insert(0, str(sources))
    from facegear.machine_code import kept, shipped

    with tempfile.TemporaryDirectory() as cache:
        own = {"PYTHONPATH": str(sources), "PYTHONHASHSEED": "0", kept.VARIABLE: cache}
        environment = {**os.environ, **own, **shipped.COMPILING}
        subprocess.run([sys.executable, "-c", FIRST_CALLS], check=True, env=environment, cwd=cache)
        shipped.write(Path(shipped.__file__).with_name(shipped.ARCHIVE), Path(cache) / "machine_code")


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
