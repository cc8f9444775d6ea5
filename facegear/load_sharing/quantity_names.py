"""Names of what one machine among many is judged by."""

from collections.abc import Sequence

from facegear.load_sharing.groups import load_groups
from facegear.transmission.layout import Layout

PEAK, OPEN, REVERSED = "peak_mesh_force_n", "open_share", "reversed_share"


def quantity_names(layout: Layout, dynamic: bool) -> tuple[str, ...]:
    """Columns of a sample.

    `k_gamma <mesh>`: largest quasi-static load of a path over an even share of its group's mean;
    `k_gamma_k_v <mesh>`: the same of the motion, so the product of K_gamma and the dynamic factor;
    `coefficient <group>`: mean over time of the largest load over the mean (equations (25), (26));
    then the largest load of a mesh, the share of time in which some mesh that shares a load carries
    nothing, and in which some mesh is loaded on the flank that it does not work on.
    """
    groups = load_groups(layout)
    factor = "k_gamma_k_v" if dynamic else "k_gamma"
    paths = [f"{factor} {layout.mesh_names[mesh]}" for group in groups for mesh in group.meshes]
    return (*paths, *(f"coefficient {group.name}" for group in groups), PEAK, OPEN, REVERSED)


def columns_of(start: str, names: Sequence[str]) -> list[str]:
    """Those of the names that begin with a text."""
    return [name for name in names if name.startswith(start)]
