"""Each point in a process of its own: processor time, and the largest memory while it is computed."""

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from facegear.arrays import Array

LONG = 2.0
"""Seconds of a call from which on once is enough; shorter ones are repeated."""
REPEATS, TOGETHER = 4, 1.0
"""How often at least, and for how many seconds together."""
PROCESSES, SHORT = 3, 0.5
"""Of a point whose calls take no more seconds than this: the memory that a process is given decides up to a
third of their time.
"""
COLUMNS = ["curve", "size", "seconds", "seconds_largest", "peak_mb", "own_mb", "load"]
NEGLIGIBLE_MB = 10.0
"""Memory below this cannot be distinguished from what the process itself takes."""
ONE_THREAD = {f"{library}_NUM_THREADS": "1" for library in ("OMP", "MKL", "OPENBLAS")}


def measured(name: str, number: int) -> dict[str, float]:
    """Point `number` of a curve, in this process: size, seconds, peak_mb of the process, own_mb of the call,
    and `called_s` that the longest call took.

    The time is the least of a few calls, the first of which loads libraries; the memory that of the last.
    """
    from validation.growth.curves import CURVES

    curve = CURVES[name]
    size, call = curve.prepare(curve.values[number])
    seconds: list[float] = []
    while not seconds or (max(seconds) < LONG and (len(seconds) < REPEATS or sum(seconds) < TOGETHER)):
        _forget_peak()
        before, begin = _memory_mb("VmRSS"), time.process_time()
        result = call()
        seconds.append(time.process_time() - begin)
        peak = _memory_mb("VmHWM")
        point_size = float(result if size is None else size)
        del result
    return {
        "size": point_size,
        "seconds": min(seconds) / curve.times,
        "called_s": max(seconds),
        "peak_mb": peak,
        "own_mb": max(peak - before, 0.0),
    }


def _forget_peak() -> None:
    Path("/proc/self/clear_refs").write_text("5")


def _memory_mb(name: str) -> float:
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(float(line.split()[1]) / 1024.0 for line in lines if line.startswith(f"{name}:"))


def growth_table(sizes: Mapping[str, int], step: Callable[[], None] = lambda: None) -> pd.DataFrame:
    """All points of the curves, `sizes` of each, one process after the other.

    Columns curve, size, seconds (of a processor, one thread, the least of the processes), seconds_largest (of
    the processes), peak_mb, own_mb, load (processes that waited for a processor, mean of the minute before).
    """
    rows = []
    for name, count in sizes.items():
        for number in range(count):
            points = [_in_a_process(name, number)]
            while points[0]["called_s"] < SHORT and len(points) < PROCESSES:
                points.append(_in_a_process(name, number))
            quickest = min(points, key=lambda point: point["seconds"])
            of_processes = {
                "seconds_largest": max(point["seconds"] for point in points),
                "load": os.getloadavg()[0],
            }
            rows.append({"curve": name, **quickest, **of_processes})
            step()
    return pd.DataFrame(rows)[COLUMNS]


def _in_a_process(name: str, number: int) -> dict[str, float]:
    """`measured` of a point, in a process of its own."""
    command = [sys.executable, "-m", "validation.growth.measure", name, str(number)]
    environment = {**os.environ, **ONE_THREAD}
    run = subprocess.run(command, env=environment, check=True, stdout=subprocess.PIPE, text=True)
    point: dict[str, float] = json.loads(run.stdout.splitlines()[-1])
    return point


def exponents(table: pd.DataFrame) -> pd.DataFrame:
    """One row a curve: from, to (sizes), seconds_from, seconds_to, exponent over all sizes and over the last
    two, peak_mb_to, memory_exponent of what the call itself takes (empty where that is little).
    """
    rows = []
    for name, curve in table.groupby("curve", sort=False):
        size, seconds = curve["size"].to_numpy(), curve["seconds"].to_numpy()
        large = (curve["own_mb"] > NEGLIGIBLE_MB).to_numpy()
        rows.append(
            {
                "curve": name,
                "from": size[0],
                "to": size[-1],
                "seconds_from": seconds[0],
                "seconds_to": seconds[-1],
                "exponent": slope(size, seconds),
                "exponent_at_the_end": slope(size[-2:], seconds[-2:]),
                "peak_mb_to": curve["peak_mb"].iloc[-1],
                "memory_exponent": slope(size[large], curve["own_mb"].to_numpy()[large]),
            }
        )
    return pd.DataFrame(rows)


def rounded(fitted: pd.DataFrame) -> pd.DataFrame:
    """The table with numbers of three digits."""
    numbers = fitted.select_dtypes("number").columns
    return fitted.assign(**{name: [float(f"{value:.3g}") for value in fitted[name]] for name in numbers})


def slope(size: Array, amount: Array) -> float:
    """Exponent of a power law fitted by least squares of logarithms; NaN for fewer than two sizes."""
    if size.size < 2:
        return float("nan")
    return float(np.polyfit(np.log(size), np.log(amount), 1)[0])


if __name__ == "__main__":
    print(json.dumps(measured(sys.argv[1], int(sys.argv[2]))))
