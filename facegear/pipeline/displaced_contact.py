"""Contact of a pair whose two bodies stand displaced, without load and under torques, and its answer."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import degrees, isfinite, radians, tau
from pathlib import Path

import pandas as pd

from facegear.arrays import Arrays
from facegear.build.machine_layout import layout
from facegear.build.plans import contact_plan
from facegear.build.tooth_numbers import ToothNumbers
from facegear.build.tooth_pair import ToothPair, pair, pair_design
from facegear.contact.analysis import met_contacts
from facegear.contact.gear_flank import every_flank_from_arrays
from facegear.errors import ConfigError, extras_named, require_choice
from facegear.io.tables import write_workbook
from facegear.machine.poses.displaced_pair import DisplacedFlank, Displacement, MeshPlace, displaced_flanks
from facegear.number_format import count_noun
from facegear.pipeline.outcome import Outcome
from facegear.schema.contact import Contact
from facegear.schema.transmission import Transmission

SHIFTS, TURNS = ("x_um", "y_um", "z_um"), ("tilt_x_deg", "tilt_y_deg", "theta_deg")
"""Keys of a body's displacements: along the axes, µm, and about them, deg."""
LARGEST_SHIFT, LARGEST_TURN = 5000.0, 2.0
"""Largest shift (um) and turn (deg) of a body: the bounds of assembly errors in a config."""


def displaced_contact(
    tooth_pair: ToothPair,
    transmission: Transmission | None,
    mesh: str | None,
    pinion: Mapping[str, float],
    face_gear: Mapping[str, float],
    position: float,
) -> dict[str, DisplacedFlank]:
    """Compute the unloaded contact of the drive and the back flank of a mesh whose two bodies are
    displaced.

    The displacements are rigid motions, given in frames of the machine and added to the errors of
    assembly of the config. The pinion's x is the tangent as the upper gear's teeth move, z outwards along
    the pinion, y square to both, the gears' axis towards the upper gear where axes are at a right angle.
    The gear's x points to azimuth 0, y a quarter turn further, z from the lower to the upper gear. Nothing
    is loaded: the flanks are rigid.

    Parameters
    ----------
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    transmission : Transmission or None
        Section `transmission` of the config, None if it has none.
    mesh : str or None
        Name of the mesh, `pinion/gear`; None for the first one. It must be None without a transmission.
    pinion : Mapping[str, float]
        Displacement of the pinion by the keys SHIFTS (um) and TURNS (deg); missing keys are 0.
    face_gear : Mapping[str, float]
        Displacement of the face gear, by the same keys (um, deg).
    position : float
        Position of the mesh cycle, a fraction of a pitch from 0 to 1.

    Returns
    -------
    dict[str, DisplacedFlank]
        Path, approach and backlash of each flank (m, rad), by the names `drive` and `back`.

    Raises
    ------
    ConfigError
        For a pair without bodies, a displacement that is not a number within bounds, and a mesh that
        the machine does not have.
    NotConverged
        Where flanks do not face each other.
    """
    if not (isinstance(position, int | float) and 0.0 <= position <= 1.0):
        raise ConfigError("position", position, "from 0 to 1, a place of a pitch")
    displacements = displacement("pinion", pinion), displacement("face_gear", face_gear)
    return displaced_flanks(
        pair_design(tooth_pair), _mesh_place(tooth_pair, transmission, mesh), *displacements, float(position)
    )


def displacement(body: str, values: Mapping[str, float]) -> Displacement:
    """Convert the displacement of a body from the keys and units of a user to SI units, and refuse
    wrong ones.

    Parameters
    ----------
    body : str
        `pinion` or `face_gear`, for the messages.
    values : Mapping[str, float]
        Values by the keys SHIFTS (um, at most LARGEST_SHIFT in magnitude) and TURNS (deg, at most
        LARGEST_TURN); missing keys are 0.

    Returns
    -------
    Displacement
        Shifts (3,) in m and turns (3,) in rad, both in the order x, y, z.

    Raises
    ------
    ConfigError
        For another key and for a value that is not a number within bounds.
    """
    for key, value in values.items():
        require_choice(key, (*SHIFTS, *TURNS), f"key of the displacement {body}")
        largest = LARGEST_SHIFT if key in SHIFTS else LARGEST_TURN
        number = isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)
        if not number or abs(value) > largest:
            raise ConfigError(f"{body}.{key}", value, f"a number from -{largest:g} to {largest:g}")
    x, y, z = (1e-6 * values.get(key, 0.0) for key in SHIFTS)
    first, second, third = (radians(values.get(key, 0.0)) for key in TURNS)
    return Displacement((x, y, z), (first, second, third))


