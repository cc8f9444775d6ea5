"""Force laws as expressions of heyoka.py, each with the runtime parameters of a contact's state."""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from facegear.arrays import Array
from facegear.meshing.linear import LinearLaw
from facegear.meshing.load_dependent import LoadDependentLaw
from facegear.meshing.power import PowerLaw
from facegear.motion.integrator.system import System

CONTACT_PARAMETER, EDGE_PARAMETER = 0, 1
"""First parameters of a contact: 1 in contact, and the deflection from which its amount counts."""


def series(heyoka: Any, row: Array) -> Any:
    """Return a Fourier row as an expression of the phase.

    Parameters
    ----------
    heyoka : module
        The library.
    row : (2, harmonics + 1) array
        Sine part first, any unit.

    Returns
    -------
    expression
        The series.
    """
    terms = [heyoka.expression(float(row[1, 0]))]
    for j in range(1, row.shape[1]):
        angle = float(j) * heyoka.time
        terms += [float(row[0, j]) * heyoka.sin(angle)] if row[0, j] else []
        terms += [float(row[1, j]) * heyoka.cos(angle)] if row[1, j] else []
    return heyoka.sum(terms)


def rate_of_series(row: Array) -> Array:
    """Return the Fourier row of the derivative by phase.

    Parameters
    ----------
    row : (2, harmonics + 1) array
        Sine part first, any unit.

    Returns
    -------
    (2, harmonics + 1) array
        In the same unit.
    """
    j = np.arange(row.shape[1])
    return np.array([-j * row[1], j * row[0]])


class ForceExpression(Protocol):
    """Elastic forces of contacts over the length scale times the square of the mesh frequency."""

    @property
    def parameters(self) -> int:
        """Number of runtime parameters of each contact."""

    @property
    def levels(self) -> Array:
        """Amounts (contacts, L) beyond the edge at which pieces of the law begin, over the length scale."""

    @property
    def table(self) -> Array | None:
        """Parameters (contacts, 2 L + 1, parameters) of each piece where the state is the piece's number.

        Piece p stands at L + p, back flanks before, the open contact at L. None where the state is the
        parameters.
        """

    def force(self, contact: int, deflection: Any) -> Any:
        """Return the force of a contact as an expression, 0 while it is open.

        Parameters
        ----------
        contact : int
            Number of the contact.
        deflection : expression
            Its deflection, over the length scale.

        Returns
        -------
        expression
            The force.
        """

    def is_touching(self, contact: int) -> Any:
        """Return an expression that is 1 in contact and 0 while a contact is open.

        Parameters
        ----------
        contact : int
            Number of the contact.

        Returns
        -------
        expression
            1 or 0.
        """

    def state(self, contact: int, drive: list[Any], back: list[Any]) -> list[Any]:
        """Return the state of a contact, its parameters or the number of its piece, as expressions.

        Parameters
        ----------
        contact : int
            Number of the contact.
        drive, back : list of expression
            Whether each piece of the law has begun on the drive and on the back flank, 1 or 0.

        Returns
        -------
        list of expression
            The state.
        """


@dataclass(frozen=True, eq=False)
class _LinearForce:
    """k(phase) times the amount. Parameters: 1 in contact, and then the edge."""

    heyoka: Any
    stiffness: Array
    lower: Array
    upper: Array
    parameters: int = 2
    table: None = None

    @property
    def levels(self) -> Array:
        """The edge alone."""
        return np.zeros((len(self.stiffness), 1))

    def force(self, contact: int, deflection: Any) -> Any:
        """Return the stiffness times the amount."""
        amount = deflection - float(self.upper[contact])
        if self.lower[contact] < self.upper[contact]:
            first = self.parameters * contact
            amount = (
                self.heyoka.par[first + CONTACT_PARAMETER] * deflection
                - self.heyoka.par[first + EDGE_PARAMETER]
            )
        return series(self.heyoka, self.stiffness[contact]) * amount

    def is_touching(self, contact: int) -> Any:
        """Return the first parameter."""
        if self.lower[contact] < self.upper[contact]:
            return self.heyoka.par[self.parameters * contact + CONTACT_PARAMETER]
        return self.heyoka.expression(1.0)

    def state(self, contact: int, drive: list[Any], back: list[Any]) -> list[Any]:
        """Return both parameters."""
        edges = [float(self.upper[contact]), float(self.lower[contact])]
        sides = [*drive, *back]
        at = [side * edge for side, edge in zip(sides, edges, strict=False)]
        return [self.heyoka.sum(sides), self.heyoka.sum(at)]


