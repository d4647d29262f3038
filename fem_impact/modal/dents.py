"""Dents that stay: what a strike left of the groove of each site, and how a later strike meets it."""

from dataclasses import dataclass
from math import cos, sin
from typing import Self

import numpy as np

from fem_impact.arrays import Array
from fem_impact.modal.groove import ACROSS, CELLS, WORK, sunk_beside
from fem_impact.modal.groove import AT as IN_GROOVE
from fem_impact.modal.laws import contact_rate, contact_stiffness
from fem_impact.modal.motion import AT, SITE, ModalState, Sites, Start, Touched
from fem_impact.modal.sites import ALIKE, lowest
from fem_impact.modal.touch import OWN
from fem_impact.physics.contact_law import ContactLaw, FlowLaw


@dataclass(frozen=True, eq=False)
class Dent:
    """The dent that one site of the rod has pressed into the barrier, or the barrier into the site.

    Attributes
    ----------
    site : number of the site
    across : R2, m, of the contact that pressed it, in which each cell is as wide as its depth makes it
    place, depth : (m,) m, on the barrier from where the sequence began, or along the skin of the site
    deepest, size : m, of the tip and of a cell, see `fem_impact.modal.groove.Groove`
    """

    site: int
    across: float
    place: Array
    depth: Array
    deepest: float
    size: float

    @classmethod
    def of(cls, held: Touched, s: int, sites: Sites, now: ModalState, along: float) -> Self | None:
        """Return what the groove of a site leaves; None where nothing has flowed.

        ``along``, m, is where the mass centre stood when the strike began.
        """
        if held.site[s, SITE.known] != OWN or not held.works[s, WORK.flow] > 0.0:
            return None
        state, law = held.state[s], FlowLaw(*held.flow[s])
        cells = np.arange(int(state[IN_GROOVE.first]), int(state[IN_GROOVE.last]) + 1)
        place = (cells + 0.5) * held.size[s] - _origin(sites, s, now, along, law.ploughs)
        # the ridge that was piled up is left out: a strike begins at the level of the surface beside it
        depth = np.maximum(held.depth[s][cells % CELLS], 0.0)
        return cls(s, law.R2, place, depth, float(state[IN_GROOVE.deepest]), float(held.size[s]))

    def meets(self, held: Touched, s: int, sites: Sites, now: ModalState, along: float) -> bool:
        """Put the dent under a site that has just touched, if it is one of that site and lies there."""
        law = FlowLaw(*held.flow[s])
        if s != self.site or abs(law.R2 / self.across - 1.0) > ALIKE:
            return False
        x, near = self.place + _origin(sites, s, now, along, law.ploughs), 0.0
        if law.ploughs:
            near = _places(sites, s, now)[0]
        if not (self.depth[np.abs(x - near) <= held.size[s] * ACROSS] > 0.0).any():
            return False
        size = held.size[s] = max(held.size[s], self.size)
        first = int(np.floor(x[0] / size))
        cells = np.arange(first, min(first + CELLS, int(np.ceil(x[-1] / size))))
        held.depth[s][cells % CELLS] = np.interp((cells + 0.5) * size, x, self.depth, 0.0, 0.0)
        state = held.state[s]
        state[IN_GROOVE.first], state[IN_GROOVE.last] = cells[0], cells[-1]
        dent = state[IN_GROOVE.dent] = self.depth.max()
        state[IN_GROOVE.deepest], state[IN_GROOVE.sinks] = self.deepest, sunk_beside(self.deepest, dent)
        return True


def meet(
    dents: tuple[Dent, ...], start: Start, sites: Sites, now: ModalState, held: Touched, s: int, along: float
) -> tuple[Dent | None, float]:
    """Return the dent that a site meets as it touches, and how fast it may swing on it, rad/s.

    The site has the law of a smooth surface; the last dent that fits is put under it. None, 0: there is none.
    """
    if held.site[s, SITE.known] != OWN or not FlowLaw(*held.flow[s]).yields:
        return None, 0.0
    met = next((dent for dent in reversed(dents) if dent.meets(held, s, sites, now, along)), None)
    if met is None:
        return None, 0.0
    laws = ContactLaw(*held.law[s]), FlowLaw(*held.flow[s])
    stiffness = contact_stiffness(*laws, float(held.size[s]) * ACROSS)
    return met, contact_rate(start, sites, now, s, stiffness)


def _places(sites: Sites, s: int, now: ModalState) -> tuple[float, float]:
    """Return the place of a site in its groove, m, and how far up the slope it stands from the start, m."""
    rigid = now.rigid
    turned, a = lowest(sites, s, float(rigid[AT.turn]))
    t = sites.t[a] + sites.radius[a] * sin(turned) + sites.along_t[s] @ now.q
    n = sites.n[a] - sites.radius[a] * cos(turned) + sites.along_n[s] @ now.q
    arm = cos(rigid[AT.turn]) * t + sin(rigid[AT.turn]) * n
    place = rigid[AT.along] + arm - sites.offset[a] - sites.radius[a] * turned
    return float(place), float(rigid[AT.along] + arm)


def _origin(sites: Sites, s: int, now: ModalState, along: float, ploughs: bool) -> float:
    """Return where places of a dent begin in the coordinate of the cells of a site's groove, m."""
    if ploughs:
        place, stands = _places(sites, s, now)
        return place - stands - along
    turned, a = lowest(sites, s, float(now.rigid[AT.turn]))
    return -float(sites.radius[a] * turned)
