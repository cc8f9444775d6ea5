"""For all tests: no windows, and the same examples of every property each time.

`make random` looks at fresh ones: pytest -m hypothesis --hypothesis-profile=random.
"""

import os

from hypothesis import settings

os.environ.setdefault("MPLBACKEND", "Agg")
settings.register_profile("fixed", derandomize=True)
settings.register_profile("random", derandomize=False, print_blob=True)
settings.load_profile("fixed")
