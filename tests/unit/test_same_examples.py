"""Properties draw the same examples in every plain run; only `make random` draws fresh ones."""

from hypothesis import given, settings
from hypothesis import strategies as st

DRAWN = []


@settings(max_examples=5, database=None)
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
