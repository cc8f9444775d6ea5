"""Runs in an environment with ROSS and openTorsion, in the folder with `problem.json` (`shaft_peer.py`).

Writes `result.json`: for every shaft its compliance at the pinion in x, y, z, tilt_x, tilt_y by ROSS and the
natural frequencies of a pinion on it at every speed; for every chain its frequencies by openTorsion.
"""

import json
from itertools import pairwise
from pathlib import Path

import numpy as np
import opentorsion
import ross

WEIGHTLESS = 1e-6
"""Density of the shafts, kg/m3: the pinion alone has mass."""


def rotor(shaft: dict) -> tuple[ross.Rotor, int]:
    """Return ROSS' rotor with the pinion as a disc, and the pinion's node.

    Parameters
    ----------
    shaft : dict
        Data of the shaft.

    Returns
    -------
    ross.Rotor, int
        Rotor and index of the node.
    """
    shear = shaft["young"] / (2.0 * (1.0 + shaft["poisson"]))
    steel = ross.Material(name="steel", rho=WEIGHTLESS, E=shaft["young"], G_s=shear)
    marks = np.cumsum([0.0, *(segment[0] for segment in shaft["segments"])])
    nodes = np.unique(
        np.round(np.concatenate([marks, [shaft["pinion"]], [b["position"] for b in shaft["bearings"]]]), 12)
    )
    elements = []
    for left, right in pairwise(nodes):
        number = int(np.searchsorted(marks, 0.5 * (left + right))) - 1
        _, outer, inner = shaft["segments"][number]
        elements.append(ross.ShaftElement(L=right - left, idl=inner, odl=outer, material=steel))
    pinion = int(np.abs(nodes - shaft["pinion"]).argmin())
    disc = ross.DiskElement(n=pinion, m=shaft["mass"], Id=shaft["diametral"], Ip=shaft["polar"])
    bearings = [
        ross.BearingElement(
            n=int(np.abs(nodes - bearing["position"]).argmin()),
            kxx=bearing["radial"],
            cxx=0.0,
            kzz=bearing["axial"],
        )
        for bearing in shaft["bearings"]
    ]
    return ross.Rotor(elements, [disc], bearings), pinion


def compliance(assembly: ross.Rotor, pinion: int) -> list[list[float]]:
    """Return the static compliance in x, y, z, tilt_x, tilt_y: a node's coordinates in ROSS' order without
    torsion.

    Parameters
    ----------
    assembly : ross.Rotor
        The rotor.
    pinion : int
        Index of the pinion's node.

    Returns
    -------
    list[list[float]]
        Compliance, 5 rows, SI units.
    """
    coordinates = 6 * pinion + np.arange(5)
    return np.linalg.inv(stiffness_without_torsion(assembly))[np.ix_(coordinates, coordinates)].tolist()


def whirling_frequencies(assembly: ross.Rotor, pinion: int, speed: float) -> list[float]:
    """Return the four frequencies that a pinion on a weightless shaft has across it.

    Parameters
    ----------
    assembly : ross.Rotor
        The rotor.
    pinion : int
        Index of the pinion's node.
    speed : float
        Speed, rad/s.

    Returns
    -------
    list[float]
        Frequencies, Hz.
    """
    coordinates = 6 * pinion + np.array([0, 1, 3, 4])
    stiffness = np.linalg.inv(
        np.linalg.inv(stiffness_without_torsion(assembly))[np.ix_(coordinates, coordinates)]
    )
    mass, turning = (
        assembly.M(0.0)[np.ix_(coordinates, coordinates)],
        speed * assembly.G()[np.ix_(coordinates, coordinates)],
    )
    inverse, zero = np.linalg.inv(mass), np.zeros((4, 4))
    system = np.block([[zero, np.eye(4)], [-inverse @ stiffness, -inverse @ turning]])
    roots = np.linalg.eigvals(system).imag
    return (np.sort(roots[roots > 0.0]) / (2.0 * np.pi)).tolist()


def stiffness_without_torsion(assembly: ross.Rotor) -> np.ndarray:
    """Return the stiffness with torsion held.

    Parameters
    ----------
    assembly : ross.Rotor
        The rotor.

    Returns
    -------
    (dof, dof) array
        Stiffness, SI units.
    """
    stiffness = assembly.K(0.0)
    torsion = 6 * np.arange(len(stiffness) // 6) + 5
    stiffness[torsion, torsion] += 1.0
    return stiffness


def torsional_frequencies(chain: dict) -> list[float]:
    """Return the frequencies of masses on torsional springs in a row, without the zero.

    Parameters
    ----------
    chain : dict
        Inertias and stiffnesses.

    Returns
    -------
    list[float]
        Frequencies, Hz.
    """
    count = len(chain["stiffness"])
    springs = [opentorsion.Shaft(i, i + 1, k=chain["stiffness"][i], I=0.0) for i in range(count)]
    discs = [opentorsion.Disk(i, inertia) for i, inertia in enumerate(chain["inertia"])]
    omega_squared, _ = opentorsion.Assembly(springs, disk_elements=discs).undamped_modal_analysis()
    return (np.sqrt(np.sort(np.abs(omega_squared))[1:]) / (2.0 * np.pi)).tolist()


problem = json.loads(Path("problem.json").read_text(encoding="utf-8"))
shafts = []
for shaft_data in problem["shafts"]:
    assembly, at = rotor(shaft_data)
    frequencies = [whirling_frequencies(assembly, at, speed) for speed in shaft_data["speeds"]]
    shafts.append({"compliance": compliance(assembly, at), "frequencies": frequencies})
result = {"shafts": shafts, "chains": [torsional_frequencies(chain) for chain in problem["chains"]]}
Path("result.json").write_text(json.dumps(result), encoding="utf-8")
