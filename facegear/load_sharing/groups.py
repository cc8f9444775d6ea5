"""Which meshes share one load."""

from dataclasses import dataclass
from enum import StrEnum

from facegear.transmission.layout import Layout, Role, Side


class GroupKind(StrEnum):
    """`inputs`: the meshes of one input pinion, equation (25); `idlers`: one gear's idlers, equation (26).

    `drivers`: all input pinions on the only face gear, where a pinion has no second mesh to share with.
    """

    INPUTS = "inputs"
    IDLERS = "idlers"
    DRIVERS = "drivers"


@dataclass(frozen=True)
class LoadGroup:
    """Meshes (positions in `Layout.meshes`) that share one load."""

    name: str
    kind: GroupKind
    meshes: tuple[int, ...]


def load_groups(layout: Layout) -> tuple[LoadGroup, ...]:
    """The groups of a layout with at least two meshes each; the tail pinion counts as an idler."""
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
        groups.append(LoadGroup("inputs", GroupKind.DRIVERS, meshes))
    idler_side = Side.LOWER if Side.LOWER in sides else sides[0]
    idlers = tuple(layout.mesh_index(i, idler_side) for i in of_role[False])
    groups.append(LoadGroup("idlers", GroupKind.IDLERS, idlers))
    return tuple(group for group in groups if len(group.meshes) > 1)
