"""Which places of the rod touched, how wide and how deep: the sites of contact of an impact."""

from math import cos, sin, sqrt

import numpy as np

from fem_impact.arrays import Array
from fem_impact.case.case import Case
from fem_impact.modal.flat import LAW
from fem_impact.modal.landing import flexibility
from fem_impact.modal.motion import SITE, Touched
from fem_impact.modal.rod import ModalRod
from fem_impact.modal.sites import skin
from fem_impact.modal.touch import OWN
from fem_impact.outcome.groups import ContactSite
from fem_impact.physics.contact_law import FlowLaw


def pressed_sites(case: Case, rod: ModalRod, held: Touched) -> tuple[ContactSite, ...]:
    """Return the places of contact in the order of their first touch."""
    own = np.flatnonzero((held.site[:, SITE.known] == OWN) & (held.site[:, SITE.end] > 0.0))
    laid = np.flatnonzero((held.flats.deepest > 0.0).any(axis=1))
    found = [
        *(_pressed(case, rod, held, s) for s in own.tolist()),
        *(_laid(case, rod, held, f) for f in laid.tolist()),
    ]
    return tuple(sorted(found, key=lambda site: site.start))


def _pressed(case: Case, rod: ModalRod, held: Touched, s: int) -> ContactSite:
    """Return a site with a contact of its own."""
    flow, of = FlowLaw(*held.flow[s].tolist()), held.site[s]  # `flow_of` would be compiled in each process
    dent = float(held.depth[s].max()) if flow.yields else 0.0
    across = of[SITE.deepest] + dent  # as wide as `fem_impact.modal.groove` says
    half, wide = sqrt(flow.R1 * across), sqrt(flow.R2 * across)
    middle = skin(rod.sites, s, float(of[SITE.turned]))[0] - _first(case)
    depth = _of_barrier(case, float(of[SITE.deepest]), dent, bool(flow.ploughs))
    return _site([of], middle - half, middle + half, 2.0 * wide, depth)


def _laid(case: Case, rod: ModalRod, held: Touched, f: int) -> ContactSite:
    """Return a straight part that lay along the barrier; the barrier gives way by its share of the depth."""
    flats, pair = held.flats, case.contact
    rows = [held.site[s] for s in flats.ends[f]]
    t = [skin(rod.sites, int(s), float(held.site[s, SITE.turned]))[0] for s in flats.ends[f]]
    cells = flats.deepest[f] > 0.0
    places = t[0] + flats.share[f][cells] * (t[1] - t[0]) - _first(case)
    sunk = 0.5 * (flats.dent[f] + flats.deepest[f])
    wide = np.sqrt(flats.base[f] + flats.law[f, LAW.widens] * sunk)
    half = 0.5 * flats.law[f, LAW.size]
    deepest, dent = float(flats.deepest[f].max()), float(flats.dent[f].max())
    depth = _of_barrier(case, deepest, dent, pair.softer == pair.barrier)
    low, high = float(places.min()) - half, float(places.max()) + half
    return _site(rows, low, high, 2.0 * float(wide[cells].max()), depth)


def _of_barrier(case: Case, deepest: float, dent: float, flows: bool) -> float:
    """Return the depth in the barrier, m: its share of what is elastic, and the dent, m, if it flows."""
    return flexibility(case) * case.contact.modulus * (deepest - dent) + dent * flows


def _site(rows: list[Array], low: float, high: float, width: float, depth: float) -> ContactSite:
    """Return a place of contact from the rows of its sites, see `SiteIndex`."""
    touched = [of for of in rows if of[SITE.end] > 0.0]
    return ContactSite(
        start=float(min(of[SITE.start] for of in touched)),
        end=float(max(of[SITE.end] for of in touched)),
        impulse_n=float(sum(of[SITE.impulse_n] for of in rows)),
        impulse_t=float(sum(of[SITE.impulse_t] for of in rows)),
        low_t=low,
        high_t=high,
        width=width,
        depth=depth,
    )


def _first(case: Case) -> float:
    """Return t, m, of what touches first from the mass centre: of a flat part, of the end before."""
    body, angle = case.bodies.body, case.contact.angle
    x, z = body.contact_point(angle)
    return float(cos(angle) * (x - body.x_c) + sin(angle) * (z - body.z_c))
