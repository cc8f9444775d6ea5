"""Twenty machines of `facegear new`, from their numbers to their report: `python -m validation.starters`."""

import random
import re
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from math import pi
from pathlib import Path
from tempfile import TemporaryDirectory

import pandas as pd

from facegear.errors import FacegearError
from facegear.gearbox import Gearbox, load
from facegear.new_machine.first_machine import first_machine
from facegear.new_machine.wishes import MachineWishes

TABLE = Path(__file__).parents[1] / "docs" / "measured" / "starters.csv"
COUNT, SEED = 20, 50
"""Number of machines, and the seed by which they are drawn."""
TEETH, RATIOS = (12, 40), (3.0, 7.0)
"""Smallest and largest number of pinion teeth and gear ratio."""
ANGLES, MODULES = (17.5, 20.0, 22.5, 25.0, 27.5), (1.0, 2.0, 2.5, 3.5, 5.0)
"""Pressure angles, deg, and modules, mm."""
KINDS = ((1, 0), (2, 0), (3, 0), (5, 0), (1, 2), (2, 2), (2, 3))
"""Driving pinions and idlers."""
UNIT_LOADS = (20.0, 60.0)
"""Unit load F_t/(b m), MPa, on a face of FACE modules."""
FACE = 6.4
PITCH_SPEEDS = (5.0, 40.0)
"""Speed at the pitch circle of the pinion, m/s."""
SAFETIES = ("bending_safety", "pitting_safety")
"""Safeties of the pinions' drive flank that `facegear new` prints, in the order of its line."""
SHARING = ("k_gamma_inputs", "k_gamma_idlers_least", "k_gamma_idlers_largest", "group_ratio")
"""Numbers of load sharing that `facegear new` prints for a split-torque machine, in the order of its line."""


def draw_machines(count: int = COUNT, seed: int = SEED) -> Iterator[MachineWishes]:
    """Draw machines by a fixed seed, so that each run makes the same ones.

    Parameters
    ----------
    count : int
        Number of machines.
    seed : int
        Seed of the draw.

    Yields
    ------
    MachineWishes
        What a user would give, with the coarse resolution.
    """
    draw = random.Random(seed)
    for number in range(1, count + 1):
        teeth, module = draw.randint(*TEETH), draw.choice(MODULES)
        pinions, idlers = draw.choice(KINDS)
        force = draw.uniform(*UNIT_LOADS) * FACE * module**2
        torque = force * 0.5e-3 * module * teeth * (2 if idlers else 1)
        speed = draw.uniform(*PITCH_SPEEDS) / (pi * 1e-3 * module * teeth) * 60.0
        yield MachineWishes(
            case=f"starter_{number}",
            pinion_teeth=teeth,
            face_gear_teeth=round(teeth * draw.uniform(*RATIOS)),
            module_mm=module,
            torque_n_m=float(f"{torque:.3g}"),
            speed_rpm=float(f"{speed:.3g}"),
            pinions=pinions,
            pressure_angle_deg=draw.choice(ANGLES),
            idlers=idlers,
            coarse=True,
        )


