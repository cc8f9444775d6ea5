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
"""Number of elements for the layer's energies: along the radius, through the rim and through the layer."""
FIT_TOLERANCE = 1e-8


def fitted_teeth(section: Section, design: PairDesign) -> Section:
    """Return the section whose layer has the stiffness of the teeth; without a layer, as it is.

    Parameters
    ----------
    section : Section
        Section of the face gear.
    design : PairDesign
        Pair of gears.

    Returns
    -------
    Section
        Section with fitted hoop and shear stiffness.

    Raises
    ------
    NotConverged
        Where no stiffness gives the energies of the teeth.
    """
    layer = section.layer
    if layer is None:
        return section
    rim = rim_below(section)
    target_energies = tooth_energies(design, section.material, rim, ORDER)

    def ratios(logarithms: Array) -> Array:
        hoop, shear = np.exp(logarithms)
        return np.log(layer_energies(replace(layer, hoop=hoop, shear=shear), section, rim) / target_energies)

    solution = root(ratios, np.log([layer.hoop, layer.shear]), tol=FIT_TOLERANCE)
    if np.abs(solution.fun).max() > 1e2 * FIT_TOLERANCE:
        off = f"energies of layer and teeth differ by {100 * np.abs(solution.fun).max():.2g} %"
        raise NotConverged("layer of teeth", f"rim {1e3 * rim:g} mm", off)
    hoop, shear = np.exp(solution.x).tolist()
    return replace(section, layer=replace(layer, hoop=hoop, shear=shear))


def layer_energies(layer: Layer, section: Section, rim: float) -> Array:
    """Compute twice the energy of a layer on a rim in the waves of `tooth_energies`.

    Parameters
    ----------
    layer : Layer
        Layer of teeth.
    section : Section
        Section of the face gear.
    rim : float
        Thickness of the rim, m.

    Returns
    -------
    (2,) array
        J.
    """
    mesh = strip(layer, rim)
    corners = rectangle(layer.inner_radius, layer.outer_radius, layer.back - rim, layer.back)
    whole = replace(section, corners=corners, is_edge_held=(False,) * 4, layer=layer)
    elements = elements_of(mesh)
    stiffness = elastic_stiffness(whole, mesh, elements).at(ORDER)
    r, height = elements.shape_points
    back = np.flatnonzero(np.isclose(height, layer.back - rim, rtol=0.0, atol=1e-9))
    middle = 0.5 * (layer.inner_radius + layer.outer_radius)
    is_rising = np.stack([np.ones(back.size), r[back] - middle], axis=1)
    return energies(stiffness, 3 * back + 2, is_rising)


def strip(layer: Layer, rim: float) -> BodyMesh:
    """Return layer and rim as rows of rectangles.

    Parameters
    ----------
    layer : Layer
        Layer of teeth.
    rim : float
        Thickness of the rim, m.

    Returns
    -------
    BodyMesh
        Mesh, m.
    """
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
