"""The public casing of the reference page, reduced to five seats, a base and 30 modes, in mm, t and s.

`tests/unit/casing/public_casing.npz` and `public_sensors.npz` were made by 20-node bricks in a program of
their own; `box_casings.box_casing((15, 13, 9))` repeats them.
"""

from pathlib import Path

import numpy as np

from facegear.casing.mounted import Foot, mount
from facegear.casing.reduction import Interface, Reduction, reduce_casing
from facegear.casing.whole import whole_casing
from facegear.io.matrices import native

FILE = Path(__file__).parents[1] / "unit" / "casing" / "public_casing.npz"
SEATS = {"p0": 101, "p1": 102, "p2": 103, "lower gear": 104, "upper gear": 105}
BASE = 301


def read_public_casing():
    stiffness, mass = (native.npz_matrix(FILE, quantity) for quantity in ("stiffness", "mass"))
    return whole_casing(stiffness, mass, None, native.read_nodes(FILE), "mm_t_s")


def make_interfaces(casing):
    seats = [Interface(name, (node,), casing.position_of_node[node]) for name, node in SEATS.items()]
    return seats, Interface("base", (BASE,), casing.position_of_node[BASE])


def sensor_rows():
    """Motions (3, 66) of the corner (150, 130, 90) mm by the rows of the file, SI units."""
    motion = np.load(FILE.with_name("public_sensors.npz"))["motion"]
    per_metre = np.r_[np.tile(np.repeat([1e3, 1.0], 3), 6), np.ones(30)]
    return 1e-3 * motion * per_metre


def mount_public(modes=30, factor=1.0, damping_ratio=0.01, with_mass=True, turned=0.0):
    """The public casing on its held base, `factor` times stiffer, turned about the gears' axis, rad."""
    casing = read_public_casing()
    seats, base = make_interfaces(casing)
    reduction = reduce_casing(casing, [*seats, base], modes)
    sensors = sensor_rows()[:, : 36 + modes] * np.r_[np.ones(36), reduction_signs(casing, modes)]
    mass = reduction.mass if with_mass else np.zeros_like(reduction.mass)
    reduction = Reduction(factor * reduction.stiffness, mass, None, reduction.frequencies, sensors)
    cosine, sine = np.cos(turned), np.sin(turned)
    axes = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]]), np.zeros(3)
    return mount(reduction, seats, [Foot(base)], ["x", "y", "z"], axes, damping_ratio, casing.total_mass)


def reduction_signs(casing, modes):
    """Factors (modes,) from modes of the file to those of unit mass in kg."""
    rows = 36 + np.arange(modes)
    return 1.0 / np.sqrt(casing.mass.diagonal()[rows])
