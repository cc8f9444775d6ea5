"""Outputs of a machine: report, files of a run, figures, models for other programs."""

from collections.abc import Callable, Sequence
from datetime import UTC, datetime
from importlib.metadata import version
from math import radians, tau
from pathlib import Path
from typing import TYPE_CHECKING

from facegear.build.cases import expand_cases
from facegear.build.tooth_pair import pair_design
from facegear.door.case import Case
from facegear.errors import extras_named, file_path, require_choice
from facegear.exchange.flank_table import write_nominal_points
from facegear.exchange.rexs import gear_unit, write_rexs
from facegear.machine.machine import Machine
from facegear.pipeline.results.chain import Chain, summary_text
from facegear.pipeline.run import machine_inputs
from facegear.schema.base import keys_named

if TYPE_CHECKING:
    from facegear.pipeline.results.whole_case import WholeCase

ENDINGS = (".step", ".stp", ".stl", ".glb", ".fmu", ".rexs", ".csv")
"""Endings of the files that `Gearbox.export` writes."""


def report(self: Case, path: str | Path, on_stage: Callable[[str, str], None] | None = None) -> Path:
    """Write the report of all that the config asks for on one page that needs no other file.

    A stage that fails is named at the head of the page with its reason; all else is computed. Until the
    page is complete, what is computed is kept beside it in a folder that ends in ``.partial``: a report
    that was stopped goes on from there.

    Parameters
    ----------
    path : str or Path
        Page to write, which ends in ``.html``.
    on_stage : callable, optional
        Called as `on_stage(name, summary)`: first with ``report`` and about how long it will take, then
        with each stage and its summary, or ``not computed:`` and the reason, as soon as it is known.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    FacegearError
        For a path that cannot be written.
    MissingExtra
        Where a library of the report is not installed.
    """
    return whole_case(self, on_stage).write_report(path)


def summary(self: Case) -> str:
    """Write what is known of the machine as lines for the terminal; of what is not known only the
    geometry is computed.

    Returns
    -------
    str
        Status, key numbers, verdicts with their reasons, and gear data as on a drawing. What was
        computed in this session, or is stored and current, is in it.

    Examples
    --------
    >>> import facegear
    >>> " ".join(facegear.example().summary().splitlines()[2].split())
    'Teeth, module 23 / 143 (3.75 mm, ratio 6.217)'
    """
    return summary_text(Chain(self._values, self.store, expand_cases(self.config)))


def run(self: Case, folder: str | Path, on_stage: Callable[[str, str], None] | None = None) -> Path:
    """Compute all that the config asks for in this process and write it, with figures and report.

    Files have the names that the workflow gives them below `folder`.

    Parameters
    ----------
    folder : str or Path
        Folder to write to.
    on_stage : Callable[[str, str], None] | None
        Called as `on_stage(name, summary)` with each stage as soon as it is known; None for no calls.

    Returns
    -------
    Path
        Path of the report. Raises what `report` raises.
    """
    return whole_case(self, on_stage).write(folder)


def figures(
    self: Case,
    folder: str | Path,
    names: Sequence[str] = (),
    suffix: str = ".png",
    on_stage: Callable[[str, str], None] | None = None,
) -> list[Path]:
    """Draw the figures of the report, from stored results where they are current.

    Parameters
    ----------
    folder
        Where the files go, as `<name><suffix>`.
    names
        Names of the figures, such as ``mesh_sweep``; all if empty.
    suffix
        Format of the files, one that matplotlib writes (``.png``, ``.svg``, ``.pdf``).
    on_stage
        Called as `on_stage(name, summary)` with each stage that is computed or read; None for no calls.

    Returns
    -------
    list of Path
        The files, in the order of computation.

    Raises
    ------
    FacegearError
        If the case has no figure of such a name.
    """
    return whole_case(self, on_stage).write_figures(folder, names, suffix)


