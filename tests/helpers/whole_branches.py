"""Branches of periodic orbits through a state that is known."""

import numpy as np

from facegear.motion.branches.continuation import follow
from facegear.motion.branches.points import at_parameter


def branch_at(period_map, z, value, run):
    """The whole branch through the orbit next to the weighted state z at a parameter."""
    return follow(period_map, at_parameter(period_map, z, float(np.log(value))), run)
