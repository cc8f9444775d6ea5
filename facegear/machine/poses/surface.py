"""Contact of a pair over its pose: a response surface in torque, unloaded path and error of the shaft angle.

At equal unloaded path the contact all but does not depend on how offset and axial shift share it, so that
three coordinates are enough: ln T, the place y0 of the unloaded contact along the pinion, and dgamma. Of
every kind of teeth y0 is where the common normal passes the pinion's pitch point, about the middle of a path
that a helix lets run along the face; a shift of the pinion along its axis moves the ends of its face alone
and has no coordinate. Logarithms of positive quantities are interpolated by cubic splines over y0 and over
ln T, and linearly over dgamma. Nothing is extrapolated.

Flanks that differ, as drive and coast flanks of a helix do, have surfaces of their own.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import acos
from typing import Self

import numpy as np
import scipy

from facegear.arrays import Array, Arrays
from facegear.errors import InvalidInput
from facegear.teeth.conjugate import PairNumbers, contact_at, offset_for
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.placement import FLANKS, GEARS

STIFFNESS, RADIUS = "stiffness_n_per_m", "path_radius_m"
"""Names of two of the QUANTITIES."""
QUANTITIES = (
    STIFFNESS,
    "ste_peak_to_peak_m",
    "pressure_pa",
    RADIUS,
    "pinion_root_pa",
    "face_gear_root_pa",
)
"""Mean average stiffness, counted from where the flanks continued beyond their ends would touch; transmission
error, largest pressure, radius of the loaded path, largest root stress of both gears."""
PATHS, TORQUES, DEEPEST = 7, 5, 20.0
"""Nodes of the path and of the torque, and the ratio of the largest to the smallest torque."""
INSIDE, BEYOND = 0.32, 0.12
"""Parts of the face by which nodes begin within the path at rest and go on beyond the outer end."""
LEANING = float(np.radians(0.05))
"""Error of the shaft angle (rad) to either side that the nodes cover where bodies tilt or bend."""

FLATTEST = acos(1.0 / 1.002)
"""Slope of the common normal (rad) at the innermost node: the path of spur teeth is 0.2 % outside the radius
at which the slope vanishes.
"""

NO_TORQUE = 1e-9
"""Torque over the smallest of the nodes, dimensionless, that stands for less: zero has no logarithm."""
SURFACE_ARRAYS = {
    "pair": (None,),
    "errors": (4,),
    "angle_rad": (None,),
    "path_m": (None,),
    "torque_n_m": (None,),
    "reference_torque_n_m": (),
    STIFFNESS: (None, None, None),
    RADIUS: (None, None, None),
}
"""Arrays of a surface with their shapes; quantities beside these are stored where they are known."""
FLANK_NUMBERS = "flank_surface"
"""Name of the array (gears, flanks) with the number of each flank's surface, stored where there are several;
names of the arrays of all but the first begin with `further` and the surface's number.
"""


@dataclass(frozen=True, eq=False)
class Nodes:
    """Nodes at which contact is solved: angles (a,) rad, paths (y,) m, torques (t,) N m."""

    angles: Array
    paths: Array
    torques: Array

    def assemblies(self, pair: PairNumbers, pinion_axial: float = 0.0) -> list[AssemblyErrors]:
        """Return the assembly errors at which contact is solved: for each angle, all paths.

        The offset alone is chosen such that the unloaded contact lies at the path.

        Parameters
        ----------
        pair : PairNumbers
            Numbers of the pair.
        pinion_axial : float
            Shift of the pinion outwards along its axis, m, that of its assembly.

        Returns
        -------
        list of AssemblyErrors
            Angles times paths entries, paths fastest, m and rad.

        Raises
        ------
        InvalidInput
            For a path that the pair cannot have.
        """
        assemblies = []
        for angle in self.angles.tolist():
            for path in self.paths.tolist():
                errors = AssemblyErrors(shaft_angle_error=angle, pinion_axial=pinion_axial)
                offset = offset_for(pair, path, errors)
                if offset is None:
                    raise InvalidInput(
                        "path of the contact", f"{1e3 * path:.6g} mm", "one that the pair can have"
                    )
                assemblies.append(replace(errors, offset=offset))
        return assemblies


def surface_nodes(pair: PairNumbers, nominal: AssemblyErrors, largest: float, tilting: bool) -> Nodes:
    """Return the nodes of a pair about its nominal assembly, up to a largest torque.

    Parameters
    ----------
    pair : PairNumbers
        Numbers of the pair.
    nominal : AssemblyErrors
        Its assembly errors.
    largest : float
        Largest torque, N m.
    tilting : bool
        Whether the error of the shaft angle may change.

    Returns
    -------
    Nodes
        rad, m and N m.

    Raises
    ------
    InvalidInput
        For a pair whose flanks touch along lines.
    """
    if pair.shaper_lift <= 0.0:
        requirement = "more than the pinion's for poses: flanks that touch along lines meet them with edges"
        raise InvalidInput("teeth of the shaper", int(pair.pinion_teeth), requirement)
    at_rest = contact_at(pair, nominal)
    width = pair.last_end - pair.first_end
    middle = pair.mean_radius if at_rest is None else at_rest.path
    flattest = pair.path_at(FLATTEST, AssemblyErrors(pinion_axial=nominal.pinion_axial))
    first = max(middle - INSIDE * width, flattest)
    last = max(pair.last_end, middle) + BEYOND * width
    reach = np.array([-LEANING, LEANING]) if tilting else np.zeros(1)
    return Nodes(
        angles=nominal.shaft_angle_error + reach,
        paths=np.linspace(first, last, PATHS),
        torques=largest * np.geomspace(1.0 / DEEPEST, 1.0, TORQUES),
    )


@dataclass(frozen=True, eq=False)
class PoseSurface:
    """Quantities at nodes, each (angles, paths, torques).

    Attributes
    ----------
    pair
        Numbers of the pair, for the closed form of the unloaded contact.
    nominal
        Assembly errors that the machine's own mesh stiffness was computed with.
    nodes
        Coordinates.
    values
        By their names in QUANTITIES; those that are not known are left out.
    reference_torque
        Torque at which the machine takes a mesh stiffness that does not depend on the load (N m).
    further
        Surfaces of flanks that differ from the upper gear's drive flank, which this one is of.
    flank_numbers
        Number of the surface of drive and back flank by GEARS: 0 for this one, then those of `further`.
    """

    pair: PairNumbers
    nominal: AssemblyErrors
    nodes: Nodes
    values: Mapping[str, Array]
    reference_torque: float
    further: "tuple[PoseSurface, ...]" = ()
    flank_numbers: tuple[tuple[int, int], ...] = ((0, 0), (0, 0))

    def of_flank(self, gear: str, flank: str) -> "PoseSurface":
        """Return the surface of a flank, whose pair and assembly are those of a drive flank.

        Parameters
        ----------
        gear : str
            `upper` or `lower`.
        flank : str
            `drive` or `back`.

        Returns
        -------
        PoseSurface
            This surface, or one of `further`.
        """
        number = self.flank_numbers[GEARS.index(gear)][FLANKS.index(flank)]
        return self if number == 0 else self.further[number - 1]

    @property
    def arrays(self) -> dict[str, Array]:
        """Surface as named arrays that `of_arrays` reads again, SI units: those of SURFACE_ARRAYS and all
        other `values`, then those of further surfaces.
        """
        errors = self.nominal
        arrays = {
            "pair": self.pair.array,
            "errors": np.array(
                [errors.offset, errors.shaft_angle_error, errors.gear_axial, errors.pinion_axial]
            ),
            "angle_rad": self.nodes.angles,
            "path_m": self.nodes.paths,
            "torque_n_m": self.nodes.torques,
            "reference_torque_n_m": np.array(self.reference_torque),
            **self.values,
        }
        if not self.further:
            return arrays
        arrays[FLANK_NUMBERS] = np.array(self.flank_numbers)
        for number, surface in enumerate(self.further, start=1):
            arrays |= {f"further{number}_{name}": values for name, values in surface.arrays.items()}
        return arrays

    @classmethod
    def of_arrays(cls, arrays: Arrays) -> Self:
        """Read a surface from the arrays that the property `arrays` gives.

        Parameters
        ----------
        arrays : Arrays
            Arrays by name, as SURFACE_ARRAYS; further QUANTITIES are read where they are present.

        Returns
        -------
        Self
            SI units.
        """
        numbers = np.asarray(arrays.get(FLANK_NUMBERS, np.zeros((2, 2), int)))
        return cls(
            further=tuple(
                cls.of_arrays(
                    {
                        name.removeprefix(f"further{number}_"): values
                        for name, values in arrays.items()
                        if name.startswith(f"further{number}_")
                    }
                )
                for number in range(1, int(numbers.max()) + 1)
            ),
            flank_numbers=tuple((int(drive), int(back)) for drive, back in numbers),
            pair=PairNumbers.of_array(arrays["pair"]),
            nominal=AssemblyErrors(*(float(value) for value in arrays["errors"])),
            nodes=Nodes(arrays["angle_rad"], arrays["path_m"], arrays["torque_n_m"]),
            values={name: arrays[name] for name in QUANTITIES if name in arrays},
            reference_torque=float(arrays["reference_torque_n_m"]),
        )

    def at(self, quantity: str, torque: float, path: float, angle: float) -> float:
        """Return a quantity within the nodes: splines over path and ln(torque), linear over the angle.

        Below the smallest torque the stiffness goes on as the power of the load that it has there, and
        all else is what it is at that torque.

        Parameters
        ----------
        quantity : str
            Name from QUANTITIES.
        torque : float
            Torque on the pinion, N m.
        path : float
            Unloaded path, m.
        angle : float
            Error of the shaft angle, rad; outside the nodes the outermost one is taken.

        Returns
        -------
        float
            In the unit of the quantity: N/m, m or Pa.
        """
        nodes = self.nodes
        torque = max(torque, NO_TORQUE * float(nodes.torques[0]))
        light = min(float(np.log(torque / nodes.torques[0])), 0.0)
        weights = self.torque_weights(np.log(torque) - light)
        if quantity == STIFFNESS:
            weights = weights + light * self.torque_weights(np.log(nodes.torques[0]), 1)
        by_angle = self._splines[quantity](path) @ weights
        value = float(np.interp(angle, nodes.angles, by_angle))
        return value if quantity == RADIUS else float(np.exp(value))

    def torque_weights(self, logs: Array | float, order: int = 0) -> Array:
        """Return weights w of the node values v such that w . v is the cubic spline of v over the
        logarithm of the torque.

        Parameters
        ----------
        logs : array of any shape (...) or float
            Logarithms of torques in N m, dimensionless.
        order : int
            0 for the value there, 1 for the slope over the logarithm.

        Returns
        -------
        (..., torques) array
            Dimensionless factors.
        """
        return np.asarray(self._torque_spline(logs, order))

    @cached_property
    def reference_stiffness(self) -> float:
        """Average stiffness (N/m) at the nominal assembly and `reference_torque`, which stands for the
        machine's own stiffness where that does not depend on the load.
        """
        contact = contact_at(self.pair, self.nominal)
        assert contact is not None
        return self.at(STIFFNESS, self.reference_torque, contact.path, self.nominal.shaft_angle_error)

    def stiffness_logs(self, path: float, angle: float) -> Array:
        """Return the logarithm of the stiffness at the torques of the nodes, and its derivatives by path
        and angle.

        Parameters
        ----------
        path : float
            Unloaded path, m.
        angle : float
            Error of the shaft angle, rad.

        Returns
        -------
        (3, torques) array
            Logarithm of N/m, and derivatives in 1/m and 1/rad; the last is 0 with a single angle.
        """
        angles, spline = self.nodes.angles, self._splines[STIFFNESS]
        logs, by_path = spline(path), spline(path, 1)
        if angles.size == 1:
            return np.stack([logs[0], by_path[0], np.zeros_like(logs[0])])
        first = int(np.clip(np.searchsorted(angles, angle) - 1, 0, angles.size - 2))
        step = angles[first + 1] - angles[first]
        part = (angle - angles[first]) / step
        weights = np.array([1.0 - part, part])
        between = slice(first, first + 2)
        risen = (logs[first + 1] - logs[first]) / step
        return np.stack([weights @ logs[between], weights @ by_path[between], risen])

    def require(self, mesh: str, torque: float, path: float, angle: float) -> None:
        """Raise InvalidInput, naming the mesh, for a pose outside the nodes.

        Parameters
        ----------
        mesh : str
            Name of the mesh.
        torque : float
            Torque on the pinion, N m.
        path : float
            Unloaded path, m.
        angle : float
            Error of the shaft angle, rad.
        """
        nodes = self.nodes
        for quantity, value, range_of_nodes, unit in (
            ("path of the contact", 1e3 * path, 1e3 * nodes.paths, "mm"),
            ("error of the shaft angle", np.degrees(angle), np.degrees(nodes.angles), "deg"),
            ("torque", torque, np.append(0.0, nodes.torques[-1]), "N m"),
        ):
            low, high = float(range_of_nodes[0]), float(range_of_nodes[-1])
            if not low - 1e-9 <= value <= high + 1e-9:
                requirement = (
                    f"within {low:.6g} to {high:.6g} {unit} of the poses solved: nothing is extrapolated"
                )
                raise InvalidInput(f"{quantity} of mesh {mesh}", f"{value:.6g} {unit}", requirement)

    def left_out(self, quantity: str) -> dict[str, Array]:
        """Return the interpolation errors at inner nodes of `path` and `torque` if each node had not been
        solved.

        The spline through all other nodes is compared with the solved value. These errors belong to twice
        the distance of the nodes, and bound the error.

        Parameters
        ----------
        quantity : str
            Name from QUANTITIES.

        Returns
        -------
        dict of str to array
            Keys path and torque; the first axis counts the inner nodes of the key, the others are the
            remaining two of (angles, paths, torques). Differences of logarithms, so relative; of the
            path's radius in m.
        """
        logs = self._logs(quantity)
        over = {"path": (1, self.nodes.paths), "torque": (2, np.log(self.nodes.torques))}
        return {
            name: _left_out(node_coordinates, np.moveaxis(logs, axis, 0))
            for name, (axis, node_coordinates) in over.items()
        }

    def _logs(self, quantity: str) -> Array:
        """Return the node values (angles, paths, torques) that are interpolated: radii as they are, else
        logarithms.
        """
        values = self.values[quantity]
        return values if quantity == RADIUS else np.log(values)

    @cached_property
    def _torque_spline(self) -> "scipy.interpolate.CubicSpline":
        """Cubic spline over the logarithm of the torque of all unit vectors at once: its values are
        `torque_weights`.
        """
        torques = self.nodes.torques
        return scipy.interpolate.CubicSpline(np.log(torques), np.eye(torques.size))

    @cached_property
    def _splines(self) -> dict[str, "scipy.interpolate.CubicSpline"]:
        """Cubic splines of each quantity over the unloaded path, which return (angles, torques); see
        `_logs`.
        """
        return {
            name: scipy.interpolate.CubicSpline(self.nodes.paths, self._logs(name), axis=1)
            for name in self.values
        }


def _left_out(coordinates: Array, values: Array) -> Array:
    """Return spline value less node value at each inner node (inner, ...), the spline being through all
    others.

    coordinates (n,): rising nodes; values (n, ...): in any unit.
    """
    errors = []
    for inner in range(1, len(coordinates) - 1):
        fewer = scipy.interpolate.CubicSpline(np.delete(coordinates, inner), np.delete(values, inner, axis=0))
        errors.append(fewer(coordinates[inner]) - values[inner])
    return np.array(errors)
