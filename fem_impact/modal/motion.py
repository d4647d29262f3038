"""What moves in the march of the reduced model, what it is given and what it leaves: named tuples."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fem_impact.arrays import Array

MOST_CONTACTS = 200
SPRINGS = 100
LOOK = 8  # steps between looks at the rod's other points

NOTHING, TIP = -1, -2  # of what strikes


class MotionIndex(NamedTuple):
    """Where each number of the rigid motion stands in its array (13,); n is the barrier's normal.

    Velocities, m/s and rad/s, of the rod's mass centre and of the barrier's (``b``); the height of the rod's
    mass centre over the barrier's surface under the contact and its way along it, m; the rod's turn, rad; the
    velocity of that surface, m/s; the rod's mass centre from the barrier's, m.
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
    surface_n: int = 9
    surface_t: int = 10
    away_n: int = 11
    away_t: int = 12


class TallyIndex(NamedTuple):
    """Where each sum of a march stands in its array (10,).

    The largest depth, m, and force, N; works, J, of the normal and the tangential force, of gravity, on a
    plate, of normal flow, of shear flow under the contact, of friction, and of a viscous contact.
    """

    depth: int = 0
    force: int = 1
    work_n: int = 2
    work_t: int = 3
    gravity: int = 4
    plate: int = 5
    flow: int = 6
    shear: int = 7
    friction: int = 8
    viscous: int = 9


class RowIndex(NamedTuple):
    """Where each number stands in a row (16,) of the record.

    Time, s, forces, N, velocities of the rod, m/s and rad/s; energies, J, of its rigid motion, of the motion
    and the strain of its modes; plastic work, friction, what the contact holds, the barrier's motion, what a
    plate took, the work of gravity, and what a viscous contact took, J.
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


AT, SUM, ROW = MotionIndex(), TallyIndex(), RowIndex()
MOST_ROWS = 2048
"""Rows of a record; where a run has more, every second one is dropped."""


class Start(NamedTuple):
    """Rigid rod at first contact: kg, m2, m, m/s, rad/s, m/s2 along t and n.

    ``inverse_barrier_mass``, 1/kg, and ``plate_mobility``, m/(N s), 1 / the impedance of a plate that bends,
    are 0 for a massive barrier. ``inverse_barrier_inertia``, 1/(kg m2), is that of a free barrier about its
    mass centre, ``centre_depth``, m, under the struck point and ``centre_offset``, m, up the slope of it.
    """

    mass: float
    k2: float
    centre_t: float
    centre_n: float
    radius: float
    v_t: float
    v_n: float
    omega: float
    g_t: float
    g_n: float
    inverse_barrier_mass: float = 0.0
    plate_mobility: float = 0.0
    inverse_barrier_inertia: float = 0.0
    centre_depth: float = 0.0
    centre_offset: float = 0.0


class Modes(NamedTuple):
    """Modes of the rod: (k,) rad/s and the displacement of the followed point, kg^-1/2."""

    omega: Array
    along_t: Array
    along_n: Array


class Others(NamedTuple):
    """Other round edges that may touch: centres from the mass centre at first contact and radii, (m,) m.

    ``along_t``, ``along_n`` (m, k) are their displacements by each mode, kg^-1/2. They strike where they are
    lower than the barrier.
    """

    t: Array
    n: Array
    radius: Array
    along_t: Array
    along_n: Array


NONE = np.zeros(0)
RIGID = Modes(NONE, NONE, NONE)
ALONE = Others(NONE, NONE, NONE, np.zeros((0, 0)), np.zeros((0, 0)))
"""No modes, and no other points."""


class Bounds(NamedTuple):
    """Step, free flight that ends an impact, latest time of touch, s; largest contact radius, m."""

    step: float
    horizon: float
    latest: float
    reach: float


class ModalState(NamedTuple):
    """What moves: (13,) rigid motion; (k,) modal amplitudes and their rates, sqrt(kg) m, sqrt(kg) m/s."""

    rigid: Array
    q: Array
    rate: Array


class Springs(NamedTuple):
    """Tangential springs of a contact: (SPRINGS,) distances from its centre, widths and shifts, m."""

    place: Array
    width: Array
    shift: Array


class ModalEnd(NamedTuple):
    """The end of a march.

    Attributes
    ----------
    motion : then
    tally : (10,) largest depth and force, works, see `TallyIndex`
    held : energy in the contact and in its springs, J, 0 but for a run that was cut off
    time, steps, touches : s, number of steps, of contacts
    struck : place in `Others` of the point that strikes first, or `NOTHING`; after ``wait``, s
    over : nothing strikes within the horizon
    rows : of the record that are filled
    """

    motion: ModalState
    tally: Array
    held: tuple[float, float]
    time: float
    steps: int
    touches: int
    struck: int
    wait: float
    over: bool
    rows: int
