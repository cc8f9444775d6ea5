"""Section of a wheel from its hub, web and rim, the size of its mesh, and the patch that a mesh presses
on.

Area on which a mesh presses on the body of a face gear. A flank force turned into force and moment on height
0, spread along the ring as a raised cosine and evenly across the face, moves the pitch point in order n by
W_p = c_n <W> axially, by V_p = c_n (<V> + n h <W / r>) round the axis and by U_p = c_n (<U> - h slope) along
the radius, with c_n the transform of the patch, h the height of the pitch plane and the slope that of the
line which fits W best across the face. The second parts are the moments of the tangential and of the radial
force. Displacements are u_axial = Re[z e^(-i n psi)] W_p, u_round = Re[i z e^(-i n psi)] V_p and u_radial =
Re[z e^(-i n psi)] U_p.
"""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.errors import InvalidInput
from facegear.parts.section import COINCIDENCE, distinct, thinnest


@dataclass(frozen=True)
class Hub:
    """Rectangle from the bore to `outer_radius`, from height `back` to `front`."""

    bore_radius: float
    outer_radius: float
    back: float
    front: float


@dataclass(frozen=True)
class Web:
    """Straight conical web from hub to rim.

    Thicknesses are axial, at the hub and at the rim. `offset` is the height of its middle plane at the rim;
    `slope` is how much that plane rises for each metre outwards, the tangent of the cone angle.
    """

    hub_thickness: float
    rim_thickness: float
    offset: float
    slope: float


@dataclass(frozen=True)
class Rim:
    """Rim from `inner_radius` to `outer_radius`, from height `back` to `front`, where the teeth are.

    `front` is the height at the inner radius; it rises by `slope` for each metre outwards.
    """

    inner_radius: float
    outer_radius: float
    back: float
    front: float
    slope: float = 0.0

    @property
    def outer_front(self) -> float:
        """Height of the front at the outer radius, m."""
        return self.front + self.slope * (self.outer_radius - self.inner_radius)


def wheel(hub: Hub, web: Web, rim: Rim) -> Array:
    """Return the corners of a gear's section that consists of hub, web and rim.

    Parameters
    ----------
    hub : Hub
        The hub.
    web : Web
        The web.
    rim : Rim
        The rim.

    Returns
    -------
    (n, 2) array
        r and height, anticlockwise, m.

    Raises
    ------
    InvalidInput
        If they do not make one body: see `require_wheel`.
    """
    require_wheel(hub, web, rim)
    (low_in, high_in), (low_out, high_out) = web_ends(hub, web, rim)
    points = [
        (hub.bore_radius, hub.back),
        (hub.outer_radius, hub.back),
        (hub.outer_radius, low_in),
        (rim.inner_radius, low_out),
        (rim.inner_radius, rim.back),
        (rim.outer_radius, rim.back),
        (rim.outer_radius, rim.outer_front),
        (rim.inner_radius, rim.front),
        (rim.inner_radius, high_out),
        (hub.outer_radius, high_in),
        (hub.outer_radius, hub.front),
        (hub.bore_radius, hub.front),
    ]
    return distinct(np.array(points))


