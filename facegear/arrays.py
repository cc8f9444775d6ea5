"""The array types of all modules, named by their entries. Shapes stand in the docstrings: `(rows, 3)`."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Real numbers."""
ComplexArray = NDArray[np.complex128]
"""Complex numbers: amplitudes and multipliers."""
Integers = NDArray[np.int64]
"""Whole numbers: indices and counts."""
Mask = NDArray[np.bool_]
"""Which entries of another array are meant."""
AnyArray = NDArray[Any]
"""Entries of any kind."""
Arrays = Mapping[str, AnyArray]
"""Arrays by name, as one npz file holds them."""
