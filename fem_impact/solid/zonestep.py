"""The stable step of a yielding zone in its present shape, from the forces of its own kernel."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import LinearOperator

from fem_impact.solid.stable import gradient_squares, stable_step
from fem_impact.solid.state import State

if TYPE_CHECKING:
    from fem_impact.solid.model import Model
    from fem_impact.solid.yielding import YieldingZone

Array = NDArray[np.float64]

TINY = 1e-6  # of the height of the thinnest cell: motion from whose forces the stiffness is taken


def zone_step(zone: YieldingZone, model: Model, x: Array) -> float:
    """Return the largest stable step, s, of a model's zone at ``x`` (size,), where no cell is folded.

    Notes
    -----
    Lanczos over the assembly sees what a bound of single elements does not: their neighbours, and masses
    that were raised. Steel that flows is softer, so nothing flows here; stresses are those of now. The
    cells that yield set the step: of plates and tips dragged, squeezed and crushed, the whole body's fell as
    that of its zone within 2 %. Hanging nodes are held.
    """
    trial, places = _trial(zone), zone.places()
    moves, still = np.zeros(len(x), dtype=bool), np.zeros_like(x)
    moves[places] = True
    used = np.flatnonzero(moves & (model.inverse_mass > 0))
    reach = TINY / np.sqrt(gradient_squares(x, places).max())

    def force(motion: Array, share: float) -> Array:
        state = State(x + share * motion, motion, np.zeros_like(x), dt=share)
        trial.blocks.stress[:] = zone.blocks.stress
        trial.add(state)
        return state.force[used]

    rest = force(still, 0.0)

    def product(u: Array) -> Array:
        motion = still.copy()
        motion[used] = u.ravel()
        share = reach / np.abs(motion).max()
        return np.asarray((rest - force(motion, share)) / share)

    K = LinearOperator((len(used),) * 2, matvec=product, dtype=np.float64)
    return stable_step(K, model.inverse_mass[used], share=1.0)


def _trial(zone: YieldingZone) -> YieldingZone:
    """Return a zone of the same cells, which never flow, to be moved about."""
    old = zone.blocks
    own = {name: np.empty_like(getattr(old, name)) for name in ("stress", "pressure", "nodal")}
    blocks = old._replace(flow=np.full_like(old.flow, np.inf), **own)
    return replace(zone, blocks=blocks, room=np.empty_like(zone.room))
