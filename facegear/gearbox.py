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
from facegear.errors import ConfigError, FacegearError, chosen, extras_named, file_path
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
    """The gearbox of a config file, or of a mapping with the keys of one.

    `results`: folder that the workflow writes to; a relative one is looked for here and beside the folder of
    the config file, None computes everything anew. A mapping counts names of files from the working
    directory, and its key `extends` names a config file anywhere. Raises ConfigErrors with one line for every
    mistake.

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
    """A gearbox that needs no file: five pinions between two face gears, coarse enough to take seconds.

    It is the machine of config/paper.yaml with geometric meshes; what it computes is kept for the session.

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
        """A changed copy; what the changes do not touch is not computed again.

        `changes`: dotted config keys (list positions as numbers) and their values. Raises ConfigErrors with
        one line for every mistake.

        >>> import facegear
        >>> stiffer = facegear.example().with_values({"mesh_stiffness.mean_n_per_m": 5e8})
        >>> stiffer.values["mesh_stiffness"]["mean_n_per_m"]
        500000000.0
        """
        if not isinstance(changes, Mapping) or not all(isinstance(key, str) for key in changes):
            raise FacegearError(f"changes = {changes!r}: must be a mapping of dotted config keys to values")
        return self._changed("with_values", changes)

    def geometry(self) -> "GeometryResult":
        """Limits, contact path, backlash and smallest gaps of the unloaded pair.

        Raises ConfigError for a pair without bodies.

        >>> import facegear
        >>> facegear.example().geometry().summary.split(",")[0]
        'contact ratio 1.548'
        """
        from facegear.results.geometry import GeometryResult

        return self._chain.result(GeometryResult)

    def contact(
        self, torques: float | Iterable[float] | None = None, positions: int | None = None
    ) -> "ContactResult":
        """Loaded tooth contact at every position and torque.

        `torques`: N m on the pinion for one mesh, rising; `positions`: number of positions in a pitch; both
        as in the config unless given. Raises ConfigErrors for values that the config would refuse,
        NotConverged naming position and torque.

        >>> import facegear
        >>> table = facegear.example().contact(torques=[600]).table()
        >>> float(table["kkt_residual"].max()) < 1e-12
        True
        """
        from facegear.results.contact import ContactResult

        changes = {**self._torques(torques), **_given({"contact.positions_per_pitch": positions})}
        return self._changed("contact", changes)._chain.result(ContactResult)

    def displaced_contact(
        self,
        pinion: Mapping[str, float] | None = None,
        face_gear: Mapping[str, float] | None = None,
        mesh: str | None = None,
        position: float = 0.5,
    ) -> "DisplacedContact":
        """Contact and closing of both flanks of a mesh whose two bodies stand displaced by given amounts.

        Parameters
        ----------
        pinion
            Any of x_um, y_um, z_um, tilt_x_deg, tilt_y_deg and theta_deg; 0 unless given. x along the
            tangent as the upper gear's teeth move, y along the gears' axis towards the upper gear, z outwards
            along the pinion; tilts about the middle of its face, theta as it drives.
        face_gear
            The same of the gear: x towards azimuth 0, y a quarter turn further, z from the lower to the upper
            gear; tilts about the point of its axis that `tilt` or `hub_tilt` says, or in the pitch plane;
            theta as it is driven.
        mesh
            `pinion/gear`, as `right idler/upper`; the first one unless given, and none for a pair without a
            transmission, which counts as that of an upper gear at azimuth 0.
        position
            Place of a pitch, 0 to 1, for flanks whose contact changes with it.

        Raises ConfigError for a pair without bodies, a displacement beyond 5 mm or 2 degrees or that is no
        number, NotConverged where flanks do not face each other.

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
        config, given = self.config, (dict(pinion or {}), dict(face_gear or {}))
        flanks = displaced_contact(config.tooth_pair, config.transmission, mesh, *given, position)

        def solve(torques: float | Iterable[float] | None) -> "Outcome":
            changed = self._changed("displaced_contact", self._torques(torques))
            parts = [changed._chain.part("compliance", "arrays", {"body": body}) for body in BODIES]
            contact = changed.config.contact_used
            return loaded_displaced_contact(
                flanks, config.tooth_pair, contact, (parts[0], parts[1]), contact.torques_n_m
            )

        return DisplacedContact(flanks, solve)

    def root_stress(self) -> "RootStressResult":
        """Stress at the fillets of both gears over a tooth's passage, at the contact analysis' torques.

        The fillets carry gauges for it, whatever the config says. Raises what `contact` raises.

        >>> import facegear
        >>> table = facegear.example().root_stress().table()
        >>> table["body"].unique().tolist()
        ['pinion', 'face_gear']
        """
        from facegear.results.root_stress import RootStressResult

        return self._changed("root_stress", {"contact.root_stress": True})._chain.result(RootStressResult)

    def rating(self) -> "RatingResult":
        """Safety and life of the pair under the duty cycle of section `strength`.

        Raises ConfigError without that section, and what `contact` raises.

        >>> import facegear
        >>> facegear.example().rating().table()["failure"].unique().tolist()
        ['bending', 'pitting']
        """
        from facegear.results.rating import RatingResult

        return self._chain.result(RatingResult)

    def friction(self, speed_rpm: float | None = None) -> "FrictionResult":
        """Sliding, loss, temperatures and film of one mesh at a pinion speed, the config's unless given.

        Raises ConfigError without section `lubrication`, and what `contact` raises.

        >>> import facegear
        >>> oil = {"oil": "polyol_ester_5_cst", "supply_temperature_c": 80, "pinion": {"ra_um": 0.3}}
        >>> oil |= {"face_gear": {"ra_um": 0.3}, "bulk": {"source": "given", "temperature_c": 100}}
        >>> table = facegear.example().with_values({"lubrication": oil}).friction().table()
        >>> bool(table["efficiency"].between(0.99, 1).all())
        True
        """
        from facegear.results.friction import FrictionResult

        changed = self._changed("friction", _given({"dynamics.speed_rpm": speed_rpm}))
        return changed._chain.result(FrictionResult)

    def losses(self, speed_rpm: float | None = None) -> "MachineLossResult":
        """Loss of every mesh and heat of every body at a pinion speed, the config's unless given.

        Over the duty cycle as well, where `strength.load_factors` is `machine`. Raises what `friction` and
        `modes` raise.
        """
        from facegear.results.machine_loss import MachineLossResult

        changed = self._changed("losses", _given({"dynamics.speed_rpm": speed_rpm}))
        return changed._chain.result(MachineLossResult)

    def dynamic_stress(self, speed_rpm: float | None = None) -> "DynamicStressResult":
        """Root stress of every mesh while the machine runs at a pinion speed, the config's unless given.

        Raises what `root_stress` and `response` raise.

        >>> import facegear
        >>> table = facegear.example().dynamic_stress(1000).table()
        >>> bool((table["pinion_bound_mpa"] >= table["pinion_running_mpa"]).all())
        True
        """
        from facegear.results.dynamic_stress import DynamicStressResult

        changes = {"contact.root_stress": True, **_given({"dynamics.speed_rpm": speed_rpm})}
        return self._changed("dynamic_stress", changes)._chain.result(DynamicStressResult)

    def stress_over_speed(self) -> "StressOverSpeedResult":
        """Largest root stress and pressure over the speed range, of every motion known at a speed.

        Motions are those of the sweep and, with section `branches`, all stable ones that were followed.
        Raises what `root_stress` and `sweep` raise.

        >>> import facegear
        >>> gearbox = facegear.example().with_values({"dynamics.sweep.points": 2})
        >>> table = gearbox.stress_over_speed().table()
        >>> bool((table.loc[table["worst"], "dynamic_factor"] > 1).all())
        True
        """
        from facegear.results.stress_over_speed import StressOverSpeedResult

        changes = {"contact.root_stress": True}
        return self._changed("stress_over_speed", changes)._chain.result(StressOverSpeedResult)

    def stiffness(self) -> "StiffnessResult":
        """k(t) of one mesh at the config's load, or from given harmonics.

        Raises ConfigError for a load outside those of the contact analysis.

        >>> import facegear
        >>> facegear.example().stiffness().table()["cos_n_per_m"].round(-3).to_list()[0]
        410000000.0
        """
        from facegear.results.stiffness import StiffnessResult

        return self._chain.result(StiffnessResult)

    def mesh_law(self) -> "MeshLawResult":
        """Forces of the flanks over phase and deflection, of which `mesh_law: load_dependent` makes use.

        Raises ConfigError for a pair without bodies, and what `contact` raises.
        """
        from facegear.results.mesh_law import MeshLawResult

        return self._chain.result(MeshLawResult)

    def modes(self) -> "ModesResult":
        """Natural frequencies, classes and shapes.

        They need a contact analysis unless `modal.stiffness` is average or the mesh stiffness is given.

        >>> import facegear
        >>> int((facegear.example().modes().table()["class"] == "rigid body").sum())
        6
        """
        from facegear.results.modal import ModesResult

        return self._chain.result(ModesResult)

    def gear_bodies(self) -> "GearBodiesResult":
        """Modes and compliance of face gears that bend, with their hubs held.

        Raises ConfigError for a machine whose face gears are rigid.
        """
        from facegear.results.gear_bodies import GearBodiesResult

        return self._chain.result(GearBodiesResult)

    def gear_waves(self) -> "GearWavesResult":
        """Damped modes at the nominal speed of a machine whose face gears bend, and their waves.

        Raises ConfigError for a machine whose face gears are rigid, NotConverged.
        """
        from facegear.results.gear_waves import GearWavesResult

        return self._chain.result(GearWavesResult)

    def shafts(self) -> "ShaftsResult":
        """Stiffness and bearing loads of pinions' shafts, twist of engines and rotors, at rest.

        Raises ConfigError for a machine without shafts and torsion, NotConverged.
        """
        from facegear.results.shafts import ShaftsResult

        return self._chain.result(ShaftsResult)

    def response(self, speed_rpm: float | None = None) -> "ResponseResult":
        """Steady state at a pinion speed, the config's unless given.

        Raises ConfigErrors for a speed that the config would refuse, NotConverged naming the speed.

        >>> import facegear
        >>> facegear.example().response(1000).table()["class"].iloc[0]
        'period-1'
        """
        from facegear.results.response import ResponseResult

        changed = self._changed("response", _given({"dynamics.speed_rpm": speed_rpm}))
        return changed._chain.result(ResponseResult)

    def sweep(
        self,
        from_rpm: float | None = None,
        to_rpm: float | None = None,
        points: int | None = None,
        directions: Sequence[str] | None = None,
        threads: int = 1,
    ) -> "SweepResult":
        """Steady states over speed with the state carried over, with jumps and resonances.

        Speeds and `directions` (up, down) as in the config unless given. Raises ConfigErrors for values that
        the config would refuse, NotConverged naming the speed.

        >>> import facegear
        >>> found = facegear.example().sweep(1000, 1200, points=3, directions=["up"])
        >>> found.dataset()["deflection_ac_rms_um"].dims
        ('direction', 'speed_rpm', 'mesh')
        """
        from facegear.results.sweep import SweepResult

        given = {"from_rpm": from_rpm, "to_rpm": to_rpm, "points": points, "directions": directions}
        changes = _given({f"dynamics.sweep.{key}": value for key, value in given.items()})
        if isinstance(points, int) and points < self._values["dynamics"]["sweep"]["chunks"]:
            changes["dynamics.sweep.chunks"] = 1
        if not isinstance(threads, int) or threads < 1:
            raise FacegearError(f"sweep: threads = {threads!r}: must be a whole number of at least 1")
        return self._changed("sweep", changes)._chain.result(SweepResult, threads=threads)

    def branches(
        self,
        from_rpm: float | None = None,
        to_rpm: float | None = None,
        longest_period: int | None = None,
        starts: int | None = None,
    ) -> "BranchesResult":
        """Periodic motions over speed, stable or not, beside the sweep: folds, margins, coexistence.

        These are all motions that branches join to the first one, to those of the sweep or to those of the
        random starts, up to the longest period, with their images under the machine's symmetries. A motion
        that no branch leads to is missing if no start has found it; docs/explanation/branches.md lists all
        bounds.

        Speeds, the longest period followed through doublings and the number of random `starts` as in section
        `branches` of the config unless given, its defaults where there is no such section. Raises
        ConfigErrors for values that the config would refuse, NotConverged without a motion of period one.

        >>> import facegear
        >>> quick = {"mesh_stiffness.mesh_law": "constant_load", "dynamics.sweep.points": 2}
        >>> found = facegear.example().with_values(quick).branches(7450, 7550, starts=1)
        >>> found.table()["period"].unique().tolist()
        [1]
        """
        from facegear.results.branches import BranchesResult

        explore = _given({"starts": starts})
        changes = _given({"from_rpm": from_rpm, "to_rpm": to_rpm, "longest_period": longest_period})
        changed = self._with_branches({**changes, **({"explore": explore} if explore else {})})
        return changed._chain.result(BranchesResult)

    def branch_loci(
        self, parameters: Sequence[str] | None = None, nearest: int | None = None
    ) -> "BranchLociResult":
        """Where folds and period doublings move when a second parameter changes, with cusps.

        `parameters`: of torque, backlash, mesh_damping and bearing_stiffness; `nearest`: how many special
        points nearest to the nominal speed are followed; both as in section `branches.loci` unless given.
        Raises ConfigErrors for values that the config would refuse.
        """
        from facegear.results.branch_loci import BranchLociResult

        loci = _given({"parameters": parameters, "nearest": nearest})
        return self._with_branches({"loci": loci} if loci else {})._chain.result(BranchLociResult)

    def load_sharing(self, speed_rpm: float | None = None) -> "LoadSharingResult":
        """Load-sharing coefficients at a pinion speed, the config's unless given, averaged as section
        `load_sharing` asks.

        Raises ConfigErrors for a speed that the config would refuse, NotConverged naming the speed.

        >>> import facegear
        >>> facegear.example().load_sharing().table()["group"].to_list()
        ['right input', 'left input', 'idlers']
        """
        from facegear.results.load_sharing import LoadSharingResult

        changed = self._changed("load_sharing", _given({"dynamics.speed_rpm": speed_rpm}))
        return changed._chain.result(LoadSharingResult)

    def statics(self) -> "StaticsResult":
        """Force of every mesh at rest under the mean torques; torque, speed and power of every body.

        Raises NotConverged.

        >>> import facegear
        >>> facegear.example().statics().table()["flank"].value_counts().to_dict()
        {'drive': 7, 'back': 3}
        """
        from facegear.results.statics import StaticsResult

        return self._chain.result(StaticsResult)

    def operating_pose(self) -> "OperatingPoseResult":
        """Where the machine's own forces put the teeth of every mesh, and what contact makes of it.

        Raises ConfigErrors for a machine without contact analysis, InvalidInput for a pose outside those that
        are solved, NotConverged.
        """
        from facegear.results.operating_pose import OperatingPoseResult

        changed = self._changed("operating_pose", {"transmission.operating_pose": "static"})
        return changed._chain.result(OperatingPoseResult)

    def hunting(self, positions: int | None = None) -> "HuntingResult":
        """Load sharing at rest over the hunting cycle, in which every tooth meets every other.

        `positions`: of a mesh cycle, as in section `load_sharing` unless given. Raises NotConverged.

        >>> import facegear
        >>> facegear.example().hunting(positions=4).table()["k_gamma"].round(2).to_list()
        [1.41, 1.41, 0.65]
        """
        from facegear.results.hunting import HuntingResult

        given = _given({"load_sharing.hunting_positions": positions})
        return self._changed("hunting", given)._chain.result(HuntingResult)

    def topography(self) -> "TopographyResult":
        """Nominal points and normals of all flanks, with the mean deviation of all teeth.

        >>> import facegear
        >>> facegear.example().topography().table()["deviation_um"].abs().max().item()
        0.0
        """
        from facegear.results.topography import TopographyResult

        return self._chain.result(TopographyResult)

    def shaft_orders(self, speed_rpm: float | None = None) -> "ShaftOrdersResult":
        """Vibration at the orders of the gears' turns, from runouts, pitch deviations and single teeth.

        speed_rpm: of the pinions, None for that of the config. Linear about the static load. Raises
        ConfigErrors for a machine without geometric meshes, NotConverged.
        """
        from facegear.results.shaft_orders import ShaftOrdersResult

        changes = _given({"dynamics.speed_rpm": speed_rpm})
        return self._changed("shaft_orders", changes)._chain.result(ShaftOrdersResult)

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
        return self._changed("sharing_map", {"sharing_map": section})._chain.result(SharingMapResult)

    def tooth_errors(self) -> "ToothErrorsResult":
        """What teeth that deviate from the others of their gear add to the transmission error.

        Raises FacegearError where `tooth_pair` has no grids of single teeth.
        """
        from facegear.results.tooth_errors import ToothErrorsResult

        pair = self.config.tooth_pair
        flanks = [body.flanks for body in (pair.pinion, pair.face_gear) if body is not None]
        if flanks and all(grid.tooth is None for given in flanks for grid in given.grids):
            allowed = "given for single teeth of pinion or face_gear: all are alike"
            raise ConfigError("tooth_pair.pinion.flanks.grids", [], allowed)
        return self._chain.result(ToothErrorsResult)

    def sensitivity(self, positions: int | None = None) -> "SensitivityResult":
        """By how much each error of the machine, alone, changes its load sharing at rest; as `hunting`."""
        from facegear.results.hunting import SensitivityResult

        given = _given({"load_sharing.hunting_positions": positions})
        return self._changed("sensitivity", given)._chain.result(SensitivityResult)

    def following(self, speed_rpm: float | None = None, cycles: int | None = None) -> "FollowingResult":
        """Load sharing of the running machine while its runouts and pitch deviations turn.

        `cycles`: mesh cycles that are followed, as in section `load_sharing` unless given.

        Raises NotConverged.
        """
        from facegear.results.hunting import FollowingResult

        given = _given({"dynamics.speed_rpm": speed_rpm, "load_sharing.followed_cycles": cycles})
        return self._changed("following", given)._chain.result(FollowingResult)

    def study(self, values: Mapping[str, Iterable[Any]]) -> "Study":
        """The machine with some keys changed, in every combination of their values.

        `values`: of each dotted config key. Raises ConfigErrors with one line for every value that the config
        would refuse.

        >>> import facegear
        >>> study = facegear.example().study({"transmission.backlash_um": [80, 120]})
        >>> list(study.machines)
        ['transmission.backlash_um = 80', 'transmission.backlash_um = 120']
        """
        from facegear.results.study import Study, combinations

        changes = combinations(values)
        return Study({label: self._changed(label, given) for label, given in changes.items()}, changes)

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

        Files have the names that the workflow gives them below `folder`. Returns the path of the report;
        arguments and errors as of `report`.
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
        """Write a model for another program, by the path's ending; returns the path.

        STEP or STL (mm): the exact teeth of a body, modifications included; `body`: pinion or face_gear;
        `teeth`: a sector of so many, the whole gear unless given; a STEP product has the name of case and
        body. FMU: the dynamic model as C++17 sources for
        co-simulation (FMI 3.0), at the config's speed. GLB: a glTF scene of all gears in mesh, or of one
        pinion and its gear without a transmission. REXS: pinions, shafts, bearings and material as REXS 2.0,
        which has no face gear; the file names what is lost. CSV: nominal points and normals of all flanks
        for a measuring machine, as `flanks.file` of either body reads them. Raises FacegearError for anything
        else, ConfigError for a pair without bodies and a config without a
        transmission.
        """
        path = file_path(path)
        ending = chosen(path.suffix.lower(), ENDINGS, "ending of the path")
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
        """Percentiles, fractions and Sobol indices of the machine with its tolerances, in one process.

        `samples`: as many instead of the config's, without Sobol indices. Raises ConfigError without a
        section `tolerances`.
        """
        from facegear.results.tolerances import TolerancesResult

        self._required("tolerances")
        changes = {} if samples is None else {"samples": samples, "chunk_samples": samples, "index_blocks": 0}
        given = {f"tolerances.{key}": value for key, value in changes.items()}
        return self._changed("tolerances", given)._chain.result(TolerancesResult)

    def load_map(
        self,
        torque_factors: Sequence[float] | None = None,
        speeds_rpm: Sequence[float] | None = None,
        samples: int | None = None,
    ) -> "LoadMapResult":
        """Percentiles of the machine with its tolerances over torque and speed, the same machines everywhere.

        Torques in parts of the machine's, speeds for a dynamic model only; all as in section
        `tolerances.load_map`, or its defaults, unless given. Raises ConfigError without a section
        `tolerances`.
        """
        from facegear.results.tolerances import LoadMapResult

        tolerances = self._required("tolerances")
        given = {"torque_factors": torque_factors, "speeds_rpm": speeds_rpm, "samples": samples}
        section = {**(tolerances["load_map"] or {}), **_given(given)}
        return self._changed("load_map", {"tolerances.load_map": section})._chain.result(LoadMapResult)

    def loosest_tolerances(
        self,
        quantity: str,
        at_most: float,
        percentile: float = 99.0,
        causes: Sequence[str] | None = None,
        samples: int = 512,
        max_factor: float = 4.0,
    ) -> "Loosest":
        """By how much the deviations of all causes, or of those named, may grow until a percentile of a
        quantity exceeds a limit; `quantity` is a column of the samples.

        Twelve times `samples` machines are computed. Raises ConfigError without a section `tolerances`,
        FacegearError for names that do not exist, or a limit exceeded without any deviation.
        """
        from facegear.scenarios.inverse import loosest

        given = self._required("tolerances")["causes"]
        names = [cause["name"] for cause in given]
        named = [chosen(name, names, "causes") for name in (names if causes is None else causes)]

        def sampled(scale: float) -> Any:
            scaled = [
                {**cause, "moves": {key: gain * scale for key, gain in cause["moves"].items()}}
                if cause["name"] in named
                else cause
                for cause in given
            ]
            frame = self._changed("tolerances", {"tolerances.causes": scaled}).tolerances(samples).samples()
            return frame[chosen(quantity, list(frame.columns), "quantity")].to_numpy(float)

        return loosest(sampled, at_most, percentile / 100.0, max_factor)

    def search(self, generations: int | None = None, seeds: Sequence[int] | None = None) -> "SearchResult":
        """Designs that no other beats in every objective of the config's section `search`, in one process.

        `generations` and `seeds` as in the config unless given. Raises ConfigError without a section
        `search`, and FacegearError naming the extra where pymoo is not installed.
        """
        from facegear.results.search import SearchResult

        self._required("search")
        given = _given({"search.generations": generations, "search.seeds": seeds})
        return self._changed("search", given)._chain.result(SearchResult)

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

    def _required(self, section: str) -> Mapping[str, Any]:
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
        return self._changed("branches", {"branches": {**section, **inner}})

    def _changed(self, where: str, changes: Mapping[str, Any]) -> "Gearbox":
        if not changes:
            return self
        config = changed_config(self.config.model_dump(mode="json"), plain(changes), where)
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


def _given(changes: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in changes.items() if value is not None}
