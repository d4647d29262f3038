"""What moves in the march of the reduced model, what it is given and what it leaves: named tuples."""

from typing import NamedTuple, Self

import numpy as np

from fem_impact.arrays import Array, Bools, Ints
from fem_impact.modal.flat import Flats
from fem_impact.modal.groove import AT as IN_GROOVE
from fem_impact.modal.groove import CELLS
from fem_impact.physics.contact_law import ContactLaw, FlowLaw

MOST_CONTACTS = 200
SPRINGS = 100
MOST_ROWS = 2048
"""Rows of a record; where a run has more, every second one is dropped."""

OVER, CUT, NEXT = -1, -2, -3
"""Why a march ends, where not a site touches first: nothing strikes any more; it took too long; what
strikes next is another impact."""


class MotionIndex(NamedTuple):
    """Where each number of the rigid motion stands in its array (11,); n is the barrier's normal.

    Velocities, m/s and rad/s, of the rod's mass centre and of the barrier's (``b``); the height of the rod's
    mass centre over the barrier's surface and its way along it, m; the rod's turn, rad; the rod's mass centre
    from the barrier's, m.
    """

    V_n: int = 0
    V_t: int = 1
    Omega: int = 2
    height: int = 3
    along: int = 4
    turn: int = 5
    V_bn: int = 6
    V_bt: int = 7
    Omega_b: int = 8
    away_n: int = 9
    away_t: int = 10


class TallyIndex(NamedTuple):
    """Where each sum of a march stands in its array (5,).

    The largest force, N; works, J, of the normal force, of gravity, on a plate, and of a viscous contact.
    """

    force: int = 0
    work_n: int = 1
    gravity: int = 2
    plate: int = 3
    viscous: int = 4


class ClockIndex(NamedTuple):
    """Where each number of a march's course stands in its array (10,).

    Time and that of the last touch, s; steps; intervals of contact; whether the rod touched in the last step;
    rows of the record that are filled, and steps from one to the next; the place (t, n) of the last touch
    from the barrier's mass centre, m; the free flight before another impact, s.
    """

    time: int = 0
    last: int = 1
    steps: int = 2
    touches: int = 3
    pressed: int = 4
    rows: int = 5
    every: int = 6
    lever_t: int = 7
    lever_n: int = 8
    free: int = 9


class SiteIndex(NamedTuple):
    """Where each number of a site stands in its row (22,) of `Touched.site`.

    Depth and place along t, m, and the viscous part of its force, N, when it was looked at last; how far it
    moved since, m, and the rate of its depth, m/s; its forces, N; arm (t, n) from the rod's mass centre, m;
    how far the barrier's turn has moved the surface under it, m; the step at which it is looked at next;
    whether it was looked at in this step, has a law (2: that of a flat part), and touches; its first and last
    touch, s; its impulses, N s; its largest force, N, and depth, m, and the rod's turn then, rad.
    """

    depth: int = 0
    place: int = 1
    drag: int = 2
    moved: int = 3
    rate: int = 4
    force_n: int = 5
    force_t: int = 6
    arm_t: int = 7
    arm_n: int = 8
    sunk_n: int = 9
    sunk_t: int = 10
    wake: int = 11
    awake: int = 12
    known: int = 13
    touches: int = 14
    start: int = 15
    end: int = 16
    impulse_n: int = 17
    impulse_t: int = 18
    force: int = 19
    deepest: int = 20
    turned: int = 21


class RowIndex(NamedTuple):
    """Where each number stands in a row (17,) of the record.

    Time, s, forces, N, velocities of the rod, m/s and rad/s; energies, J, of its rigid motion, of the motion
    and the strain of its modes; plastic work, friction, what the contact holds, the barrier's motion, what a
    plate took, the work of gravity, what a viscous contact took, and waves in the barrier, J.
    """

    time: int = 0
    force_n: int = 1
    force_t: int = 2
    V_n: int = 3
    V_t: int = 4
    Omega: int = 5
    rigid: int = 6
    vibration: int = 7
    strain: int = 8
    plastic: int = 9
    friction: int = 10
    contact: int = 11
    barrier: int = 12
    plate: int = 13
    gravity: int = 14
    viscous: int = 15
    waves: int = 16


AT, SUM, CLOCK, SITE, ROW = MotionIndex(), TallyIndex(), ClockIndex(), SiteIndex(), RowIndex()


