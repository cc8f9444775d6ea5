"""Root stress of both gears on their way through the mesh."""

import pandas as pd

from facegear.arrays import Arrays
from facegear.contact.gear_flank import from_arrays
from facegear.stages.outcome import Outcome
from facegear.strength.passage import passing
from facegear.strength.root_tables import root_arrays, root_by_flank, root_tables


def root_stress(pinion: Arrays, face_gear: Arrays, loads: Arrays) -> Outcome:
    """`summary`, `passage`, `along_face`, `by_flank` (tables) and `stress` (arrays).

    pinion, face_gear: arrays of stage compliance; loads: arrays of stage contact. The first three tables
    are those of the upper gear's drive flank. Raises ConfigError where the fillets carry no gauges.
    """
    flanks = {"pinion": from_arrays(pinion), "face_gear": from_arrays(face_gear)}
    numbers = loads["flank_variant"]
    variants = [
        {body: passing(body, flank, loads, variant) for body, flank in flanks.items()}
        for variant in range(int(numbers.max()) + 1)
    ]
    positions = {body: flank.gauges.position for body, flank in flanks.items() if flank.gauges}
    tables = root_tables(variants[0])
    content = {
        **tables,
        "by_flank": root_by_flank(variants, numbers),
        "stress": root_arrays(variants, numbers, positions),
    }
    return Outcome(content, _summary(content["by_flank"]))


def _summary(table: pd.DataFrame) -> str:
    worst = table[table["torque_n_m"] == table["torque_n_m"].max()]
    peaks = worst.groupby("body", sort=False)["largest_mpa"].max()
    text = ", ".join(f"{body.replace('_', ' ')} {peak:.0f} MPa" for body, peak in peaks.items())
    return f"largest root stress at {worst['torque_n_m'].iloc[0]:g} N m: {text}"
