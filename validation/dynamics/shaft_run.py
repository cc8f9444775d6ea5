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
    """ROSS' rotor with the pinion as a disc, and the pinion's node."""
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


def compliance(built: ross.Rotor, pinion: int) -> list[list[float]]:
    """Static, in x, y, z, tilt_x, tilt_y: coordinates of a node in ROSS' order, but for the torsion."""
    own = 6 * pinion + np.arange(5)
    return np.linalg.inv(fixed(built))[np.ix_(own, own)].tolist()


def whirling(built: ross.Rotor, pinion: int, speed: float) -> list[float]:
    """The four frequencies (Hz) at a speed (rad/s) that a pinion on a weightless shaft has across it."""
    own = 6 * pinion + np.array([0, 1, 3, 4])
    stiffness = np.linalg.inv(np.linalg.inv(fixed(built))[np.ix_(own, own)])
    mass, turning = built.M(0.0)[np.ix_(own, own)], speed * built.G()[np.ix_(own, own)]
    inverse, none = np.linalg.inv(mass), np.zeros((4, 4))
    system = np.block([[none, np.eye(4)], [-inverse @ stiffness, -inverse @ turning]])
    roots = np.linalg.eigvals(system).imag
    return (np.sort(roots[roots > 0.0]) / (2.0 * np.pi)).tolist()


def fixed(built: ross.Rotor) -> np.ndarray:
    """Stiffness with torsion held."""
    stiffness = built.K(0.0)
    torsion = 6 * np.arange(len(stiffness) // 6) + 5
    stiffness[torsion, torsion] += 1.0
    return stiffness


def swinging(chain: dict) -> list[float]:
    """Frequencies (Hz) of masses on torsional springs in a row, without the zero."""
    count = len(chain["stiffness"])
    springs = [opentorsion.Shaft(i, i + 1, k=chain["stiffness"][i], I=0.0) for i in range(count)]
    discs = [opentorsion.Disk(i, inertia) for i, inertia in enumerate(chain["inertia"])]
    omega_squared, _ = opentorsion.Assembly(springs, disk_elements=discs).undamped_modal_analysis()
    return (np.sqrt(np.sort(np.abs(omega_squared))[1:]) / (2.0 * np.pi)).tolist()


problem = json.loads(Path("problem.json").read_text(encoding="utf-8"))
shafts = []
for given in problem["shafts"]:
    made, at = rotor(given)
    frequencies = [whirling(made, at, speed) for speed in given["speeds"]]
    shafts.append({"compliance": compliance(made, at), "frequencies": frequencies})
result = {"shafts": shafts, "chains": [swinging(chain) for chain in problem["chains"]]}
Path("result.json").write_text(json.dumps(result), encoding="utf-8")
