"""The command line: `facegear new`, `check`, `run`, `report`, `figures`, `limits` and `compare`."""

import argparse
import os
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import MISSING, fields
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NoReturn

import facegear
from facegear.build.cases import expand_cases
from facegear.build.face_limits import FaceNumbers, limits_in_words
from facegear.build.load import load_config, read_layers
from facegear.checking import check_config
from facegear.errors import EXTRAS, ConfigErrors, FacegearError, MissingExtra
from facegear.exchange.rexs_pinions import RexsPinions, known_of_rexs
from facegear.io.atomic import atomic_path, require_writable, require_writable_file
from facegear.new_machine.first_machine import first_machine
from facegear.new_machine.wishes import MachineWishes
from facegear.number_format import count_noun
from facegear.questions import OPTIONS, QUESTIONS, complete_answers, flag, reader
from facegear.schema.yaml_file import read_yaml

ROOT = Path(__file__).parents[1]
"""Folder of the repository, in which the workflow lies if it is at hand."""
INTERRUPTED = 130
"""Exit code of a command that was stopped by Ctrl-C, as shells have it."""
STOPPED = {"new": "; no file was written", "report": "; the same command goes on from here"}
"""Rest of the line of a command that was stopped by Ctrl-C: what the user has or can do."""
CONFIG = "config file (yaml)"
"""Help text of the argument `config`."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; a mistake of the user ends it with one line for each mistake and exit code 1.

    A file or folder that the system refuses ends it in the same way. Ctrl-C ends it with one line and exit
    code INTERRUPTED.

    Parameters
    ----------
    arguments : Sequence[str] or None
        Arguments behind the program's name; those of the process if None.

    Returns
    -------
    int
        Exit code; 0 means success.
    """
    options = parser().parse_args(arguments)
    try:
        return options.command(options)
    except KeyboardInterrupt:
        # The terminal shows ^C behind what stands there, such as a question.
        start = "\n" if sys.stderr.isatty() else ""
        print(f"{start}{options.name}: stopped{STOPPED.get(options.name, '')}", file=sys.stderr)
        return INTERRUPTED
    except FacegearError as error:
        print(error, file=sys.stderr)
    except OSError as error:
        if error.filename is None:
            raise
        print(
            f"{os.fsdecode(error.filename)}: {(error.strerror or 'cannot be used').lower()}", file=sys.stderr
        )
    return 1


class Parser(argparse.ArgumentParser):
    """Parser of the command line that reports a mistake in one line, without the usage of all options."""

    def error(self, message: str) -> NoReturn:
        """End the program with exit code 2 and one line to standard error.

        Parameters
        ----------
        message : str
            The mistake.
        """
        self.exit(
            2, f"{self.prog}: {message.removeprefix('argument ')}; {self.prog} --help lists all options\n"
        )


def parser() -> argparse.ArgumentParser:
    """Build the parser of the command line, with a subcommand for each command.

    Returns
    -------
    Parser
        Parser whose result holds the arguments, the command's name as `name`, and as `command` its
        function, which takes the result and returns an exit code.
    """
    top = Parser("facegear", description="Pinion and face gear transmissions.")
    top.add_argument("--version", action="version", version=f"facegear {installed_version()}")
    commands = top.add_subparsers(required=True, metavar="command", dest="name")
    new = commands.add_parser("new", help="write a config to start from, asking for what is not given")
    new.add_argument("config", type=Path, help="file to write, such as own.yaml")
    for name, (kind, default, text) in QUESTIONS.items():
        new.add_argument(
            flag(name), type=reader(kind), help=text + ("" if default is None else f" ({default})")
        )
    optional_values = new.add_argument_group("values that are chosen unless they are given")
    for name, (kind, text) in OPTIONS.items():
        optional_values.add_argument(flag(name), type=reader(kind), help=text)
    new.add_argument(
        "--from", dest="rexs", type=Path, metavar="REXS", help="REXS file whose equal pinions are taken over"
    )
    new.add_argument(
        "--coarse", action="store_true", help="few positions and speeds, for a first answer soon"
    )
    new.set_defaults(command=_new)
    run = commands.add_parser(
        "run", help="compute all that a config asks for, with Snakemake if it is at hand"
    )
    run.add_argument("config", type=Path, help=CONFIG)
    run.add_argument("targets", nargs="*", help="files to make (all of them)")
    run.add_argument("--cores", default="2", help="processor cores to use (2)")
    run.add_argument("--directory", default=".", help="where results/ and .snakemake/ go")
    run.add_argument("--verbose", action="store_true", help="show all that Snakemake says")
    run.add_argument("--dry-run", "-n", action="store_true", help="only say what would be run, and why")
    run.set_defaults(command=_run)
    report = commands.add_parser("report", help="write the report of a config as one html file")
    report.add_argument("config", type=Path, help=CONFIG)
    report.add_argument("--output", type=Path, help="file to write (<case>.html in this folder)")
    report.add_argument("--results", default="results", help="folder of stored results to read (results)")
    report.set_defaults(command=_report)
    figures = commands.add_parser("figures", help="draw the figures of a config, from stored results")
    figures.add_argument("config", type=Path, help=CONFIG)
    figures.add_argument("names", nargs="*", help="figures to draw, such as mesh_sweep (all of them)")
    figures.add_argument("--png", action="store_true", help="write pictures (png), not drawings (svg)")
    figures.add_argument("--results", default="results", help="folder of stored results to read (results)")
    figures.add_argument("--output", type=Path, help="folder to write to (figures/ of the case's results)")
    figures.set_defaults(command=_figures)
    check = commands.add_parser(
        "check", help="find mistakes, implausible values and what would fail later, in seconds"
    )
    check.add_argument("config", type=Path, help=CONFIG)
    check.set_defaults(command=_check)
    limits = commands.add_parser("limits", help="between which radii the face of a gear may lie")
    for field in fields(FaceNumbers):
        kind = int if "teeth" in field.name else float
        default = None if field.default is MISSING else field.default
        text = "required" if default is None else f"({default:g})"
        limits.add_argument(
            flag(field.name), type=reader(kind), required=default is None, default=default, help=text
        )
    limits.set_defaults(command=_limits)
    compare = commands.add_parser("compare", help="what moved between two folders of results, and why")
    compare.add_argument("old", help="a folder of results, or a stored answer such as current/quick")
    compare.add_argument("new", help="the same")
    compare.add_argument(
        "--page", type=Path, help="write an html page with the curves of both over each other"
    )
    compare.set_defaults(command=_compare)
    return top


