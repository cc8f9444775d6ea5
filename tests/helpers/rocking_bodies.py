"""Bodies that rock and turn, written against the interface alone: two tilts added to the lumped model.

With polar inertia P, diametral inertia J, stiffness k and the body's speed W the tilts a, b obey, as one
number z = a + i b, J z'' - i W P z' + k z = moments: they whirl at w^2 -+ (W P / J) w - k / J = 0.
"""

from dataclasses import dataclass, replace

import numpy as np

from facegear.machine.linear_model import LinearModel, Spin

TURN = np.array([[0.0, 1.0], [-1.0, 0.0]])


@dataclass(frozen=True)
class Rocking:
    """Tilts of one body about x and y, kg m2, N m/rad, N m.

    levers (flanks, 2): deflection of each flank by the tilts, m. turning_damping: in the turning body, N m s.
    softening: stiffness lost for the square of the speed, kg m2. leaning: couples x of the body with tilt_y,
    N. ratio: speed of the body over that of the pinions.
    """

    body: str
    inertia: float
    stiffness: float
    polar: float = 0.0
    moments: tuple[float, float] = (0.0, 0.0)
    levers: np.ndarray | None = None
    leaning: float = 0.0
    turning_damping: float = 0.0
    softening: float = 0.0
    ratio: float = 1.0

    def __call__(self, lumped: LinearModel) -> LinearModel:
        n = lumped.size
        stiffness = widened(lumped.stiffness, self.stiffness * np.eye(2))
        x = lumped.labels.index(f"{self.body}:x")
        stiffness[x, n + 1] = stiffness[n + 1, x] = self.leaning
        none = np.zeros((n, n))
        levers = np.zeros((len(lumped.rows), 2)) if self.levers is None else self.levers
        return replace(
            lumped,
            labels=(*lumped.labels, f"{self.body}:tilt_x", f"{self.body}:tilt_y"),
            mass=widened(lumped.mass, self.inertia * np.eye(2)),
            stiffness=stiffness,
            rows=np.hstack([lumped.rows, levers]),
            torques=np.append(lumped.torques, [0.0, 0.0]),
            forces=np.append(lumped.forces, self.moments),
            lengths=np.append(lumped.lengths, [0.1, 0.1]),
            dampers=widened(lumped.dampers, self.turning_damping * np.eye(2)),
            spin=Spin(
                widened(none, self.ratio * self.polar * TURN),
                widened(none, self.ratio * self.turning_damping * TURN),
                widened(none, -(self.ratio**2) * self.softening * np.eye(2)),
            ),
        )


@dataclass(frozen=True, eq=False)
class InOtherCoordinates:
    """Equal bodies in coordinates p, q = transform p, in which masses need not be diagonal."""

    bodies: Rocking
    transform: np.ndarray

    def __call__(self, lumped: LinearModel) -> LinearModel:
        model, t = self.bodies(lumped), self.transform
        return replace(
            model,
            mass=t.T @ model.mass @ t,
            stiffness=t.T @ model.stiffness @ t,
            rows=model.rows @ t,
            torques=t.T @ model.torques,
            forces=t.T @ model.forces,
            dampers=t.T @ model.dampers @ t,
            spin=Spin(*(t.T @ getattr(model.spin, one) @ t for one in Spin.__dataclass_fields__)),
        )


def widened(matrix, corner):
    """A matrix with another behind it on the diagonal."""
    n, more = len(matrix), len(corner)
    wide = np.zeros((n + more, n + more))
    wide[:n, :n], wide[n:, n:] = matrix, corner
    return wide


def whirl(inertia, stiffness, polar, speed):
    """Angular frequencies (2,) of a body that turns at `speed`, rad/s: backward, then forward."""
    half = 0.5 * polar * speed / inertia
    root = np.sqrt(half**2 + stiffness / inertia)
    return np.array([root - half, root + half])