def _mesh_place(tooth_pair: ToothPair, transmission: Transmission | None, mesh: str | None) -> MeshPlace:
    """Return the place of a named mesh, or of the first one for None: gear side, pinion azimuth and
    tilt height.

    The tilt height (m) is that of the point about which the gear tilts, over the pinion's axis and
    towards the gear. Without a machine the place is that of an upper gear and a pinion at azimuth 0,
    tilted in the pitch plane. Raises ConfigError for a name that does not exist.
    """
    teeth = ToothNumbers.of_config(tooth_pair.model_dump())
    if transmission is None:
        if mesh is not None:
            raise ConfigError("mesh", mesh, "left out: the config has no transmission")
        height = teeth.pitch_radius if teeth.kind is None else teeth.kind.pitch_height(1.0)
        return MeshPlace("upper", 0.0, height)
    machine = layout(transmission, teeth)
    names = machine.mesh_names
    i, g = machine.meshes[names.index(require_choice(mesh, names, "mesh")) if mesh is not None else 0]
    return MeshPlace(machine.gears[g].side.value, float(machine.angles[i]) % tau, machine.tilt_distance(g))


def unloaded_table(flanks: Mapping[str, DisplacedFlank]) -> pd.DataFrame:
    """Tabulate the unloaded contact in the units of its columns (um, mm, deg).

    Parameters
    ----------
    flanks : Mapping[str, DisplacedFlank]
        Contact by name of the flank.

    Returns
    -------
    pd.DataFrame
        A row for each flank, in the order of `flanks`; `DisplacedContact.table` describes the columns.
    """
    return pd.DataFrame(
        [
            {
                "flank": name,
                "offset_um": 1e6 * flank.design.assembly.offset,
                "gear_axial_um": 1e6 * flank.design.assembly.gear_axial,
                "shaft_angle_error_deg": degrees(flank.design.assembly.shaft_angle_error),
                "outward_um": 1e6 * flank.outward,
                "approach_um": 1e6 * flank.approach,
                "deflection_um": 1e6 * flank.deflection,
                "closing_um": 1e6 * flank.closure,
                "backlash_um": 1e6 * flank.backlash,
                "unloaded_path_mm": 1e3 * flank.path,
                "to_inner_end_mm": 1e3 * flank.to_inner_end,
                "to_outer_end_mm": 1e3 * flank.to_outer_end,
                "pressure_angle_deg": degrees(flank.slope),
            }
            for name, flank in flanks.items()
        ]
    )