def installed_version() -> str:
    """Return the version of the installed package.

    Returns
    -------
    str
        The version, or `unknown: this folder is not installed`.
    """
    try:
        return version("facegear")
    except PackageNotFoundError:
        return "unknown: this folder is not installed"


def _new(options: argparse.Namespace) -> int:
    """Write a config with the answers to QUESTIONS and the given OPTIONS, and print what to expect of
    the machine.

    Values of a REXS file count less than given ones. Refuses an existing file, and writes none if the
    config has mistakes. Returns exit code 0.
    """
    if options.config.exists():
        raise FacegearError(f"{options.config}: exists already; choose another name")
    if options.config.suffix not in (".yaml", ".yml"):
        raise FacegearError(f"{options.config}: must end in .yaml")
    rexs = RexsPinions({}, ()) if options.rexs is None else known_of_rexs(options.rexs)
    read = dict(rexs.values)
    if options.idlers and options.pinions is None and "pinions" in read:
        read["pinions"] = max(read["pinions"] - options.idlers, 0)
    new_values = {name: value for name, value in vars(options).items() if value is not None}
    given_values = {name: new_values[name] for name in OPTIONS if name in new_values}
    wishes = MachineWishes(
        case=options.config.stem,
        coarse=options.coarse,
        **(read | complete_answers({**read, **new_values}) | given_values),
    )
    machine = first_machine(wishes)
    with TemporaryDirectory() as folder:
        draft = Path(folder) / options.config.name
        draft.write_text(machine.text, encoding="utf-8")
        try:
            expand_cases(load_config(draft))
        except ConfigErrors as error:
            raise ConfigErrors("new", list(error.lines)) from None
    _say_if_new(options.config.parent)
    with atomic_path(options.config) as temporary:
        temporary.write_text(machine.text, encoding="utf-8")
    print(*rexs.notes, *machine.expectations, sep="\n")
    print(f"{options.config}: written; `facegear report {options.config}` computes it")
    return 0


def _say_if_new(folder: Path) -> None:
    """Print a line to standard error if a folder does not exist, so that a misspelt name is noticed."""
    if not folder.exists():
        print(f"{folder}: new folder", file=sys.stderr)


def _run(options: argparse.Namespace) -> int:
    """Compute all results of a config and return the exit code.

    The config is read first, so that its mistakes are not met by Snakemake's own reader. Snakemake runs
    the workflow if it is at hand; it is no part of the wheel, so otherwise this process computes the
    same files.
    """
    read_layers(options.config)
    return _with_snakemake(options) if (ROOT / "workflow" / "Snakefile").is_file() else _run_here(options)


def _with_snakemake(options: argparse.Namespace) -> int:
    """Run the workflow in a subprocess of Snakemake with the options of `run` and return its exit code.
    Ctrl-C is left to Snakemake.
    """
    if find_spec("snakemake") is None:
        raise MissingExtra("snakemake", EXTRAS["snakemake"])
    command = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "workflow" / "Snakefile")]
    command += [
        "--cores",
        options.cores,
        "--directory",
        options.directory,
        "--configfile",
        str(options.config),
    ]
    command += ["--verbose"] * options.verbose + ["--dry-run"] * options.dry_run
    folder = Path(options.directory)
    for inside in () if options.dry_run else ("", ".snakemake", "results"):
        require_writable(folder / inside)
    with subprocess.Popen([*command, "--", *options.targets], env=_with_cache(folder.resolve())) as run:
        while True:
            # A terminal sends Ctrl-C to Snakemake, too, which ends its jobs before it ends itself.
            with suppress(KeyboardInterrupt):
                return run.wait()


