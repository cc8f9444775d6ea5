"""Criteria of the scorecard: what each accepts, and what passed by accident once."""

import numpy as np
import pandas as pd
import pytest

from facegear.motion.steady_state.statistics import spectrum
from paper.scorecard.criteria import CRITERIA

SPEEDS = np.linspace(1000.0, 2000.0, 101)


def bump(at, width=30.0):
    return 1.0 + 4.0 * np.exp(-(((SPEEDS - at) / width) ** 2))


def sweep(up, down, quantity="deflection_ac_rms_um", part="right input/lower", labels="period-1"):
    return pd.concat(
        pd.DataFrame(
            {
                "direction": direction,
                "speed_rpm": SPEEDS,
                "quantity": quantity,
                "body_or_mesh": part,
                "value": values,
                "class": labels,
            }
        )
        for direction, values in (("up", up), ("down", down))
    )


def leaning(lean):
    """A resonance near 1500 rpm that the sweeps leave at different speeds."""
    late, early = bump(1540.0), bump(1460.0)
    lower = np.ones_like(SPEEDS)
    inside = (SPEEDS > 1450) & (SPEEDS < 1550)
    high = np.where(inside, 5.0, lower)
    return sweep(high, lower) if lean == "hardening" else sweep(lower, high), late, early


@pytest.mark.parametrize("lean", ["hardening", "softening"])
def test_lean_is_read_from_which_sweep_stays_high(lean):
    tables = {"sweep": leaning(lean)[0]}
    for asked in ("hardening", "softening"):
        found = CRITERIA["jump_leans"](tables, near=1500.0, within=0.06, lean=asked)
        assert found.holds is (asked == lean)


def test_no_lean_where_both_sweeps_agree():
    tables = {"sweep": sweep(bump(1500.0), bump(1500.0))}
    assert not CRITERIA["jump_leans"](tables, near=1500.0, within=0.06, lean="hardening").holds


def test_peak_speed_is_that_of_the_nearest_local_maximum():
    level = bump(1200.0) + 2 * bump(1700.0)
    tables = {"sweep": sweep(level, level, "x_ac_rms_um", "tail idler")}
    found = CRITERIA["peak_speed"](tables, parts=["tail idler"], near=1300.0)
    assert found.value == pytest.approx(1200.0)
    assert CRITERIA["dominant_peak"](tables, parts=["tail idler"], near=1700.0, within=0.06).holds
    assert CRITERIA["not_dominant_peak"](tables, parts=["tail idler"], near=1200.0, within=0.06).holds


def test_flat_level_has_no_peak():
    level = np.linspace(1.0, 2.0, SPEEDS.size)
    tables = {"sweep": sweep(level, level, "x_ac_rms_um", "tail idler")}
    assert CRITERIA["peak_speed"](tables, parts=["tail idler"], near=1300.0).value is None


def jumps(*rows):
    """Jumps as (speed, RMS before, RMS after, class before, class after) in a sweep of 1000 to 2000 rpm."""
    names = ("deflection_ac_rms_before_um", "deflection_ac_rms_after_um", "class_before", "class_after")
    frame = pd.DataFrame(
        [(speed - 1.0, speed + 1.0, *rest) for speed, *rest in rows],
        columns=["speed_before_rpm", "speed_after_rpm", *names],
    )
    return {"jumps": frame, "sweep": pd.DataFrame({"speed_rpm": SPEEDS})}


REGULAR = ("period-1", "period-1")


def test_nearest_jump_counts_in_either_direction():
    tables = jumps((1001.0, 1.0, 2.0, *REGULAR), (1800.0, 2.0, 1.0, *REGULAR))
    assert CRITERIA["jump_speed"](tables, near=1700.0).value == pytest.approx(1800.0)
    assert CRITERIA["jump_speed"](jumps(), near=1700.0).value is None


