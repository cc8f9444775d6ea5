"""Elementary functions of eight numbers at once, to rounding."""

import math
from typing import Any

from facegear.dynamics.abreast.wide import (
    divide,
    exponent,
    mantissa,
    nearest,
    power_of_two,
    splat,
    subtract,
    where_positive,
)
from facegear.machine_code.compiler import FAST, for_callers
from facegear.machine_code.vectors import add, multiply, multiply_add

Wide = Any
"""WIDTH doubles."""
inlined = for_callers(**FAST)
_LOG = tuple(2.0 / (2 * i + 1) for i in range(11, -1, -1))
_EXP = tuple(1.0 / math.factorial(i) for i in range(14, -1, -1))
_SIN = tuple((-1.0) ** i / math.factorial(2 * i + 1) for i in range(9, -1, -1))
_COS = tuple((-1.0) ** i / math.factorial(2 * i) for i in range(9, -1, -1))
_LN2 = math.log(2.0)
_PI = math.pi
SMALLEST = 1e-300


@inlined
def logarithm(value: Wide) -> Wide:
    """Natural logarithm of numbers from SMALLEST on."""
    power, rest = exponent(value), mantissa(value)
    over = subtract(rest, splat(1.4142135623730951))
    power = where_positive(over, add(power, splat(1.0)), power)
    rest = where_positive(over, multiply(rest, splat(0.5)), rest)
    ratio = divide(subtract(rest, splat(1.0)), add(rest, splat(1.0)))
    square = multiply(ratio, ratio)
    total = splat(0.0)
    for term in _LOG:
        total = multiply_add(total, square, splat(term))
    return multiply_add(power, splat(_LN2), multiply(total, ratio))


@inlined
def exponential(value: Wide) -> Wide:
    """e to the power of numbers between -700 and 700."""
    power = nearest(multiply(value, splat(1.0 / _LN2)))
    rest = multiply_add(power, splat(-_LN2), value)
    total = splat(0.0)
    for term in _EXP:
        total = multiply_add(total, rest, splat(term))
    return multiply(total, power_of_two(power))


@inlined
def sine_and_cosine(angle: Wide) -> tuple[Wide, Wide]:
    """Of angles from 0 to 2 pi, rad: by series for a quarter of angle - pi, doubled twice."""
    quarter = multiply(subtract(angle, splat(_PI)), splat(0.25))
    square = multiply(quarter, quarter)
    sine, cosine = splat(0.0), splat(0.0)
    for term in _SIN:
        sine = multiply_add(sine, square, splat(term))
    for term in _COS:
        cosine = multiply_add(cosine, square, splat(term))
    sine = multiply(sine, quarter)
    for _ in range(2):
        sine, cosine = (
            multiply(splat(2.0), multiply(sine, cosine)),
            multiply_add(multiply(splat(-2.0), sine), sine, splat(1.0)),
        )
    return subtract(splat(0.0), sine), subtract(splat(0.0), cosine)
