"""Groups of meshes that share one load."""

from dataclasses import dataclass
from enum import StrEnum

from facegear.transmission.layout import Layout, Role, Side


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
        """Whether the machine splits a load among the meshes, so that a load-sharing coefficient exists."""
        return self.kind is not GroupKind.INDEPENDENT


def split_groups(layout: Layout) -> tuple[LoadGroup, ...]:
    """Return the groups among whose meshes the machine splits a load.

    Parameters
    ----------
    layout : Layout
        Bodies and meshes.

    Returns
    -------
    tuple of LoadGroup
        Empty where nothing is split.
    """
    return tuple(group for group in load_groups(layout) if group.splits_load)


def load_groups(layout: Layout) -> tuple[LoadGroup, ...]:
    """Return the groups of a layout with at least two meshes each; the tail pinion counts as an idler.

    Parameters
    ----------
    layout : Layout
        Bodies and meshes.

    Returns
    -------
    tuple of LoadGroup
        Inputs first, then idlers.
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
