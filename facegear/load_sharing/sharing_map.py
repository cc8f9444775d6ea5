"""Load-sharing map: mesh load factors over the numbers that decide them, beside the closed form.

Idlers between two face gears share by X = k_e sigma / W: stiffness of a path, standard deviation of its
lateness, load of all paths. Inputs share by 2 b k / W: the backlash of the loop is a misfit between their two
meshes. Each computed value is that of the machine's own statics.

References
----------
Singh 2010 for the curves of idlers; docs/explanation/theory.md for the loop through inputs and idlers.
"""

from collections.abc import Sequence
from functools import cached_property

import numpy as np
import pandas as pd

from facegear.arrays import Array, Integers
from facegear.load_sharing.closed_form import SplitMachine, k_gamma_samples, plane_freedom
from facegear.load_sharing.even_shares import even_shares
from facegear.load_sharing.groups import GroupKind, LoadGroup, split_groups
from facegear.load_sharing.options import MapOptions
from facegear.load_sharing.path_changes import floated, with_half_backlash, with_scaled_bearings
from facegear.transmission.flanks import carried, constant_errors, flank_law
from facegear.transmission.layout import Role, Side
from facegear.transmission.loaded_modes import pressed_springs
from facegear.transmission.machine import Machine
from facegear.transmission.static_gears import at_rest
from facegear.transmission.statics import Equilibria, settle

LEVELS = (50.0, 95.0, 99.0)
"""Percentiles of K_gamma in tables, %."""
JUDGED_LEVEL = 95.0
"""Percentile that advice is about, %."""
AS_GIVEN = "as given"
FLOATING: dict[str, tuple[Side, ...]] = {
    AS_GIVEN: (),
    "upper": (Side.UPPER,),
    "lower": (Side.LOWER,),
    "both": (Side.LOWER, Side.UPPER),
}
"""Which face gears float on each curve of the idlers."""
WANDERS = 1e-3
"""Way of a floating gear in its plane, m, beyond which its meshes do not hold it: far more than backlash."""
PERCENT_COLUMNS = tuple(f"k_gamma_p{level:g}" for level in LEVELS)
CLOSED_COLUMNS = tuple(f"closed_p{level:g}" for level in LEVELS)
CURVE_COLUMNS = ("group", "floating", "number", "all_carry", *PERCENT_COLUMNS, *CLOSED_COLUMNS)
INPUT_COLUMNS = ("group", "bearing_factor", "bearing_n_per_m", "number", "k_gamma", "closed")
POINT_COLUMNS = ("torque_n_m", "group", "kind", "load_n", "number", *PERCENT_COLUMNS)