def export(self: Case, path: str | Path, body: str = "pinion", teeth: int | None = None) -> Path:
    """Write a model for another program, by the path's ending.

    STEP or STL (mm): the exact teeth of a body, modifications included; a STEP product has the name of
    case and body. FMU: the dynamic model as C++17 sources for co-simulation (FMI 3.0), at the config's
    speed. GLB: a glTF scene of all gears in mesh, or of one pinion and its gear without a transmission.
    REXS: pinions, shafts, bearings and material as REXS 2.0, which has no face gear; the file names what
    is lost. CSV: nominal points and normals of all flanks for a measuring machine, as `flanks.file` of
    either body reads them.

    Parameters
    ----------
    path : str or Path
        File to write.
    body : str
        `pinion` or `face_gear`, for STEP and STL.
    teeth : int or None
        Number of teeth of a sector, for STEP and STL; None for the whole gear.

    Returns
    -------
    Path
        The path. Raises FacegearError for anything else, ConfigError for a pair without bodies and a
        config without a transmission.
    """
    path = file_path(path)
    ending = require_choice(path.suffix.lower(), ENDINGS, "ending of the path")
    if ending == ".fmu":
        # it loads all kernels of the motion, for one ending of many
        from facegear.exchange.fmu import write_fmu

        with keys_named():
            return write_fmu(path, machine_of(self), self._values["dynamics"]["speed_rpm"])
    if ending == ".glb":
        return _scene(self, path)
    if ending == ".csv":
        return write_nominal_points(path, self.config.tooth_pair)
    if ending == ".rexs":
        return _gear_unit(self, path)
    with extras_named():
        from facegear.pipeline.stages.tooth_bodies import export  # finite elements, an extra

        return export(path, body, teeth, self.config.tooth_pair, self.config.case)


def _scene(self: Case, path: Path) -> Path:
    """Write all gears in mesh as a glTF scene; without a section transmission one pinion at azimuth 0
    and the upper gear.
    """
    from facegear.exchange.gltf import write_gltf  # a library of the extra `exchange`

    design, machine = pair_design(self.config.tooth_pair), self.config.transmission
    if machine is None:
        return write_gltf(path, design, [("pinion", 0.0)], ["upper"])
    angles = [
        radians(pinion.angle_deg)
        if pinion.angle_deg is not None
        else tau * (pinion.angle_pitches or 0.0) / design.face_gear.teeth
        for pinion in machine.pinions
    ]
    names = [pinion.name for pinion in machine.pinions]
    return write_gltf(path, design, list(zip(names, angles, strict=True)), machine.face_gears)


def _gear_unit(self: Case, path: Path) -> Path:
    """Write shafts, pinions, bearings and materials of the config as a REXS file, dated now."""
    date = datetime.now(UTC).isoformat(timespec="seconds")
    return write_rexs(path, gear_unit(self.config), date, version("facegear"))


def machine_of(self: Case) -> "Machine":
    """Build the lumped machine as stage dynamics_response takes it; earlier stages, such as contact,
    are computed if not known.

    Returns
    -------
    Machine
        The machine, SI units. Raises ConfigError where the config has no transmission.
    """
    return machine_inputs(self._chain.arguments("dynamics_response")).build()


def whole_case(self: Case, on_stage: Callable[[str, str], None] | None = None) -> "WholeCase":
    """Return an object that computes all that the config asks for, with the cases of its studies, when
    it is needed.

    Parameters
    ----------
    on_stage : callable or None
        Called as `on_stage(name, summary)` with each stage as soon as it is known; None for no calls.

    Returns
    -------
    WholeCase
        Object that writes report, files and figures. Raises MissingExtra without the packages of the
        extra `workflow`.
    """
    from facegear.pipeline.results.whole_case import WholeCase  # the report needs the extra `workflow`

    chain = Chain(self._values, self.store, expand_cases(self.config))
    return WholeCase(chain) if on_stage is None else WholeCase(chain, on_stage)
