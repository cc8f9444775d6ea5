"""Public bearings and their numbers, and an independent answer to a motion: NumPy, in N, mm and rad."""

from dataclasses import replace

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq, root

from facegear.bearings.elements import BallBearing, RollerBearing

P1 = BallBearing(10, 12.7e-3, 70e-3, clearance=15e-6)
P2 = BallBearing(
    *(14, 11.906e-3, 60e-3),
    contact_angle=np.radians(40.0),
    first_element=0.1,
    groove_ratio_outer=0.53,
)
P3 = RollerBearing(17, 11e-3, 70.5e-3, clearance=30e-6, effective_length=11.2e-3)
TAPERED = RollerBearing(
    *(17, 9e-3, 62e-3),
    contact_angle=np.radians(14.0),
    clearance=5e-6,
    first_element=0.2,
    effective_length=13e-3,
)
PUBLIC = {"P1": P1, "P2": P2, "P3": P3}
ALL = {**PUBLIC, "tapered": TAPERED, "mirrored": replace(P2, direction=-1)}
ALL |= {f"thrown {name}": replace(bearing, speed=900.0) for name, bearing in ALL.items()}


TABLE = """
P1.1 5000 0 0 0 0 | 41.7799 0 0 0 0 | 2351.694 5 159.3 306.604
  228.7 136.24 10.827 3.186 10.27 zb -327.87
P1.2 4000 0 2000 0 0 | 37.9698 0 145.9843 0 2683.5345 | 2212.695 10 360.0 284.256
  358.08 317.82 77.762 42.536 54.11 xz -37.167 xb -3055 ya 3006.2 zb 794.33
P1.3 3000 -2000 1500 8000 5000 | 30.6201 -23.5062 135.0634 1940.1992 2372.3957 | 2098.632 10 360.0 365.637
  328.36 318.01 69.114 41.745 44.153 xy -27.551 xz -35.032 yz 33.005 xa -77.829 xb -2607.7 ya 2630.3 yb 77.829
  za 614.91 zb 655.51 ab 7.9029
P1.4 0 0 -6000 0 12000 | -6.8724 0 -189.9183 0 534.6694 | 1732.224 10 360.0 134.745
  405.2 404.06 144.13 89.201 89.935 xz -13.141 xb 5203.8 ya -5193.7 zb -406.81
P2.1 0 0 5000 0 0 | 0 0 21.0147 0 0 | 538.830 14 360.0 2385.25
  233.92 233.92 369.25 166.33 166.33 xb -6048.2 ya 6048.2
P2.2 3000 1000 5000 0 0 | 111.8083 37.2696 0.6885 -1390.6375 4171.8011 | 1758.402 14 360.0 344.871
  281.13 168.6 304.06 101.14 172.94 xy 42.215 xz 6.3436 yz 2.0215 xa 775.62 xb -5756.3 ya 3689 yb -775.62
  za -941.2 zb 2816.1 ab -26.934
P2.3 4000 0 3500 0 0 | 146.9202 0.1077 -24.2352 43.6775 5790.8408 | 2236.312 9 213.6 253.48
  283.92 77.216 195.57 31.133 145.24 xy -0.4026 xz 6.1955 yz 3.6542 xa -14.369 xb -4563.3 ya 1234.8 yb 14.369
  za 102.2 zb 2929.7 ab 0.66349
P2.4 2000 1500 6000 -20000 30000 | 100.5293 72.5007 -0.5670 -2799.7027 3904.8548 | 1896.338 14 334.9 267.103
  251.22 203.39 324.41 129.5 163.09 xy 74.282 xz -12.449 yz -5.2289 xa 1377.7 xb -5225.1 ya 4330.5 yb -1377.7
  za -2265 zb 3276.9 ab -50.259
P3.1 10000 0 0 0 0 | 35.3106 0 0 0 0 | 3112.154 7 129.7 1437.39
  760.6 280.11 0 1.6831 6.4587
P3.2 6000 8000 0 0 0 | 21.1449 28.1857 0 0 0 | 2977.916 6 129.6 1463.85
  466.2 596.73 0 4.8111 3.5818 xy 227.08 ab -2.1348
P3.3 10000 0 0 0 20000 | 33.3029 0 0 0 3480.8810 | 3039.447 7 133.1 567.378
  677.13 277.97 0 2.0146 5.404 xb 819.05 ya -460.07
P3.4 5000 -2000 0 15000 10000 | 22.2273 -1.3933 0 7088.6480 2177.1763 | 1539.716 11 220.0 1424.85
  506.23 404.94 0 5.1766 4.1185 xy -25.93 xa 612.61 xb 434.08 ya -84.762 yb -612.61 ab 0.52271
"""
"""Section 5 of the project's notes on bearings, made by a program of its own.

Load in N and N mm, motion in um and urad, hardest load in N, loaded elements, zone in degrees, life in
million turns; stiffness in N/um, N/mrad and N m/mrad.
"""


