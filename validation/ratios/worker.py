"""One job of the `facegear` on the path, timed: runs as a file, so that the code of any commit can be on it.

Reads one line for each call from its input, and answers with a line of JSON: processor time in s and largest
memory in MB. `answers` is a file for what the first call gave.
"""

import json
import pickle
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np


def main(given: str, answers: str) -> None:
    from facegear.pipeline.run import call
    from facegear.pipeline.table import STAGES

    name, wildcards, arguments = pickle.loads(Path(given).read_bytes())
    stage = STAGES[name]
    for line in sys.stdin:
        begin = time.process_time() if line.strip() == "warm" else 0.0
        content = call(stage, arguments, **stage.typed(wildcards)).content
        seconds = time.process_time() - begin
        if not Path(answers).exists():
            Path(answers).write_bytes(pickle.dumps(flat(content)))
        print(json.dumps({"seconds": seconds, "memory_mb": _largest_memory()}), flush=True)


def _largest_memory() -> float:
    """Of this process, MB; `resource` would count that of the process it was started by as well."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(float(line.split()[1]) / 1024.0 for line in lines if line.startswith("VmHWM:"))


def flat(content: Any, name: str = "") -> dict[str, np.ndarray]:
    """All columns and arrays of what a stage gave, by the name under which they stand in it."""
    if hasattr(content, "columns"):
        return {f"{name}{column}": content[column].to_numpy() for column in content.columns}
    if isinstance(content, dict):
        parts = [flat(value, f"{name}{key}/") for key, value in content.items()]
        return {key: value for part in parts for key, value in part.items()}
    if isinstance(content, list | tuple):
        return flat(dict(enumerate(content)), name)
    return {name.rstrip("/"): np.asarray(content)}


if __name__ == "__main__":
    main(*sys.argv[1:])
