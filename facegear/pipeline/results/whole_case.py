"""All that a config asks for, computed in this process: the report, and every file of the case."""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from facegear.build.notes import notes
from facegear.errors import FacegearError, MissingExtra, extras_named, file_path, require_choice
from facegear.io.atomic import atomic_path, require_writable, require_writable_file
from facegear.pipeline.arguments import typed_arguments
from facegear.pipeline.machine_conditions import machine_loads
from facegear.pipeline.needs import resolved_needs
from facegear.pipeline.provenance.manifest import versions
from facegear.pipeline.report_tables import (
    REPORT_TABLES,
    asked_for,
    outlook_in_words,
    reported_tables,
    shown_pair,
    table_name,
)
from facegear.pipeline.results.base import StageOutput
from facegear.pipeline.results.chain import Chain
from facegear.pipeline.results.store import PartialResults
from facegear.pipeline.run import write_stage
from facegear.pipeline.stage import Stage, load
from facegear.pipeline.table import STAGES
from facegear.report.case import case_report
from facegear.report.figures.draw_matplotlib import save
from facegear.report.page import with_omissions
from facegear.report.viewers import body_view

OnStage = Callable[[str, str], None]
"""Is called with the name of each stage and its summary as soon as it is known."""
NOT_COMPUTED = "not computed"
"""Beginning of the summary of a stage that failed."""
PICTURE_ENDINGS = (".eps", ".jpg", ".pdf", ".png", ".svg", ".tif", ".webp")
"""Endings of the formats in which figures are written."""
NOT_REPORTED = ("mesh", "mesh_law")
"""Stages whose files only other programs and stages read."""


