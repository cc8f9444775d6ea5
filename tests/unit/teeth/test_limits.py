"""The limits table of the reference page oracles.md, to all digits given."""

import pytest
from references import against, agrees

from facegear.teeth.limits import radius_limits

TABLE = {
    23: (245.149, 245.429, 302.907, 302.994),
    24: (245.264, 245.552, 302.358, 302.449),
    25: (245.380, 245.675, 301.836, 301.930),
    26: (245.497, 245.800, 301.338, 301.436),
}


@against(
    "analytic",
    "undercut and pointing limits of the generated flank, computed twice by independent means",
    capability="geometry",
    module="facegear.teeth.limits",
)
@pytest.mark.parametrize("teeth", TABLE)
def test_undercut_and_pointing_radii_match_the_table(pair, teeth):
    short, long = radius_limits(pair(teeth, 1.0)), radius_limits(pair(teeth, 1.25))
    found = (short.inner, long.inner, long.outer_planar, long.outer)
    names = ("inner, short shaper", "inner", "outer, planar", "outer")
    for name, value, expected in zip(names, found, TABLE[teeth], strict=True):
        agrees(f"limit radius, {name}, mm", 1e3 * value, expected, absolute=5.01e-4)


@pytest.mark.parametrize("teeth", TABLE)
def test_pointing_limit_does_not_depend_on_the_shaper_tip(pair, teeth):
    assert radius_limits(pair(teeth, 1.0)).outer == radius_limits(pair(teeth, 1.25)).outer
