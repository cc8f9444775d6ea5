"""The deck CalculiX is given, read back; no run."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from contact_bodies import STEEL, pair_design

from facegear.teeth.design import AssemblyErrors
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.unloaded_contact import unloaded_contact
from validation.contact.calculix import write_deck

TURN = 1e-3


def read(path, design):
    """Nodes (mm) by label and the labels of the sets of a deck at a position off the middle of the pitch."""
    phi1 = -0.4 * 2 * pi / design.pinion.teeth
    angles = phi1, float(unloaded_contact(design, [phi1]).phi2[0])
    write_deck(path, design, MeshSizes(3e-3, 8e-3, 4e-3), (STEEL, STEEL), 3, angles, TURN)
    nodes, sets, target = {}, {}, None
    for line in path.read_text().splitlines():
        if line.startswith("*"):
            name = line.split("NSET=")[-1] if line.startswith(("*NSET", "*NODE,")) else None
            target = sets.setdefault(name, []) if name else None
        elif target is not None and line.count(",") == 3:
            label, *place = line.split(",")
            nodes[int(label)] = np.array(place, dtype=float)
        elif target is not None:
            target.append(int(line.strip(",")))
    return nodes, sets, angles


@pytest.mark.parametrize("assembly", [AssemblyErrors(), AssemblyErrors(0.1e-3, 1e-3, 0.05e-3)])
def test_bore_turns_about_its_own_axis_wherever_the_gear_stands(tmp_path, assembly):
    design = replace(pair_design(), assembly=assembly)
    nodes, sets, _ = read(tmp_path / "deck.inp", design)
    bore = np.array([nodes[label] for label in sets["H_PINION"]])
    np.testing.assert_allclose(np.hypot(bore[:, 0], bore[:, 2]), 1e3 * design.pinion.bore_radius, rtol=1e-6)
