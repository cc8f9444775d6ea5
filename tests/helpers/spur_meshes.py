"""Meshes of spur teeth at ninety degrees: every 97th node, and checks of all numberings.

`python tests/helpers/spur_meshes.py` wrote `tests/unit/teeth/spur_meshes.npz` while both sides of a tooth
were mirror images by construction, before the commit that added the file; spur meshes are a limit of the
family since.
Each array's name is that of the config, the body and the quantity.
"""

from dataclasses import replace
from zlib import crc32

import numpy as np
from spur_values import ROOT, shipped_designs

from facegear.teeth.design import PairDesign
from facegear.teeth.mesh_sizes import named_sizes, thin_fillet
from facegear.teeth.tooth_mesh import FeTooth, gear_tooth, pinion_tooth

STORED = ROOT / "tests" / "unit" / "teeth" / "spur_meshes.npz"
EVERY = 97
BUILDERS = {"pinion": pinion_tooth, "face_gear": gear_tooth}


def meshed_designs() -> dict[str, PairDesign]:
    """Return the different designs of the shipped configs and one with a chamfer, by name."""
    designs = shipped_designs()
    plain = designs["concentric"]
    chamfered = replace(plain.pinion, tip_chamfer=0.08 * plain.module)
    return designs | {"chamfered": replace(plain, pinion=chamfered)}


def spur_mesh(design: PairDesign, body: str) -> FeTooth:
    """Return a coarse mesh of a tooth, thin at its fillet."""
    return BUILDERS[body](design, thin_fillet(named_sizes("coarse", design.module), "coarse"))


def mesh_values(tooth: FeTooth) -> dict[str, np.ndarray]:
    """Return every 97th node (m), parameters of surfaces, and checksums of the numberings."""
    numbers = [tooth.hexes, tooth.cut_left, tooth.cut_right, *tooth.faces.values()]
    numbers += [grid.nodes for grid in tooth.surfaces.values()]
    values = {"nodes": tooth.nodes[::EVERY]}
    values["numbers"] = np.array(
        [crc32(np.ascontiguousarray(part, dtype=np.int64).tobytes()) for part in numbers]
    )
    for name, grid in tooth.surfaces.items():
        values[f"{name} u"], values[f"{name} v"] = grid.u[:, ::8], grid.v[:, ::8]
    return values


def all_spur_meshes() -> dict[str, np.ndarray]:
    """Return the values of both bodies' meshes of all designs, by name."""
    return {
        f"{name}/{body}/{quantity}": value
        for name, design in meshed_designs().items()
        for body in BUILDERS
        for quantity, value in mesh_values(spur_mesh(design, body)).items()
    }


if __name__ == "__main__":
    np.savez_compressed(STORED, **all_spur_meshes())