def run_machine(machine: MachineWishes, folder: Path) -> dict[str, object]:
    """Write the config of a machine and its report.

    Parameters
    ----------
    machine : MachineWishes
        The machine.
    folder : Path
        Where config and page go.

    Returns
    -------
    dict
        A row of the table: the machine's numbers, `outcome` (report, incomplete or refused), `reason` of what
        is missing, `stages` that were computed, load sharing of a split-torque machine by `hunting` with the
        stiffness of the contact analysis, safeties of the pinions, both also as `facegear new` printed them,
        and `processor_s`.
    """
    stages: list[str] = []
    reasons: list[str] = []
    start = time.process_time()

    def note(stage: str, summary: str) -> None:
        if summary.startswith("not computed: "):
            reasons.append(f"{stage}: {summary.removeprefix('not computed: ')}")
        elif stage != "report":
            stages.append(stage)

    outcome = "refused"
    estimates: dict[str, float] = {}
    try:
        path = folder / f"{machine.case}.yaml"
        first = first_machine(machine)
        path.write_text(first.text, encoding="utf-8")
        gearbox = load(path, None)
        gearbox.report(folder / f"{machine.case}.html", note)
        outcome = "incomplete" if reasons else "report"
        if machine.idlers:
            estimates = computed_sharing(gearbox) | printed_numbers(first.expectations[1], SHARING)
        estimates |= computed_safety(gearbox) | printed_numbers(first.expectations[-2], SAFETIES)
    except FacegearError as error:
        reasons.append(str(error).splitlines()[0])
    return {
        "machine": machine.case,
        "pinion_teeth": machine.pinion_teeth,
        "face_gear_teeth": machine.face_gear_teeth,
        "module_mm": machine.module_mm,
        "pressure_angle_deg": machine.pressure_angle_deg,
        "inputs": machine.pinions,
        "idlers": machine.idlers,
        "torque_n_m": machine.torque_n_m,
        "speed_rpm": machine.speed_rpm,
        "outcome": outcome,
        "reason": "; ".join(reasons),
        "stages": len(stages),
        **estimates,
        "processor_s": round(time.process_time() - start, 1),
    }


def computed_sharing(gearbox: Gearbox) -> dict[str, float]:
    """Compute the load sharing of a split-torque machine over its hunting cycle.

    Parameters
    ----------
    gearbox : Gearbox
        The machine.

    Returns
    -------
    dict
        Numbers by the names of SHARING, dimensionless.
    """
    hunting = gearbox.hunting()
    meshes = hunting.meshes().set_index("mesh")["k_gamma"]
    idlers = meshes.filter(like="idler")
    values = (
        meshes.filter(like="input").max(),
        idlers.min(),
        idlers.max(),
        hunting.table()["group_ratio"].max(),
    )
    return {name: round(float(value), 3) for name, value in zip(SHARING, values, strict=True)}


def computed_safety(gearbox: Gearbox) -> dict[str, float]:
    """Compute the safety of the pinions' drive flank by finite elements and contact analysis.

    Parameters
    ----------
    gearbox : Gearbox
        The machine.

    Returns
    -------
    dict
        Numbers by the names of SAFETIES, dimensionless.
    """
    safety = gearbox.rating().safety().set_index(["body", "flank"]).loc[("pinion", "drive")]
    return {name: round(float(safety[name]), 3) for name in SAFETIES}


def printed_numbers(line: str, names: Sequence[str]) -> dict[str, float]:
    """Read numbers from a line that `facegear new` prints.

    Parameters
    ----------
    line : str
        The line, which begins with the numbers.
    names : sequence of str
        What the numbers are, in their order.

    Returns
    -------
    dict
        Numbers by these names with `printed_` before them, any unit.
    """
    numbers = re.findall(r"\d+\.\d+|\d+", line)
    return {f"printed_{name}": float(number) for name, number in zip(names, numbers, strict=False)}


def run_all(machines: Sequence[MachineWishes]) -> pd.DataFrame:
    """Run machines to their reports, one after the other.

    Parameters
    ----------
    machines : sequence of MachineWishes
        The machines.

    Returns
    -------
    DataFrame
        A row each, as of `run_machine`, with the commit.
    """
    command = ["git", "rev-parse", "--short=8", "HEAD"]
    commit = subprocess.run(
        command, capture_output=True, text=True, check=True, cwd=TABLE.parent
    ).stdout.strip()
    rows = []
    with TemporaryDirectory() as folder:
        for machine in machines:
            rows.append(run_machine(machine, Path(folder)) | {"commit": commit})
            print(f"{machine.case}: {rows[-1]['outcome']}, {rows[-1]['processor_s']} s", file=sys.stderr)
    return pd.DataFrame(rows)


if __name__ == "__main__":
    numbers = {int(word) for word in sys.argv[1:]}
    chosen_machines = [
        machine for number, machine in enumerate(draw_machines(), 1) if not numbers or number in numbers
    ]
    table = run_all(chosen_machines)
    if numbers:
        print(table.to_string(index=False))
    else:
        table.to_csv(TABLE, index=False)
        print(TABLE)
