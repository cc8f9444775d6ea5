"""The inputs of a machine that shape its dynamics and that publications tend to leave out, in words."""

from collections.abc import Mapping
from typing import Any

SOURCES = {
    "fem": "computed by finite elements",
    "fem_scaled": "computed by finite elements and scaled to a given mean",
    "harmonics": "given as harmonics",
}
"""Where the mesh stiffness is from, in words, by the value of `mesh_stiffness.source`."""


def inputs_in_words(values: Mapping[str, Any]) -> list[str]:
    """Describe the inputs.

    Parameters
    ----------
    values : Mapping[str, Any]
        Plain values of the config.

    Returns
    -------
    list[str]
        A phrase for each input.
    """
    transmission, pair = values["transmission"], values["tooth_pair"]
    torque, error = transmission["torque"], transmission["transmission_error"]
    gear, pinion, shaper = pair["face_gear"], pair["pinion"], pair["shaper"]
    stiffness = values["mesh_stiffness"]
    further_text = "; ".join(
        f"harmonic {term['order']}: {term['amplitude_um']:.3g} µm" for term in error["more_harmonics"]
    )
    mean = "" if stiffness["source"] == "fem" else f", mean {1e-6 * stiffness['mean_n_per_m']:.3g} N/µm"
    phasing = _phasing(error["phasing"])
    teeth = (
        []
        if pinion is None
        else [
            f"face width {gear['inner_radius_mm']:g} to {gear['outer_radius_mm']:g} mm, "
            f"rim {gear['rim_thickness_mm']:g} mm, bore {pinion['bore_radius_mm']:g} mm, "
            f"shaper teeth {shaper['teeth']}"
        ]
    )
    pinions_with_torque = [
        pinion for pinion in transmission["pinions"] if pinion.get("torque_n_m") is not None
    ]
    torque_text = "".join(
        f", {pinion['name']} {pinion['torque_n_m']:g} N m" for pinion in pinions_with_torque
    )
    return [
        f"torque per engine {torque['per_input_n_m']:g} N m{torque_text}",
        f"power at the tail {100 * torque['tail_share']:.3g} %",
        "e(t) from contact"
        if error["source"] == "from_contact"
        else f"e(t): {error['amplitude_um']:.4g} µm read as its {error['meaning']}, cosine, "
        f"phase {error['phase_deg']:g} deg, {phasing}" + (f", {further_text}" if further_text else ""),
        f"phases of the lower meshes {transmission['phase_convention']}",
        f"mesh stiffness {SOURCES[stiffness['source']]}" + mean + _variation(stiffness["variation"]),
        _kinematics(transmission),
        *teeth,
    ]


def inputs_caption(values: Mapping[str, Any], of_publication: bool) -> str:
    """Write a figure's line of inputs; for a figure of a publication it says who chose them.

    Parameters
    ----------
    values : Mapping[str, Any]
        Plain values of the config.
    of_publication : bool
        Whether the figure belongs to a publication.

    Returns
    -------
    str
        The line.
    """
    lead = "Not disclosed by the paper, chosen here: " if of_publication else "Inputs of the base case: "
    return lead + "; ".join(inputs_in_words(values))


def _phasing(phasing: str | Mapping[str, float]) -> str:
    if isinstance(phasing, str):
        return {"in_step": "in step at all meshes", "mesh": "shifted like the mesh stiffness"}[phasing]
    lags = ", ".join(f"{mesh} {lag:g}" for mesh, lag in phasing.items())
    return f"in step but for lags in mesh periods: {lags}"


def _variation(factor: float) -> str:
    return "" if factor == 1.0 else f", {factor:.3g} times its variation"


def _kinematics(transmission: Mapping[str, Any]) -> str:
    radius = transmission["face_gear"]["mesh_radius_mm"]
    return "meshes geometric" if radius is None else f"meshes as printed, mesh radius {radius:g} mm"