@dataclass(frozen=True, eq=False)
class WholeCase:
    """All that a case's config asks for: it computes stages in order, and writes report, files and
    figures.

    - chain: stages of the case; it must know all cases of the config
    - on_stage: called with name and summary of each stage as soon as it is known
    - records: of each stage that is known, rule, summary, seconds and versions, for the report
    - failures: reasons why stages could not be computed, by stage
    """

    chain: Chain
    on_stage: OnStage = lambda name, summary: None
    records: list[Mapping[str, Any]] = field(default_factory=list)
    failures: dict[str, str] = field(default_factory=dict)

    def write_report(self, path: str | Path) -> Path:
        """Write the report as one page that needs no other file.

        A stage that fails is named at the head of the page, with the reason. What is computed is kept beside
        the page until it is complete, so that a report that was stopped goes on from there.

        Parameters
        ----------
        path : str or Path
            File to write.

        Returns
        -------
        Path
            Its path.
        """
        path = file_path(path)
        if path.suffix != ".html":
            raise FacegearError(f"{path}: must end in .html")
        require_writable_file(path)
        partial = PartialResults(path.with_suffix(".partial"))
        partial.require_usable()
        self.on_stage("report", self.outlook())
        store = replace(self.chain.store, partial=partial, failures={})
        going_on = replace(self, chain=replace(self.chain, store=store))
        with extras_named(), TemporaryDirectory() as folder:
            stages = [stage for stage in self._stages_made() if _is_reported(stage)]
            text = going_on._page(Path(folder), going_on._computable(stages))
        text = with_omissions(text, [f"{titles}: {reason}" for titles, reason in self.omissions()])
        with atomic_path(path) as temporary:
            temporary.write_text(text, encoding="utf-8")
        if not self.failures:
            partial.remove()
        return path

    def omissions(self) -> list[tuple[str, str]]:
        """List the stages that could not be computed, those with one reason together.

        Returns
        -------
        list of tuple
            Titles of stages, joined by commas, and the reason.
        """
        by_reason: dict[str, list[str]] = {}
        for name, reason in self.failures.items():
            by_reason.setdefault(reason, []).append(STAGES[name].title)
        return [(", ".join(titles), reason) for reason, titles in by_reason.items()]

    def outlook(self) -> str:
        """Say how many stages a report computes, and about how long they will take.

        Returns
        -------
        str
            Number of stages, and their processor time in s or min.
        """
        return outlook_in_words(
            self.chain.case, [stage for stage in self._stages_made() if _is_reported(stage)]
        )

    def write(self, folder: str | Path) -> Path:
        """Write the files of every stage, its figures and the report below a folder.

        They have the names and contents that the workflow gives them, without records of what made them.

        Parameters
        ----------
        folder : str or Path
            The folder.

        Returns
        -------
        Path
            Path of the report.
        """
        folder = file_path(folder, "folder")
        require_writable(folder)
        for stage in self._stages_made():
            content = self._output(stage).content
            paths = {
                name: [str(folder / file.at({"each": text})) for text in file.each_text(self.chain.case)]
                if file.each_text
                else str(folder / file.path)
                for name, file in stage.files.items()
            }
            write_stage(stage, content, paths)
        with extras_named():
            text = self._page(folder / "figures", self._stages_made())
        with atomic_path(folder / "report.html") as temporary:
            temporary.write_text(text, encoding="utf-8")
        return folder / "report.html"

    def write_figures(
        self, folder: str | Path, names: Sequence[str] = (), suffix: str = ".png"
    ) -> list[Path]:
        """Draw figures of the case into a folder.

        Parameters
        ----------
        folder
            Where the files go, as `<name><suffix>`.
        names
            Names of the figures, as those of the files in the case's `figures` folder; all if empty.
        suffix
            Format of the files, one that matplotlib writes.

        Returns
        -------
        list of Path
            The files, in the order of computation.

        Raises
        ------
        FacegearError
            If the case has no figure of such a name.
        """
        folder, names = file_path(folder, "folder"), [names] if isinstance(names, str) else names
        require_choice(suffix, PICTURE_ENDINGS, "suffix")
        if not isinstance(names, Sequence):
            raise FacegearError(f"names = {names!r}: must be a list of names of figures")
        known_names = {name: stage for stage in self._stages_made() for name in self._figure_names(stage)}
        for name in names:
            if name not in known_names:
                raise FacegearError(f"figure {name!r}: must be one of this case: {', '.join(known_names)}")
        requested_names = names or known_names
        paths = []
        with extras_named():
            for stage in (
                stage
                for stage in self._stages_made()
                if set(self._figure_names(stage)) & set(requested_names)
            ):
                self._output(stage)
                for name, figure in self._figures(stage):
                    if name in requested_names:
                        path = folder / f"{name}{suffix}"
                        save(figure, path)
                        paths.append(path)
        return paths

    def _stages_made(self) -> list[Stage]:
        """Return the rows of all stages that a plain run of the case makes, in the order of the table."""
        return [stage for name, stage in STAGES.items() if asked_for(name, self.chain.case)]

    def _computable(self, stages: list[Stage]) -> list[Stage]:
        """Compute stages, and return those that did not fail; the others are noted in `failures`, with
        the reason.

        A missing library is raised, as the machine is not at fault.
        """
        for stage in stages:
            try:
                self._output(stage)
            except MissingExtra:
                raise  # nothing is wrong with the machine: the user installs it
            except FacegearError as error:
                self._note_failure(stage.name, " ".join(str(error).splitlines()))
            except MemoryError:
                self._note_failure(stage.name, "not enough memory; a coarser mesh.resolution takes less")
        return [stage for stage in stages if stage.name not in self.failures]

    def _note_failure(self, name: str, reason: str) -> None:
        """Store and announce that a stage could not be computed; a reason that was announced before is
        not repeated.
        """
        is_known = reason in self.failures.values()
        self.failures[name] = reason
        self.on_stage(name, f"{NOT_COMPUTED}: {'for the same reason' if is_known else reason}")

    def _output(self, stage: Stage) -> StageOutput:
        """Return the output of a stage; the first time it is added to `records` and announced by
        `on_stage`.
        """
        start = time.perf_counter()
        output = self.chain.output(stage.name)
        if stage.name not in [record["rule"] for record in self.records]:
            seconds = round(time.perf_counter() - start, 3)
            record = {"rule": stage.name, "summary": output.summary, "seconds": seconds}
            self.records.append({**record, "versions": versions()})
            self.on_stage(stage.name, output.summary)
        return output

    def _page(self, folder: Path, stages: list[Stage]) -> str:
        """Return the report as the text of an HTML page, from the given stages; their figures are
        written to `folder`.
        """
        for stage in stages:
            self._output(stage)
        table_files = reported_tables(self.chain.case)
        if machine_loads(self.chain.case):
            table_files.append(("duty_loads", "duty_loads"))
        table_files = [(name, file) for name, file in table_files if name not in self.failures]
        tables = {
            table_name(STAGES[name].files[file].path): self.chain.part(name, file)
            for name, file in table_files
        }
        pictures = {name: path for stage in stages for name, path in self._draw_stage(stage, folder)}
        values = {**self.chain.values, "reproduction": False}
        return case_report(
            values,
            tables,
            pictures,
            self.records,
            self._part("geometry", "pair"),
            self._view(),
            self._bodies(),
            notes=notes(self.chain.values),
            pressure=self._part("contact", "pressure"),
        )

    def _figure_names(self, stage: Stage) -> Sequence[str]:
        """Return the names of all figures of a stage, none if it draws none."""
        return stage.figures.figure_names(self.chain.case) if stage.figures else ()

    def _figures(self, stage: Stage) -> Iterator[tuple[str, Any]]:
        """Describe the figures of a stage from its stored parts; yield name and description (`Figure`)
        of each.
        """
        names = self._figure_names(stage)
        if stage.figures is None or not names:
            return
        draw, needs = load(stage.figures.draw), resolved_needs(stage.figures.needs, self.chain.case)
        figures = draw(
            **self.chain.upstream_arguments(stage.figures.upstream), **typed_arguments(draw, needs)
        )
        yield from zip(names, figures, strict=True)

    def _draw_stage(self, stage: Stage, folder: Path) -> Iterator[tuple[str, Path]]:
        """Write the figures of a stage to `folder`, each as svg and as json (interactive); yield name
        and svg path.

        An error is passed over if a stage has failed, as the figure then shows that stage.
        """
        try:
            for name, figure in self._figures(stage):
                path = folder / f"{name}.svg"
                save(figure, path, path.with_suffix(".json"))
                yield name, path
        except FacegearError:
            if not self.failures:  # otherwise they show a stage that is named there
                raise

    def _part(self, stage: str, file: str) -> Any:
        """Return the content of a file of a stage; None where a plain run does not make the stage, or
        it has failed.
        """
        is_there = asked_for(stage, self.chain.case) and stage not in self.failures
        return self.chain.part(stage, file) if is_there else None

    def _view(self) -> Any:
        """Return the interactive view of the pair in mesh; None without a contact analysis."""
        if (loads := self._part("contact", "pressure")) is None:
            return None
        stress, friction = self._part("root_stress", "stress"), self._part("lubrication", "local")
        return shown_pair(self.chain.values, self.chain.part("contact", "ltca"), loads, stress, friction)

    def _bodies(self) -> Any:
        """Return the interactive view of the mode shapes of face gears; None where none bends."""
        if (shapes := self._part("gear_bodies", "shapes")) is None:
            return None
        return body_view(self.chain.part("gear_bodies", "modes"), shapes)


def _is_reported(stage: Stage) -> bool:
    """Whether the report shows a table of a stage, or its figures; NOT_REPORTED are for other programs."""
    return stage.name in REPORT_TABLES or (stage.figures is not None and stage.name not in NOT_REPORTED)