class PublicCase:
    """One row of the table in SI units, with the half of the last digit that is printed of each number."""

    def __init__(self, text):
        head, *lines = text.strip().split("\n")
        name, rest = head.split(maxsplit=1)
        load, motion, result = rest.split("|")
        self.name, self.bearing = name, PUBLIC[name[:2]]
        self.load = np.array(load.split(), float) / [1, 1, 1, 1e3, 1e3]
        self.motion = np.array(motion.split(), float) * 1e-6
        hardest, count, zone, life = result.split()
        self.hardest, self.count, self.zone = float(hardest), int(count), np.radians(float(zone))
        self.life = float(life)
        words = " ".join(lines).split()
        self.stiffness = np.diag(np.array(words[:5], float)) / 1e6
        self.digits = np.diag([half_digit(word) for word in words[:5]]) / 1e6
        for place, value in zip(words[5::2], words[6::2], strict=True):
            i, j = ("xyzab".index(letter) for letter in place)
            self.stiffness[i, j] = self.stiffness[j, i] = float(value) / 1e6
            self.digits[i, j] = self.digits[j, i] = half_digit(value) / 1e6
        # N/um and N m/mrad are 1e6 N/m and 1e3 N m/rad; N/mrad is 1e3 N/rad.
        scale = np.full((5, 5), 1e9)
        scale[:3, :3], scale[3:, 3:] = 1e12, 1e9
        self.stiffness, self.digits = self.stiffness * scale, self.digits * scale


def half_digit(text):
    """Half of the last digit of a printed number; five digits are printed, without zeros at the end."""
    number = abs(float(text))
    return 0.5 * 10.0 ** (np.floor(np.log10(number)) - 4) if number else 0.0


def public_cases():
    parts = TABLE.strip().split("\nP")
    return [PublicCase(part if part.startswith("P") else f"P{part}") for part in parts]


def compute_ellipse(difference):
    """Axis ratio and both elliptic integrals of a contact, by quadrature."""

    def integrals(ratio):
        parameter = 1.0 - ratio**-2
        first = quad(lambda t: 1.0 / np.sqrt(1.0 - parameter * np.sin(t) ** 2), 0.0, np.pi / 2, epsabs=1e-14)
        second = quad(lambda t: np.sqrt(1.0 - parameter * np.sin(t) ** 2), 0.0, np.pi / 2, epsabs=1e-14)
        return first[0], second[0]

    def excess(ratio):
        first, second = integrals(ratio)
        return 1.0 - 2.0 * (first / second - 1.0) / (ratio**2 - 1.0) - difference

    ratio = brentq(excess, 1.01, 100.0, xtol=1e-13)
    return ratio, *integrals(ratio)


def ball_constants(bearing):
    """Stiffness of inner and outer contact in N/mm^1.5."""
    ball, gamma = 1e3 * bearing.element_diameter, bearing.pitch_ratio
    constants = []
    for sign, ratio in ((1, bearing.groove_ratio_inner), (-1, bearing.groove_ratio_outer)):
        groove = ratio * ball
        term = sign * gamma / (1.0 - sign * gamma)
        rho = 2.0 / ball * (2.0 + term - ball / (2.0 * groove))
        difference = (term + ball / (2.0 * groove)) / (2.0 + term - ball / (2.0 * groove))
        chi, first, second = compute_ellipse(difference)
        modulus = 1e-6 * bearing.young / (1.0 - bearing.poisson**2)
        length = first * (rho / (chi**2 * second)) ** (1 / 3)
        constants.append(np.pi / np.sqrt(4.5) * modulus * length**-1.5)
    return constants


def positive(value):
    """Positive part by the real part, so that complex steps pass through."""
    return np.where(np.real(value) > 0.0, value, 0.0)