class MappedMachine:
    """A machine at rest, with the stiffness and load of its paths; computed when asked for.

    Parameters
    ----------
    machine : Machine
        With geometric meshes and two face gears.
    """

    def __init__(self, machine: Machine) -> None:
        self.machine = machine

    @cached_property
    def machine_at_rest(self) -> Machine:
        """The machine for static questions alone."""
        return at_rest(self.machine)

    @cached_property
    def base(self) -> Equilibria:
        """Equilibrium without drawn errors. Raises NotConverged."""
        return self.equilibria(np.zeros((1, len(self.machine.layout.pinions))))

    @cached_property
    def forces(self) -> Array:
        """Load of each mesh without drawn errors, (meshes,), N."""
        return np.abs(carried(self.base.forces)[0])

    @cached_property
    def mesh_springs(self) -> Array:
        """Stiffness of each mesh under its load, (meshes,), N/m; 0 where it carries nothing."""
        springs = np.diagonal(pressed_springs(self.machine_at_rest)[1])
        return np.asarray(springs.reshape(2, -1).sum(axis=0))

    def equilibria(self, late: Array) -> Equilibria:
        """Equilibrium for pinions whose upper meshes are late.

        Parameters
        ----------
        late : (samples, pinions) array
            Lateness beside the machine's own errors, m along the line of action; positive unloads the mesh.

        Returns
        -------
        Equilibria
            One for each sample, in m and N. Raises NotConverged.
        """
        layout = self.machine.layout
        meshes, upper = len(layout.meshes), [layout.mesh_index(i, Side.UPPER) for i in range(late.shape[1])]
        tangential = np.zeros((len(late), meshes))
        tangential[:, upper] = late
        errors = constant_errors(self.machine_at_rest) + np.concatenate([tangential, -tangential], axis=1)
        names = [f"sample {number}" for number in range(len(late))]
        return settle(
            self.machine_at_rest, flank_law(self.machine_at_rest).mean(), np.zeros(len(late)), errors, names
        )

    def idler_forces(self, group: LoadGroup, late: Array) -> Array:
        """Load of the meshes of a group of idlers whose paths are late.

        Parameters
        ----------
        group : LoadGroup
            Idlers.
        late : (samples, paths) array
            Lateness of each path, m.

        Returns
        -------
        (samples, paths) array
            N. Raises NotConverged.
        """
        pinions, every = self.pinions(group), np.zeros((len(late), len(self.machine.layout.pinions)))
        every[:, pinions] = late * self.working_flank(group)
        return np.abs(carried(self.equilibria(every).forces)[:, list(group.meshes)])

    def working_flank(self, group: LoadGroup) -> Array:
        """Return on which flank the upper mesh of each path works.

        Parameters
        ----------
        group : LoadGroup
            Idlers.

        Returns
        -------
        (paths,) array
            Dimensionless: 1 on the drive flank, -1 on the back flank.
        """
        layout, forces = self.machine.layout, self.base.forces[0]
        upper = [layout.mesh_index(i, Side.UPPER) for i in self.pinions(group)]
        return np.where(forces[upper] < 0.0, -1.0, 1.0)

    def pinions(self, group: LoadGroup) -> Integers:
        """Return the numbers of the pinions of a group's meshes.

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        (meshes,) array of int
            In the order of the meshes, dimensionless.
        """
        return np.array([self.machine.layout.meshes[mesh][0] for mesh in group.meshes])

    def even(self, group: LoadGroup) -> Array:
        """Return the nominal even share of each mesh of a group.

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        (meshes,) array
            N; nan where there is none.
        """
        return np.asarray(even_shares(self.machine)[list(group.meshes)])

    def load(self, group: LoadGroup) -> float:
        """Return the load W that the meshes of a group carry together without drawn errors.

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        float
            N.
        """
        return float(self.forces[list(group.meshes)].sum())

    def factor(self, group: LoadGroup) -> float:
        """Return K_gamma of a group without drawn errors.

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        float
            The number, dimensionless.
        """
        return float((self.forces[list(group.meshes)] / self.even(group)).max())

    def group_spring(self, group: LoadGroup) -> float:
        """Return the mean stiffness of the loaded meshes of the pinions of a group.

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        float
            N/m; nan where none is loaded.
        """
        pinions = self.pinions(group)
        is_on_pinion = [i in pinions for i, _ in self.machine.layout.meshes]
        springs = self.mesh_springs[is_on_pinion]
        has_load = springs > 0.0
        return float(springs[has_load].mean()) if has_load.any() else float("nan")

    def bearing(self, group: LoadGroup) -> float:
        """Return the mean tangential stiffness of the bearings of the pinions of a group.

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        float
            N/m.
        """
        bodies = [self.machine.layout.pinions[i].body for i in self.pinions(group)]
        return float(np.mean([body.bearing[0] for body in bodies]))

    def path_stiffness(self, group: LoadGroup) -> float:
        """Return the stiffness k_e of a path through an idler.

        Parameters
        ----------
        group : LoadGroup
            Idlers.

        Returns
        -------
        float
            N/m: two meshes and the bearing in series.
        """
        form = SplitMachine(1, 1, 1.0, self.group_spring(group), 0.0, self.machine.layout.pressure_angle)
        return form.path_stiffness(self.bearing(group))

    def freedom(self, group: LoadGroup) -> float:
        """Return `plane_freedom` of the face gears as they are held.

        Parameters
        ----------
        group : LoadGroup
            Idlers.

        Returns
        -------
        float
            The number, dimensionless.
        """
        layout = self.machine.layout
        bearings = tuple(0.5 * (gear.body.bearing[0] + gear.body.bearing[1]) for gear in layout.gears)
        stiffness = self.path_stiffness(group)
        return plane_freedom(len(group.meshes), stiffness, (bearings[0], bearings[1]), layout.pressure_angle)

    def backlash(self, group: LoadGroup) -> float:
        """Return the mean backlash 2 b of the meshes of a group.

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        float
            m.
        """
        return float(2.0 * self.machine.half_backlashes[list(group.meshes)].mean())

    def number(self, group: LoadGroup, deviation: float) -> float:
        """Number that decides the sharing of a group, dimensionless.

        Parameters
        ----------
        group : LoadGroup
            Idlers: k_e times `deviation` over W. Meshes of an input: 2 b k over its load.
        deviation : float
            Standard deviation of the lateness of a path, m.

        Returns
        -------
        float
            The number, dimensionless; nan where the group carries nothing.
        """
        load = self.load(group)
        if load <= 0.0:
            return float("nan")
        if group.kind is GroupKind.IDLERS:
            return self.path_stiffness(group) * deviation / load
        return self.backlash(group) * self.group_spring(group) / load


