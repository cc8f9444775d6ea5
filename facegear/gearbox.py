"""The front door: one object that answers for a machine, from its teeth to its load sharing."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, field
from functools import cache, cached_property
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

from facegear.config.cases import changed_config, expand_cases
from facegear.config.keys import keys_named
from facegear.config.load import config_of, load_config, plain
from facegear.config.model import Config, resolved_values
from facegear.errors import ConfigError, FacegearError, extras_named, file_path, require_choice
from facegear.pipeline.run import machine_inputs
from facegear.results.chain import Chain
from facegear.results.store import Store, case_folder

if TYPE_CHECKING:
    from facegear.results.branch_loci import BranchLociResult
    from facegear.results.branches import BranchesResult
    from facegear.results.contact import ContactResult
    from facegear.results.displaced_contact import DisplacedContact
    from facegear.results.dynamic_stress import DynamicStressResult
    from facegear.results.friction import FrictionResult
    from facegear.results.gear_bodies import GearBodiesResult
    from facegear.results.gear_waves import GearWavesResult
    from facegear.results.geometry import GeometryResult
    from facegear.results.hunting import FollowingResult, HuntingResult, SensitivityResult
    from facegear.results.load_sharing import LoadSharingResult
    from facegear.results.machine_loss import MachineLossResult
    from facegear.results.mesh_law import MeshLawResult
    from facegear.results.modal import ModesResult
    from facegear.results.operating_pose import OperatingPoseResult
    from facegear.results.rating import RatingResult
    from facegear.results.response import ResponseResult
    from facegear.results.root_stress import RootStressResult
    from facegear.results.search import SearchResult
    from facegear.results.shaft_orders import ShaftOrdersResult
    from facegear.results.shafts import ShaftsResult
    from facegear.results.sharing_map import SharingMapResult
    from facegear.results.statics import StaticsResult
    from facegear.results.stiffness import StiffnessResult
    from facegear.results.stress_over_speed import StressOverSpeedResult
    from facegear.results.study import Study
    from facegear.results.sweep import SweepResult
    from facegear.results.tolerances import LoadMapResult, TolerancesResult
    from facegear.results.tooth_errors import ToothErrorsResult
    from facegear.results.topography import TopographyResult
    from facegear.results.whole_case import WholeCase
    from facegear.scenarios.inverse import Loosest
    from facegear.stages.outcome import Outcome
    from facegear.transmission.machine import Machine

ENDINGS = (".step", ".stp", ".stl", ".glb", ".fmu", ".rexs", ".csv")
"""Endings of the files that `Gearbox.export` writes."""
HOLDS = {"tolerances": "causes and what is asked of them", "search": "variables and objectives"}
"""Sections that a config may leave out, and what they say."""


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
class Gearbox:
    """A machine as its config describes it; every answer is computed once, or read where it is stored.

    `config` is validated, `store` finds what is known already or stored by the workflow. A stored result is
    used if it was made from the same part of the config, by the same code, from inputs of which the same
    holds; `source` of each result says which it is.

    >>> import facegear
    >>> gearbox = facegear.example().with_values({"transmission.backlash_um": 120})
    >>> gearbox.modes().source
    'computed'
    """

    config: Config
    store: Store = field(default_factory=Store)

    @property
    def values(self) -> dict[str, Any]:
        """The config as plain values, complete, with what follows from other keys filled in.

        A copy: what is changed in it changes no answer, `with_values` does.
        """
        return deepcopy(self._values)

    @cached_property
    def _values(self) -> dict[str, Any]:
        return resolved_values(self.config)

    def with_values(self, changes: Mapping[str, Any]) -> "Gearbox":
        """Return a changed copy; what the changes do not touch is not computed again.

        Parameters
        ----------
        changes : Mapping[str, Any]
            Values by dotted config key (list positions as numbers).

        Returns
        -------
        Gearbox
            The copy. Raises ConfigErrors with one line for every mistake.

        Examples
        --------
        >>> import facegear
        >>> stiffer = facegear.example().with_values({"mesh_stiffness.mean_n_per_m": 5e8})
        >>> stiffer.values["mesh_stiffness"]["mean_n_per_m"]
        500000000.0
        """
        if not isinstance(changes, Mapping) or not all(isinstance(key, str) for key in changes):
            raise FacegearError(f"changes = {changes!r}: must be a mapping of dotted config keys to values")
        return self._with_changes("with_values", changes)

    def geometry(self) -> "GeometryResult":
        """Compute limits, contact path, backlash and smallest gaps of the unloaded pair.

        Returns
        -------
        GeometryResult
            The geometry. Raises ConfigError for a pair without bodies.

        Examples
        --------
        >>> import facegear
        >>> facegear.example().geometry().summary.split(",")[0]
        'contact ratio 1.548'
        """
        from facegear.results.geometry import GeometryResult

        return self._chain.result(GeometryResult)

    def contact(
        self, torques: float | Iterable[float] | None = None, positions: int | None = None
    ) -> "ContactResult":
        """Solve the loaded tooth contact at every position and torque.

        Parameters
        ----------
        torques : float | Iterable[float] | None
            N m on the pinion for one mesh, rising; None for those of the config.
        positions : int or None
            Number of positions in a pitch; None for that of the config.

        Returns
        -------
        ContactResult
            The contact. Raises ConfigErrors for values that the config would refuse, NotConverged naming
            position and torque.

        Examples
        --------
        >>> import facegear
        >>> table = facegear.example().contact(torques=[600]).table()
        >>> float(table["kkt_residual"].max()) < 1e-12
        True
        """
        from facegear.results.contact import ContactResult

        changes = {**self._torques(torques), **_drop_none({"contact.positions_per_pitch": positions})}
        return self._with_changes("contact", changes)._chain.result(ContactResult)

    def displaced_contact(
        self,
        pinion: Mapping[str, float] | None = None,
        face_gear: Mapping[str, float] | None = None,
        mesh: str | None = None,
        position: float = 0.5,
    ) -> "DisplacedContact":
        """Compute contact and closing of both flanks of a mesh whose two bodies are displaced by given
        amounts.

        Parameters
        ----------
        pinion : Mapping[str, float] | None
            Any of x_um, y_um, z_um, tilt_x_deg, tilt_y_deg and theta_deg; 0 unless given. x along the tangent
            as the upper gear's teeth move, y along the gears' axis towards the upper gear, z outwards along
            the pinion; tilts about the middle of its face, theta as it drives.
        face_gear : Mapping[str, float] | None
            The same keys (um, deg) for the gear: x towards azimuth 0, y a quarter turn further, z from the
            lower to the upper gear; tilts about the point of its axis that `tilt` or `hub_tilt` says, or in
            the pitch plane; theta as it is driven.
        mesh : str or None
            `pinion/gear`, as `right idler/upper`; the first one unless given, and none for a pair without a
            transmission, which counts as that of an upper gear at azimuth 0.
        position : float
            Place within a pitch, fraction from 0 to 1, for flanks whose contact changes with it.

        Returns
        -------
        DisplacedContact
            The contact. Raises ConfigError for a pair without bodies, a displacement beyond 5 mm or 2 degrees
            or that is no number, NotConverged where flanks do not face each other.

        Examples
        --------
        >>> import facegear
        >>> moved = {"x_um": 100, "y_um": -20}
        >>> found = facegear.example().displaced_contact(pinion=moved, mesh="right input/upper")
        >>> found.table().set_index("flank")["approach_um"].round(1).to_dict()
        {'drive': 82.9, 'back': -99.0}
        """
        from facegear.geometry.bodies import BODIES
        from facegear.results.displaced_contact import DisplacedContact

        with extras_named():
            from facegear.stages.displaced_contact import displaced_contact, loaded_displaced_contact

        for body, displacement in {"pinion": pinion, "face_gear": face_gear}.items():
            if displacement is not None and not isinstance(displacement, Mapping):
                raise FacegearError(f"{body} = {displacement!r}: must be a mapping such as {{'x_um': 10}}")
        config, displacements = self.config, (dict(pinion or {}), dict(face_gear or {}))
        flanks = displaced_contact(config.tooth_pair, config.transmission, mesh, *displacements, position)

        def solve(torques: float | Iterable[float] | None) -> "Outcome":
            gearbox = self._with_changes("displaced_contact", self._torques(torques))
            parts = [gearbox._chain.part("compliance", "arrays", {"body": body}) for body in BODIES]
            contact = gearbox.config.contact_used
            return loaded_displaced_contact(
                flanks, config.tooth_pair, contact, (parts[0], parts[1]), contact.torques_n_m
            )

        return DisplacedContact(flanks, solve)

    def root_stress(self) -> "RootStressResult":
        """Compute the stress at the fillets of both gears over a tooth's passage, at the contact analysis'
        torques.

        The fillets carry gauges for it, whatever the config says.

        Returns
        -------
        RootStressResult
            The stress. Raises what `contact` raises.

        Examples
        --------
        >>> import facegear
        >>> table = facegear.example().root_stress().table()
        >>> table["body"].unique().tolist()
        ['pinion', 'face_gear']
        """
        from facegear.results.root_stress import RootStressResult

        return self._with_changes("root_stress", {"contact.root_stress": True})._chain.result(
            RootStressResult
        )

    def rating(self) -> "RatingResult":
        """Compute safety and life of the pair under the duty cycle of section `strength`.

        Returns
        -------
        RatingResult
            The rating. Raises ConfigError without that section, and what `contact` raises.

        Examples
        --------
        >>> import facegear
        >>> facegear.example().rating().table()["failure"].unique().tolist()
        ['bending', 'pitting']
        """
        from facegear.results.rating import RatingResult

        return self._chain.result(RatingResult)

    def friction(self, speed_rpm: float | None = None) -> "FrictionResult":
        """Compute sliding, loss, temperatures and film of one mesh at a pinion speed.

        Parameters
        ----------
        speed_rpm : float or None
            Speed of the pinions, rpm; None for that of the config.

        Returns
        -------
        FrictionResult
            The results. Raises ConfigError without section `lubrication`, and what `contact` raises.

        Examples
        --------
        >>> import facegear
        >>> oil = {"oil": "polyol_ester_5_cst", "supply_temperature_c": 80, "pinion": {"ra_um": 0.3}}
        >>> oil |= {"face_gear": {"ra_um": 0.3}, "bulk": {"source": "given", "temperature_c": 100}}
        >>> table = facegear.example().with_values({"lubrication": oil}).friction().table()
        >>> bool(table["efficiency"].between(0.99, 1).all())
        True
        """
        from facegear.results.friction import FrictionResult

        gearbox = self._with_changes("friction", _drop_none({"dynamics.speed_rpm": speed_rpm}))
        return gearbox._chain.result(FrictionResult)

    def losses(self, speed_rpm: float | None = None) -> "MachineLossResult":
        """Compute the loss of every mesh and the heat of every body at a pinion speed.

        Over the duty cycle as well, where `strength.load_factors` is `machine`.

        Parameters
        ----------
        speed_rpm : float or None
            Speed of the pinions, rpm; None for that of the config.

        Returns
        -------
        MachineLossResult
            The losses. Raises what `friction` and `modes` raise.
        """
        from facegear.results.machine_loss import MachineLossResult

        gearbox = self._with_changes("losses", _drop_none({"dynamics.speed_rpm": speed_rpm}))
        return gearbox._chain.result(MachineLossResult)

    def dynamic_stress(self, speed_rpm: float | None = None) -> "DynamicStressResult":
        """Compute the root stress of every mesh while the machine runs at a pinion speed.

        Parameters
        ----------
        speed_rpm : float or None
            Speed of the pinions, rpm; None for that of the config.

        Returns
        -------
        DynamicStressResult
            The stress. Raises what `root_stress` and `response` raise.

        Examples
        --------
        >>> import facegear
        >>> table = facegear.example().dynamic_stress(1000).table()
        >>> bool((table["pinion_bound_mpa"] >= table["pinion_running_mpa"]).all())
        True
        """
        from facegear.results.dynamic_stress import DynamicStressResult

        changes = {"contact.root_stress": True, **_drop_none({"dynamics.speed_rpm": speed_rpm})}
        return self._with_changes("dynamic_stress", changes)._chain.result(DynamicStressResult)

    def stress_over_speed(self) -> "StressOverSpeedResult":
        """Compute the largest root stress and pressure over the speed range, of every motion known at a
        speed.

        Motions are those of the sweep and, with section `branches`, all stable ones that were followed.

        Returns
        -------
        StressOverSpeedResult
            The stress. Raises what `root_stress` and `sweep` raise.

        Examples
        --------
        >>> import facegear
        >>> gearbox = facegear.example().with_values({"dynamics.sweep.points": 2})
        >>> table = gearbox.stress_over_speed().table()
        >>> bool((table.loc[table["worst"], "dynamic_factor"] > 1).all())
        True
        """
        from facegear.results.stress_over_speed import StressOverSpeedResult

        changes = {"contact.root_stress": True}
        return self._with_changes("stress_over_speed", changes)._chain.result(StressOverSpeedResult)

    def stiffness(self) -> "StiffnessResult":
        """Compute k(t) of one mesh at the config's load, or from given harmonics.

        Returns
        -------
        StiffnessResult
            The stiffness. Raises ConfigError for a load outside those of the contact analysis.

        Examples
        --------
        >>> import facegear
        >>> facegear.example().stiffness().table()["cos_n_per_m"].round(-3).to_list()[0]
        410000000.0
        """
        from facegear.results.stiffness import StiffnessResult

        return self._chain.result(StiffnessResult)

    def mesh_law(self) -> "MeshLawResult":
        """Compute the forces of the flanks over phase and deflection, which `mesh_law: load_dependent` uses.

        Returns
        -------
        MeshLawResult
            The law. Raises ConfigError for a pair without bodies, and what `contact` raises.
        """
        from facegear.results.mesh_law import MeshLawResult

        return self._chain.result(MeshLawResult)

    def modes(self) -> "ModesResult":
        """Compute natural frequencies, classes and shapes.

        They need a contact analysis unless `modal.stiffness` is average or the mesh stiffness is given.

        Returns
        -------
        ModesResult
            The modes.

        Examples
        --------
        >>> import facegear
        >>> int((facegear.example().modes().table()["class"] == "rigid body").sum())
        6
        """
        from facegear.results.modal import ModesResult

        return self._chain.result(ModesResult)

    def gear_bodies(self) -> "GearBodiesResult":
        """Compute modes and compliance of face gears that bend, with their hubs held.

        Returns
        -------
        GearBodiesResult
            The results. Raises ConfigError for a machine whose face gears are rigid.
        """
        from facegear.results.gear_bodies import GearBodiesResult

        return self._chain.result(GearBodiesResult)

    def gear_waves(self) -> "GearWavesResult":
        """Compute the damped modes at the nominal speed of a machine whose face gears bend, and their waves.

        Returns
        -------
        GearWavesResult
            The results. Raises ConfigError for a machine whose face gears are rigid, NotConverged.
        """
        from facegear.results.gear_waves import GearWavesResult

        return self._chain.result(GearWavesResult)

    def shafts(self) -> "ShaftsResult":
        """Compute stiffness and bearing loads of pinions' shafts, and the twist of engines and rotors, at
        rest.

        Returns
        -------
        ShaftsResult
            The results. Raises ConfigError for a machine without shafts and torsion, NotConverged.
        """
        from facegear.results.shafts import ShaftsResult

        return self._chain.result(ShaftsResult)

    def response(self, speed_rpm: float | None = None) -> "ResponseResult":
        """Compute the steady state at a pinion speed.

        Parameters
        ----------
        speed_rpm : float or None
            Speed of the pinions, rpm; None for that of the config.

        Returns
        -------
        ResponseResult
            The response. Raises ConfigErrors for a speed that the config would refuse, NotConverged naming
            the speed.

        Examples
        --------
        >>> import facegear
        >>> facegear.example().response(1000).table()["class"].iloc[0]
        'period-1'
        """
        from facegear.results.response import ResponseResult

        gearbox = self._with_changes("response", _drop_none({"dynamics.speed_rpm": speed_rpm}))
        return gearbox._chain.result(ResponseResult)

    def sweep(
        self,
        from_rpm: float | None = None,
        to_rpm: float | None = None,
        points: int | None = None,
        directions: Sequence[str] | None = None,
        threads: int = 1,
    ) -> "SweepResult":
        """Compute steady states over speed with the state carried over, with jumps and resonances.

        What is None is as in the config.

        Parameters
        ----------
        from_rpm : float or None
            First speed of the pinions, rpm.
        to_rpm : float or None
            Last speed of the pinions, rpm.
        points : int or None
            Number of speeds.
        directions : Sequence[str] | None
            `up`, `down` or both.
        threads : int
            Number of threads.

        Returns
        -------
        SweepResult
            The sweep. Raises ConfigErrors for values that the config would refuse, NotConverged naming the
            speed.

        Examples
        --------
        >>> import facegear
        >>> found = facegear.example().sweep(1000, 1200, points=3, directions=["up"])
        >>> found.dataset()["deflection_ac_rms_um"].dims
        ('direction', 'speed_rpm', 'mesh')
        """
        from facegear.results.sweep import SweepResult

        sweep_changes = {"from_rpm": from_rpm, "to_rpm": to_rpm, "points": points, "directions": directions}
        changes = _drop_none({f"dynamics.sweep.{key}": value for key, value in sweep_changes.items()})
        if isinstance(points, int) and points < self._values["dynamics"]["sweep"]["chunks"]:
            changes["dynamics.sweep.chunks"] = 1
        if not isinstance(threads, int) or threads < 1:
            raise FacegearError(f"sweep: threads = {threads!r}: must be a whole number of at least 1")
        return self._with_changes("sweep", changes)._chain.result(SweepResult, threads=threads)

    def branches(
        self,
        from_rpm: float | None = None,
        to_rpm: float | None = None,
        longest_period: int | None = None,
        starts: int | None = None,
    ) -> "BranchesResult":
        """Follow periodic motions over speed, stable or not, beside the sweep: folds, margins, coexistence.

        These are all motions that branches join to the first one, to those of the sweep or to those of the
        random starts, up to the longest period, with their images under the machine's symmetries. A motion
        that no branch leads to is missing if no start has found it; docs/explanation/branches.md lists all
        bounds. What is None is as in section `branches` of the config, or its default where there is no such
        section.

        Parameters
        ----------
        from_rpm : float or None
            First speed of the pinions, rpm.
        to_rpm : float or None
            Last speed of the pinions, rpm.
        longest_period : int or None
            Longest period followed through doublings, in mesh periods.
        starts : int or None
            Number of random starts.

        Returns
        -------
        BranchesResult
            The branches. Raises ConfigErrors for values that the config would refuse, NotConverged without a
            motion of period one.

        Examples
        --------
        >>> import facegear
        >>> quick = {"mesh_stiffness.mesh_law": "constant_load", "dynamics.sweep.points": 2}
        >>> found = facegear.example().with_values(quick).branches(7450, 7550, starts=1)
        >>> found.table()["period"].unique().tolist()
        [1]
        """
        from facegear.results.branches import BranchesResult

        explore = _drop_none({"starts": starts})
        changes = _drop_none({"from_rpm": from_rpm, "to_rpm": to_rpm, "longest_period": longest_period})
        gearbox = self._with_branches({**changes, **({"explore": explore} if explore else {})})
        return gearbox._chain.result(BranchesResult)

    def branch_loci(
        self, parameters: Sequence[str] | None = None, nearest: int | None = None
    ) -> "BranchLociResult":
        """Follow folds and period doublings, with cusps, while a second parameter changes.

        Parameters
        ----------
        parameters : Sequence[str] | None
            Some of torque, backlash, mesh_damping and bearing_stiffness; None for those of section
            `branches.loci`.
        nearest : int or None
            Number of special points nearest to the nominal speed that are followed; None for that of the
            section.

        Returns
        -------
        BranchLociResult
            The loci. Raises ConfigErrors for values that the config would refuse.
        """
        from facegear.results.branch_loci import BranchLociResult

        loci = _drop_none({"parameters": parameters, "nearest": nearest})
        return self._with_branches({"loci": loci} if loci else {})._chain.result(BranchLociResult)

    def load_sharing(self, speed_rpm: float | None = None) -> "LoadSharingResult":
        """Compute load-sharing coefficients at a pinion speed, averaged as section `load_sharing` asks.

        Parameters
        ----------
        speed_rpm : float or None
            Speed of the pinions, rpm; None for that of the config.

        Returns
        -------
        LoadSharingResult
            The coefficients. Raises ConfigErrors for a speed that the config would refuse, NotConverged
            naming the speed.

        Examples
        --------
        >>> import facegear
        >>> facegear.example().load_sharing().table()["group"].to_list()
        ['right input', 'left input', 'idlers']
        """
        from facegear.results.load_sharing import LoadSharingResult

        gearbox = self._with_changes("load_sharing", _drop_none({"dynamics.speed_rpm": speed_rpm}))
        return gearbox._chain.result(LoadSharingResult)

    def statics(self) -> "StaticsResult":
        """Compute the force of every mesh at rest under the mean torques, and torque, speed and power of
        every body.

        Returns
        -------
        StaticsResult
            The results. Raises NotConverged.

        Examples
        --------
        >>> import facegear
        >>> facegear.example().statics().table()["flank"].value_counts().to_dict()
        {'drive': 7, 'back': 3}
        """
        from facegear.results.statics import StaticsResult

        return self._chain.result(StaticsResult)

    def operating_pose(self) -> "OperatingPoseResult":
        """Compute the pose of the teeth of every mesh under the machine's own forces, and their contact
        there.

        Returns
        -------
        OperatingPoseResult
            The poses. Raises ConfigErrors for a machine without contact analysis, InvalidInput for a pose
            outside those that are solved, NotConverged.
        """
        from facegear.results.operating_pose import OperatingPoseResult

        gearbox = self._with_changes("operating_pose", {"transmission.operating_pose": "static"})
        return gearbox._chain.result(OperatingPoseResult)

    def hunting(self, positions: int | None = None) -> "HuntingResult":
        """Compute the load sharing at rest over the hunting cycle, in which every tooth meets every other.

        Parameters
        ----------
        positions : int or None
            Number of positions in a mesh cycle; None for that of section `load_sharing`.

        Returns
        -------
        HuntingResult
            The load sharing. Raises NotConverged.

        Examples
        --------
        >>> import facegear
        >>> facegear.example().hunting(positions=4).table()["k_gamma"].round(2).to_list()
        [1.41, 1.41, 0.65]
        """
        from facegear.results.hunting import HuntingResult

        changes = _drop_none({"load_sharing.hunting_positions": positions})
        return self._with_changes("hunting", changes)._chain.result(HuntingResult)

    def topography(self) -> "TopographyResult":
        """Return nominal points and normals of all flanks, with the mean deviation of all teeth.

        Returns
        -------
        TopographyResult
            The points.

        Examples
        --------
        >>> import facegear
        >>> facegear.example().topography().table()["deviation_um"].abs().max().item()
        0.0
        """
        from facegear.results.topography import TopographyResult

        return self._chain.result(TopographyResult)

    def shaft_orders(self, speed_rpm: float | None = None) -> "ShaftOrdersResult":
        """Compute the vibration at the orders of the gears' turns, from runouts, pitch deviations and single
        teeth.

        It is linear about the static load.

        Parameters
        ----------
        speed_rpm : float or None
            Speed of the pinions, rpm; None for that of the config.

        Returns
        -------
        ShaftOrdersResult
            The orders. Raises ConfigErrors for a machine without geometric meshes, NotConverged.
        """
        from facegear.results.shaft_orders import ShaftOrdersResult

        changes = _drop_none({"dynamics.speed_rpm": speed_rpm})
        return self._with_changes("shaft_orders", changes)._chain.result(ShaftOrdersResult)

    def sharing_map(self) -> "SharingMapResult":
        """Map load sharing over the numbers that decide it, and try what changes of the machine would buy.

        Returns
        -------
        SharingMapResult
            For the deviations of section `sharing_map`, or its defaults. Raises ConfigErrors for a machine
            without geometric meshes or with one face gear, NotConverged.
        """
        from facegear.results.sharing_map import SharingMapResult

        section = self._values["sharing_map"] or {}
        return self._with_changes("sharing_map", {"sharing_map": section})._chain.result(SharingMapResult)

    def tooth_errors(self) -> "ToothErrorsResult":
        """Compute what teeth that deviate from the others of their gear add to the transmission error.

        Returns
        -------
        ToothErrorsResult
            The errors. Raises FacegearError where `tooth_pair` has no grids of single teeth.
        """
        from facegear.results.tooth_errors import ToothErrorsResult

        pair = self.config.tooth_pair
        flanks = [body.flanks for body in (pair.pinion, pair.face_gear) if body is not None]
        if flanks and all(grid.tooth is None for flank in flanks for grid in flank.grids):
            requirement = "given for single teeth of pinion or face_gear: all are alike"
            raise ConfigError("tooth_pair.pinion.flanks.grids", [], requirement)
        return self._chain.result(ToothErrorsResult)

    def sensitivity(self, positions: int | None = None) -> "SensitivityResult":
        """Compute by how much each error of the machine, alone, changes its load sharing at rest.

        Parameters
        ----------
        positions : int or None
            Number of positions in a mesh cycle; None for that of section `load_sharing`.

        Returns
        -------
        SensitivityResult
            The sensitivities. Raises NotConverged.
        """
        from facegear.results.hunting import SensitivityResult

        changes = _drop_none({"load_sharing.hunting_positions": positions})
        return self._with_changes("sensitivity", changes)._chain.result(SensitivityResult)

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
        from facegear.results.hunting import FollowingResult

        changes = _drop_none({"dynamics.speed_rpm": speed_rpm, "load_sharing.followed_cycles": cycles})
        return self._with_changes("following", changes)._chain.result(FollowingResult)

    def study(self, values: Mapping[str, Iterable[Any]]) -> "Study":
        """Change some keys of the machine, in every combination of their values.

        Parameters
        ----------
        values : Mapping[str, Iterable[Any]]
            Values of each dotted config key.

        Returns
        -------
        Study
            The changed machines. Raises ConfigErrors with one line for every value that the config would
            refuse.

        Examples
        --------
        >>> import facegear
        >>> study = facegear.example().study({"transmission.backlash_um": [80, 120]})
        >>> list(study.machines)
        ['transmission.backlash_um = 80', 'transmission.backlash_um = 120']
        """
        from facegear.results.study import Study, combinations

        changes = combinations(values)
        return Study(
            {label: self._with_changes(label, changed_values) for label, changed_values in changes.items()},
            changes,
        )

    def report(self, path: str | Path, on_stage: Callable[[str, str], None] | None = None) -> Path:
        """Write the report of all that the config asks for on one page that needs no other file.

        A stage that fails is named at the head of the page with its reason; all else is computed. Until the
        page is complete, what is computed is kept beside it in a folder that ends in ``.partial``: a report
        that was stopped goes on from there.

        Parameters
        ----------
        path : str or Path
            Page to write, which ends in ``.html``.
        on_stage : callable, optional
            Called with ``report`` and about how long it will take, and then with the name of each stage and
            its summary, or ``not computed:`` and the reason, as soon as it is known.

        Returns
        -------
        Path
            The page.

        Raises
        ------
        FacegearError
            For a path that cannot be written.
        MissingExtra
            Where a library of the report is not installed.
        """
        return self._whole_case(on_stage).write_report(path)

    def summary(self) -> str:
        """Write what is known of the machine as lines for the terminal; geometry is all that it computes.

        Returns
        -------
        str
            Status, key numbers, verdicts with their reasons, and gear data as on a drawing. What was computed
            in this session, or is stored and current, is in it.

        Examples
        --------
        >>> import facegear
        >>> " ".join(facegear.example().summary().splitlines()[2].split())
        'Teeth, module 23 / 143 (3.75 mm, ratio 6.217)'
        """
        from facegear.results.summary import summary_text

        return summary_text(Chain(self._values, self.store, expand_cases(self.config)))

    def run(self, folder: str | Path, on_stage: Callable[[str, str], None] | None = None) -> Path:
        """Compute all that the config asks for in this process and write it, with figures and report.

        Files have the names that the workflow gives them below `folder`.

        Parameters
        ----------
        folder : str or Path
            Folder to write to.
        on_stage : Callable[[str, str], None] | None
            As of `report`.

        Returns
        -------
        Path
            Path of the report. Raises what `report` raises.
        """
        return self._whole_case(on_stage).write(folder)

    def figures(
        self,
        folder: str | Path,
        names: Sequence[str] = (),
        suffix: str = ".png",
        on_stage: Callable[[str, str], None] | None = None,
    ) -> list[Path]:
        """Draw the figures of the report, from stored results where they are current.

        Parameters
        ----------
        folder
            Where the files go, as `<name><suffix>`.
        names
            Names of the figures, such as ``mesh_sweep``; all if empty.
        suffix
            Format of the files, one that matplotlib writes (``.png``, ``.svg``, ``.pdf``).
        on_stage
            Called with the name of each stage that is computed or read, and its summary.

        Returns
        -------
        list of Path
            The files, in the order of computation.

        Raises
        ------
        FacegearError
            If the case has no figure of such a name.
        """
        return self._whole_case(on_stage).write_figures(folder, names, suffix)

    def export(self, path: str | Path, body: str = "pinion", teeth: int | None = None) -> Path:
        """Write a model for another program, by the path's ending.

        STEP or STL (mm): the exact teeth of a body, modifications included; a STEP product has the name of
        case and body. FMU: the dynamic model as C++17 sources for co-simulation (FMI 3.0), at the config's
        speed. GLB: a glTF scene of all gears in mesh, or of one pinion and its gear without a transmission.
        REXS: pinions, shafts, bearings and material as REXS 2.0, which has no face gear; the file names what
        is lost. CSV: nominal points and normals of all flanks for a measuring machine, as `flanks.file` of
        either body reads them.

        Parameters
        ----------
        path : str or Path
            File to write.
        body : str
            `pinion` or `face_gear`, for STEP and STL.
        teeth : int or None
            Number of teeth of a sector, for STEP and STL; None for the whole gear.

        Returns
        -------
        Path
            The path. Raises FacegearError for anything else, ConfigError for a pair without bodies and a
            config without a transmission.
        """
        path = file_path(path)
        ending = require_choice(path.suffix.lower(), ENDINGS, "ending of the path")
        if ending == ".fmu":
            from facegear.exchange.fmu import write_fmu

            with keys_named():
                return write_fmu(path, self._machine(), self._values["dynamics"]["speed_rpm"])
        if ending == ".glb":
            return self._scene(path)
        if ending == ".csv":
            from facegear.config.flank_table import write_nominal_points

            return write_nominal_points(path, self.config.tooth_pair)
        if ending == ".rexs":
            return self._gear_unit(path)
        with extras_named():
            from facegear.stages.cad import export

            return export(path, body, teeth, self.config.tooth_pair, self.config.case)

    def tolerances(self, samples: int | None = None) -> "TolerancesResult":
        """Compute percentiles, fractions and Sobol indices of the machine with its tolerances, in one
        process.

        Parameters
        ----------
        samples : int or None
            Number of samples, without Sobol indices; None for that of the config, with them.

        Returns
        -------
        TolerancesResult
            The results. Raises ConfigError without a section `tolerances`.
        """
        from facegear.results.tolerances import TolerancesResult

        self._require_section("tolerances")
        changes = {} if samples is None else {"samples": samples, "chunk_samples": samples, "index_blocks": 0}
        changed_values = {f"tolerances.{key}": value for key, value in changes.items()}
        return self._with_changes("tolerances", changed_values)._chain.result(TolerancesResult)

    def load_map(
        self,
        torque_factors: Sequence[float] | None = None,
        speeds_rpm: Sequence[float] | None = None,
        samples: int | None = None,
    ) -> "LoadMapResult":
        """Compute percentiles of the machine with its tolerances over torque and speed, with the same
        machines everywhere.

        What is None is as in section `tolerances.load_map`, or its default.

        Parameters
        ----------
        torque_factors : Sequence[float] | None
            Torques, as ratios to the machine's.
        speeds_rpm : Sequence[float] | None
            Speeds of the pinions, rpm; for a dynamic model only.
        samples : int or None
            Number of machines.

        Returns
        -------
        LoadMapResult
            The percentiles. Raises ConfigError without a section `tolerances`.
        """
        from facegear.results.tolerances import LoadMapResult

        tolerances = self._require_section("tolerances")
        load_map_values = {"torque_factors": torque_factors, "speeds_rpm": speeds_rpm, "samples": samples}
        section = {**(tolerances["load_map"] or {}), **_drop_none(load_map_values)}
        return self._with_changes("load_map", {"tolerances.load_map": section})._chain.result(LoadMapResult)

    def loosest_tolerances(
        self,
        quantity: str,
        at_most: float,
        percentile: float = 99.0,
        causes: Sequence[str] | None = None,
        samples: int = 512,
        max_factor: float = 4.0,
    ) -> "Loosest":
        """Compute the factor by which deviations may grow until a percentile of a quantity exceeds a limit.

        Twelve times `samples` machines are computed.

        Parameters
        ----------
        quantity : str
            Column of the samples.
        at_most : float
            Limit, in the unit of the quantity.
        percentile : float
            Percentile, %.
        causes : Sequence[str] | None
            Names of the causes whose deviations grow; None for all.
        samples : int
            Number of samples.
        max_factor : float
            Largest factor tried.

        Returns
        -------
        Loosest
            The factor. Raises ConfigError without a section `tolerances`, FacegearError for names that do not
            exist, or a limit exceeded without any deviation.
        """
        from facegear.scenarios.inverse import loosest

        cause_sections = self._require_section("tolerances")["causes"]
        names = [cause["name"] for cause in cause_sections]
        scaled_names = [
            require_choice(name, names, "causes") for name in (names if causes is None else causes)
        ]

        def sample_quantity(scale: float) -> Any:
            scaled_causes = [
                {**cause, "moves": {key: gain * scale for key, gain in cause["moves"].items()}}
                if cause["name"] in scaled_names
                else cause
                for cause in cause_sections
            ]
            frame = (
                self._with_changes("tolerances", {"tolerances.causes": scaled_causes})
                .tolerances(samples)
                .samples()
            )
            return frame[require_choice(quantity, list(frame.columns), "quantity")].to_numpy(float)

        return loosest(sample_quantity, at_most, percentile / 100.0, max_factor)

    def search(self, generations: int | None = None, seeds: Sequence[int] | None = None) -> "SearchResult":
        """Search designs that no other beats in every objective of the config's section `search`, in one
        process.

        Parameters
        ----------
        generations : int or None
            Number of generations; None for that of the config.
        seeds : Sequence[int] | None
            Seeds of the random numbers, one for each island; None for those of the config.

        Returns
        -------
        SearchResult
            The designs. Raises ConfigError without a section `search`, and FacegearError naming the extra
            where pymoo is not installed.
        """
        from facegear.results.search import SearchResult

        self._require_section("search")
        changes = _drop_none({"search.generations": generations, "search.seeds": seeds})
        return self._with_changes("search", changes)._chain.result(SearchResult)

    def __repr__(self) -> str:
        pair, machine = self.config.tooth_pair, self.config.transmission
        pinions, gears = (len(machine.pinions), len(machine.face_gears)) if machine else (1, 1)
        return (
            f"Gearbox({self.config.case}: pinions {pinions} x {pair.pinion_teeth} teeth, "
            f"face gears {gears} x {pair.face_gear_teeth} teeth)"
        )

    def _torques(self, torques: float | Iterable[float] | None) -> dict[str, Any]:
        """Changed keys of a contact analysis at other torques (N m on the pinion); none for None."""
        if torques is None:
            return {}
        changes: dict[str, Any] = {
            "contact.torques_n_m": torques if isinstance(torques, Iterable) else [torques]
        }
        changes["mesh_stiffness.torque_n_m"] = None  # need not lie within these
        if self._values["strength"] is not None:  # nor its duty cycle; the fillets keep their gauges
            changes |= {"strength": None, "contact.root_stress": self._values["contact"]["root_stress"]}
        return changes

    def _require_section(self, section: str) -> Mapping[str, Any]:
        """A section of HOLDS. Raises ConfigError where the config leaves it out."""
        values: Mapping[str, Any] | None = self._values[section]
        if values is None:
            raise ConfigError(section, None, f"a section of the config: {HOLDS[section]}")
        return values

    def _with_branches(self, changes: Mapping[str, Any]) -> "Gearbox":
        """A copy with a section `branches`, in which some values differ from the config's."""
        section = self._values["branches"] or {}
        inner = {
            key: {**section.get(key, {}), **value} if isinstance(value, Mapping) else value
            for key, value in changes.items()
        }
        return self._with_changes("branches", {"branches": {**section, **inner}})

    def _with_changes(self, label: str, changes: Mapping[str, Any]) -> "Gearbox":
        if not changes:
            return self
        config = changed_config(self.config.model_dump(mode="json"), plain(changes), label)
        return Gearbox(config, self.store)

    def _scene(self, path: Path) -> Path:
        from math import radians, tau

        from facegear.config.tooth_pair import pair_design
        from facegear.exchange.gltf import write_gltf

        design, machine = pair_design(self.config.tooth_pair), self.config.transmission
        if machine is None:
            return write_gltf(path, design, [("pinion", 0.0)], ["upper"])
        angles = [
            radians(pinion.angle_deg)
            if pinion.angle_deg is not None
            else tau * (pinion.angle_pitches or 0.0) / design.face_gear.teeth
            for pinion in machine.pinions
        ]
        names = [pinion.name for pinion in machine.pinions]
        return write_gltf(path, design, list(zip(names, angles, strict=True)), machine.face_gears)

    def _gear_unit(self, path: Path) -> Path:
        from datetime import UTC, datetime
        from importlib.metadata import version

        from facegear.exchange.rexs import write_rexs
        from facegear.variants.gear_unit import gear_unit

        date = datetime.now(UTC).isoformat(timespec="seconds")
        return write_rexs(path, gear_unit(self.config), date, version("facegear"))

    def _machine(self) -> "Machine":
        """The lumped machine as the dynamics take it. Raises ConfigError without a transmission."""
        return machine_inputs(self._chain.arguments("dynamics_response")).build()

    def _whole_case(self, on_stage: Callable[[str, str], None] | None) -> "WholeCase":
        from facegear.results.whole_case import WholeCase

        chain = Chain(self._values, self.store, expand_cases(self.config))
        return WholeCase(chain) if on_stage is None else WholeCase(chain, on_stage)

    @cached_property
    def _chain(self) -> Chain:
        return Chain(self._values, self.store)


def _drop_none(changes: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in changes.items() if value is not None}
