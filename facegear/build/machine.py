"""The lumped machine with its mesh law, friction, elastic gears and poses, put together in one place."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, Self

import numpy as np
import pandas as pd
from scipy.interpolate import PchipInterpolator

from facegear.arrays import Array, Arrays
from facegear.build.lumped_model import machine
from facegear.build.tooth_numbers import ToothNumbers
from facegear.errors import ConfigError
from facegear.harmonics import Harmonics, fit_harmonics, stack_series
from facegear.lubrication.columns import EXCITATION_COLUMNS, EXCITATION_FLANK, EXCITATION_TILTS
from facegear.machine.disturbances import MeshFriction
from facegear.machine.elastic_gears import ElasticGears
from facegear.machine.imperfections import from_arrays
from facegear.machine.layout import Layout
from facegear.machine.machine import FlankTables, Machine
from facegear.machine.mean_load import at_mean_load
from facegear.machine.poses.fixed_point import posed_machine
from facegear.machine.poses.surface import PoseSurface
from facegear.machine.static_gears import at_rest
from facegear.machine.statics import mean_equilibrium
from facegear.meshing import stiffness_source
from facegear.meshing.force_table import ForceTable
from facegear.parts.reduced_body import ReducedBody
from facegear.schema.transmission import Transmission
from facegear.teeth.placement import FLANKS, GEARS

TablesOf = Callable[[Layout], tuple[FlankTables, ...]]
"""Tables of the flanks at each gear of a machine."""


def flank_tables(law: Arrays, layout: Layout) -> tuple[FlankTables, ...]:
    """Return the force tables of drive and back flanks at each gear of a machine.

    Parameters
    ----------
    law : mapping of arrays
        Arrays `law` of stage mesh_law: `level_m`, `force_n` and `slope_n_per_m`, with the tables of
        `ForceTable` along the first axis, and the numbers `flank_variant` (gears, 2) of the tables for
        the drive and back flank of each gear.
    layout : Layout
        Layout of the machine.

    Returns
    -------
    tuple[FlankTables, ...]
        One entry for each gear; a gear alone has the tables of the upper one.
    """
    return tables_of(law)(layout)


def tables_of(law: Arrays) -> TablesOf:
    """Return a function that gives the force tables of the flanks of many machines with one mesh law.

    Machines with the same gears get the same table objects, whose arrays cannot be written.

    Parameters
    ----------
    law : mapping of arrays
        Arrays `law` of stage mesh_law, as in `flank_tables`.

    Returns
    -------
    TablesOf
        Function from a layout to the tables of its gears, one FlankTables a gear, as `flank_tables`
        returns.
    """
    tables = [
        ForceTable(_read_only(levels), _read_only(forces), _read_only(slopes))
        for levels, forces, slopes in zip(law["level_m"], law["force_n"], law["slope_n_per_m"], strict=True)
    ]

    @cache
    def of_gears(names: tuple[str, ...]) -> tuple[FlankTables, ...]:
        """Return the tables of drive and back flank of gears by the names of `Layout.contact_gears`."""
        numbers = law["flank_variant"][[GEARS.index(name) for name in names]]
        return tuple(FlankTables(tables[drive], tables[back]) for drive, back in numbers)

    return lambda layout: of_gears(layout.contact_gears)


def _read_only(values: Array) -> Array:
    """Return a copy of an array that cannot be written, as machines share it."""
    copy = values.copy()
    copy.flags.writeable = False
    return copy


ORDERS = 8
"""Harmonics of the mesh frequency that friction excites; the mean is exact."""


def with_friction(machine: Machine, table: pd.DataFrame) -> Machine:
    """Return a machine with friction of its meshes, which disturbs the motion and does nothing at rest.

    Each mesh has the ratios of friction to elastic force at the torque that it carries at rest, as a
    Fourier series of ORDERS harmonics over the mesh cycle. Between the torques of the contact analysis
    they are interpolated over the logarithm of the torque, outside they are those of the nearest.

    Parameters
    ----------
    machine : Machine
        The lumped machine.
    table : pd.DataFrame
        Table `excitation` of stage lubrication: columns torque_n_m and position (pitches), then friction
        over mesh force: three force components, and lever arms on pinion and gear (mm); for teeth other
        than spur ones also those that tilt the pinion, with rows for each flank of each gear.

    Returns
    -------
    Machine
        Copy of the machine with `friction` set.

    Raises
    ------
    NotConverged
        If the machine has no static equilibrium.
    """
    layout = machine.layout
    torques = np.abs(layout.mesh_torques(mean_equilibrium(at_rest(machine)).forces[0]))
    if layout.kind is None:
        return replace(machine, friction=MeshFriction(_series_of_meshes(table, layout, torques)))
    drive, back = (
        np.concatenate(
            [
                _series_of_meshes(
                    _rows_of_flank(table, layout.contact_gears[gear], flank), layout, torques[[mesh]]
                )
                for mesh, (_, gear) in enumerate(layout.meshes)
            ]
        )
        for flank in FLANKS
    )
    return replace(machine, friction=MeshFriction(drive, back))


def _rows_of_flank(table: pd.DataFrame, gear: str, flank: str) -> pd.DataFrame:
    """Return the rows of table `excitation` that belong to a flank of a gear."""
    gears, flanks = (table[name] for name in EXCITATION_FLANK)
    return table[(gears == gear) & (flanks == flank)]


def _series_of_meshes(table: pd.DataFrame, layout: Layout, torques: Array) -> Array:
    """Return the Fourier series (n, parts, 2, orders) of friction's parts over elastic force at n torques of
    meshes, N m, from rows of table `excitation` of one flank.
    """
    table_torques, ratios = _ratios(table)
    for column, name in enumerate(_ratio_names(table)):
        if name.endswith("_mm"):
            arm = layout.gear_arm if name.startswith("face_gear") else layout.pinion_arm
            ratios[..., column] /= 1e3 * arm
    return np.stack([_series(table_torques, ratios, torque) for torque in torques])


def _ratio_names(table: pd.DataFrame) -> list[str]:
    """Return the columns of table `excitation` after torque and position, with those of tilts where it has
    them.
    """
    return [*EXCITATION_COLUMNS[2:], *(name for name in EXCITATION_TILTS if name in table)]


def _ratios(table: pd.DataFrame) -> tuple[Array, Array]:
    """Return the torques (t,) of table `excitation`, N m, rising, and its ratios (t, positions, parts).

    The last axis has the columns of `_ratio_names`: friction over mesh force, as three force components and
    lever arms in mm.
    """
    names = _ratio_names(table)
    by_torque = table.sort_values(["torque_n_m", "position"]).groupby("torque_n_m")
    ratios = np.stack([rows[names].to_numpy() for _, rows in by_torque])
    return np.array(list(by_torque.groups), float), ratios


def _series(torques: Array, ratios: Array, torque: float) -> Array:
    """Return the Fourier series (parts, 2, orders) of friction's ratios over the mesh cycle at one torque.

    The axis of 2 has the sine part first. `torques` (t,) and `torque` are in N m, `ratios` is (t,
    positions, parts). Ratios are interpolated (PCHIP) over the logarithm of the torque, which is clipped to
    the range of `torques`.
    """
    clipped_torque = np.clip(torque, torques[0], torques[-1])
    at = (
        ratios[0] if torques.size == 1 else PchipInterpolator(np.log(torques), ratios)(np.log(clipped_torque))
    )
    return stack_series([fit_harmonics(column).series.truncate(ORDERS) for column in at.T])


def at_mesh_torque(section: Transmission, torque: float) -> Transmission:
    """Scale all torques of a machine so that each input pinion has a given torque in each of its meshes.

    An input meshes with all face gears, among which its torque is taken to be shared evenly: the factor
    is torque times number of face gears over abs(per_input_n_m).

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    torque : float
        Torque on an input pinion by each of its meshes, N m. A positive one keeps the signs of all
        torques, a negative one reverses them.

    Returns
    -------
    Transmission
        The section with the scaled torques.

    Raises
    ------
    ConfigError
        If `torque.per_input_n_m` is 0.
    """
    input_torque = section.torque.per_input_n_m
    if input_torque == 0.0:
        raise ConfigError(
            "transmission.torque.per_input_n_m", input_torque, "not 0, for the bins of a duty cycle"
        )
    factor = torque * len(section.face_gears) / abs(input_torque)
    return Transmission.of_config(with_torques(section.model_dump(mode="json"), factor))


def with_torques(transmission: Mapping[str, Any], part: float) -> dict[str, Any]:
    """Multiply the mean torques of section `transmission` by a factor: inputs, single pinions and single
    gears.

    Amplitudes of periodic torques and external forces stay.

    Parameters
    ----------
    transmission : Mapping[str, Any]
        Plain values of the section.
    part : float
        Factor on the torques, dimensionless.

    Returns
    -------
    dict[str, Any]
        Plain values with the new torques.
    """

    def scale_torque(section: Mapping[str, Any]) -> dict[str, Any]:
        """Return a section with its torque multiplied by the factor; a torque of None stays."""
        torque = section.get("torque_n_m")
        return {**section, "torque_n_m": torque if torque is None else part * torque}

    return {
        **transmission,
        "torque": {**transmission["torque"], "per_input_n_m": part * transmission["torque"]["per_input_n_m"]},
        "pinions": [scale_torque(pinion) for pinion in transmission["pinions"]],
        "single_gears": {name: scale_torque(gear) for name, gear in transmission["single_gears"].items()},
    }


@dataclass(frozen=True, kw_only=True)
class MachineInputs:
    """Everything that decides what a lumped machine is.

    The pipeline resolves it from the config and from the files of earlier stages; a feature that changes
    what a machine is adds a field here and a line to `build`.

    Attributes
    ----------
    transmission : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Tooth numbers, module (m) and pressure angle (rad) of the pair.
    harmonics : Harmonics or pd.DataFrame or None
        Mesh stiffness (N/m): a series, or table `harmonics` of stage stiffness, which brings the pair's
        own transmission error; None where it is not computed.
    unloaded_error : Harmonics or None
        Transmission error of the unloaded pair (m) beside a series of the stiffness.
    friction : pd.DataFrame or None
        Table `excitation` of stage lubrication, where friction acts on the motion.
    law : mapping of arrays or None
        Arrays `law` of stage mesh_law, where mesh forces depend on the load.
    poses : mapping of arrays or None
        Arrays `surface` of stage pose_surface, where meshes stand in the loaded position of their bodies.
    bodies : mapping of arrays or None
        Arrays `reduced` of stage gear_bodies, where face gears bend.
    casing : mapping of arrays or None
        Arrays `reduced` of stage casing, where the machine stands on one.
    tooth_errors : mapping of arrays or None
        Arrays `curves` of stage tooth_errors, where single teeth deviate.
    """

    transmission: Transmission
    teeth: ToothNumbers
    harmonics: Harmonics | pd.DataFrame | None = None
    unloaded_error: Harmonics | None = None
    friction: pd.DataFrame | None = None
    law: Arrays | None = None
    poses: Arrays | None = None
    bodies: Arrays | None = None
    casing: Arrays | None = None
    tooth_errors: Arrays | None = None

    @classmethod
    def of_config(cls, values: Mapping[str, Any], harmonics: Harmonics | pd.DataFrame) -> Self:
        """Return the inputs of a machine of which only the mesh stiffness is computed or given: no
        friction, mesh law, poses, elastic gears or errors of single teeth.

        Parameters
        ----------
        values : mapping
            Plain values of a whole config.
        harmonics : Harmonics or pd.DataFrame
            Mesh stiffness: a series (N/m), or table `harmonics` of stage stiffness.

        Returns
        -------
        MachineInputs
            Inputs with sections `transmission` and `tooth_pair` of the config.
        """
        transmission = Transmission.of_config(values["transmission"])
        return cls(
            transmission=transmission,
            teeth=ToothNumbers.of_config(values["tooth_pair"]),
            harmonics=harmonics,
        )

    def at_torque(self, torque_n_m: float, speed_rpm: float | None = None) -> Self:
        """Return the inputs of the machine with all mean torques scaled to another torque of the input
        pinions.

        Parameters
        ----------
        torque_n_m : float
            Torque on an input pinion by each of its meshes, N m.
        speed_rpm : float or None
            Speed of the pinions, rpm, for rolling elements that feel centrifugal force; None: that of the
            inputs.

        Returns
        -------
        MachineInputs
            A copy with the torques of `at_mesh_torque`; friction, law and poses stay.
        """
        section = at_mesh_torque(self.transmission, torque_n_m)
        return replace(self, transmission=section if speed_rpm is None else section.at_speed(speed_rpm))

    def build(self) -> Machine:
        """Build the lumped machine from the config, the mesh stiffness and everything else that was
        computed.

        Returns
        -------
        Machine
            The lumped machine with mesh law, elastic gears, errors of single teeth, poses, tangents of
            rolling bearings and friction, added in this order as far as the inputs hold them.

        Raises
        ------
        ConfigError
            If pinions or torques do not fit the layout.
        NotConverged
            If the loaded position of the bodies, or the static equilibrium for friction, is not found.
        """
        if self.harmonics is None:
            raise ValueError("harmonics: a mesh stiffness is needed to build a machine")
        series, error, flanks = self.harmonics, self.unloaded_error, None
        if isinstance(series, pd.DataFrame):
            error = stiffness_source.unloaded_error(series)
            flanks = stiffness_source.flank_series(series)
            series = stiffness_source.series_of(series)
        lumped_machine = machine(
            self.transmission, self.teeth, series, error, casing=self.casing, flank_stiffness=flanks
        )
        if self.law is not None:
            lumped_machine = replace(lumped_machine, tables=flank_tables(self.law, lumped_machine.layout))
        if self.bodies is not None:
            elastic = elastic_gears(self.bodies, lumped_machine.layout)
            lumped_machine = replace(lumped_machine, bodies=elastic, softening=elastic.softening())
        if self.tooth_errors is not None:
            errors = replace(lumped_machine.imperfections, teeth=from_arrays(self.tooth_errors))
            lumped_machine = replace(lumped_machine, imperfections=errors)
        # Friction acts where the loaded bodies stand, so poses come first.
        if self.poses is not None:
            lumped_machine = posed_machine(lumped_machine, PoseSurface.of_arrays(self.poses))
        lumped_machine = at_mean_load(lumped_machine)
        return lumped_machine if self.friction is None else with_friction(lumped_machine, self.friction)


def elastic_gears(bodies: Arrays, layout: Layout) -> ElasticGears:
    """Read the reduced bodies of the face gears that bend, by the gears' numbers in a layout.

    Parameters
    ----------
    bodies : mapping of arrays
        Arrays `reduced` of stage gear_bodies, SI units; names begin with `lower_` or `upper_`.
    layout : Layout
        Layout of the machine.

    Returns
    -------
    ElasticGears
        Reduced bodies of the gears that are not rigid.
    """
    gear_numbers = {gear.side.value: number for number, gear in enumerate(layout.gears)}
    return ElasticGears(
        layout,
        {
            number: ReducedBody.of_arrays(bodies, side)
            for side, number in gear_numbers.items()
            if f"{side}_order" in bodies
        },
    )