class Start(NamedTuple):
    """What of both bodies does not move: kg, m2, m/s2 along t and n.

    ``inverse_barrier_mass``, 1/kg, and ``plate_mobility``, m/(N s), 1 / the impedance of a plate that bends,
    are 0 for a massive barrier. ``inverse_barrier_inertia``, 1/(kg m2), is that of a free barrier about its
    mass centre.
    """

    mass: float
    k2: float
    g_t: float = 0.0
    g_n: float = 0.0
    inverse_barrier_mass: float = 0.0
    plate_mobility: float = 0.0
    inverse_barrier_inertia: float = 0.0


class Sites(NamedTuple):
    """Where the rod may touch: smooth curves and corners of its convex outline.

    Attributes
    ----------
    t, n, radius : (a,) centres of the arcs from the mass centre at first contact, and their radii, m
    low, high : (a,) turns of the rod, rad, between which an arc is what is lowest of its site
    offset : (a,) m, which makes the place of a site that rolls from arc to arc continuous
    begin : (s + 1,) first arc of each site, and behind the last one
    along_t, along_n : (s, k) displacement of each site by each mode, kg^-1/2
    base : the turn, rad, from which a whole one is counted
    apart : (s,) whether a site that has not touched in this impact begins another one
    """

    t: Array
    n: Array
    radius: Array
    low: Array
    high: Array
    offset: Array
    begin: Ints
    along_t: Array
    along_n: Array
    base: float
    apart: Bools

    @classmethod
    def point(cls, t: float, n: float, radius: float) -> Self:
        """Return the one site of a round body that does not vibrate: its centre and radius, m."""
        t_, n_, r, low, high = (np.array([value]) for value in (t, n, radius, -np.pi, np.pi))
        none, apart = np.zeros((1, 0)), np.zeros(1, np.bool_)
        return cls(t_, n_, r, low, high, t_.copy(), np.array([0, 1]), none, none, -np.pi, apart)


class Touched(NamedTuple):
    """The contact of each site: its laws, and the state of its springs or its groove.

    Attributes
    ----------
    site : (s, 22) see `SiteIndex`
    law, flow : (s, 10), (s, 17) numbers of a `ContactLaw` and a `FlowLaw`
    place, width, shift : (s, SPRINGS) tangential springs: distances from the centre, widths and shifts, m
    depth, normal, sheared : (s, CELLS) cells, and ``state`` (s, 11), ``works`` (s, 3), J, ``tip`` (s, 7),
        its radius, m, and the numbers of both flanks, and ``size`` (s,), m, of a
        `fem_impact.modal.groove.Groove`
    work_t : (s,) work of the tangential force, J
    flats : straight parts that have landed; their sites have no contacts of their own
    over_speed : factors of friction, a `fem_impact.fem.sliding.speed_table`
    """

    site: Array
    law: Array
    flow: Array
    place: Array
    width: Array
    shift: Array
    depth: Array
    normal: Array
    sheared: Array
    state: Array
    works: Array
    tip: Array
    size: Array
    work_t: Array
    flats: Flats
    over_speed: Array

    @classmethod
    def nothing(cls, sites: int, over_speed: Array) -> Self:
        """Return the contacts of sites that have not touched."""

        def rows(width: int) -> Array:
            return np.zeros((sites, width))

        laws = rows(len(ContactLaw._fields)), rows(len(FlowLaw._fields))
        springs = rows(SPRINGS), rows(SPRINGS), rows(SPRINGS)
        cells = rows(CELLS), rows(CELLS), rows(CELLS)
        once = np.zeros(sites), np.zeros(sites)
        whole = *laws, *springs, *cells, rows(len(IN_GROOVE)), rows(3), rows(7), *once
        return cls(rows(len(SITE)), *whole, Flats.none(), over_speed)


class Bounds(NamedTuple):
    """Step, free flight that ends an impact, latest time of touch, s."""

    step: float
    horizon: float
    latest: float


class Modes(NamedTuple):
    """Modes of the rod: (k,) rad/s."""

    omega: Array


class ModalState(NamedTuple):
    """What moves: (11,) rigid motion; (k,) modal amplitudes and their rates, sqrt(kg) m, sqrt(kg) m/s."""

    rigid: Array
    q: Array
    rate: Array


class Springs(NamedTuple):
    """Tangential springs of a contact: (SPRINGS,) distances from its centre, widths and shifts, m."""

    place: Array
    width: Array
    shift: Array