@dataclass(frozen=True, eq=False)
class _CubicForce:
    """Cubic pieces of the amount with coefficients that are series of the phase.

    Parameters: 1 in contact, the deflection at which the piece begins, and all numbers of its series.
    """

    heyoka: Any
    levels: Array
    pieces: Array
    lower: Array
    upper: Array

    @property
    def parameters(self) -> int:
        """Contact, edge, and a coefficient for each power, part and harmonic."""
        return 2 + int(self.pieces[0, 0].size)

    def force(self, contact: int, deflection: Any) -> Any:
        """Return the cubic of the piece that the contact is in."""
        first = self.parameters * contact
        beyond = deflection - self.heyoka.par[first + EDGE_PARAMETER]
        cubic = [self._coefficient(first + 2, power) for power in range(4)]
        return ((cubic[3] * beyond + cubic[2]) * beyond + cubic[1]) * beyond + cubic[0]

    def _coefficient(self, first: int, power: int) -> Any:
        """Coefficient of a power: a series of the phase whose numbers are parameters."""
        hy, harmonics = self.heyoka, self.pieces.shape[-1]
        sine, cosine = first + 2 * harmonics * power, first + 2 * harmonics * power + harmonics
        terms = [hy.par[cosine]]
        for j in range(1, harmonics):
            angle = float(j) * hy.time
            terms += [hy.par[sine + j] * hy.sin(angle), hy.par[cosine + j] * hy.cos(angle)]
        return hy.sum(terms)

    def is_touching(self, contact: int) -> Any:
        """Return the first parameter."""
        return self.heyoka.par[self.parameters * contact + CONTACT_PARAMETER]

    def state(self, contact: int, drive: list[Any], back: list[Any]) -> list[Any]:
        """Return the number of the piece: 0 open, p on the drive flank, -p on the back flank."""
        if self.lower[contact] >= self.upper[contact]:
            return [self.heyoka.expression(1.0)]
        return [self.heyoka.sum([*drive, *(-side for side in back)])]

    @property
    def table(self) -> Array:
        """Parameters of every contact in every piece."""
        contacts, count = self.levels.shape
        table = np.zeros((contacts, 2 * count + 1, self.parameters))
        for piece in range(count):
            begin = self.levels[:, piece]
            for sign, edge in ((1, self.upper + begin), (-1, self.lower - begin)):
                rows = table[:, count + sign * (piece + 1)]
                rows[:, CONTACT_PARAMETER], rows[:, EDGE_PARAMETER] = 1.0, edge
                odd = float(sign) ** np.arange(1, 5)  # the law is odd: its even powers turn on a back flank
                rows[:, 2:] = (self.pieces[:, piece] * odd[:, None, None]).reshape(contacts, -1)
        return table


@dataclass(frozen=True, eq=False)
class _PowerForce:
    """A factor of the phase times x^n, a cubic below the level (`facegear.meshing.power`).

    Parameters: side (1 drive, -1 back, 0 open) and offset of the amount, x = side deflection - offset; 1 in
    the cubic piece, 1 in that of the power.
    """

    heyoka: Any
    factor: Array
    cubic: tuple[float, float]
    exponent: float
    levels: Array
    lower: Array
    upper: Array
    parameters: int = 4
    table: None = None

    def force(self, contact: int, deflection: Any) -> Any:
        """Return the cubic or the power. The base of the power is 1 where it does not count."""
        side, offset, is_cubic, is_power = self._of(contact)
        amount = side * deflection - offset
        square, cube = self.cubic
        shape = is_cubic * amount * amount * (square + cube * amount)
        shape = shape + is_power * (is_power * (amount - 1.0) + 1.0) ** self.exponent
        return side * series(self.heyoka, self.factor) * shape

    def _of(self, contact: int) -> list[Any]:
        return [self.heyoka.par[self.parameters * contact + i] for i in range(self.parameters)]

    def is_touching(self, contact: int) -> Any:
        """Return the sum of the two pieces."""
        *_, is_cubic, is_power = self._of(contact)
        return is_cubic + is_power

    def state(self, contact: int, drive: list[Any], back: list[Any]) -> list[Any]:
        """Return the four parameters."""
        hy, zero = self.heyoka, self.heyoka.expression(0.0)
        on_back, past = back or (zero, zero)
        edges = drive[0] * float(self.upper[contact])
        if back:
            edges = edges - on_back * float(self.lower[contact])
        return [drive[0] - on_back, edges, hy.sum([drive[0], -drive[1], on_back, -past]), drive[1] + past]


def force_of(heyoka: Any, system: System, frequency: float, lower: Array, upper: Array) -> ForceExpression:
    """Return the force of the contacts of a system.

    Parameters
    ----------
    heyoka : module
        The library.
    system : System
        The system.
    frequency : float
        Mesh frequency, rad/s.
    lower, upper : (contacts,) array
        Edges over the length scale, relative.

    Returns
    -------
    ForceExpression
        Forces over the length scale and the square of the frequency, kg.

    Raises
    ------
    ValueError
        For a power law without clearance, whose contacts would pull.
    """
    law, scale = system.law, system.scale
    if isinstance(law, LinearLaw):
        return _LinearForce(heyoka, law.fourier[law.kind] / frequency**2, lower, upper)
    if isinstance(law, LoadDependentLaw):
        powers = scale ** np.arange(-1.0, 3.0)[:, None, None] / frequency**2
        coefficients = np.array([table.coefficients for table in law.tables])[law.kind]
        return _CubicForce(heyoka, law.levels.T / scale, coefficients * powers, lower, upper)
    if not isinstance(law, PowerLaw) or not (lower < upper).all():
        raise ValueError("not set up here: another law, or a power law without clearance")
    size = law.size * scale ** (law.exponent - 1.0) / frequency**2
    n, level = law.exponent, law.level / scale
    cubic = (3.0 - n) * level ** (n - 2.0), (n - 2.0) * level ** (n - 3.0)
    factor = size * np.array([[0.0, 0.0], [1.0, law.depth]])
    return _PowerForce(heyoka, factor, cubic, n, law.levels.T / scale, lower, upper)
