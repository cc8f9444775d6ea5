"""Run oscillators with backlash by the closed form of each stretch between two contact switches.

x'' + 2 z x' + k (x - side) = Fm + F cos(W t), with k = 1 in contact and k = 0 in the gap. The code shares
nothing with the integrator of facegear. All oscillators advance together in NumPy arrays, each from switch to
switch at its own time. The state is checked for a switch PARTS times a period, and the switch is located by
Newton's method within a bracket.

Notation: `time` counts from the begin of a part of the period, `p`, `q` and `r` are the constants of the
solution p + q f(time) + r g(time) + forced motion. In contact f and g are the decaying cosine and sine, in
the gap they are time and (1 - exp(-2 z time)) / (2 z).
"""

from dataclasses import dataclass, fields

import numpy as np

from facegear.arrays import Array, Integers, Mask

PARTS = 64
"""Checks for a contact switch in each period."""
WINDOW = 32
"""Parts that one step evaluates, a free choice that changes the cost alone."""
LONGEST = 512
"""Longest motion, in periods, that counts as periodic."""
REPEAT_DISTANCE = 1e-11
"""Distance between two states that repeat each other; motions of the suite are of the size of 1."""
CLOSE = 1e-9
"""Relative step after which the root search ends. Newton's method leaves about its square."""
ITERATIONS = 60
"""Largest number of steps of the root search, enough for bisection alone."""


@dataclass(eq=False)
class Oscillators:
    """Damping ratio, mean force, force amplitude and speed of oscillators, each (n,)."""

    damping: Array
    mean: Array
    force: Array
    speed: Array


@dataclass(eq=False)
class _Lanes:
    """Oscillators (n,) with their state, at `time` after the begin of a part of their period."""

    number: Integers
    damping: Array
    mean: Array
    speed: Array
    cosine: Array
    sine: Array
    tables: Array
    x: Array
    v: Array
    time: Array
    part: Integers
    period: Integers

    def select(self, rows: Integers) -> "_Lanes":
        """Return the oscillators that `rows` selects."""
        return _Lanes(*(getattr(self, entry.name)[rows] for entry in fields(self)))


def run_closed_form(oscillators: Oscillators, starts: Array, periods: int, window: int) -> Array:
    """Return the states at the ends of the last periods.

    A run ends early where its state has repeated itself for LONGEST periods to within REPEAT_DISTANCE. Its
    last states then are those of the periods before that.

    Parameters
    ----------
    oscillators : Oscillators
        Equations of n oscillators, dimensionless.
    starts : Array
        Displacement and velocity (n, 2) at phase 0, dimensionless.
    periods : int
        Length of the run, in periods of the load.
    window : int
        Largest number of periods whose states are returned, more than twice LONGEST.

    Returns
    -------
    Array
        Displacement and velocity (n, min(periods, window), 2), dimensionless.
    """
    lanes = _make_lanes(oscillators, starts)
    states = np.empty((len(starts), min(periods, window), 2))
    while len(lanes.x):
        end_rows = _advance(lanes)
        if not len(end_rows):
            continue
        at_end = lanes.period[end_rows]
        states[lanes.number[end_rows], (at_end - 1) % window] = np.stack(
            [lanes.x[end_rows], lanes.v[end_rows]], axis=1
        )
        is_done = at_end == periods
        for row in np.flatnonzero((at_end % window == 0) & ~is_done):
            is_done[row] = _repeats(states[lanes.number[end_rows[row]]])
        if is_done.any():
            for row in end_rows[is_done]:
                shift = lanes.period[row] % window if lanes.period[row] > window else 0
                states[lanes.number[row]] = np.roll(states[lanes.number[row]], -shift, axis=0)
            lanes = lanes.select(np.setdiff1d(np.arange(len(lanes.x)), end_rows[is_done]))
    return states


def _repeats(states: Array) -> bool:
    """Say whether the states (periods, 2) repeat after at most LONGEST periods."""
    distance = np.abs(states[-1 - LONGEST : -1] - states[-1]).max(axis=1)[::-1]
    period = int(np.argmax(distance <= REPEAT_DISTANCE)) + 1
    return bool(np.abs(states[-LONGEST:] - states[-LONGEST - period : -period]).max() <= REPEAT_DISTANCE)