def _with_cache(folder: Path) -> dict[str, str]:
    """Return this process's environment for Snakemake; if its cache cannot be written in the home
    folder, XDG_CACHE_HOME lies in `folder` (of results).

    Snakemake ends with a traceback where it cannot make its own folder there.
    """
    from platformdirs import user_cache_path  # a library of the extra `workflow`

    try:
        require_writable(user_cache_path("snakemake"))
    except (FacegearError, RuntimeError):
        return {**os.environ, "XDG_CACHE_HOME": str(folder / ".snakemake" / "cache")}
    return dict(os.environ)


def _run_here(options: argparse.Namespace) -> int:
    """Compute the whole case in this process, without Snakemake, into results/<case> of the directory;
    refuse single targets and dry runs. Returns exit code 0.
    """
    if options.targets or options.dry_run:
        hint = "the workflow is not part of an installed package: run this from its repository"
        raise FacegearError(f"run: single files and --dry-run need Snakemake; {hint}")
    gearbox = facegear.load(options.config, None)
    folder = Path(options.directory) / "results" / gearbox.config.case
    print(gearbox.run(folder, _print_stage))
    return 0


def _report(options: argparse.Namespace) -> int:
    """Write the report of a config as one html file (<case>.html unless named), computing what is not
    stored; return exit code 1 if a stage could not be computed.
    """
    gearbox = facegear.load(options.config, options.results)
    path = options.output or Path(f"{gearbox.config.case}.html")
    _say_if_new(path.parent)
    failures: list[str] = []

    def print_stage(stage: str, summary: str) -> None:
        """Print the line of a stage, and add its name to `failures` if it could not be computed."""
        failures.extend([stage] * summary.startswith("not computed: "))
        _print_stage(stage, summary)

    print(gearbox.report(path, print_stage))
    return 1 if failures else 0


def _figures(options: argparse.Namespace) -> int:
    """Draw the named figures, or all, as svg or png into a folder, and print the path of a single one,
    else their number and folder. Returns exit code 0; refuses to overwrite the svg of a run.
    """
    gearbox = facegear.load(options.config, options.results)
    folder, suffix = options.output, ".png" if options.png else ".svg"
    if folder is None:
        folder = (gearbox.store.folder or Path(options.results) / gearbox.config.case) / "figures"
        if not options.png:
            raise FacegearError(f"figures: the svg in {folder} are those of the run: add --png or --output")
    paths = gearbox.figures(folder, options.names, suffix, _print_stage)
    print(paths[0] if len(paths) == 1 else f"{count_noun(len(paths), 'figure')} in {folder}")
    return 0


def _print_stage(stage: str, summary: str) -> None:
    """Print `stage: summary` to standard error when a stage is finished."""
    print(f"{stage}: {summary}", file=sys.stderr, flush=True)


def _check(options: argparse.Namespace) -> int:
    """Print remarks on a config and, to standard error, what would fail later; return exit code 1 in
    that case.
    """
    result = check_config(load_config(options.config), read_yaml(options.config))
    for line in result.remarks:
        print(line)
    if result.failures:
        for line in result.failures:
            print(f"{options.config}: would fail later: {line}", file=sys.stderr)
        return 1
    print(
        f"{options.config}: no mistakes; {count_noun(len(result.cases), 'case')}: {', '.join(result.cases)}"
    )
    return 0


def _limits(options: argparse.Namespace) -> int:
    """Print between which radii the face of a gear may lie, from FaceNumbers; return exit code 0."""
    numbers = {field.name: getattr(options, field.name) for field in fields(FaceNumbers)}
    print(limits_in_words(FaceNumbers(**numbers)))
    return 0


def _compare(options: argparse.Namespace) -> int:
    """Compare two folders of results and print what moved and why; write a page if asked to. Return
    exit code 1 if a value moved beyond its numerical error, a label changed, or something stands in one
    folder only.
    """
    from facegear.report.compare import answers, judge, page  # these draw, and bring matplotlib

    if options.page:
        _say_if_new(options.page.parent)
        require_writable_file(options.page)
    with answers.open_answer(options.old) as old, answers.open_answer(options.new) as new:
        comparison = judge.compare(old, new)
        reasons = page.causes_table(comparison, old, new)
        print(page.verdict(comparison))
        sides = {options.old: old, options.new: new}.items()
        for sentence in filter(None, [page.stored_in_words(name, folder) for name, folder in sides]):
            print(sentence)
        if len(comparison.rows):
            print(page.by_table(comparison).to_string(index=False, na_rep=""))
            for reason in reasons.itertuples(index=False):
                print(f"{reason.cause}  [{reason.table}]")
        if options.page:
            page.write_page(options.page, comparison, reasons, old, new)
    return 0 if comparison.equal else 1


if __name__ == "__main__":
    sys.exit(main())
