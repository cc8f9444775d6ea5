"""The table of stages: what each takes, what it writes, when it is made. All else that names them follows.

Its rows stand in `facegear.pipeline.rows`. Columns that a reader asks for are given there by name, so that
reading this table loads nothing that computes.
"""

from facegear.pipeline.rows import branches, dynamics, friction, machine, sharing, strength, teeth, variants

ROWS = (
    *teeth.ROWS,
    *friction.PAIR_ROWS,
    *machine.ROWS,
    *dynamics.ROWS,
    *branches.ROWS,
    *sharing.ROWS,
    *strength.LOAD_ROWS,
    *friction.ROWS,
    *strength.ROWS,
    *variants.ROWS,
)
"""All stages, chapter by chapter; none takes from a later one."""

STAGES = {stage.name: stage for stage in ROWS}
"""By name, in the order in which a case goes through them."""
