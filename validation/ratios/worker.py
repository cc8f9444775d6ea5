"""One job of the `facegear` on the path, timed: runs as a file, so that the code of any commit can be on it.

    python worker.py JOB ANSWERS INPUTS

JOB is a file of JSON: `config` (path of a config file), `changes` by dotted keys, and either `stage` and
`wildcards` of the workflow or `calls`, methods of a gearbox. Each line that is read from the standard input
starts one call: `warm` for its own time, `whole` for that since the process began. It is answered by a line
of JSON: `seconds` of a processor, `wall` seconds and `memory_mb`, the largest memory of the process. ANSWERS
is the npz file that the numbers of the first call are written to; INPUTS is a folder in which this code keeps
what other stages give to the stage. Only the standard library is imported before the clock is read.
"""

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any


def main(job: str, answers: str, inputs: str) -> None:
    """Answer each line of the standard input.

    Parameters
    ----------
    job, answers, inputs : str
        Paths, as the module says.
    """
    asked = json.loads(Path(job).read_text(encoding="utf-8"))
    call: Callable[[], Any] | None = None
    for line in sys.stdin:
        whole = line.strip() == "whole"
        call = call or (_stage(asked, inputs) if asked["stage"] else _calls(asked))
        begin, clock = 0.0 if whole else time.process_time(), time.perf_counter()
        content = call()
        seconds, wall = time.process_time() - begin, time.perf_counter() - clock
        print(json.dumps({"seconds": seconds, "wall": wall, "memory_mb": _largest_memory()}), flush=True)
        if not Path(answers).exists():
            _write(Path(answers), content)


def _stage(asked: dict[str, Any], inputs: str) -> Callable[[], Any]:
    """Call of a stage whose inputs are computed now, or read where this code has kept them."""
    import facegear
    from facegear.pipeline.run import call
    from facegear.pipeline.table import STAGES
    from facegear.results.chain import Chain
    from facegear.results.partial import PartialResults
    from facegear.results.store import Store

    gearbox = facegear.load(asked["config"], results=None).with_values(asked["changes"])
    stage = STAGES[asked["stage"]]
    arguments = Chain(gearbox.values, Store(partial=PartialResults(Path(inputs)))).arguments(stage.name)
    return lambda: call(stage, arguments, **stage.typed(asked["wildcards"])).content


def _calls(asked: dict[str, Any]) -> Callable[[], Any]:
    """Calls that a user makes through the Python door, its import among them."""

    def answer() -> Any:
        import facegear

        if not asked["calls"]:
            return {"door": facegear.Gearbox.__name__}
        gearbox = facegear.load(asked["config"], results=None).with_values(asked["changes"])
        return {name: getattr(gearbox, name)().content for name in asked["calls"]}

    return answer


def _largest_memory() -> float:
    """Largest memory of this process, MB; `resource` would count that of the process it was started by."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(float(line.split()[1]) / 1024.0 for line in lines if line.startswith("VmHWM:"))


def _write(path: Path, content: Any) -> None:
    """Write all columns and arrays into an npz file without Python objects."""
    import numpy as np

    with path.open("wb") as file:
        np.savez(file, **flat(content))  # type: ignore[arg-type]


def flat(content: Any, name: str = "") -> dict[str, Any]:
    """Return all columns and arrays of what a stage gave, by the name under which they stand in it.

    Parameters
    ----------
    content : Any
        Tables, arrays, numbers and texts in mappings and lists.
    name : str
        Beginning of all names.

    Returns
    -------
    dict
        Arrays of numbers or texts, of any shape and unit.
    """
    if hasattr(content, "columns"):
        return {f"{name}{column}": _plain(content[column].to_numpy()) for column in content.columns}
    if isinstance(content, dict):
        parts = [flat(value, f"{name}{key}/") for key, value in content.items()]
        return {key: value for part in parts for key, value in part.items()}
    if isinstance(content, list | tuple):
        return flat(dict(enumerate(content)), name)
    return {name.rstrip("/"): _plain(content)}


def _plain(values: Any) -> Any:
    """Array of numbers, or of texts where one of them is none."""
    import numpy as np

    array = np.asarray(values)
    if array.dtype.kind != "O":
        return array
    try:
        return array.astype(float)
    except (TypeError, ValueError):
        return array.astype(str)


if __name__ == "__main__":
    main(*sys.argv[1:])