def test_ripples_and_steps_between_irregular_motions_are_no_jumps():
    tables = jumps((1700.0, 1.0, 1.2, *REGULAR), (1710.0, 1.0, 3.0, "chaotic", "not settled"))
    assert CRITERIA["jump_speed"](tables, near=1700.0).value is None
    found = CRITERIA["jump_speed"](jumps((1710.0, 1.0, 3.0, "chaotic", "period-2")), near=1700.0)
    assert found.value == pytest.approx(1710.0)


def test_chance_of_a_nearest_number_is_the_covered_share_of_the_sweep():
    tables = jumps((1010.0, 1.0, 2.0, *REGULAR), (1500.0, 1.0, 2.0, *REGULAR), (1520.0, 1.0, 2.0, *REGULAR))
    found = CRITERIA["jump_speed"](tables, near=1700.0)
    assert found.chance(50.0) == pytest.approx((60.0 + 120.0) / 1000.0)
    assert CRITERIA["jump_speed"](jumps(), near=1700.0).chance(50.0) == 0.0


def test_peaks_of_an_irregular_motion_do_not_count():
    level = bump(1200.0) + 2 * bump(1700.0)
    noisy = np.where(SPEEDS > 1500.0, "chaotic", "period-1")
    tables = {"sweep": sweep(level, level, "x_ac_rms_um", "tail idler", noisy)}
    assert CRITERIA["peak_speed"](tables, parts=["tail idler"], near=1700.0).value == pytest.approx(1200.0)


def test_ripple_is_no_peak():
    level = 10.0 * bump(1700.0) + 0.5 * bump(1200.0)
    tables = {"sweep": sweep(level, level, "x_ac_rms_um", "tail idler")}
    assert CRITERIA["peak_speed"](tables, parts=["tail idler"], near=1200.0).value == pytest.approx(1700.0)


def test_end_of_the_sweep_is_no_dominant_peak():
    level = np.linspace(1.0, 2.0, SPEEDS.size)
    tables = {"sweep": sweep(level, level, "x_ac_rms_um", "tail idler")}
    assert not CRITERIA["dominant_peak"](tables, parts=["tail idler"], near=2000.0, within=0.06).holds


def wave(harmonics):
    cycles = np.arange(128) / 64
    return sum(a * np.cos(2 * np.pi * (order * cycles - lag)) for order, a, lag in harmonics)


def response(**meshes):
    return pd.concat(
        pd.DataFrame({"mesh": f"{name}/{side}", "deflection_um": values})
        for name, sides in meshes.items()
        for side, values in zip(("lower", "upper"), sides, strict=True)
    )


def test_synchronous_pinions_move_together_and_others_do_not():
    a, lag = wave([(1, 1, 0)]), wave([(1, 1, 0.25)])
    tables = {"response": response(a=(a, a), b=(2 * a + 1, a), c=(a, lag))}
    assert CRITERIA["synchronous"](tables, a="a", b="b", lower=0.95).holds
    assert not CRITERIA["synchronous"](tables, a="a", b="c", lower=0.95).holds
    assert CRITERIA["not_synchronous"](tables, a="c", b=["a", "b"], upper=0.9).holds
    assert not CRITERIA["not_synchronous"](tables, a="a", b=["b", "c"], upper=0.9).holds


def test_spectral_statements_follow_the_lines():
    rows = [
        *(("a/lower", 0.5, 1.0), ("a/lower", 1.0, 9.0), ("a/lower", 2.0, 5.0)),
        *(("a/upper", 0.5, 3.0), ("a/upper", 1.0, 9.0), ("a/upper", 2.0, 5.0)),
    ]
    tables = {"spectrum": pd.DataFrame(rows, columns=["mesh", "order", "amplitude_um"])}
    assert CRITERIA["dominant_lines"](tables, pinion="a", lines=[1.0, 2.0]).holds
    assert not CRITERIA["dominant_lines"](tables, pinion="a", lines=[1.0, 0.5]).holds
    assert CRITERIA["line_larger"](tables, pinion="a", line=0.5, fraction=0.05).holds
    assert not CRITERIA["line_larger"](tables, pinion="a", line=1.0, fraction=0.05).holds
    assert not CRITERIA["line_larger"](tables, pinion="a", line=0.5, fraction=0.3).holds
    assert CRITERIA["subharmonic_content"](tables, pinion="a", fraction=0.1).holds
    assert not CRITERIA["subharmonic_content"](tables, pinion="a", fraction=0.2).holds