class SlowBearing:
    """Energy and force of a bearing at one motion (mm, rad; N, N mm), written once more from the formulas.

    Complex motions are allowed without centrifugal force.
    """

    def __init__(self, bearing):
        self.bearing = bearing
        self.angles = bearing.first_element + 2 * np.pi * np.arange(bearing.elements) / bearing.elements
        self.is_ball = isinstance(bearing, BallBearing)
        diameter, pitch = 1e3 * bearing.element_diameter, 1e3 * bearing.pitch_diameter
        density, cage = bearing.density * 1e-9, 0.5 * bearing.speed * (1 - bearing.pitch_ratio)
        if self.is_ball:
            self.constants = ball_constants(bearing)
            volume = np.pi * diameter**3 / 6
        else:
            volume = np.pi * diameter**2 / 4 * 1e3 * bearing.effective_length
        self.thrown = (
            density * volume * pitch / 2 * cage**2 / 1e3 * np.cos(bearing.contact_angle) ** (not self.is_ball)
        )

    def motions(self, q, angle, radius, height):
        x, y, z, a, b = q
        cosine, sine = np.cos(angle), np.sin(angle)
        radial = (x + height * b) * cosine + (y - height * a) * sine
        return radial, z + radius * (a * sine - b * cosine)

    def centres(self, q, angle):
        """Vector from the outer to the inner groove's centre."""
        bearing = self.bearing
        ball, alpha, sign = 1e3 * bearing.element_diameter, bearing.contact_angle, bearing.direction
        inner = (bearing.groove_ratio_inner - 0.5) * ball
        distance = (bearing.groove_ratio_inner + bearing.groove_ratio_outer - 1) * ball
        radius = 500 * bearing.pitch_diameter + inner * np.cos(alpha)
        radial, axial = self.motions(q, angle, radius, sign * inner * np.sin(alpha))
        rest = distance * np.cos(alpha) - 500 * bearing.clearance
        return rest + radial, sign * distance * np.sin(alpha) + axial, distance, inner

    def ball_energy(self, q, angle):
        inner, outer = self.constants
        radial, axial, distance, inner_length = self.centres(q, angle)
        if not self.thrown:
            total = (inner ** (-2 / 3) + outer ** (-2 / 3)) ** -1.5
            approach = positive(np.sqrt(radial**2 + axial**2) - distance)
            return 0.4 * total * approach**2.5
        outer_length = distance - inner_length

        def loads(ball):
            r, z = ball
            to_inner = np.hypot(radial - r, axial - z)
            to_outer = np.hypot(r, z)
            first = inner * max(to_inner - inner_length, 0.0) ** 1.5
            second = outer * max(to_outer - outer_length, 0.0) ** 1.5
            gradient = [
                -first * (radial - r) / to_inner + second * r / to_outer - self.thrown,
                -first * (axial - z) / to_inner + second * z / to_outer,
            ]
            energy = 0.4 * first * max(to_inner - inner_length, 0.0)
            energy += 0.4 * second * max(to_outer - outer_length, 0.0) - self.thrown * r
            return gradient, energy

        free = outer_length + (self.thrown / outer) ** (2 / 3)
        part = (outer_length + 0.5 * max(np.hypot(radial, axial) - distance, 0.0)) / np.hypot(radial, axial)
        best = min(
            (
                root(lambda ball: loads(ball)[0], start, tol=1e-13).x
                for start in ((free, 0.0), (part * radial, part * axial))
            ),
            key=lambda ball: np.abs(loads(ball)[0]).max(),
        )
        assert np.abs(loads(best)[0]).max() < 1e-6 * self.thrown
        return loads(best)[1] + self.thrown * (outer_length + 0.6 * (free - outer_length))

    def slices(self):
        bearing = self.bearing
        length, diameter = 1e3 * bearing.effective_length, 1e3 * bearing.element_diameter
        number = np.arange(1, bearing.slices + 1)
        at = length * ((number - 0.5) / bearing.slices - 0.5)
        factor = 0.00045 if bearing.contact_angle else 0.00035
        assert length <= 2.5 * diameter
        drop = factor * diameter * np.log(1.0 / (1.0 - (2 * at / length) ** 2)) * bearing.has_profile
        return at, drop, 35948 * length ** (8 / 9) / bearing.slices

    def roller_energy(self, q, angle):
        bearing = self.bearing
        at, drop, stiffness = self.slices()
        alpha, sign = bearing.contact_angle, bearing.direction
        radius, height = 500 * bearing.pitch_diameter - at * np.sin(alpha), sign * at * np.cos(alpha)
        radial, axial = self.motions(q, angle, radius, height)
        normal = (
            radial * np.cos(alpha) + sign * axial * np.sin(alpha) - 500 * bearing.clearance * np.cos(alpha)
        )
        if not self.thrown:
            return np.sum(9 / 19 * stiffness * positive(normal - 2 * drop) ** (19 / 9))
        hard = 2 ** (10 / 9) * stiffness

        def energy(where, first=0.0, gradient=False):
            inner = np.maximum(normal - first - where[0] - where[1] * at - drop, 0.0)
            outer = np.maximum(where[0] + where[1] * at - drop, 0.0)
            if gradient:
                pull = hard * outer ** (10 / 9) - hard * inner ** (10 / 9)
                return [pull.sum() - self.thrown, (pull * at).sum()]
            return np.sum(9 / 19 * hard * (inner ** (19 / 9) + outer ** (19 / 9))) - self.thrown * where[0]

        free = root(lambda u: energy((u[0], 0.0), 1e3, True)[0], [2e-3], tol=1e-13).x[0]
        middle = normal[bearing.slices // 2]
        starts = ((free, 0.0), (max(middle / 2, free), (normal[-1] - normal[0]) / (at[-1] - at[0]) / 2))
        best = min(
            (root(energy, start, (0.0, True), tol=1e-13).x for start in starts),
            key=lambda where: np.abs(energy(where, 0.0, True)).max(),
        )
        assert np.abs(energy(best, 0.0, True)).max() < 1e-6 * self.thrown
        return energy(best) - energy((free, 0.0), 1e3)

    def energy(self, q):
        """N mm at a motion in mm and rad."""
        one = self.ball_energy if self.is_ball else self.roller_energy
        return sum(one(q, angle) for angle in self.angles)

    def force(self, q):
        """N and N mm, by complex steps of the energy."""
        return np.array([self.energy(np.asarray(q) + 1e-30j * step).imag / 1e-30 for step in np.eye(5)])
