"""The front door: one object that answers for a machine, from its teeth to its load sharing."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from facegear.build.load import config_of, load_config
from facegear.door import machine, motion, outputs, sharing, strength, studies, teeth
from facegear.door.case import Case, drop_none
from facegear.errors import file_path
from facegear.pipeline.results.sharing import FollowingResult
from facegear.pipeline.results.store import Store, case_folder


def load(config: str | Path | Mapping[str, Any], results: str | Path | None = "results") -> "Gearbox":
    """Load the gearbox of a config file, or of a mapping with the keys of one.

    Parameters
    ----------
    config : str | Path | Mapping[str, Any]
        Path of the file, or the mapping. A mapping counts names of files from the working directory, and its
        key `extends` names a config file anywhere.
    results : str or Path or None
        Folder that the workflow writes to; a relative one is looked for here and beside the folder of the
        config file. None computes everything anew.

    Returns
    -------
    Gearbox
        The gearbox. Raises ConfigErrors with one line for every mistake.

    Examples
    --------
    >>> import facegear
    >>> facegear.load("config/harmonics_only.yaml").values["tooth_pair"]["pinion_teeth"]
    23
    >>> facegear.load({"extends": "config/harmonics_only.yaml", "case": "mine"}).config.case
    'mine'
    """
    if isinstance(config, Mapping):
        read, folders = config_of(config), [Path()]
    else:
        path = file_path(config, "config")
        read, folders = load_config(path), [Path(), path.resolve().parent.parent]
    if results is None:
        return Gearbox(read, Store())
    return Gearbox(read, Store(case_folder(folders, file_path(results, "results"), read.case)))


@cache
def example() -> "Gearbox":
    """Return a gearbox that needs no file: five pinions between two face gears, coarse enough to take
    seconds.

    It is the machine of config/paper.yaml with geometric meshes; what it computes is kept for the session.

    Returns
    -------
    Gearbox
        The gearbox.

    Examples
    --------
    >>> import facegear
    >>> facegear.example().values["tooth_pair"]["face_gear_teeth"]
    143
    """
    return Gearbox(load_config(str(files("facegear") / "example.yaml")))


@dataclass(frozen=True, eq=False, repr=False)
class Gearbox(Case):
    """A machine as its config describes it; every answer is computed once, or read where it is stored.

    `config` is validated, `store` finds what is known already or stored by the workflow. A stored result is
    used if it was made from the same part of the config, by the same code, from inputs of which the same
    holds; `source` of each result says which it is.

    >>> import facegear
    >>> gearbox = facegear.example().with_values({"transmission.backlash_um": 120})
    >>> gearbox.modes().source
    'computed'
    """

    geometry = teeth.geometry
    topography = teeth.topography
    contact = teeth.contact
    displaced_contact = teeth.displaced_contact
    tooth_errors = teeth.tooth_errors
    stiffness = teeth.stiffness
    mesh_law = teeth.mesh_law

    modes = machine.modes
    statics = machine.statics
    gear_bodies = machine.gear_bodies
    gear_waves = machine.gear_waves
    shafts = machine.shafts
    shaft_orders = machine.shaft_orders
    casing_loads = machine.casing_loads
    casing_response = machine.casing_response
    operating_pose = machine.operating_pose

    response = motion.response
    sweep = motion.sweep
    branches = motion.branches
    branch_loci = motion.branch_loci

    load_sharing = sharing.load_sharing
    hunting = sharing.hunting
    sensitivity = sharing.sensitivity
    sharing_map = sharing.sharing_map

    root_stress = strength.root_stress
    dynamic_stress = strength.dynamic_stress
    stress_over_speed = strength.stress_over_speed
    rating = strength.rating
    bearing_life = strength.bearing_life
    friction = strength.friction
    losses = strength.losses

    study = studies.study
    tolerances = studies.tolerances
    load_map = studies.load_map
    loosest_tolerances = studies.loosest_tolerances
    search = studies.search

    report = outputs.report
    summary = outputs.summary
    run = outputs.run
    figures = outputs.figures
    export = outputs.export

    def following(self, speed_rpm: float | None = None, cycles: int | None = None) -> "FollowingResult":
        """Compute the load sharing of the running machine while its runouts and pitch deviations turn.

        Parameters
        ----------
        speed_rpm : float or None
            Speed of the pinions, rpm; None for that of the config.
        cycles : int or None
            Number of mesh cycles that are followed; None for that of section `load_sharing`.

        Returns
        -------
        FollowingResult
            The load sharing. Raises NotConverged.
        """
        changes = drop_none({"dynamics.speed_rpm": speed_rpm, "load_sharing.followed_cycles": cycles})
        return self._with_changes("following", changes)._chain.result(FollowingResult)

    def __repr__(self) -> str:
        pair, machine = self.config.tooth_pair, self.config.transmission
        pinions, gears = (len(machine.pinions), len(machine.face_gears)) if machine else (1, 1)
        return (
            f"Gearbox({self.config.case}: pinions {pinions} x {pair.pinion_teeth} teeth, "
            f"face gears {gears} x {pair.face_gear_teeth} teeth)"
        )
