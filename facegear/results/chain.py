"""The stages one after the other in one process: each finds or computes what it needs of those before it."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from facegear.config.modal import modes_need_contact
from facegear.config.needs import loads_from_machine, stage_needs
from facegear.results.store import Store

if TYPE_CHECKING:
    from facegear.config.tolerances import Design
    from facegear.contact.gear_flank import GearFlank
    from facegear.results.branch_loci import BranchLociResult
    from facegear.results.branches import BranchesResult
    from facegear.results.contact import ContactResult
    from facegear.results.dynamic_stress import DynamicStressResult
    from facegear.results.geometry import GeometryResult
    from facegear.results.load_sharing import LoadSharingResult
    from facegear.results.modal import ModesResult
    from facegear.results.rating import RatingResult
    from facegear.results.response import ResponseResult
    from facegear.results.root_stress import RootStressResult
    from facegear.results.search import SearchResult
    from facegear.results.stiffness import StiffnessResult
    from facegear.results.stress_over_speed import StressOverSpeedResult
    from facegear.results.sweep import SweepResult
    from facegear.results.tolerances import LoadMapResult, TolerancesResult
    from facegear.stages.outcome import Outcome


@dataclass(frozen=True, eq=False)
class Chain:
    """What the workflow's rules do, without files: `values` of a whole config, and the store of results.

    A stage is imported where it runs, so that modes load no mesh and no compiler.
    """

    values: Mapping[str, Any]
    store: Store

    def geometry(self) -> "GeometryResult":
        """The unloaded pair."""
        from facegear.results.geometry import GeometryResult

        def compute() -> "Outcome":
            from facegear.stages.geometry import geometry

            return geometry(**self._needs("geometry"))

        return self.store.result("geometry", self.values, GeometryResult, compute)

    def contact(self) -> "ContactResult":
        """Loaded tooth contact, from the compliance of both bodies."""
        from facegear.results.contact import ContactResult

        def compute() -> "Outcome":
            from facegear.stages.contact import contact

            pinion, face_gear = self._compliance("pinion"), self._compliance("face_gear")
            return contact(pinion, face_gear, **self._needs("contact"))

        return self.store.result("contact", self.values, ContactResult, compute)

    def root_stress(self) -> "RootStressResult":
        """Stress at the fillets, from the gauges of both bodies and the contact's loads."""
        from facegear.results.root_stress import RootStressResult

        def compute() -> "Outcome":
            from facegear.stages.root_stress import root_stress

            pinion, face_gear = self._compliance("pinion"), self._compliance("face_gear")
            return root_stress(pinion, face_gear, self.contact().content["loads"])

        return self.store.result("root_stress", self.values, RootStressResult, compute)

    def rating(self) -> "RatingResult":
        """Safety and life, from the root stress and, where asked for, the machine's motion in every bin."""
        from facegear.results.rating import RatingResult

        def compute() -> "Outcome":
            from facegear.stages.rating import rating

            loads = [self._duty_spectrum()] if loads_from_machine(self.values) else []
            stress, by_torque = self.root_stress().content["stress"], self.contact().content["by_torque"]
            return rating(stress, by_torque, *loads, **self._needs("rating"))

        return self.store.result("rating", self.values, RatingResult, compute)

    def dynamic_stress(self) -> "DynamicStressResult":
        """Root stress of every mesh in motion, from the response and the root stress."""
        from facegear.results.dynamic_stress import DynamicStressResult

        def compute() -> "Outcome":
            from facegear.stages.dynamic_root_stress import dynamic_root_stress

            response, stress = self.response().content["response"], self.root_stress().content["stress"]
            by_torque = self.contact().content["by_torque"]
            return dynamic_root_stress(response, stress, by_torque, **self._needs("dynamic_root_stress"))

        return self.store.result("dynamic_root_stress", self.values, DynamicStressResult, compute)

    def stress_over_speed(self) -> "StressOverSpeedResult":
        """Root stress and pressure over speed, from the sweep and, where asked for, the branches."""
        from facegear.results.stress_over_speed import StressOverSpeedResult

        def compute() -> "Outcome":
            from facegear.stages.stress_over_speed import stress_over_speed

            return stress_over_speed(
                self.sweep().content["sweep"],
                None if self.values["branches"] is None else self.branches().content["branches"],
                self.root_stress().content["stress"],
                self.contact().content["by_torque"],
                self._harmonics(),
                **self._needs("stress_over_speed"),
            )

        return self.store.result("stress_over_speed", self.values, StressOverSpeedResult, compute)

    def stiffness(self) -> "StiffnessResult":
        """k(t), from the contact or from given harmonics."""
        from facegear.results.stiffness import StiffnessResult

        def compute() -> "Outcome":
            from facegear.stages.stiffness import stiffness

            section = self.values["mesh_stiffness"]
            given = section["source"] == "harmonics"
            return stiffness(section, ltca=None if given else self.contact().content["ltca"])

        return self.store.result("stiffness", self.values, StiffnessResult, compute)

    def modes(self) -> "ModesResult":
        """Modes, from the mean stiffness of the config or from that of the contact analysis."""
        from facegear.results.modal import ModesResult

        def compute() -> "Outcome":
            from facegear.stages.modal import modal

            asks = modes_need_contact(self.values)
            return modal(**self._needs("modal"), harmonics=self._harmonics() if asks else None)

        return self.store.result("modal", self.values, ModesResult, compute)

    def response(self) -> "ResponseResult":
        """Steady state at the speed."""
        from facegear.results.response import ResponseResult

        def compute() -> "Outcome":
            from facegear.stages.dynamics_response import dynamics_response

            return dynamics_response(self._harmonics(), **self._needs("dynamics_response"))

        return self.store.result("dynamics_response", self.values, ResponseResult, compute)

    def sweep(self, threads: int = 1) -> "SweepResult":
        """Steady states over speed, from the chunks; natural frequencies beside them."""
        from facegear.results.sweep import SweepResult

        def compute() -> "Outcome":
            from facegear.stages.dynamics_sweep import dynamics_sweep

            needs = self._needs("dynamics_sweep")
            return dynamics_sweep(self._chunks(), self._harmonics(), **needs, threads=threads)

        found = self.store.result("dynamics_sweep", self.values, SweepResult, compute)
        return replace(found, content={**found.content, "frequencies": self.modes().table()})

    def branches(self) -> "BranchesResult":
        """Branches of periodic motions, from random starts and the sweep, which stands beside them."""
        from facegear.results.branches import BranchesResult

        def compute() -> "Outcome":
            from facegear.stages.branches import branches

            count = max(len(self.values["branches"]["explore"]["speeds_rpm"]), 1)
            starts = [self._starts(number) for number in range(count)]
            jumps = self.sweep().content["jumps"]
            return branches(starts, self._chunks(), jumps, self._harmonics(), **self._needs("branches"))

        found = self.store.result("branches", self.values, BranchesResult, compute)
        return replace(found, content={**found.content, "sweep": self.sweep().content["sweep"]})

    def branch_loci(self) -> "BranchLociResult":
        """Loci of the special points that the branches have."""
        from facegear.results.branch_loci import BranchLociResult

        def compute() -> "Outcome":
            from facegear.stages.branches_loci import branches_loci

            orbits = self.branches().content["orbits"]
            return branches_loci(orbits, self._harmonics(), **self._needs("branches_loci"))

        return self.store.result("branches_loci", self.values, BranchLociResult, compute)

    def load_sharing(self) -> "LoadSharingResult":
        """Load sharing at the speed."""
        from facegear.results.load_sharing import LoadSharingResult

        def compute() -> "Outcome":
            from facegear.stages.load_sharing import load_sharing

            return load_sharing(self._harmonics(), **self._needs("load_sharing"))

        return self.store.result("load_sharing", self.values, LoadSharingResult, compute)

    def tolerances(self) -> "TolerancesResult":
        """What the samples say; each design in one piece."""
        from facegear.results.tolerances import TolerancesResult

        def compute() -> "Outcome":
            from facegear.stages.tolerances import tolerances

            samples, indices = self._samples("samples"), self._samples("indices")
            return tolerances(samples, indices, **self._needs("tolerances"))

        return self.store.result("tolerances", self.values, TolerancesResult, compute)

    def load_map(self) -> "LoadMapResult":
        """Percentiles over torque and speed."""
        from facegear.results.tolerances import LoadMapResult

        def compute() -> "Outcome":
            from facegear.stages.sampled_machine import SampledMachine
            from facegear.stages.tolerances_map import tolerances_map

            return tolerances_map(SampledMachine(**self._varied("tolerances_map")))

        return self.store.result("tolerances_map", self.values, LoadMapResult, compute)

    def search(self) -> "SearchResult":
        """Front of designs, island after island, and its winners."""
        from facegear.results.search import SearchResult

        def compute() -> "Outcome":
            from facegear.stages.designs import SearchedMachine
            from facegear.stages.search import search
            from facegear.stages.search_island import search_island

            given = self._varied("search")
            islands = {
                seed: search_island(seed, SearchedMachine(**given)).content["designs"]
                for seed in self.values["search"]["seeds"]
            }
            return search(islands, SearchedMachine(**given))

        return self.store.result("search", self.values, SearchResult, compute)

    def _needs(self, rule: str) -> dict[str, Any]:
        return stage_needs(rule, self.values)

    def _harmonics(self) -> Any:
        return self.stiffness().content["harmonics"]

    def _compliance(self, body: str) -> "GearFlank":
        from facegear.contact.gear_flank import STORED, from_arrays
        from facegear.io import arrays
        from facegear.stages.compliance import compliance

        return self.store.part(
            "compliance",
            body,
            self.values,
            f"compliance/{body}.npz",
            lambda path: from_arrays(arrays.read(path, STORED)),
            lambda: compliance(body, **self._needs("compliance")),
        )

    def _varied(self, rule: str) -> dict[str, Any]:
        """All that a stage needs of the machine that many are made from."""
        needs = self._needs(rule)
        return {**needs, "harmonics": self._harmonics(), "flanks": self._flanks(needs["pair"])}

    def _flanks(self, pair: Mapping[str, Any] | None) -> "dict[str, GearFlank]":
        """Compliance of both bodies, where machines among many are put into contact."""
        return {} if pair is None else {body: self._compliance(body) for body in ("pinion", "face_gear")}

    def _duty_spectrum(self) -> Any:
        from facegear.io import tables
        from facegear.stages.duty_loads import duty_loads
        from facegear.strength.columns import DUTY_SPECTRUM_COLUMNS

        return self.store.part(
            "duty_loads",
            "",
            self.values,
            "strength/duty_spectrum.csv",
            lambda path: tables.read(path, DUTY_SPECTRUM_COLUMNS),
            lambda: duty_loads(self._harmonics(), **self._needs("duty_loads")).content["duty_spectrum"],
        )

    def _chunks(self) -> list[Any]:
        """Arrays of the sweep's chunks, direction by direction."""
        sweep = self.values["dynamics"]["sweep"]
        return [self._chunk(name, n) for name in sweep["directions"] for n in range(sweep["chunks"])]

    def _chunk(self, direction: str, number: int) -> Any:
        from facegear.dynamics.sweeps.stored import SHAPES
        from facegear.io import arrays
        from facegear.stages.dynamics_sweep_chunk import dynamics_sweep_chunk

        name, needs = f"{direction}_{number}", self._needs("dynamics_sweep_chunk")
        return self.store.part(
            "dynamics_sweep_chunk",
            name,
            self.values,
            f"dynamics/chunks/{name}.npz",
            lambda path: arrays.read(path, SHAPES),
            lambda: dynamics_sweep_chunk(direction, number, self._harmonics(), **needs).content["chunk"],
        )

    def _starts(self, number: int) -> Any:
        from facegear.dynamics.branches.stored import SHAPES
        from facegear.io import arrays
        from facegear.stages.branches_starts import branches_starts

        needs = self._needs("branches_starts")
        return self.store.part(
            "branches_starts",
            str(number),
            self.values,
            f"branches/starts/{number}.npz",
            lambda path: arrays.read(path, SHAPES),
            lambda: branches_starts(number, self._harmonics(), **needs).content["found"],
        )

    def _samples(self, design: "Design") -> list[Any]:
        """The table of all samples of a design (samples or indices); none where the config asks for none."""
        from facegear.config.base import parse
        from facegear.config.tolerances import Tolerances, sizes
        from facegear.stages.sampled_machine import SampledMachine
        from facegear.stages.tolerances_chunk import tolerances_chunk

        count = sizes(parse(Tolerances, self.values["tolerances"]), design)
        if not count:
            return []
        machine = SampledMachine(**self._varied("tolerances_chunk"))
        return [tolerances_chunk(design, 0, count - 1, machine).content["chunk"]]
