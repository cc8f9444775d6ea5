"""Quantities that are compared between two folders of results, and the numerical error of each.

An error is relative to the largest magnitude of its column in either folder. In tables with one quantity a
row it is relative to the largest magnitude of that quantity. The errors are those of the accuracy table in
README.md and of the page that stands beside each.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeVar

Declaration = TypeVar("Declaration")

MOTION_COLUMNS = ("class", "motion", "class_before", "class_after")
"""Columns that name a class of motion."""
REGULAR = "period"
"""Prefix of the name of a class whose numbers repeat; the numbers of the other classes are statistics."""
OPEN_CLASSES = ("not settled", "undecided")
"""Classes that leave open which irregular motion it is: they contradict none of the others."""
AFTER_IRREGULAR = "after_irregular"
"""Column of rows whose motion, numbers, class and all, rounding can decide."""
SYMMETRY_BROKEN = "symmetry_broken"
"""Column of rows whose motion has mirror images under the machine's symmetries, which are one motion."""


@dataclass(frozen=True)
class Bracket:
    """Columns of rows that lie between two speeds, such as jumps, and are known no closer.

    Attributes
    ----------
    before, after
        Columns of the two speeds.
    error
        Column that says how far the true speed may lie from them, in the unit of the speeds; where a table
        lacks it, it is the distance of the two.
    errors
        Relative numerical error of columns, as in `Table`, where a row's speeds are others in both tables: by
        how much a number changes over the error of the speeds.
    """

    before: str
    after: str
    error: str
    errors: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Table:
    """One csv table.

    Attributes
    ----------
    keys
        Columns that name a row. Without any, rows are compared in the order in which they stand.
    quantity
        Column that says what the column `value` of a row is, for tables with one quantity a row.
    errors
        Numerical error of columns that begin with a text, relative; the longest beginning counts. A column
        without one has no stated error.
    zero
        Magnitudes up to which numbers of a column, or of a quantity, count as zero, for what is left of
        equations that are solved to rounding.
    motion
        Columns, where present, that name the class of motion of a row.
    item
        The key that names a mesh or body; mirror images exchange these.
    bracket
        Speeds that name a row, beside `keys`, up to their error.
    """

    keys: tuple[str, ...] = ()
    quantity: str | None = None
    errors: Mapping[str, float] = field(default_factory=dict)
    zero: Mapping[str, float] = field(default_factory=dict)
    motion: tuple[str, ...] = MOTION_COLUMNS
    item: str | None = None
    bracket: Bracket | None = None

    def error(self, column: str, elsewhere: bool = False) -> float | None:
        """Return the numerical error of a column: that of the longest text in `errors` with which its
        name begins.

        Parameters
        ----------
        column : str
            Name of the column.
        elsewhere : bool
            Whether the row's bracket lies elsewhere in the other table; bracket.errors then go first.

        Returns
        -------
        float or None
            The error, relative to the largest magnitude of the column; None where none is stated.
        """
        errors = {**self.errors, **self.bracket.errors} if elsewhere and self.bracket else self.errors
        fitting = [start for start in errors if column.startswith(start)]
        return errors[max(fitting, key=len)] if fitting else None


ROUNDING_ERROR = 1e-9
"""Linear algebra and convex problems that are solved to rounding."""
CONTACT = {"k_": 3e-3, "ste": 1e-2, "pressure": 1e-2, "path": 1e-4}
"""docs/explanation/contact.md: the default mesh against one that is finer in every direction."""
RESIDUALS = {"kkt_residual": 1e-12, "torque_residual": 1e-10}
"""Relative residuals up to which a contact counts as solved."""
MOTION = {
    "value": 8.6e-4,
    "energy_fraction": 1.8e-3,
    "resonance_rpm": ROUNDING_ERROR,
    "order": ROUNDING_ERROR,
}
"""docs/explanation/dynamics.md: periodic motions against 1e-10 and 4096 samples; energies are squares."""
MOTION_RESIDUAL = {"residual": 1e-7}
"""Change over a period, over the scale, up to which a motion counts as periodic at the nominal speed."""
MULTIPLIERS = 1e-5
"""docs/explanation/dynamics.md: of the nominal motion, whose tolerance is finer than that of a sweep."""
JUMPS = {**MOTION, "deflection": 8.6e-4, "leading_multiplier": 5e-3}
"""docs/explanation/dynamics.md, jumps: at the same speed, against a tolerance of 1e-9."""
OVER_BRACKET = {"deflection": 3e-2, "leading_multiplier": 0.15}
"""docs/explanation/dynamics.md, jumps: change of a motion over the width of a bracket next to its fold."""
FORCES = {"fraction": 6e-4, "mean_n": 6e-4, "largest_n": 2e-3}
"""docs/explanation/load_sharing.md: means and largest values of periodic motions."""
SHARING = {
    "mean": 6e-4,
    "starts": 6e-4,
    "m": 2e-3,
    "cycle": 2e-3,
    "envelope": 2e-3,
    "coefficient": 2e-3,
    "lost": 2e-3,
}
"""docs/explanation/load_sharing.md."""