def idler_groups(machine: Machine) -> list[LoadGroup]:
    """Return the groups of idlers, which have a map over the deviation of their errors.

    Parameters
    ----------
    machine : Machine
        With geometric meshes and two face gears.

    Returns
    -------
    list of LoadGroup
        Empty where there is none.
    """
    return [group for group in split_groups(machine.layout) if group.kind is GroupKind.IDLERS]


def input_groups(machine: Machine) -> list[LoadGroup]:
    """Return the inputs between two face gears, which have a map over their misfit.

    Parameters
    ----------
    machine : Machine
        With geometric meshes and two face gears.

    Returns
    -------
    list of LoadGroup
        Empty where there is none.
    """
    return [group for group in split_groups(machine.layout) if group.kind is GroupKind.INPUTS]


def draws(group: LoadGroup, options: MapOptions) -> Array:
    """Draw the lateness of the paths of a group.

    Parameters
    ----------
    group : LoadGroup
        Idlers.
    options : MapOptions
        Number of samples and seed.

    Returns
    -------
    (samples, paths) array
        Lateness over its standard deviation, dimensionless.
    """
    random = np.random.default_rng(options.seed)
    return random.standard_normal((options.samples, len(group.meshes)))


def floating_machine(machine: Machine, group: LoadGroup, floating: str) -> MappedMachine | None:
    """Let face gears float; None where the meshes do not hold them there.

    Parameters
    ----------
    machine : Machine
        As it is given.
    group : LoadGroup
        Whose paths have to stay loaded.
    floating : str
        A key of FLOATING.

    Returns
    -------
    MappedMachine or None
        The machine with the bearings of these gears gone in their planes.
    """
    mapped = MappedMachine(floated(machine, FLOATING[floating]))
    if not FLOATING[floating]:
        return mapped
    layout, displacements = machine.layout, mapped.base.displacements[0]
    first = 4 * len(layout.pinions)
    ways = [np.hypot(*displacements[first + 4 * g : first + 4 * g + 2]) for g in range(len(layout.gears))]
    return mapped if max(ways) < WANDERS and mapped.load(group) > 0.0 else None


def idler_curves(machine: Machine, options: MapOptions, largest: float) -> pd.DataFrame:
    """Compute K_gamma of idlers over X for each way of floating the face gears.

    Parameters
    ----------
    machine : Machine
        With geometric meshes and two face gears.
    options : MapOptions
        Samples and points.
    largest : float
        Largest X = k_e sigma / W, dimensionless.

    Returns
    -------
    pd.DataFrame
        CURVE_COLUMNS: all_carry is the fraction of samples in which every path carries; closed_* is the
        closed form, for the load that the group carries. Raises NotConverged.
    """
    rows: list[tuple[object, ...]] = []
    for group in idler_groups(machine):
        errors = draws(group, options)
        for floating in FLOATING:
            mapped = floating_machine(machine, group, floating)
            if mapped is None or not np.isfinite(mapped.even(group)).all() or mapped.load(group) <= 0.0:
                continue
            load, stiffness = mapped.load(group), mapped.path_stiffness(group)
            freedom = mapped.freedom(group) if floating == AS_GIVEN else 1.0
            carried_part = load / float(mapped.even(group).sum())
            for number in np.linspace(0.0, largest, options.points).tolist():
                forces = mapped.idler_forces(group, number * load / stiffness * errors)
                factors = (forces / mapped.even(group)).max(axis=1)
                exact = carried_part * k_gamma_samples(number, errors, freedom)
                all_carry = float((forces > 0.0).all(axis=1).mean())
                rows.append((group.name, floating, number, all_carry, *levels(factors), *levels(exact)))
    return pd.DataFrame(rows, columns=list(CURVE_COLUMNS))


