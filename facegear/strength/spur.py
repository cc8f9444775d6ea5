"""External spur gears as the cylindrical gear standard sees them, SI units."""

from dataclasses import dataclass
from math import acos, cos, pi, sin, sqrt, tan

from facegear.errors import FacegearError


@dataclass(frozen=True)
class SpurGear:
    """One external spur gear cut by a rack.

    module (m), pressure_angle (rad) of the rack, profile_shift in modules, tip_radius and width in m;
    rack_addendum (h_fP) and rack_tip_radius (rho_fP) of the cutting rack in modules.
    """

    teeth: int
    module: float
    pressure_angle: float
    profile_shift: float
    tip_radius: float
    width: float
    rack_addendum: float
    rack_tip_radius: float

    @property
    def base_radius(self) -> float:
        """Base radius, m."""
        return 0.5 * self.module * self.teeth * cos(self.pressure_angle)

    @property
    def base_pitch(self) -> float:
        """Distance of neighbouring flanks along the line of action, m."""
        return pi * self.module * cos(self.pressure_angle)

    @property
    def tip_roll(self) -> float:
        """Length of the involute's tangent at the tip, m."""
        return sqrt(self.tip_radius**2 - self.base_radius**2)


@dataclass(frozen=True)
class SpurMesh:
    """A pinion and a wheel at a centre distance (m). Raises FacegearError where they cannot mesh."""

    pinion: SpurGear
    wheel: SpurGear
    centre_distance: float

    def __post_init__(self) -> None:
        if self.centre_distance <= self.pinion.base_radius + self.wheel.base_radius:
            minimum = self.pinion.base_radius + self.wheel.base_radius
            raise FacegearError(f"centre_distance = {self.centre_distance:g}: must be above {minimum:g} m")

    @property
    def working_angle(self) -> float:
        """Working pressure angle, rad."""
        return acos((self.pinion.base_radius + self.wheel.base_radius) / self.centre_distance)

    @property
    def ratio(self) -> float:
        """Teeth of the wheel over those of the pinion."""
        return self.wheel.teeth / self.pinion.teeth

    @property
    def contact_ratio(self) -> float:
        """Transverse contact ratio."""
        path = self.pinion.tip_roll + self.wheel.tip_roll - self.centre_distance * sin(self.working_angle)
        return path / self.pinion.base_pitch

    def single_contact_radius(self, gear: SpurGear) -> float:
        """Radius (m) of the outer point of single pair tooth contact on one of the gears."""
        roll = gear.tip_roll - (self.contact_ratio - 1.0) * gear.base_pitch
        return sqrt(gear.base_radius**2 + roll**2)

    def pitch_curvature_radius(self) -> float:
        """Relative radius of curvature at the pitch point, m."""
        radii = [gear.base_radius * tan(self.working_angle) for gear in (self.pinion, self.wheel)]
        return 1.0 / sum(1.0 / radius for radius in radii)
