"""The inputs of a lumped machine, and the one place that builds the machine of them."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

import pandas as pd

from facegear.arrays import Arrays
from facegear.config.loads import at_mesh_torque
from facegear.config.lumped_model import machine
from facegear.config.machine_layout import ToothNumbers
from facegear.config.mesh_friction import with_friction
from facegear.config.mesh_law import flank_tables
from facegear.config.transmission import Transmission
from facegear.gear_body.reduced_body import ReducedBody
from facegear.harmonics.series import Harmonics
from facegear.poses.fixed_point import posed_machine
from facegear.poses.surface import PoseSurface
from facegear.stiffness import tables as stiffness_tables
from facegear.transmission.elastic_gears import ElasticGears
from facegear.transmission.layout import Layout
from facegear.transmission.machine import Machine
from facegear.transmission.tooth_errors import from_arrays


@dataclass(frozen=True, kw_only=True)
class MachineInputs:
    """Everything that decides what a lumped machine is.

    The pipeline resolves it from the config and from the files of earlier stages; a feature that changes what
    a machine is adds a field here and a line to `build`.

    Attributes
    ----------
    transmission : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Tooth numbers, module (m) and pressure angle (rad) of the pair.
    harmonics : Harmonics or pd.DataFrame or None
        Mesh stiffness (N/m): a series, or table `harmonics` of stage stiffness, which brings the pair's own
        transmission error; None where it is not computed.
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
    tooth_errors: Arrays | None = None

    @classmethod
    def of_config(cls, values: Mapping[str, Any], harmonics: Harmonics | pd.DataFrame) -> Self:
        """Return the inputs of a machine without anything that earlier stages compute but its stiffness.

        Parameters
        ----------
        values : mapping
            Plain values of a whole config.
        harmonics : Harmonics or pd.DataFrame
            Mesh stiffness, N/m.

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

    def at_torque(self, torque_n_m: float) -> Self:
        """Return the inputs with another torque.

        Parameters
        ----------
        torque_n_m : float
            Torque of an input in each of its meshes, N m.

        Returns
        -------
        MachineInputs
            The same inputs, all torques of the transmission in proportion.
        """
        return replace(self, transmission=at_mesh_torque(self.transmission, torque_n_m))

    def build(self) -> Machine:
        """Build the machine.

        Returns
        -------
        Machine
            The lumped machine with everything that the inputs hold.

        Raises
        ------
        ConfigError
            If pinions or torques do not fit the layout.
        NotConverged
            If the loaded position of the bodies is not found.
        """
        if self.harmonics is None:
            raise ValueError("harmonics: a mesh stiffness is needed to build a machine")
        series, error = self.harmonics, self.unloaded_error
        if isinstance(series, pd.DataFrame):
            error = stiffness_tables.unloaded_error(series)
            series = stiffness_tables.series_of(series)
        lumped_machine = machine(self.transmission, self.teeth, series, error)
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
        return lumped_machine if self.friction is None else with_friction(lumped_machine, self.friction)


def elastic_gears(bodies: Arrays, layout: Layout) -> ElasticGears:
    """Return the face gears of a layout that bend.

    Parameters
    ----------
    bodies : mapping of arrays
        Arrays `reduced` of stage gear_bodies.
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