TABLES: Mapping[str, Table] = {
    "machine/ratings.csv": Table(("quantity",), "quantity", {"value": ROUNDING_ERROR}),
    "machine/bodies.csv": Table(("body",), errors={"": ROUNDING_ERROR}),
    "machine/meshes.csv": Table(("mesh",), errors={"": ROUNDING_ERROR}),
    "modal/frequencies.csv": Table(("order",), errors={"frequency": ROUNDING_ERROR}, motion=()),
    "modal/contacts.csv": Table(("contact",), errors={"force": ROUNDING_ERROR, "stiffness": 3e-3}, motion=()),
    "contact/by_torque.csv": Table(("torque_n_m",), errors=CONTACT),
    "contact/ltca.csv": Table(("torque_n_m", "position"), errors=CONTACT, zero=RESIDUALS),
    "stiffness/harmonics.csv": Table(
        ("order",), errors={"sin_n": 3e-3, "cos_n": 3e-3, "amplitude": 3e-3, "e_": 1e-2}
    ),
    "stiffness/tvms.csv": Table(("position",), errors={"k_": 3e-3}),
    "dynamics/summary.csv": Table(
        ("quantity", "body_or_mesh"), "quantity", MOTION, zero=MOTION_RESIDUAL, item="body_or_mesh"
    ),
    "dynamics/response.csv": Table(
        ("mesh", "mesh_cycle"),
        errors={"deflection": 8.6e-4, "elastic_force": 8.6e-4, "time_s": ROUNDING_ERROR},
    ),
    "dynamics/spectrum.csv": Table(
        ("mesh", "order"), errors={"amplitude": 8.6e-4, "frequency": ROUNDING_ERROR}
    ),
    "dynamics/multipliers.csv": Table(errors={"": MULTIPLIERS}),
    "dynamics/seams.csv": Table(("direction", "speed_rpm")),
    "dynamics/bearings.csv": Table(("body", "direction"), errors={"static": ROUNDING_ERROR, "": 8.6e-4}),
    "dynamics/sweep.csv": Table(
        ("direction", "speed_rpm", "quantity", "body_or_mesh"), "quantity", MOTION, item="body_or_mesh"
    ),
    "dynamics/resonances.csv": Table(
        ("direction", "speed_rpm", "quantity", "body_or_mesh"), "quantity", MOTION, item="body_or_mesh"
    ),
    "dynamics/jumps.csv": Table(
        ("direction",),
        errors=JUMPS,
        bracket=Bracket("speed_before_rpm", "speed_after_rpm", "error_rpm", OVER_BRACKET),
    ),
    "load_sharing/summary.csv": Table(("study", "point", "group"), errors=SHARING),
    "load_sharing/nominal_summary.csv": Table(("group",), errors=SHARING),
    "load_sharing/forces.csv": Table(("mesh",), errors=FORCES),
    "load_sharing/nominal.csv": Table(("group", "cycle_fraction"), errors=SHARING),
    "load_sharing/reference.csv": Table(("quantity", "group"), "quantity", SHARING),
    "load_sharing/speed_range.csv": Table(("group", "speed_rpm"), errors=SHARING),
    "load_sharing/hunting_groups.csv": Table(("group",), errors={"": ROUNDING_ERROR}),
    "load_sharing/hunting_meshes.csv": Table(("mesh",), errors={"": ROUNDING_ERROR}),
    "load_sharing/hunting_cycles.csv": Table(("cycle",), errors={"": ROUNDING_ERROR}),
    "strength/root_stress.csv": Table(("torque_n_m", "body", "fillet"), errors={"largest": 1e-2}),
    "strength/safety.csv": Table(("body", "flank")),
    "strength/rating.csv": Table(("body", "gear", "flank", "failure", "method")),
    "tolerances/percentiles.csv": Table(("quantity", "percentile"), "quantity", {"value": 6e-3}),
}
"""Keys, kind of quantity and numerical errors of each compared table, by its path."""


@dataclass(frozen=True)
class Curve:
    """A table that is drawn: column `y` over column `x`, one line for each combination of values of
    `series`.

    `quantity`: value of column `quantity` of the rows that are drawn, in tables with one quantity a
    row; None draws all rows.
    """

    x: str
    y: str
    series: tuple[str, ...] = ()
    quantity: str | None = None


CURVES: Mapping[str, Curve] = {
    "stiffness/tvms.csv": Curve("position", "k_n_per_m"),
    "contact/by_torque.csv": Curve("torque_n_m", "k_average_mean_n_per_m"),
    "dynamics/response.csv": Curve("mesh_cycle", "deflection_um", ("mesh",)),
    "dynamics/sweep.csv": Curve("speed_rpm", "value", ("direction", "body_or_mesh"), "deflection_ac_rms_um"),
    "load_sharing/nominal.csv": Curve("cycle_fraction", "coefficient", ("group",)),
    "load_sharing/speed_range.csv": Curve("speed_rpm", "mean", ("group",)),
}
"""Columns of the curves that a comparison draws, by the path of their table."""


def declaration_of(declarations: Mapping[str, Declaration], name: str) -> Declaration | None:
    """Return the declaration of the table with a path, or of the table whose path ends in `/` and a
    declared one.

    So tables of a study's point, which lie in a folder inside, share the declaration of the machine's
    table.

    Parameters
    ----------
    declarations : Mapping[str, Declaration]
        Any values by path of the table, such as TABLES or CURVES.
    name : str
        Path of the table inside a folder of results, with `/`.

    Returns
    -------
    Declaration or None
        The first that fits, None where there is none.
    """
    return next(
        (declarations[path] for path in declarations if name == path or name.endswith(f"/{path}")), None
    )