def _make_lanes(oscillators: Oscillators, starts: Array) -> _Lanes:
    damping, mean, force, speed = (getattr(oscillators, entry.name) for entry in fields(oscillators))
    gap = np.array([0.0, 1.0]) - speed[:, None] ** 2
    lag = (2.0 * damping * speed)[:, None]
    size = force[:, None] / (gap**2 + lag**2)
    cosine, sine = size * gap, size * lag
    phase = 2.0 * np.pi / PARTS * np.arange(PARTS + WINDOW + 1)
    forced = cosine[:, :, None] * np.cos(phase) + sine[:, :, None] * np.sin(phase)
    time = 2.0 * np.pi / speed[:, None] / PARTS * np.arange(PARTS + WINDOW + 1)
    free = [np.stack(_free(damping[:, None], time, np.full(time.shape, k == 1))[:2], axis=1) for k in (0, 1)]
    tables = np.concatenate([np.stack(free, axis=1), forced[:, :, None]], axis=2)
    zero = np.zeros(len(starts), dtype=np.int64)
    return _Lanes(
        number=np.arange(len(starts)),
        damping=damping,
        mean=mean,
        speed=speed,
        cosine=cosine,
        sine=sine,
        tables=tables,
        x=starts[:, 0].copy(),
        v=starts[:, 1].copy(),
        time=np.zeros(len(starts)),
        part=zero,
        period=zero.copy(),
    )


def _free(damping: Array, time: Array, contact: Mask) -> tuple[Array, Array, Array, Array]:
    """Return f and g at each time, and their rates."""
    natural = np.sqrt(1.0 - damping**2)
    decay = np.exp(-damping * time)
    f, g = decay * np.cos(natural * time), decay * np.sin(natural * time)
    fade = decay**2
    return (
        np.where(contact, f, time),
        np.where(contact, g, (1.0 - fade) / (2.0 * damping)),
        np.where(contact, -damping * f - natural * g, 1.0),
        np.where(contact, natural * f - damping * g, fade),
    )


@dataclass(eq=False)
class _Stretches:
    """Solutions of lanes (n,) from one switch to the next."""

    damping: Array
    speed: Array
    contact: Mask
    side: Array
    cosine: Array
    sine: Array
    begin: Array
    p: Array
    q: Array
    r: Array

    def select(self, rows: Integers) -> "_Stretches":
        """Return the stretches that `rows` selects."""
        return _Stretches(*(getattr(self, entry.name)[rows] for entry in fields(self)))

    def forced(self, time: Array) -> tuple[Array, Array]:
        """Return the forced motion and its rate at each time."""
        phase = self.begin + self.speed * time
        c, s = np.cos(phase), np.sin(phase)
        return self.cosine * c + self.sine * s, self.speed * (self.sine * c - self.cosine * s)

    def state(self, time: Array) -> tuple[Array, Array]:
        """Return displacement and velocity at each time."""
        forced, forced_rate = self.forced(time)
        f, g, f_rate, g_rate = _free(self.damping, time, self.contact)
        return self.p + self.q * f + self.r * g + forced, self.q * f_rate + self.r * g_rate + forced_rate

    def margin(self, x: Array) -> Array:
        """Return the distance to the next switch, negative behind it."""
        if x.ndim == 1:
            return np.where(self.contact, self.side * x - 1.0, 1.0 - np.abs(x))
        return np.where(self.contact[:, None], self.side[:, None] * x - 1.0, 1.0 - np.abs(x))


