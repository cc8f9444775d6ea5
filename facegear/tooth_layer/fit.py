"""Stiffness round the axis and in shear of the layer that stands for the teeth, from their own energies.

Two waves of one order bend and twist a rim. The layer of Fourier elements on a rim of the same thickness gets
the two numbers with which it stores as much energy in both as the real teeth do. What fills the layer is its
volume of teeth.
"""

from dataclasses import replace

import numpy as np
from scipy.optimize import root

from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.gear_body.elements import elements_of
from facegear.gear_body.matrices import elastic_stiffness
from facegear.gear_body.mesh import BodyMesh
from facegear.gear_body.section import Layer, Section, rectangle
from facegear.geometry.design import PairDesign
from facegear.tooth_layer.rim import rim_below
from facegear.tooth_layer.sector import energies, tooth_energies

ORDER = 4
"""Nodal diameters of the waves; three to six give the same numbers to 1 %."""
ELEMENTS = (6, 4, 4)
"""Of the layer's energies: along the radius, through the rim and through the layer."""
REACHED = 1e-8


def fitted_teeth(section: Section, design: PairDesign) -> Section:
    """The section whose layer has the stiffness of the teeth of `design`; without a layer, as it is.

    Raises NotConverged.
    """
    layer = section.layer
    if layer is None:
        return section
    rim = rim_below(section)
    wanted = tooth_energies(design, section.material, rim, ORDER)

    def missing(logarithms: Array) -> Array:
        hoop, shear = np.exp(logarithms)
        return np.log(layer_energies(replace(layer, hoop=hoop, shear=shear), section, rim) / wanted)

    solution = root(missing, np.log([layer.hoop, layer.shear]), tol=REACHED)
    if np.abs(solution.fun).max() > 1e2 * REACHED:
        off = f"energies of layer and teeth differ by {100 * np.abs(solution.fun).max():.2g} %"
        raise NotConverged("layer of teeth", f"rim {1e3 * rim:g} mm", off)
    hoop, shear = np.exp(solution.x).tolist()
    return replace(section, layer=replace(layer, hoop=hoop, shear=shear))


def layer_energies(layer: Layer, section: Section, rim: float) -> Array:
    """Twice the energy (2,), J, of a layer on a rim `rim` (m) thick in the waves of `tooth_energies`."""
    mesh = strip(layer, rim)
    corners = rectangle(layer.inner_radius, layer.outer_radius, layer.back - rim, layer.back)
    whole = replace(section, corners=corners, is_edge_held=(False,) * 4, layer=layer)
    elements = elements_of(mesh)
    stiffness = elastic_stiffness(whole, mesh, elements).at(ORDER)
    r, height = elements.shape_points
    back = np.flatnonzero(np.isclose(height, layer.back - rim, rtol=0.0, atol=1e-9))
    middle = 0.5 * (layer.inner_radius + layer.outer_radius)
    rising = np.stack([np.ones(back.size), r[back] - middle], axis=1)
    return energies(stiffness, 3 * back + 2, rising)


def strip(layer: Layer, rim: float) -> BodyMesh:
    """Layer and rim as rows of rectangles."""
    across, below, above = ELEMENTS
    r = np.linspace(layer.inner_radius, layer.outer_radius, across + 1)
    heights = np.concatenate(
        [
            np.linspace(layer.back - rim, layer.back, below + 1),
            np.linspace(layer.back, layer.front, above + 1)[1:],
        ]
    )
    nodes = np.stack(np.meshgrid(r, heights), axis=-1).reshape(-1, 2)
    first = (np.arange(below + above)[:, None] * (across + 1) + np.arange(across)).ravel()
    quads = np.stack([first, first + 1, first + across + 2, first + across + 1], axis=1)
    return BodyMesh(nodes, quads, np.repeat([False, True], [below * across, above * across]))