def test_noise_is_no_larger_line():
    rows = [("a/lower", 0.5, 1e-9), ("a/lower", 1.0, 9.0), ("a/upper", 0.5, 2e-9), ("a/upper", 1.0, 9.0)]
    tables = {"spectrum": pd.DataFrame(rows, columns=["mesh", "order", "amplitude_um"])}
    assert not CRITERIA["line_larger"](tables, pinion="a", line=0.5, fraction=0.05).holds


def test_window_beside_1x_and_the_mean_is_no_subharmonic_content():
    per_period, periods = 16, 256
    cycles = np.arange(per_period * periods) / per_period
    rng = np.random.default_rng(1)

    def spectra(samples):
        orders, lines = spectrum(samples[:, None], per_period, periodic=False)
        return pd.concat(
            pd.DataFrame({"mesh": f"a/{side}", "order": orders, "amplitude_um": lines[:, 0]})
            for side in ("lower", "upper")
        )

    plain = 5.0 + np.cos(2 * np.pi * cycles) + 1e-3 * rng.standard_normal(cycles.size)
    for samples, expected in ((plain, False), (plain + 0.3 * np.cos(np.pi * cycles), True)):
        tables = {"spectrum": spectra(samples)}
        assert CRITERIA["subharmonic_content"](tables, pinion="a", fraction=0.05).holds is expected


def curves(**points):
    return pd.concat(
        pd.DataFrame(
            {
                "study": "s",
                "point": point,
                "kind": "idlers",
                "group": "idlers",
                "cycle_fraction": np.arange(100) / 100,
                "coefficient": values,
                "lost_fraction": (np.asarray(values) >= 3.0).astype(float),
            }
        )
        for point, values in points.items()
    )


def test_flat_region_and_steepness_are_read_from_the_curves():
    x = np.arange(100) / 100
    smooth = 2.0 + 0.9 * np.sin(2 * np.pi * x)
    flat = np.where(x < 0.4, 1.5, smooth)
    tables = {
        "curves": curves(smooth=smooth, flat=flat, steep=2.0 + 0.9 * np.sin(6 * np.pi * x)),
        "sharing": pd.DataFrame({"study": "s", "point": ["smooth", "flat", "steep"], "kind": "idlers"}),
    }
    asked = {"study": "s", "kind": "idlers"}
    assert CRITERIA["flat_region"](tables, point="flat", **asked).holds
    assert not CRITERIA["flat_region"](tables, point="steep", **asked).holds
    assert CRITERIA["steeper"](tables, point="steep", **asked).holds
    assert not CRITERIA["steeper"](tables, point="smooth", **asked).holds


def test_lost_regions_move_only_if_the_instants_differ():
    first = np.where(np.arange(100) < 20, 3.0, 1.0)
    same = {"curves": curves(a=first, b=first)}
    moved = {"curves": curves(a=first, b=np.roll(first, 40))}
    asked = {"study": "s", "kind": "idlers", "by": 0.05}
    assert not CRITERIA["lost_regions_move"](same, **asked).holds
    assert CRITERIA["lost_regions_move"](moved, **asked).holds
    assert CRITERIA["one_carrier_occurs"](same, study="s").holds


def test_one_carrier_is_asked_of_some_curve_of_each_kind():
    reached, never = np.full(100, 3.0), np.full(100, 1.2)
    idlers = curves(a=never, b=reached)
    inputs = curves(a=never, b=never).assign(kind="inputs", group="inputs")
    assert CRITERIA["one_carrier_occurs"]({"curves": idlers}, study="s").holds
    assert not CRITERIA["one_carrier_occurs"]({"curves": pd.concat([idlers, inputs])}, study="s").holds


