"""The contact analysis of a pair, as designed and in many assemblies, with its tables."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import pandas as pd

from facegear.arrays import AnyArray, Integers
from facegear.contact.flanks import PinionSurface
from facegear.contact.gear_flank import GearFlank, PairFlanks, contact_model, flank_models, flanks_of
from facegear.contact.ltca import ContactModel, KnownContact, even_positions, loaded_contact
from facegear.contact.nodal_loads import load_arrays, touching_reactions, wrench_table
from facegear.contact.options import ContactPlan
from facegear.contact.pattern import LTCA_COLUMNS
from facegear.contact.position import LoadedPosition
from facegear.contact.pressure import FlankPressure, LineLoads, flank_pressure
from facegear.contact.summary import by_flank, by_torque, join_flanks, with_wrenches
from facegear.teeth.design import AssemblyErrors, Material, PairDesign
from facegear.teeth.placement import nominal_pairs, nominal_teeth


def ltca_table(results: Sequence[LoadedPosition], pressure: FlankPressure) -> pd.DataFrame:
    """Tabulate contact results, one row a torque and position.

    nan: pressure where no plane is inside, average stiffness where the unloaded teeth interfere.

    Parameters
    ----------
    results : Sequence[LoadedPosition]
        Contact by position and torque.
    pressure : FlankPressure
        Pressure of the same results.

    Returns
    -------
    pd.DataFrame
        Columns LTCA_COLUMNS.
    """
    of_each = [
        (
            1e6 * r.ste,
            1e6 * r.unloaded_error,
            r.k_average,
            r.k_local,
            r.fillet_share,
            1e6 * r.overlap,
            r.residual,
        )
        for r in results
    ]
    ste, unloaded_error, average, local, in_fillets, overlap, residual = np.array(of_each).T
    shares = np.array([r.load_share for r in results])
    columns = (
        np.array([r.torque for r in results]),
        np.array([r.position for r in results]),
        *(ste, unloaded_error, average, local),
        np.count_nonzero(shares, axis=1),
        *shares.T,
        *np.array([_pressures(loads) for loads in pressure.loads]).T,
        *(in_fillets, overlap, residual),
        np.abs(shares.sum(axis=1) - 1.0),
    )
    order = np.lexsort((columns[1], columns[0]))
    return pd.DataFrame(
        {name: values[order] for name, values in zip(LTCA_COLUMNS, columns, strict=True)}, copy=False
    )


def _pressures(loads: LineLoads) -> tuple[float, ...]:
    """Return largest pressure inside and its error (MPa), then line load (N/mm) and loaded length (mm) of
    tip edges.
    """
    largest, error = loads.largest()
    tip, length = loads.at_tips()
    return 1e-6 * largest, 1e-6 * error, 1e-3 * tip, 1e3 * length


def pressure_arrays(
    results: Sequence[LoadedPosition], surface: PinionSurface, pressure: FlankPressure
) -> dict[str, AnyArray]:
    """Collect loads and pressures as PRESSURE_ARRAYS.

    First come the forces of all loaded basis functions, one a row, whether they act in a fillet, and the
    lattice (`shape`, `point_m`) of their nodes. Then come `line_*`, one row a loaded plane across the
    pinion's axis: its number, the line load along the contact line and the length it stands for, its edge
    (a number in EDGES), and the pressure there: 0 with an error of 0 unless inside. Last come the contact
    lines: a pair's points on the pinion in all planes, whether loaded or not.

    Parameters
    ----------
    results : Sequence[LoadedPosition]
        Contact by position and torque.
    surface : PinionSurface
        Contact surface of the pinion.
    pressure : FlankPressure
        Pressure of the same results.

    Returns
    -------
    dict of arrays
        Arrays with the (...) shapes of PRESSURE_ARRAYS.
    """
    lines: dict[str, list[AnyArray]] = {}
    for result, loads in zip(results, pressure.loads, strict=True):
        rows = {
            "line_torque_n_m": np.full(loads.line.size, result.torque),
            "line_position": np.full(loads.line.size, result.position),
            "line_tooth": pressure.tooth[loads.line],
            "line_plane": loads.plane,
            "line_where": loads.edge,
            "line_length_m": loads.length,
            "line_load_n_per_m": loads.line_load,
            "line_pressure_pa": np.nan_to_num(loads.pressure),
            "line_error_pa": np.nan_to_num(loads.error),
            "line_half_width_m": np.nan_to_num(loads.half_width),
        }
        for name, values in rows.items():
            lines.setdefault(name, []).append(values)
    position, tooth, points = pressure.every_point(surface.design)
    return {
        **_forces(results),
        "shape": np.array(surface.shape),
        "point_m": surface.nodes,
        **{name: np.concatenate(parts) for name, parts in lines.items()},
        "contact_position": position,
        "contact_tooth": tooth,
        "contact_point_m": points,
    }


def _forces(results: Sequence[LoadedPosition]) -> dict[str, AnyArray]:
    """Return the first six PRESSURE_ARRAYS: torque, position, pair, node, force and `in_fillet` of each
    loaded hat.
    """
    spots = [(result, spot) for result in results for spot in result.spots]
    count = [spot.hats.size for _, spot in spots]
    return {
        "torque_n_m": np.repeat([result.torque for result, _ in spots], count),
        "position": np.repeat([result.position for result, _ in spots], count),
        "tooth": np.repeat([spot.tooth for _, spot in spots], count),
        "node": np.concatenate([spot.hats for _, spot in spots]),
        "force_n": np.concatenate([spot.force for _, spot in spots]),
        "in_fillet": np.concatenate([spot.fillet for _, spot in spots]),
    }


STIFFNESS_COLUMNS = ("torque_n_m", "position", "k_average_n_per_m", "k_local_n_per_m", "interference_um")
"""Columns of table `ltca` from which the stiffness of a flank follows."""


@dataclass(frozen=True, eq=False)
class ContactAnalysis:
    """Solved contact of the different pairs that flanks are part of; tables and arrays are made when first
    read.

    Attributes
    ----------
    models
        The pairs, that of the upper gear's drive flank first.
    results
        Positions of each pair at each torque, and the pressure on its flanks.
    numbers : (gears, flanks) array of int
        Which of the pairs each flank is part of.
    """

    models: list[ContactModel]
    results: list[tuple[list[LoadedPosition], FlankPressure]]
    numbers: Integers

    @property
    def is_spur(self) -> bool:
        """Whether the teeth are spur ones, whose tables and arrays leave wrenches and further flanks out."""
        return self.models[0].design.is_spur

    @cached_property
    def ltca(self) -> list[pd.DataFrame]:
        """The contact table of each pair, columns LTCA_COLUMNS, one row a torque and position; for
        teeth other than spur ones WRENCH_QUANTITIES follow.
        """
        tables = [ltca_table(*result) for result in self.results]
        if self.is_spur:
            return tables
        on = ["torque_n_m", "position"]
        return [table.merge(wrench, on=on) for table, wrench in zip(tables, self.wrenches, strict=True)]

    @cached_property
    def other_flanks(self) -> pd.DataFrame:
        """The columns STIFFNESS_COLUMNS of `ltca` for the flanks whose design differs from the upper gear's
        drive flank, by gear and flank; without rows for spur teeth.
        """
        first, *further = (table[list(STIFFNESS_COLUMNS)] for table in self.ltca)
        numbers = np.zeros_like(self.numbers) if self.is_spur else self.numbers
        return join_flanks([first.iloc[:0], *further], numbers)[[*STIFFNESS_COLUMNS, "gear", "flank"]]

    @cached_property
    def pressure(self) -> list[dict[str, AnyArray]]:
        """Loads and pressures of each pair, as PRESSURE_ARRAYS."""
        return [
            pressure_arrays(results, model.flanks.pinion, pressure)
            for model, (results, pressure) in zip(self.models, self.results, strict=True)
        ]

    @cached_property
    def stored_pressure(self) -> dict[str, AnyArray]:
        """Arrays of the pressure file: PRESSURE_ARRAYS of the upper gear's drive flank, with those of the
        other pairs for teeth other than spur ones, see `pattern.pressure_of_flanks`.
        """
        if self.is_spur:
            return self.pressure[0]
        arrays = {**self.pressure[0], "flank_variant": self.numbers}
        for number, (pressure, table) in enumerate(zip(self.pressure[1:], self.ltca[1:], strict=True), 1):
            unloaded_error = dict(zip(table["position"], 1e-6 * table["unloaded_ste_um"], strict=True))
            errors = [unloaded_error[position] for position in pressure["contact_position"].tolist()]
            arrays |= {f"{number}_{name}": values for name, values in pressure.items()}
            arrays[f"{number}_unloaded_m"] = np.array(errors)
        return arrays

    @cached_property
    def wrenches(self) -> list[pd.DataFrame]:
        """Force and moment of the pinion on the gear, by pair, columns WRENCH_COLUMNS of `nodal_loads`."""
        return [
            wrench_table(model.flanks.pinion, results)
            for model, (results, _) in zip(self.models, self.results, strict=True)
        ]

    @cached_property
    def by_torque(self) -> list[pd.DataFrame]:
        """Summary of each pair's contact, one row a torque, columns COLUMNS of `summary` and
        `path_radius_mm`.
        """
        return [by_torque(*tables) for tables in zip(self.ltca, self.pressure, strict=True)]

    @cached_property
    def by_flank(self) -> pd.DataFrame:
        """`by_torque` of both flanks of both gears, columns BY_FLANK_COLUMNS; with `with_wrenches` for teeth
        other than spur ones.
        """
        designs = [model.design for model in self.models]
        if self.is_spur:
            return by_flank(self.by_torque, designs, self.numbers)
        tables = zip(self.by_torque, self.ltca, strict=True)
        return by_flank([with_wrenches(*of_pair) for of_pair in tables], designs, self.numbers)

    @cached_property
    def loads(self) -> dict[str, AnyArray]:
        """Forces of all pairs on the nodes of both bodies, as LOAD_ARRAYS of `facegear.contact.pattern`."""
        return load_arrays([results for results, _ in self.results], self.numbers)


def contact_analysis(
    design: PairDesign,
    materials: tuple[Material, Material],
    flanks: Sequence[PairFlanks],
    plan: ContactPlan,
    every_flank: bool = True,
    known_contacts: Sequence[KnownContact | None] = (),
    gears: Sequence[str] | None = None,
) -> ContactAnalysis:
    """Solve the contact of the flanks of pinion and face gear, or of the upper gear's drive flank alone.

    All pairs that differ in assembly errors and deviations alone are solved on the same compliances.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    materials : tuple[Material, Material]
        Pinion and face gear.
    flanks : Sequence[tuple[GearFlank, GearFlank]]
        Surfaces and compliances of pinion and face gear for each of `placement.nominal_pairs`, or for those
        of the upper gear; the first alone without `every_flank`.
    plan : ContactPlan
        Torques, positions and options.
    every_flank : bool
        Whether all flanks are solved, not only the upper gear's drive flank.
    known_contacts : Sequence[KnownContact or None]
        Contact of pairs that differ little, with the same nodes and plan, in the order of `flanks`.
    gears : Sequence[str], optional
        Gears whose flanks are solved; those that `flanks` are of if not given.

    Returns
    -------
    ContactAnalysis
        Solved contact of all different pairs.

    Raises
    ------
    NotConverged
        Names position and torque.
    """
    models, numbers = flank_models(design, flanks, gears)
    if not every_flank:
        models, numbers = models[:1], np.zeros_like(numbers)
    contact_by_teeth = dict(zip(nominal_pairs(design), known_contacts, strict=False))
    results = [
        _solve_model(pair_model, materials, plan, contact_by_teeth.get(nominal_teeth(pair_model.design)))
        for pair_model in models
    ]
    return ContactAnalysis(models, results, numbers)


def _solve_model(
    model: ContactModel,
    materials: tuple[Material, Material],
    plan: ContactPlan,
    known_contact: KnownContact | None,
) -> tuple[list[LoadedPosition], FlankPressure]:
    """Solve the contact of one pair at all positions and torques of the plan, and the pressure on its
    flanks.

    The results come position by position; pressures are in the same order.
    """
    results = loaded_contact(model, even_positions(plan.positions), plan.torques, plan.options, known_contact)
    return results, flank_pressure(results, model.flanks, materials)


ONE_FLANK = np.zeros((2, 2), dtype=int)
"""Numbers of the contact that each flank of each gear uses where all flanks are alike: always 0."""


@dataclass(frozen=True, eq=False)
class PosedContact:
    """Drive flanks in one assembly: tables and arrays as stage contact stores them.

    ltca: columns LTCA_COLUMNS; by_torque: as `summary.by_torque` returns it; pressure and loads:
    PRESSURE_ARRAYS and LOAD_ARRAYS; reactions: as returned by `touching_reactions`.
    """

    errors: AssemblyErrors
    ltca: pd.DataFrame
    by_torque: pd.DataFrame
    pressure: dict[str, AnyArray]
    loads: dict[str, AnyArray]
    reactions: pd.DataFrame


def posed_contacts(
    design: PairDesign,
    materials: tuple[Material, Material],
    flanks: tuple[GearFlank, GearFlank],
    plan: ContactPlan,
    assemblies: Sequence[AssemblyErrors],
) -> Iterator[PosedContact]:
    """Solve the contact of the drive flanks of pinion and face gear in each assembly.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    materials : tuple[Material, Material]
        Pinion and face gear.
    flanks : tuple[GearFlank, GearFlank]
        Surfaces and compliances of pinion and face gear.
    plan : ContactPlan
        Torques, positions and options.
    assemblies : Sequence[AssemblyErrors]
        Errors of each assembly.

    Yields
    ------
    PosedContact
        Contact in each assembly.

    Raises
    ------
    NotConverged
        Names position and torque.
    """
    model = contact_model(design, *flanks)
    for errors in assemblies:
        yield _solve_assembly(model.with_assembly(errors), errors, materials, plan)


def met_contacts(
    design: PairDesign,
    materials: tuple[Material, Material],
    flanks: Sequence[PairFlanks],
    plan: ContactPlan,
    pair_torques: Sequence[tuple[PairDesign, tuple[float, ...]]],
) -> Iterator[PosedContact]:
    """Solve the contact of pairs of the design's bodies in other assemblies, each at its own torques.

    Parameters
    ----------
    design : PairDesign
        Pair of gears that the flanks were made for.
    materials : tuple[Material, Material]
        Pinion and face gear.
    flanks : Sequence[tuple[GearFlank, GearFlank]]
        Surfaces and compliances of pinion and face gear for each of `placement.nominal_pairs`.
    plan : ContactPlan
        Positions and options; its torques are not used.
    pair_torques : Sequence[tuple[PairDesign, tuple[float, ...]]]
        Pairs that differ from `design` in properties that move no node, and torques of each, N m.

    Yields
    ------
    PosedContact
        Contact of each pair.

    Raises
    ------
    NotConverged
        Names position and torque.
    """
    for pair_design, torques in pair_torques:
        model = contact_model(pair_design, *flanks_of(pair_design, design, flanks))
        yield _solve_assembly(model, pair_design.assembly, materials, replace(plan, torques=torques))


def _solve_assembly(
    model: ContactModel, errors: AssemblyErrors, materials: tuple[Material, Material], plan: ContactPlan
) -> PosedContact:
    """Solve the contact of one pair whose `errors` are already in `model`, and make its tables and
    arrays.
    """
    results = loaded_contact(model, even_positions(plan.positions), plan.torques, plan.options)
    pressures = flank_pressure(results, model.flanks, materials)
    table = ltca_table(results, pressures)
    arrays = pressure_arrays(results, model.flanks.pinion, pressures)
    loads = load_arrays([results], ONE_FLANK)
    reactions = touching_reactions(model.flanks.pinion, results)
    return PosedContact(errors, table, by_torque(table, arrays), arrays, loads, reactions)