def web_ends(hub: Hub, web: Web, rim: Rim) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return lower and upper height of the web where it ends at the hub, and where it ends at the rim.

    Parameters
    ----------
    hub : Hub
        The hub.
    web : Web
        The web.
    rim : Rim
        The rim.

    Returns
    -------
    pair of pairs of float
        (lower, upper) at the hub's outer radius, then at the rim's inner radius, m.
    """
    middle = web.offset - web.slope * (rim.inner_radius - hub.outer_radius)
    at_hub = (middle - 0.5 * web.hub_thickness, middle + 0.5 * web.hub_thickness)
    at_rim = (web.offset - 0.5 * web.rim_thickness, web.offset + 0.5 * web.rim_thickness)
    return at_hub, at_rim


def require_wheel(hub: Hub, web: Web, rim: Rim) -> None:
    """Raise InvalidInput unless bore, hub and rim follow each other outwards and the web ends within the
    faces of both hub and rim.

    Parameters
    ----------
    hub : Hub
        The hub.
    web : Web
        The web.
    rim : Rim
        The rim.
    """
    if hub.outer_radius >= rim.inner_radius:
        limit = f"below `inner radius of the rim`, {1e3 * rim.inner_radius:g} mm"
        raise InvalidInput("outer radius of the hub", 1e3 * hub.outer_radius, limit)
    if hub.bore_radius >= hub.outer_radius:
        limit = f"below `outer radius of the hub`, {1e3 * hub.outer_radius:g} mm"
        raise InvalidInput("bore radius of the hub", 1e3 * hub.bore_radius, limit)
    at_hub, at_rim = web_ends(hub, web, rim)
    rim_front = min(rim.front, rim.outer_front)
    for part, body, front, (low, high) in (
        ("hub", hub, hub.front, at_hub),
        ("rim", rim, rim_front, at_rim),
    ):
        if body.back >= front:
            raise InvalidInput(f"back of the {part}", 1e3 * body.back, f"below {1e3 * front:g} mm")
        if low < body.back - COINCIDENCE or high > body.front + COINCIDENCE:
            limit = (
                f"such that the web, {1e3 * low:.4g} to {1e3 * high:.4g} mm at the {part}, stays between the "
                f"{part}'s faces, {1e3 * body.back:g} and {1e3 * body.front:g} mm"
            )
            raise InvalidInput("offset of the web", 1e3 * web.offset, limit)


ACROSS = 2
"""Elements across the thinnest wall."""
LARGEST = 6_000
"""Elements that a section may take, those at its corners left out."""


def require_meshable(corners: Array, across: int = ACROSS) -> None:
    """Raise InvalidInput for a section so thin that its mesh would have more elements than LARGEST.

    Parameters
    ----------
    corners : (n, 2) array
        Corners of the section, m.
    across : int
        Number of elements across the thinnest wall.
    """
    size = thinnest(corners) / across
    next_corners = np.roll(corners, -1, axis=0)
    area = abs(0.5 * float(np.sum(corners[:, 0] * next_corners[:, 1] - corners[:, 1] * next_corners[:, 0])))
    if area > LARGEST * size**2:
        min_thickness_mm = 1e3 * across * np.sqrt(area / LARGEST)
        requirement = (
            f"at least {min_thickness_mm:.3g} mm beside an area of {1e6 * area:.4g} mm2, to be meshed"
        )
        raise InvalidInput("thinnest wall of the section", float(f"{1e3 * size * across:.4g}"), requirement)


@dataclass(frozen=True)
class Patch:
    """Area on which a mesh presses on the body.

    Attributes
    ----------
    height
        Height of the pitch plane over height 0, m.
    half_width
        Half width of the raised cosine along the ring, rad.
    """

    height: float
    half_width: float

    def factor(self, order: int) -> float:
        """Return c_n: the mean of a wave of order n over the patch, weighted by the raised cosine.

        With a = n half_width it is sin(a) / a / (1 - (a / pi)^2), and 1/2 at a = pi.

        Parameters
        ----------
        order : int
            The order n.

        Returns
        -------
        float
            Dimensionless, a factor; 1 for order 0.
        """
        angle = order * self.half_width
        if abs(angle - np.pi) < 1e-6:
            return 0.5
        return float(np.sinc(angle / np.pi) / (1.0 - (angle / np.pi) ** 2))

    def rows(self, order: int, teeth: Array) -> Array:
        """Return W_p, V_p and U_p at a mesh from the means below the teeth: c_n <W>, c_n (<V> + n height <W
        / r>) and c_n (<U> - height slope).

        Parameters
        ----------
        order : int
            The order n.
        teeth : (5, ...) array
            MEANS of `matrices`: <W>, <V> (m), <W / r> (m/m), <U> (m) and slope (m/m).

        Returns
        -------
        (3, ...) array
            Axial, circumferential and radial displacement of the pitch point, m.
        """
        levers = np.zeros((3, 5))
        levers[[0, 1, 2], [0, 1, 3]] = 1.0
        levers[1, 2], levers[2, 4] = order * self.height, -self.height
        return np.asarray(self.factor(order) * (levers @ teeth))

    def leaning(self, order: int, responses: Array) -> Array:
        """Return W_p, V_p, U_p and slope by a unit moment on the slope.

        Parameters
        ----------
        order : int
            The order n.
        responses : (5,) array
            MEANS of `matrices` by a unit moment on the slope, 1/N and rad/(N m).

        Returns
        -------
        (4,) array
            1/N and rad/(N m).
        """
        factor = self.factor(order)
        return factor * np.append(self.rows(order, responses), factor * responses[-1])

    def compliance(self, order: int, below: Array) -> Array:
        """Return H_n: W_p, V_p and U_p at a mesh (rows) by unit forces along the axis, round it and along the
        radius (columns).

        Parameters
        ----------
        order : int
            The order n.
        below : (5, 5) array
            Compliance of MEANS of `matrices`, m/N for <W>.

        Returns
        -------
        (3, 3) array
            m/N.
        """
        return self.rows(order, self.rows(order, below).T)
