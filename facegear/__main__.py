"""The command line: `python -m facegear run`, `check`, `limits` and `compare`."""

import argparse
import os
import sys
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path

from facegear.config.load import load_config, read_layers
from facegear.errors import EXTRAS, FacegearError, MissingExtra

ROOT = Path(__file__).parents[1]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; a mistake of the user's ends it with one line each and exit code 1."""
    given = _parser().parse_args(arguments)
    try:
        return given.command(given)
    except FacegearError as error:
        print(error, file=sys.stderr)
        return 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser("facegear", description="Spur pinion and face gear transmissions.")
    commands = parser.add_subparsers(required=True)
    run = commands.add_parser("run", help="compute a config, or some of its files, with Snakemake")
    run.add_argument("config", type=Path)
    run.add_argument("targets", nargs="*", help="files to make; all of them without any")
    run.add_argument("--cores", default="2")
    run.add_argument("--directory", default=".", help="where results/ and .snakemake/ go")
    run.add_argument("--verbose", action="store_true", help="show all that Snakemake says")
    run.add_argument("--dry-run", "-n", action="store_true", help="only tell what would be run, and why")
    run.set_defaults(command=_run)
    check = commands.add_parser("check", help="read and check a config, and compute nothing")
    check.add_argument("config", type=Path)
    check.set_defaults(command=_check)
    limits = commands.add_parser("limits", help="between which radii the face of a gear may lie")
    for name, default in LIMITS.items():
        kind = int if "teeth" in name else float
        flag = f"--{name.replace('_', '-')}"
        limits.add_argument(flag, type=kind, required=default is None, default=default)
    limits.set_defaults(command=_limits)
    compare = commands.add_parser("compare", help="what moved between two folders of results, and why")
    compare.add_argument("old", help="a folder of results, or a release's stored answer such as 0.1.0/quick")
    compare.add_argument("new", help="the same")
    compare.add_argument("--page", type=Path, help="write a report page with both laid over each other")
    compare.set_defaults(command=_compare)
    return parser


LIMITS = {
    **dict.fromkeys(("pinion_teeth", "face_gear_teeth", "module_mm")),
    "pressure_angle_deg": 25.0,
    "shaper_teeth": 0,
    "pinion_addendum_modules": 1.0,
    "pinion_dedendum_modules": 1.25,
    "profile_shift_modules": 0.0,
    "gear_addendum_modules": 1.0,
    "shaper_addendum_modules": 1.25,
    "shaper_tip_rounding_modules": 0.0,
}
"""Arguments of `limits` and their defaults, if any. A shaper of 0 teeth has three more than the pinion."""


def _run(given: argparse.Namespace) -> int:
    """Hand over to Snakemake, whose own reader of configs is not met by a file that cannot be read."""
    read_layers(given.config)
    if find_spec("snakemake") is None:
        raise MissingExtra("snakemake", EXTRAS["snakemake"])
    if not (ROOT / "Snakefile").is_file():
        raise FacegearError("the workflow is not part of an installed package: run this from its repository")
    command = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile")]
    command += ["--cores", given.cores, "--directory", given.directory, "--configfile", str(given.config)]
    command += ["--verbose"] * given.verbose + ["--dry-run"] * given.dry_run
    os.execv(sys.executable, [*command, "--", *given.targets])


def _check(given: argparse.Namespace) -> int:
    from facegear.config.cases import expand_cases

    cases = expand_cases(load_config(given.config))
    print(f"{given.config}: no mistakes; {len(cases)} case{'s' * (len(cases) > 1)}: {', '.join(cases)}")
    return 0


def _limits(given: argparse.Namespace) -> int:
    from facegear.config.limits import limits_in_words

    print(limits_in_words(**{name: getattr(given, name) for name in LIMITS}))
    return 0


def _compare(given: argparse.Namespace) -> int:
    """Exit code 0 where nothing moved beyond its numerical error and no label changed, else 1."""
    from facegear.compare.answers import opened
    from facegear.compare.judge import compare
    from facegear.compare.page import by_table, causes_table, verdict, write_page

    with opened(given.old) as old, opened(given.new) as new:
        comparison = compare(old, new)
        reasons = causes_table(comparison, old, new)
        print(verdict(comparison))
        if len(comparison.rows):
            print(by_table(comparison).to_string(index=False, na_rep=""))
            for reason in reasons.itertuples(index=False):
                print(f"{reason.cause}  [{reason.table}]")
        if given.page:
            write_page(given.page, comparison, reasons, old, new)
    return 0 if comparison.equal else 1


if __name__ == "__main__":
    sys.exit(main())
