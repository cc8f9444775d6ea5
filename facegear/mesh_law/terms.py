"""What compiled statics ask of a law; every law is a NamedTuple type with an implementation of its own."""

from typing import Any

from facegear.machine_code.compiler import by_type


@by_type(nogil=True, fastmath={"contract"})
def held_force(held: Any, k: int, m: int, amount: float) -> tuple[float, float]:
    """Force and slope of contact m at an amount > 0 and phase number k of `MeshLaw.held`."""
