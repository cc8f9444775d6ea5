"""Config section `modal`: which mesh stiffness natural modes feel."""

from collections.abc import Mapping
from typing import Any, Literal

from pydantic import Field

from facegear.config.base import Section


class Modal(Section):
    """Natural modes about the loaded machine."""

    stiffness: Literal["local", "average"] = Field(
        "local",
        description="small vibrations feel the slope dF / d deflection at the load, some 30 % above average, "
        "F / deflection; both at mesh_stiffness.torque_n_m. A mean given for modes (source fem) or with "
        "harmonics is taken as it is",
    )


def modes_need_contact(values: Mapping[str, Any]) -> bool:
    """Whether modes take their stiffness from the contact analysis.

    They take the config's own mean with given harmonics, where source fem has one (for the modes only), and
    where average is asked for and source fem_scaled scales to it.

    Parameters
    ----------
    values : Mapping[str, Any]
        Plain values of a whole config.

    Returns
    -------
    bool
        True if they need it.
    """
    section = values["mesh_stiffness"]
    if section["source"] == "harmonics":
        return False
    has_mean = section["mean_n_per_m"] is not None
    return not has_mean or (section["source"] == "fem_scaled" and values["modal"]["stiffness"] == "local")