def loaded_displaced_contact(
    flanks: Mapping[str, DisplacedFlank],
    tooth_pair: ToothPair,
    contact: Contact,
    bodies: tuple[Arrays, Arrays],
    torques: Sequence[float],
) -> Outcome:
    """Solve the loaded contact of both flanks of a displaced pair at each torque, over one pitch.

    The compliance of the bodies is that of the pair as assembled; only the gaps follow the
    displacements. Root stress is not computed.

    Parameters
    ----------
    flanks : Mapping[str, DisplacedFlank]
        Unloaded contact by name of the flank; each holds the pair with its displaced assembly.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    contact : Contact
        Section `contact` of the config: positions per pitch and options of the solver. Its torques are
        not used.
    bodies : tuple[Arrays, Arrays]
        Arrays of stage compliance, of the pinion and of the face gear.
    torques : Sequence[float]
        Torques on the pinion, N m, positive and rising.

    Returns
    -------
    Outcome
        Tables `by_torque` (a row a flank and torque) and `ltca` (a row a flank, torque and position),
        with the columns of `ContactResult.by_torque` and `.table` behind a first column `flank`.

    Raises
    ------
    NotConverged
        Where contact does not converge.
    """
    plan = replace(contact_plan(contact), root_stress=False)
    requests = [(flank.design, tuple(torques)) for flank in flanks.values()]
    teeth, compliances = pair(tooth_pair), list(zip(*map(every_flank_from_arrays, bodies), strict=True))
    solutions = list(met_contacts(teeth.design, teeth.materials, compliances, plan, requests))
    tables = {
        name: pd.concat(
            [
                getattr(solution, name).assign(flank=flank)
                for flank, solution in zip(flanks, solutions, strict=True)
            ],
            ignore_index=True,
        )
        for name in ("by_torque", "ltca")
    }
    content = {
        name: table[["flank", *(column for column in table.columns if column != "flank")]]
        for name, table in tables.items()
    }
    return Outcome(content, f"contact of both flanks at {count_noun(len(torques), 'torque')}")


Torques = float | Iterable[float] | None
"""Torques on the pinion, N m; None: those of the config."""


@dataclass(frozen=True, eq=False, repr=False)
class DisplacedContact:
    """Contact of both flanks of a mesh, its two bodies displaced: where they meet, how much they close.

    Attributes
    ----------
    flanks
        Unloaded contact of the flanks `drive` and `back`.
    solve
        Function from torques to the tables of the loaded contact.
    """

    flanks: Mapping[str, DisplacedFlank]
    solve: Callable[[Torques], Outcome]

    def table(self) -> pd.DataFrame:
        """One row a flank, drive and back: what it meets without load.

        - offset_um, gear_axial_um, shaft_angle_error_deg: errors of assembly that the displacements
          amount to, those of the config included, as the flank meets them; outward_um: shift of the
          pinion along its axis. It moves the ends of its face, and closes or opens flanks with a helix or a
          taper; the ends of spur pinions stay.
        - approach_um: how far the flanks have come together along the line of action from as assembled,
          exactly; deflection_um: its first order, which a lumped mesh counts as its deflection;
          closing_um: the rest, as in `operating_pose().table()`. A positive approach presses or turns
          the gear ahead.
        - backlash_um: backlash of the displaced pair along the drive flank's normal.
        - unloaded_path_mm: place of the contact along the pinion's axis, where it passes the pitch radius;
          to_inner_end_mm, to_outer_end_mm: its distances from the ends of the face, negative beyond them.
        - pressure_angle_deg: slope of the common normal there; NaN for flanks with modifications or
          deviations and beyond the ends of the face, where the contact is searched.

        Returns
        -------
        pd.DataFrame
            One row for `drive`, one for `back`; column `flank`, then those above.
        """
        return unloaded_table(self.flanks)

    def loaded(self, torques: Torques = None) -> pd.DataFrame:
        """Solve the contact of both flanks under torques, by finite element compliances; see
        `contact()`.

        Parameters
        ----------
        torques : Torques
            Torques on the pinion, N m, rising; None for those of the config. A single number is one
            torque.

        Returns
        -------
        pd.DataFrame
            A row for each flank and torque: `flank`, then the columns of `ContactResult.by_torque`.
            Raises what `contact` raises.
        """
        table: pd.DataFrame = self.solve(torques).content["by_torque"]
        return table.copy()

    def to_excel(self, path: str | Path) -> Path:
        """Write `table()` as a sheet of a workbook (.xlsx).

        Parameters
        ----------
        path : str or Path
            File to write.

        Returns
        -------
        Path
            The path. Raises MissingExtra where openpyxl is not installed.
        """
        with extras_named():
            return write_workbook(path, {"unloaded": self.table()})

    def __repr__(self) -> str:
        """Return a line with the approach of each flank, um."""
        approaches = ", ".join(f"{name} {1e6 * flank.approach:.4g} um" for name, flank in self.flanks.items())
        return f"DisplacedContact(approach of flanks: {approaches})"
