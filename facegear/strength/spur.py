"""External spur gears as the cylindrical gear standard sees them, SI units."""

from dataclasses import dataclass
from math import cos


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
