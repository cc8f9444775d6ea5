"""How thick the rim is that carries the teeth."""

import numpy as np

from facegear.gear_body.section import GAUSS, Section

SAME_HEIGHT = 1e-9


def rim_below(section: Section) -> float:
    """Compute the mean thickness of a section below its layer of teeth, no more than the face is wide.

    A rim thicker than that is bent by its teeth no more than a solid one.

    Parameters
    ----------
    section : Section
        Section of the face gear.

    Returns
    -------
    float
        m.

    Raises
    ------
    ValueError
        For a section without a layer.
    """
    layer = section.layer
    if layer is None:
        raise ValueError("a section without teeth")
    width = layer.outer_radius - layer.inner_radius
    r = layer.inner_radius + 0.5 * width * (GAUSS[0] + 1.0)
    first, last = section.edges[:, 0], section.edges[:, 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        part = (r[:, None] - first[:, 0]) / (last[:, 0] - first[:, 0])
        height = first[:, 1] + part * (last[:, 1] - first[:, 1])
    crossings = (part >= 0.0) & (part <= 1.0) & (height < layer.back - SAME_HEIGHT)
    back = np.where(crossings, height, -np.inf).max(axis=1)
    return float(min(0.5 * GAUSS[1] @ (layer.back - back), width))