def _stretches(lanes: _Lanes) -> _Stretches:
    """Fit the solution to the state of each lane."""
    x, v, time, damping = lanes.x, lanes.v, lanes.time, lanes.damping
    side = np.where((x > 1.0) | ((x == 1.0) & (v > 0.0)), 1.0, 0.0)
    side[(x < -1.0) | ((x == -1.0) & (v < 0.0))] = -1.0
    contact = side != 0.0
    rows, kind = np.arange(len(x)), contact.astype(np.int64)
    begin = (2.0 * np.pi / PARTS * lanes.part).astype(np.float64)
    cosine, sine = lanes.cosine[rows, kind], lanes.sine[rows, kind]
    zero = np.zeros(len(x))
    stretches = _Stretches(damping, lanes.speed, contact, side, cosine, sine, begin, zero, zero, zero)
    forced, forced_rate = stretches.forced(time)
    f, g, _, g_rate = _free(damping, time, contact)
    rest, drift = side + lanes.mean, lanes.mean / (2.0 * damping)
    a = x - forced - rest
    b = (v - forced_rate + damping * a) / np.sqrt(1.0 - damping**2)
    size = np.where(contact, f**2 + g**2, 1.0)
    gap_r = (v - forced_rate - drift) / np.where(contact, 1.0, g_rate)
    stretches.q = np.where(contact, (a * f - b * g) / size, drift)
    stretches.r = np.where(contact, (a * g + b * f) / size, gap_r)
    stretches.p = np.where(contact, rest, x - forced - drift * time - gap_r * g)
    return stretches


def _advance(lanes: _Lanes) -> Integers:
    """Move each lane to its next switch or WINDOW parts on; return the lanes whose period ended."""
    stretches = _stretches(lanes)
    rows, kind = np.arange(len(lanes.x)), stretches.contact.astype(np.int64)
    parts = np.arange(1, WINDOW + 1)
    f, g = (lanes.tables[rows, kind, of, 1 : WINDOW + 1] for of in (0, 1))
    forced = lanes.tables[rows[:, None], kind[:, None], 2, lanes.part[:, None] + parts]
    x = stretches.p[:, None] + stretches.q[:, None] * f + stretches.r[:, None] * g + forced
    outside = stretches.margin(x) < 0.0
    ahead = np.minimum(WINDOW, PARTS - lanes.part)
    first = np.argmax(outside, axis=1)
    switches = outside[rows, first] & (first < ahead)
    length = 2.0 * np.pi / lanes.speed / PARTS

    onward_rows = np.flatnonzero(~switches)
    onward = stretches.select(onward_rows)
    lanes.x[onward_rows], lanes.v[onward_rows] = onward.state(length[onward_rows] * ahead[onward_rows])
    lanes.time[onward_rows] = 0.0
    lanes.part[onward_rows] += ahead[onward_rows]

    hit = np.flatnonzero(switches)
    if len(hit):
        of_hit, before, step = stretches.select(hit), first[hit], length[hit]
        time = _locate(of_hit, np.maximum(lanes.time[hit], before * step), (before + 1) * step)
        edge, lanes.v[hit] = of_hit.state(time)
        lanes.x[hit] = np.where(edge > 0.0, 1.0, -1.0)
        over = time >= (before + 1) * step
        lanes.part[hit] += before + over
        lanes.time[hit] = np.where(over, 0.0, np.maximum(time - before * step, 0.0))

    end_rows = np.flatnonzero(lanes.part == PARTS)
    lanes.part[end_rows] = 0
    lanes.period[end_rows] += 1
    return end_rows


def _locate(stretches: _Stretches, low: Array, high: Array) -> Array:
    """Return the time of the switch between `low` and `high` by Newton's method, else by bisection."""
    time = scale = high
    is_found = np.zeros(len(high), dtype=bool)
    for _ in range(ITERATIONS):
        x, v = stretches.state(time)
        margin = stretches.margin(x)
        inside = margin >= 0.0
        low, high = np.where(inside, time, low), np.where(inside, high, time)
        rate = v * np.where(stretches.contact, stretches.side, -np.sign(x))
        with np.errstate(divide="ignore", invalid="ignore"):
            trial = time - margin / rate
        close = np.abs(trial - time) <= CLOSE * scale
        next_time = np.where((trial > low) & (trial < high), trial, 0.5 * (low + high))
        # Newton's method squares the error, so that the step after such a one would be below rounding.
        next_time[close] = np.clip(trial, low, high)[close]
        time = np.where(is_found, time, next_time)
        is_found |= close
        if is_found.all():
            break
    return time
