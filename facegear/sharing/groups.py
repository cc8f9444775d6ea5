"""Groups of meshes that share one load, names of what a machine is judged by, and settings of the stage."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from facegear.machine.layout import Layout, Role, Side
from facegear.quantities import (
    BEARINGS,
    ERROR_HARMONIC,
    ERROR_RANGE,
    FRICTION,
    JUMP_MARGIN,
    K_GAMMA,
    K_V,
    OPEN_FRACTION,
    PAST_LAW,
    PEAK,
    PRESSURE,
    REVERSED_FRACTION,
    ROOTS,
)


class GroupKind(StrEnum):
    """`inputs`: the meshes of one input pinion, equation (25); `idlers`: one gear's idlers, equation (26).

    `independent`: pinions on the only face gear. The torque of each sets the load of its mesh, so that they
    split nothing and have no load-sharing coefficient.
    """

    INPUTS = "inputs"
    IDLERS = "idlers"
    INDEPENDENT = "independent"


@dataclass(frozen=True)
class LoadGroup:
    """Meshes (positions in `Layout.meshes`) that share one load."""

    name: str
    kind: GroupKind
    meshes: tuple[int, ...]

    @property
    def splits_load(self) -> bool:
        """Whether the machine splits one load among the meshes, so that a load-sharing coefficient
        exists; False for independent pinions.
        """
        return self.kind is not GroupKind.INDEPENDENT


def split_groups(layout: Layout) -> tuple[LoadGroup, ...]:
    """Return those groups of `load_groups` among whose meshes the machine splits a load.

    Parameters
    ----------
    layout : Layout
        Bodies and meshes.

    Returns
    -------
    tuple of LoadGroup
        Groups of kind INPUTS and IDLERS; empty where nothing is split, as with one face gear.
    """
    return tuple(group for group in load_groups(layout) if group.splits_load)


def load_groups(layout: Layout) -> tuple[LoadGroup, ...]:
    """Return the groups of meshes that are compared with each other, each with at least two meshes.

    With two face gears: each input pinion's two meshes, then the lower meshes of all idlers and tails.
    With one face gear: the meshes of all inputs, and of all idlers, as independent ones that split
    nothing.

    Parameters
    ----------
    layout : Layout
        Bodies and meshes.

    Returns
    -------
    tuple of LoadGroup
        Inputs first, then idlers, with which tail pinions count.
    """
    of_role: dict[bool, list[int]] = {True: [], False: []}
    for i, pinion in enumerate(layout.pinions):
        of_role[pinion.role is Role.INPUT].append(i)
    sides = [gear.side for gear in layout.gears]
    groups: list[LoadGroup] = []
    if len(sides) > 1:
        for i in of_role[True]:
            meshes = tuple(layout.mesh_index(i, side) for side in sides)
            groups.append(LoadGroup(layout.pinions[i].name, GroupKind.INPUTS, meshes))
    else:
        meshes = tuple(layout.mesh_index(i, sides[0]) for i in of_role[True])
        groups.append(LoadGroup("inputs", GroupKind.INDEPENDENT, meshes))
    idler_side = Side.LOWER if Side.LOWER in sides else sides[0]
    idlers = tuple(layout.mesh_index(i, idler_side) for i in of_role[False])
    kind = GroupKind.IDLERS if len(sides) > 1 else GroupKind.INDEPENDENT
    groups.append(LoadGroup("idlers", kind, idlers))
    return tuple(group for group in groups if len(group.meshes) > 1)


def quantity_names(
    layout: "Layout",
    dynamic: bool,
    contact: bool = False,
    gauges: bool = False,
    jumps: bool = False,
    friction: bool = False,
    law: bool = False,
) -> tuple[str, ...]:
    """Return the names of the quantities of one machine, in the order of the columns of a table of samples.

    `k_gamma <mesh>`: mesh load factor of a path, its largest mean of a mesh cycle over its nominal even
    share (`facegear.sharing.even_shares`); of the motion with `k_v <mesh>`, the largest load over that
    mean; `coefficient <group>`: mean over time of the largest load over the mean (equations (25), (26));
    then the largest load of a mesh, the fraction of time in which some mesh that shares a load carries
    nothing, and in which some mesh is loaded on the flank that it does not work on; the mass of bearings
    for the loads on them (`facegear.sharing.quantities`).

    Parameters
    ----------
    layout : Layout
        Bodies and meshes.
    dynamic : bool
        True: quantities of the motion at speed, with k_v. False: of the quasi-static machine.
    contact : bool
        Whether the loaded transmission error of the tooth pair and its pressure are listed.
    gauges : bool
        Whether the root stress of both bodies is listed, too (`facegear.strength.contact_pressure`); only
        with `contact`.
    jumps : bool
        Whether the distance from the operating speed to the nearest jump is listed
        (`facegear.motion.sweeps.whole_sweep`).
    friction : bool
        Whether the columns FRICTION of `facegear.quantities` are listed.
    law : bool
        Whether the fraction of positions at which a flank is past the last level of its load-dependent law,
        the largest of all, is listed.

    Returns
    -------
    tuple of str
        Names in the order of the columns.
    """
    # Those who only check names, as a config does, need not load what a machine is made of.
    groups = load_groups(layout)
    sharing_meshes = [layout.mesh_names[mesh] for group in groups for mesh in group.meshes]
    paths = [f"{factor} {mesh}" for factor in (K_GAMMA, K_V)[: 1 + dynamic] for mesh in sharing_meshes]
    names = [
        *paths,
        *(f"coefficient {group.name}" for group in split_groups(layout)),
        PEAK,
        OPEN_FRACTION,
        REVERSED_FRACTION,
        BEARINGS,
    ]
    names += [PAST_LAW] if law else []
    names += [ERROR_RANGE, ERROR_HARMONIC, PRESSURE] if contact else []
    names += ROOTS.values() if contact and gauges else []
    names += FRICTION if friction else ()
    return (*names, *([JUMP_MARGIN] if jumps else []))


@dataclass(frozen=True)
class SpeedRange:
    """Evenly spaced speeds in rpm, both ends included."""

    first: float
    last: float
    points: int


@dataclass(frozen=True)
class SharingOptions:
    """Samples a cycle, cycles and starts averaged, size (m at mesh) and seed of the starts' disturbance.

    Then the confidence level, the speed of the quasi-static run (rpm), and the range of speeds looked over.
    """

    samples: int
    cycles: int
    starts: int
    spread: float
    seed: int
    confidence: float
    slow_rpm: float
    speeds: SpeedRange


@dataclass(frozen=True)
class MapOptions:
    """Deviations, samples and points of the load-sharing map.

    Attributes
    ----------
    mesh_error : float
        Standard deviation of the error of each mesh of an idler, m along the line of action.
    position : float
        Standard deviation of the tangential position of each idler, m.
    samples : int
        Machines drawn for each value of the number.
    points : int
        Values of the number on each curve.
    seed : int
        Of the draws.
    bearing_factors : (curves,) tuple of float
        Factors on the bearing stiffness of the inputs, one curve each, dimensionless.
    """

    mesh_error: float
    position: float
    samples: int
    points: int
    seed: int
    bearing_factors: tuple[float, ...]

    def deviation(self, push: float, arm: float = 1.0) -> float:
        """Compute the standard deviation of the lateness of an idler path: sqrt(2 (arm mesh_error)^2 + (push
        position)^2).

        Both meshes err independently; a pinion out of place along its tangent makes its path late by as much
        as its bearing feels of the path's force there.

        Parameters
        ----------
        push : float
            Tangential force of both meshes on the pinion over the force of the group's one, dimensionless:
            twice the cosine of the pressure angle of spur teeth.
        arm : float
            Torque on the pinion over the force of the group's mesh, over that of a drive flank, along which
            errors count; dimensionless.

        Returns
        -------
        float
            Standard deviation along the line of action, m.
        """
        return float(np.sqrt(2.0 * (arm * self.mesh_error) ** 2 + (push * self.position) ** 2))
