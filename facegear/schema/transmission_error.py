"""Config of the transmission error e(t), and its Fourier series."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from facegear.errors import ConfigError
from facegear.harmonics import Harmonics
from facegear.schema.base import Section, refuse

FROM_CONTACT = "numbers, where mesh_stiffness.source is harmonics: no contact analysis gives e(t)"
"""Requirement on a transmission error from contact where nothing computes the contact."""


Lag = Annotated[float, Field(ge=0, lt=1)]


class ErrorHarmonic(Section):
    """One harmonic of the transmission error, amplitude * cos(order * angle + phase)."""

    order: int = Field(ge=1, le=64, description="multiple of the mesh frequency")
    amplitude_um: float = Field(ge=0, le=5000, description="half of its range")
    phase_deg: float = Field(0.0, ge=-360, le=360, description="of amplitude * cos(order * angle + phase)")


class TransmissionError(Section):
    """Static transmission error e(t) of the reference mesh; others lag by their phase or not at all.

    `transmission_error: from_contact` is short for source from_contact.
    """

    source: Literal["given", "from_contact"] = Field(
        "given",
        description="from_contact: that of the unloaded pair's contact analysis, less its mean",
    )
    amplitude_um: float | None = Field(
        None, ge=0, le=5000, description="required where source is given, else left out"
    )
    meaning: Literal["amplitude", "range"] = Field(
        "amplitude", description="what amplitude_um is; range: twice the amplitude"
    )
    phase_deg: float = Field(
        0.0, ge=-360, le=360, description="of the first harmonic, amplitude * cos(angle + phase)"
    )
    phasing: Literal["mesh", "in_step"] | dict[str, Lag] = Field(
        "mesh",
        description="mesh: like the stiffness; in_step: all together; or lags in mesh periods by "
        "`pinion/side` or `role/side`, all others in step",
    )
    more_harmonics: tuple[ErrorHarmonic, ...] = Field(
        (), description="beside the first, which is given above"
    )

    @model_validator(mode="before")
    @classmethod
    def _short(cls, values: Any) -> Any:
        """Read the short form `from_contact`."""
        if values == "from_contact":
            return {"source": "from_contact"}
        if isinstance(values, Mapping) and isinstance(harmonics := values.get("more_harmonics"), list):
            return {**values, "more_harmonics": tuple(harmonics)}
        return values

    @model_validator(mode="before")
    @classmethod
    def _known_phasing(cls, values: Any) -> Any:
        """Refuse lags that are no fraction of a mesh cycle."""
        phasing = values.get("phasing", "mesh") if isinstance(values, Mapping) else "mesh"
        for name, lag in phasing.items() if isinstance(phasing, Mapping) else ():
            if not isinstance(lag, int | float) or not 0 <= lag < 1:
                refuse(f"phasing.{name}", lag, "a number from 0 to below 1")
        if not isinstance(phasing, Mapping) and phasing not in ("mesh", "in_step"):
            refuse("phasing", phasing, "mesh, in_step, or lags by `pinion/side` or `role/side`")
        return values

    @model_validator(mode="after")
    def _orders_once(self) -> "TransmissionError":
        """Refuse an order of harmonic that is given twice."""
        orders = [1, *(term.order for term in self.more_harmonics)]
        for number, order in enumerate(orders):
            if order in orders[:number]:
                requirement = (
                    f"another one than {', '.join(map(str, orders[:number]))}; amplitude_um is order 1"
                )
                refuse(f"more_harmonics[{number - 1}].order", order, requirement)
        return self

    @model_validator(mode="after")
    def _one_source(self) -> "TransmissionError":
        """Refuse keys that the source of the error lacks or does not use."""
        if self.source == "given":
            if self.amplitude_um is None:
                refuse("amplitude_um", None, "given, unless transmission_error is from_contact")
            return self
        plain = TransmissionError.model_fields
        for key in ("amplitude_um", "meaning", "phase_deg", "phasing", "more_harmonics"):
            if (value := getattr(self, key)) != plain[key].default:
                refuse(key, value, "left out where e(t) is from_contact")
        return self


def error_series(section: TransmissionError, unloaded_error: Harmonics | None = None) -> Harmonics:
    """Return the transmission error of the reference mesh over a mesh cycle as a Fourier series.

    A given error is a sum of amplitude cos(order w t + phase_deg) with the mesh frequency w; with
    `meaning: range` the amplitude of order 1 is half of the number given.

    Parameters
    ----------
    section : TransmissionError
        Section `transmission_error` of the config.
    unloaded_error : Harmonics or None
        Transmission error of the unloaded pair, m, where it comes from contact.

    Returns
    -------
    Harmonics
        The series, m.

    Raises
    ------
    ConfigError
        If it comes from contact and there is none.
    """
    if section.source == "from_contact":
        if unloaded_error is None:
            raise ConfigError("transmission.transmission_error", "from_contact", FROM_CONTACT)
        return unloaded_error
    factor = {"amplitude": 1.0, "range": 0.5}[section.meaning]
    amplitude = factor * (section.amplitude_um or 0.0)
    first = ErrorHarmonic(order=1, amplitude_um=amplitude, phase_deg=section.phase_deg)
    terms = (first, *section.more_harmonics)
    max_order = max(term.order for term in terms)
    a, b = np.zeros(max_order + 1), np.zeros(max_order + 1)
    for term in terms:
        phase = np.radians(term.phase_deg)
        a[term.order] -= 1e-6 * term.amplitude_um * np.sin(phase)
        b[term.order] += 1e-6 * term.amplitude_um * np.cos(phase)
    return Harmonics(a, b)