def test_plateau_at_the_bound_is_not_stable_sharing():
    x = np.arange(100) / 100
    tables = {"curves": curves(bound=np.where(x < 0.4, 3.0, 2.0 + 0.9 * np.sin(6 * np.pi * x)))}
    assert not CRITERIA["flat_region"](tables, study="s", point="bound", kind="idlers").holds


def test_undefined_instants_win_no_comparison():
    x = np.arange(100) / 100
    steep, gap = 2.0 + 0.9 * np.sin(6 * np.pi * x), 2.0 + 0.1 * np.sin(2 * np.pi * x)
    gap[:20] = np.nan
    half = np.where(x < 0.6, np.nan, steep)
    points = {"steep": steep, "gap": gap, "half": half}
    tables = {
        "curves": curves(**points),
        "sharing": pd.DataFrame(
            {"study": "s", "point": list(points), "kind": "idlers", "mean": [1.8, np.nan, 1.9]}
        ),
    }
    asked = {"study": "s", "kind": "idlers"}
    assert CRITERIA["steeper"](tables, point="steep", **asked).holds
    assert not CRITERIA["steeper"](tables, point="gap", **asked).holds
    assert not CRITERIA["steeper"](tables, point="half", **asked).holds
    assert not CRITERIA["flat_region"](tables, point="half", **asked).holds
    assert CRITERIA["minimum_at"](tables, point="steep", **asked).holds
    assert not CRITERIA["minimum_at"](tables, point="gap", **asked).holds


def test_there_is_no_minimum_where_nothing_is_defined():
    tables = sharing(a=np.nan, b=np.nan)
    assert not CRITERIA["minimum_at"](tables, study="s", kind="idlers", point="a").holds
    assert not CRITERIA["differ"](tables, study="s", kind="idlers", column="mean", by=0.1).holds


def test_mean_of_a_curve_that_is_half_undefined_is_no_number():
    tables = sharing(undefined=0.6, a=1.6)
    assert CRITERIA["sharing"](tables, study="s", point="a", kind="idlers").value is None


def sharing(undefined=0.0, **means):
    return {
        "sharing": pd.DataFrame(
            {
                "study": "s",
                "point": list(means),
                "kind": "idlers",
                "mean": list(means.values()),
                "undefined_fraction": undefined,
            }
        )
    }


def test_orders_and_extremes_of_a_study_follow_its_means():
    tables = sharing(soft=1.6, mid=1.9, stiff=1.8)
    asked = {"study": "s", "kind": "idlers"}
    assert CRITERIA["minimum_at"](tables, point="soft", **asked).holds
    assert not CRITERIA["minimum_at"](tables, point="mid", **asked).holds
    assert CRITERIA["orders"](tables, points=["soft", "stiff", "mid"], **asked).holds
    assert not CRITERIA["orders"](tables, points=["soft", "mid", "stiff"], **asked).holds
    assert CRITERIA["differ"](tables, column="mean", by=0.1, **asked).holds
    assert not CRITERIA["differ"](tables, column="mean", by=0.4, **asked).holds


def test_points_named_by_numbers_are_found():
    tables = sharing(**{"80": 1.7})
    ends = dict.fromkeys(("cycle_low", "cycle_high", "starts_low", "starts_high"), 1.7)
    tables["sharing"] = tables["sharing"].assign(**ends)
    assert CRITERIA["sharing"](tables, study="s", point=80.0, kind="idlers").value == 1.7


def test_mean_spans_single_cycles_and_starts():
    ends = {"cycle_low": 1.6, "cycle_high": 1.8, "starts_low": 1.5, "starts_high": np.nan}
    tables = sharing(**{"80": 1.7})
    tables["sharing"] = tables["sharing"].assign(**ends)
    found = CRITERIA["sharing"](tables, study="s", point=80.0, kind="idlers")
    assert found.windows == (1.5, 1.8)
