"""The first estimate: the load of the paper's mean stiffness in contact analysis; k(t) at any load."""

from collections.abc import Callable

import scipy.optimize

from facegear.harmonics.fit import fit_harmonics
from facegear.harmonics.series import Harmonics
from facegear.stiffness.curve import LoadTable
from facegear.stiffness.request import Definition


def scaled_stiffness(
    table: LoadTable, mean: float, kept: int, definition: Definition
) -> Callable[[float], Harmonics]:
    """Function of the torque on one mesh's pinion (N m): the shape at that load with the given mean (N/m).

    It raises ConfigError for a load outside those solved.
    """

    def at(torque: float) -> Harmonics:
        series = fit_harmonics(table.at(torque, definition)).series.kept(kept)
        return series.scaled(mean / series.mean)

    return at


def load_for_mean(table: LoadTable, mean: float, definition: Definition) -> float | None:
    """Torque on a pinion for one mesh (N m) at which the mean stiffness is `mean` (N/m).

    None if no load of the table gives it.
    """

    def excess(torque: float) -> float:
        return float(table.at(torque, definition).mean()) - mean

    low, high = float(table.torques[0]), float(table.torques[-1])
    if excess(low) * excess(high) > 0.0:
        return None
    return float(scipy.optimize.brentq(excess, low, high, rtol=1e-10))
