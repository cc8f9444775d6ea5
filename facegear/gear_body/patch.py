"""Area on which a mesh presses on the body of a face gear.

A flank force turned into force and moment on height 0, spread along the ring as a raised cosine, moves the
pitch point in order n by W_p = c_n <W> axially and by V_p = c_n (<V> + n h <W / r>) round the axis, with c_n
the transform of the patch and h the height of the pitch plane. The second part is the moment of the
tangential force. Displacements are u_axial = Re[z e^(-i n psi)] W_p and u_round = Re[i z e^(-i n psi)] V_p.
"""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array


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
        """Return c_n: the part of a wave of order n that the patch feels.

        Parameters
        ----------
        order : int
            The order n.

        Returns
        -------
        float
            Dimensionless, a factor.
        """
        angle = order * self.half_width
        if abs(angle - np.pi) < 1e-6:
            return 0.5
        return float(np.sinc(angle / np.pi) / (1.0 - (angle / np.pi) ** 2))

    def rows(self, order: int, teeth: Array) -> Array:
        """Return W_p and V_p from the means below the teeth.

        Parameters
        ----------
        order : int
            The order n.
        teeth : (3, ...) array
            <W>, <V> (m) and <W / r> (m/m).

        Returns
        -------
        (2, ...) array
            m.
        """
        lever = order * self.height
        return self.factor(order) * (np.array([[1.0, 0.0, 0.0], [0.0, 1.0, lever]]) @ teeth)

    def leaning(self, order: int, responses: Array) -> Array:
        """Return W_p, V_p and slope by a unit moment on the slope.

        Parameters
        ----------
        order : int
            The order n.
        responses : (4,) array
            <W>, <V>, <W / r> and slope by a unit moment on the slope, 1/N and rad/(N m).

        Returns
        -------
        (3,) array
            1/N and rad/(N m).
        """
        factor = self.factor(order)
        return factor * np.append(self.rows(order, responses[:3]), factor * responses[3])

    def compliance(self, order: int, below: Array) -> Array:
        """Return H_n: motions W_p and V_p by unit loads on them.

        Parameters
        ----------
        order : int
            The order n.
        below : (3, 3) array
            Compliance of the means <W>, <V> and <W / r>, m/N.

        Returns
        -------
        (2, 2) array
            m/N.
        """
        return self.rows(order, self.rows(order, below).T)
