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
"""Number of processes for a point whose calls take no more seconds than SHORT: the memory that a process is
given decides up to a third of their time."""
COLUMNS = ["curve", "size", "seconds", "seconds_largest", "peak_mb", "own_mb", "load"]
NEGLIGIBLE_MB = 10.0
"""Memory below this cannot be distinguished from what the process itself takes."""
ONE_THREAD = {f"{library}_NUM_THREADS": "1" for library in ("OMP", "MKL", "OPENBLAS")}


def measure_point(name: str, number: int) -> dict[str, float]:
    """Measure a point of a curve in this process.

    The time is the least of a few calls, the first of which loads libraries; the memory that of the last.

    Parameters
    ----------
    name : str
        Name of the curve.
    number : int
        Index of the point.

    Returns
    -------
    dict[str, float]
        size, seconds, peak_mb of the process, own_mb of the call, and `called_s`, the s that the longest call
        took.
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
    """Measure all points of the curves, one process after the other.

    Columns curve, size, seconds (of a processor, one thread, the least of the processes), seconds_largest (of
    the processes), peak_mb, own_mb, load (processes that waited for a processor, mean of the minute before).

    Parameters
    ----------
    sizes : Mapping[str, int]
        Number of points of each curve.
    step : Callable[[], None]
        Called after each point.

    Returns
    -------
    DataFrame
        One row for each point.
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
    """Fit the exponents of each curve, one row a curve.

    Columns from, to (sizes), seconds_from, seconds_to, exponent over all sizes and over the last two,
    peak_mb_to, memory_exponent of the call's own memory (empty where that is little).

    Parameters
    ----------
    table : DataFrame
        Table of `growth_table`.

    Returns
    -------
    DataFrame
        One row for each curve.
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


def round_numbers(table: pd.DataFrame) -> pd.DataFrame:
    """Round the numbers of a table to three digits.

    Parameters
    ----------
    table : DataFrame
        Any table.

    Returns
    -------
    DataFrame
        The rounded table.
    """
    numbers = table.select_dtypes("number").columns
    return table.assign(**{name: [float(f"{value:.3g}") for value in table[name]] for name in numbers})


def slope(size: Array, amount: Array) -> float:
    """Fit the exponent of a power law by least squares of logarithms.

    Parameters
    ----------
    size : (n,) array
        Sizes, any unit.
    amount : (n,) array
        Amounts, any unit.

    Returns
    -------
    float
        Exponent, dimensionless; NaN for fewer than two sizes.
    """
    if size.size < 2:
        return float("nan")
    return float(np.polyfit(np.log(size), np.log(amount), 1)[0])


if __name__ == "__main__":
    print(json.dumps(measure_point(sys.argv[1], int(sys.argv[2]))))
