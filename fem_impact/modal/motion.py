"""What moves in the march of the reduced model, what it is given and what it leaves: named tuples."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fem_impact.arrays import Array

MOST_CONTACTS = 200
SPRINGS = 100
LOOK = 8  # steps between looks at the rod's other points

# of the rigid motion: m/s, m/s, rad/s, m and m from the barrier's surface under the contact, rad; the
# velocities of the barrier's mass centre, m/s, its spin, rad/s, and velocities of its surface, m/s; the rod's
# mass centre from the barrier's, m
V_N, V_T, SPIN, HEIGHT, ALONG, TURN, BASE_N, BASE_T, BASE_SPIN, SURFACE_N, SURFACE_T, AWAY_N, AWAY_T = range(
    13
)
# of the tally: m, N; J of the forces, gravity and a plate; J of flow, of the sheared skin, of friction
PEAK, HARDEST, WORK_N, WORK_T, WORK_G, WORK_P, FLOWED, SHEARED, RUBBED = range(9)
NOTHING, TIP = -1, -2  # of what strikes
# of a row of the record: s, N, m/s, rad/s; J of the rod's rigid motion, its modes' motion and strain, flow,
# friction, what the contact holds, the barrier's motion, a plate, gravity's work
T_ROW, F_N_ROW, F_T_ROW, V_N_ROW, V_T_ROW, SPIN_ROW = range(6)
RIGID_ROW, RATE_ROW, STRAIN_ROW, FLOW_ROW, RUB_ROW, HELD_ROW, BASE_ROW, PLATE_ROW, GRAVITY_ROW = range(6, 15)
MOST_ROWS = 2048
"""Rows of a record; where a run has more, every second one is dropped."""


class Start(NamedTuple):
    """Rigid rod at first contact: kg, m2, m, m/s, rad/s, m/s2 along t and n.

    ``lightness`` is 1 / the barrier's mass, 1/kg; ``give`` is 1 / the impedance of a plate that bends,
    m/(N s); both are 0 for a massive barrier. ``ease`` is 1 / the moment of inertia, 1/(kg m2), of a free
    barrier about its mass centre, ``deep``, m, under the struck point and ``beside``, m, up the slope of it.
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
    lightness: float = 0.0
    give: float = 0.0
    ease: float = 0.0
    deep: float = 0.0
    beside: float = 0.0


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
    tally : (9,) largest depth and force, works, see `PEAK` to `RUBBED`
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