def input_curves(machine: Machine, options: MapOptions, largest: float) -> pd.DataFrame:
    """Compute K_gamma of inputs over 2 b k / W for each stiffness of their bearings.

    Parameters
    ----------
    machine : Machine
        With geometric meshes and two face gears.
    options : MapOptions
        Points and factors on the stiffness of the bearings.
    largest : float
        Largest 2 b k / W, dimensionless.

    Returns
    -------
    pd.DataFrame
        INPUT_COLUMNS; closed is the loop formula, nan without idlers. Raises NotConverged.
    """
    rows: list[tuple[object, ...]] = []
    groups = [group for group in input_groups(machine) if np.isfinite(even_shares(machine)[group.meshes[0]])]
    for factor in options.bearing_factors:
        base_machine = MappedMachine(with_scaled_bearings(machine, (Role.INPUT,), factor))
        for number in np.linspace(0.0, largest, options.points).tolist():
            for group in groups:
                load, spring = base_machine.load(group), base_machine.group_spring(group)
                if not np.isfinite(spring):
                    continue
                half = 0.5 * number * load / spring
                mapped = MappedMachine(with_half_backlash(base_machine.machine, half))
                key = (group.name, factor, base_machine.bearing(group), number)
                rows.append((*key, mapped.factor(group), loop_factor(mapped, group)))
    return pd.DataFrame(rows, columns=list(INPUT_COLUMNS))


def loop_factor(mapped: MappedMachine, group: LoadGroup) -> float:
    """Return K_gamma of an input by the loop formula of docs/explanation/theory.md.

    Parameters
    ----------
    mapped : MappedMachine
        The machine.
    group : LoadGroup
        Meshes of an input.

    Returns
    -------
    float
        The factor, dimensionless; nan without idlers.
    """
    form = split_machine(mapped, group)
    idlers = idler_groups(mapped.machine)
    if form is None or not idlers:
        return float("nan")
    return form.input_k_gamma(mapped.bearing(group), mapped.bearing(idlers[0]))


def split_machine(mapped: MappedMachine, group: LoadGroup) -> SplitMachine | None:
    """Return the ideal machine of equal inputs and idlers that is nearest to this one.

    Parameters
    ----------
    mapped : MappedMachine
        The machine.
    group : LoadGroup
        Meshes of an input.

    Returns
    -------
    SplitMachine or None
        None without idlers.
    """
    layout, idlers = mapped.machine.layout, idler_groups(mapped.machine)
    inputs = sum(pinion.role is Role.INPUT for pinion in layout.pinions)
    spring = mapped.group_spring(group)
    if not idlers or not inputs or not np.isfinite(spring):
        return None
    return SplitMachine(
        inputs,
        len(idlers[0].meshes),
        mapped.load(group),
        spring,
        mapped.backlash(group),
        layout.pressure_angle,
    )


def map_points(machines: Sequence[tuple[float, Machine]], options: MapOptions) -> pd.DataFrame:
    """Place the machine on the map at each of its torques.

    Parameters
    ----------
    machines : sequence of (float, Machine)
        Torque of an input, N m, and the machine under it.
    options : MapOptions
        Deviations and samples.

    Returns
    -------
    pd.DataFrame
        POINT_COLUMNS, one row a torque and group; an input has one value in all percentiles. Raises
        NotConverged.
    """
    rows: list[tuple[object, ...]] = []
    for torque, machine in machines:
        mapped, deviation = MappedMachine(machine), options.deviation(machine.layout.pressure_angle)
        for group in split_groups(machine.layout):
            number = mapped.number(group, deviation)
            if not np.isfinite(number) or not np.isfinite(mapped.even(group)).all():
                continue
            factors = group_levels(mapped, group, deviation, options)
            rows.append((torque, group.name, group.kind.value, mapped.load(group), number, *factors))
    return pd.DataFrame(rows, columns=list(POINT_COLUMNS))


def group_levels(
    mapped: MappedMachine, group: LoadGroup, deviation: float, options: MapOptions
) -> tuple[float, ...]:
    """Return percentiles of K_gamma of a group by statics.

    Parameters
    ----------
    mapped : MappedMachine
        The machine.
    group : LoadGroup
        Meshes of an input, or idlers.
    deviation : float
        Standard deviation of the lateness of a path, m.
    options : MapOptions
        Samples.

    Returns
    -------
    tuple of float
        One for each of LEVELS, dimensionless. Raises NotConverged.
    """
    if group.kind is GroupKind.INPUTS:
        return (mapped.factor(group),) * len(LEVELS)
    forces = mapped.idler_forces(group, deviation * draws(group, options))
    return levels((forces / mapped.even(group)).max(axis=1))


def levels(factors: Array) -> tuple[float, ...]:
    """Return the percentiles LEVELS of drawn values.

    Parameters
    ----------
    factors : (samples,) array
        Values in any unit.

    Returns
    -------
    tuple of float
        In the same unit.
    """
    return tuple(float(value) for value in np.percentile(factors, LEVELS))
