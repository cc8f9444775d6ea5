"""Root stress of both gears on their way through the mesh."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from facegear.contact.gear_flank import GearFlank, from_arrays
from facegear.contact.nodal_loads import loads_by_tooth
from facegear.errors import ConfigError
from facegear.stages.outcome import Outcome
from facegear.strength import root_stress as superposed
from facegear.strength.root_stress import RootStress
from facegear.strength.root_tables import root_arrays, root_tables


def root_stress(
    pinion: Mapping[str, NDArray], face_gear: Mapping[str, NDArray], loads: Mapping[str, NDArray]
) -> Outcome:
    """`summary`, `passage`, `along_face` (tables) and `stress` (arrays).

    From the flanks of stage compliance and the loads of stage contact.

    Raises ConfigError where the fillets carry no gauges.
    """
    flanks = {"pinion": from_arrays(pinion), "face_gear": from_arrays(face_gear)}
    found = {body: passing(body, flank, loads) for body, flank in flanks.items()}
    positions = {body: flank.gauges.position for body, flank in flanks.items() if flank.gauges}
    tables = root_tables(found)
    return Outcome({**tables, "stress": root_arrays(found, positions)}, _summary(tables["summary"]))


def passing(body: str, flank: GearFlank, loads: Mapping[str, NDArray]) -> RootStress:
    """Root stress of one body under the loads of stage contact on its flank.

    What presses on its fillet is left out: the gauges below would read the dent. Raises ConfigError where its
    fillets carry no gauges.
    """
    if flank.gauges is None:
        raise ConfigError("contact.root_stress", False, "true, for root stress")
    return superposed.root_stress(
        flank.compliance.readings,
        loads_by_tooth(loads, body, flank.side.flank_rows * flank.side.shape[1]),
        np.unique(loads["torque_n_m"]),
        np.unique(loads["position"]),
        flank.gauges.along(body),
        flank.gauges.tangent_angle,
        flank.gauges.error,
    )


def _summary(table) -> str:  # type: ignore[no-untyped-def]
    worst = table[table["torque_n_m"] == table["torque_n_m"].max()]
    peaks = worst.groupby("body", sort=False)["largest_mpa"].max()
    told = ", ".join(f"{body.replace('_', ' ')} {peak:.0f} MPa" for body, peak in peaks.items())
    return f"largest root stress at {worst['torque_n_m'].iloc[0]:g} N m: {told}"
