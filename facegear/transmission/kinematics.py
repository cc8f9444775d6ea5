"""The kinematics of meshes by the names that a config gives them."""

from collections.abc import Mapping

from facegear.transmission.layout import Kinematics
from facegear.transmission.printed_kinematics import PRINTED_KINEMATICS
from facegear.transmission.teeth import GEOMETRIC

KINEMATICS: Mapping[str, Kinematics] = {
    kinematics.name: kinematics for kinematics in (GEOMETRIC, PRINTED_KINEMATICS)
}
"""Kinematics of the meshes by their names in a config."""
