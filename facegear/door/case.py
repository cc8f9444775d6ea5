"""The config of a machine and what is stored or computed of it, which all answers of a gearbox build on."""

from collections.abc import Iterable, Mapping
from copy import deepcopy
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Self

from facegear.build.cases import changed_config
from facegear.build.config import Config, resolved_values
from facegear.build.load import plain
from facegear.errors import ConfigError, FacegearError
from facegear.pipeline.results.chain import Chain
from facegear.pipeline.results.store import Store

HOLDS = {"tolerances": "causes and what is asked of them", "search": "variables and objectives"}
"""Sections that a config may leave out, and what they say."""


@dataclass(frozen=True, eq=False, repr=False)
class Case:
    """A machine as its config describes it, with all that is known of it; base of `Gearbox`.

    `config` is validated, `store` finds what was computed in this session or is stored by the workflow.
    Nothing in it changes: methods that take other values work on a changed copy, which shares the
    store.
    """

    config: Config
    store: Store = field(default_factory=Store)

    @property
    def values(self) -> dict[str, Any]:
        """The config as plain values, complete, with what follows from other keys filled in.

        A copy: what is changed in it changes no answer, `with_values` does.
        """
        return deepcopy(self._values)

    @cached_property
    def _values(self) -> dict[str, Any]:
        """Plain values of the config, complete with derived keys."""
        return resolved_values(self.config)

    def with_values(self, changes: Mapping[str, Any]) -> Self:
        """Return a copy with some values of the config changed; results that the changes do not touch
        are not computed again.

        Parameters
        ----------
        changes : Mapping[str, Any]
            Values by dotted config key, such as `dynamics.speed_rpm` (list positions as numbers).

        Returns
        -------
        Gearbox
            The copy. Raises ConfigErrors with one line for every mistake.

        Examples
        --------
        >>> import facegear
        >>> stiffer = facegear.example().with_values({"mesh_stiffness.mean_n_per_m": 5e8})
        >>> stiffer.values["mesh_stiffness"]["mean_n_per_m"]
        500000000.0
        """
        if not isinstance(changes, Mapping) or not all(isinstance(key, str) for key in changes):
            raise FacegearError(f"changes = {changes!r}: must be a mapping of dotted config keys to values")
        return self._with_changes("with_values", changes)

    def _torques(self, torques: float | Iterable[float] | None) -> dict[str, Any]:
        """Return changes of the config, by dotted key, for a contact analysis at other torques; none
        for None.

        Torques are in N m on the pinion of one mesh, a single one or several, rising. The torque of the
        mesh stiffness and the rating are taken out, as they need not lie within these; gauges stay.
        """
        if torques is None:
            return {}
        changes: dict[str, Any] = {
            "contact.torques_n_m": torques if isinstance(torques, Iterable) else [torques]
        }
        changes["mesh_stiffness.torque_n_m"] = None  # need not lie within these
        if self._values["strength"] is not None:  # nor its duty cycle; the fillets keep their gauges
            changes |= {"strength": None, "contact.root_stress": self._values["contact"]["root_stress"]}
        return changes

    def _require_section(self, section: str) -> Mapping[str, Any]:
        """Return section `tolerances` or `search` as plain values; raise ConfigError where the config
        leaves it out.
        """
        values: Mapping[str, Any] | None = self._values[section]
        if values is None:
            raise ConfigError(section, None, f"a section of the config: {HOLDS[section]}")
        return values

    def _with_branches(self, changes: Mapping[str, Any]) -> Self:
        """Return a copy with a section `branches` in which `changes` replace values of the config's own
        section, if there is one.

        A mapping among the changes replaces only the keys that it holds.
        """
        section = self._values["branches"] or {}
        inner = {
            key: {**section.get(key, {}), **value} if isinstance(value, Mapping) else value
            for key, value in changes.items()
        }
        return self._with_changes("branches", {"branches": {**section, **inner}})

    def _with_changes(self, label: str, changes: Mapping[str, Any]) -> Self:
        """Return a copy with changed dotted config keys that shares this case's store; the case itself
        without changes.

        `label` names the origin of the changes in messages.
        """
        if not changes:
            return self
        config = changed_config(self.config.model_dump(mode="json"), plain(changes), label)
        return type(self)(config, self.store)

    @cached_property
    def _chain(self) -> Chain:
        """Chain of stages that computes or finds the answers of this config; it does not know cases of
        studies.
        """
        return Chain(self._values, self.store)


def drop_none(changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return changes of a config without those whose value is None, which stand for "as in the config".

    Parameters
    ----------
    changes : mapping
        Values by dotted config key.

    Returns
    -------
    dict
        The changes that are given; empty if none is.
    """
    return {key: value for key, value in changes.items() if value is not None}
