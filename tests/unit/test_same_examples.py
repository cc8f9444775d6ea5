"""Properties draw the same examples in every plain run; only `make random` draws fresh ones."""

from importlib import import_module

from hypothesis import given, settings
from hypothesis import strategies as st

DRAWN = []


@settings(max_examples=60, database=None)
@given(st.integers(0, 10**9))
def draws(number):
    DRAWN.append(number)


def test_properties_draw_the_same_examples_each_time_unless_asked_for_fresh_ones(request):
    fresh = request.config.getoption("--hypothesis-profile") == "random"
    runs = []
    for _ in range(2):
        DRAWN.clear()
        draws()
        runs.append(tuple(DRAWN))
    assert (runs[0] == runs[1]) != fresh


def test_examples_do_not_depend_on_which_modules_were_imported_before(request, tmp_path, monkeypatch):
    """Hypothesis reads the numbers that stand in a project's own modules and tries them, too."""
    fresh = request.config.getoption("--hypothesis-profile") == "random"
    (tmp_path / "imported_later.py").write_text(f"NUMBERS = {list(range(1000, 1400))}")
    monkeypatch.syspath_prepend(tmp_path)
    DRAWN.clear()
    draws()
    before = tuple(DRAWN)
    import_module("imported_later")
    DRAWN.clear()
    draws()
    assert (before == tuple(DRAWN)) != fresh
