"""Rolling bearings where they stand in a machine, with the numbers of their catalogue."""

from dataclasses import dataclass, replace
from string import ascii_uppercase

import numpy as np

from facegear.bearings.elements import AnyBearing
from facegear.bearings.equilibrium import BearingState, state_at
from facegear.machine.flanks import NO_LOAD
from facegear.machine.statics import Equilibria
from facegear.rigid_body import MOTIONS


@dataclass(frozen=True, eq=False)
class PlacedBearing:
    """A rolling bearing of a machine.

    Attributes
    ----------
    key
        Key of its section in the config, for refusals.
    pinion, number
        Number of the pinion in the layout, and of the bearing on its shaft.
    name
        Name of the pinion.
    bearing
        The bearing.
    load_rating, fatigue_load_limit
        C and C_u of a catalogue, N; None where not given.
    shoulder
        Largest contact angle that its shoulder allows, rad; None where not given.
    """

    key: str
    pinion: int
    number: int
    name: str
    bearing: AnyBearing
    load_rating: float | None
    fatigue_load_limit: float | None
    shoulder: float | None

    @property
    def letter(self) -> str:
        """Letter of the bearing on its shaft, A being the first."""
        return ascii_uppercase[self.number]

    def state(self, at_rest: Equilibria, position: int = 0) -> BearingState:
        """Return the state of the bearing at an equilibrium of the machine.

        A bearing that carries nothing may stand anywhere in its clearance, also where it just touches: it is
        taken where it was assembled, if it carries nothing there. Forces below NO_LOAD of the largest on a
        flank are rounding and count as none, also where elements are pressed in and balance each other.

        Parameters
        ----------
        at_rest : Equilibria
            Equilibria of the machine.
        position : int
            Number of the equilibrium.

        Returns
        -------
        BearingState
            The state.
        """
        loads = at_rest.shafts[self.pinion]
        least = NO_LOAD * float(at_rest.flank_forces[position].max())
        state = state_at(self.bearing, loads.rings[position, self.number])
        if float(np.abs(loads.forces[position, self.number]).max()) <= least:
            assembled_state = state_at(self.bearing, np.zeros(MOTIONS))
            if float(np.abs(assembled_state.force).max()) <= least:
                state = assembled_state
        return replace(state, force=np.where(np.abs(state.force) > least, state.force, 0.0))
