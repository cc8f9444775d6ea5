import numpy as np

from facegear.harmonics.series import Harmonics
from facegear.harmonics.stored import from_table, to_table


def test_series_survives_its_table():
    series = Harmonics(np.array([0.0, 2.0, -1.0]), np.array([10.0, 0.5, 3.0]))
    again = from_table(to_table(series))
    np.testing.assert_array_equal(again.a, series.a)
    np.testing.assert_array_equal(again.b, series.b)


def test_missing_orders_are_zero():
    series = Harmonics(np.array([0.0, 0.0, 1.0]), np.array([5.0, 0.0, 2.0]))
    again = from_table(to_table(series).query("order != 1"))
    np.testing.assert_array_equal(again.amplitudes, series.amplitudes)
