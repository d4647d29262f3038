"""Bodies that have struck before: what of their last runs goes into the model of the next strike."""

from collections.abc import Sequence
from dataclasses import replace
from math import cos, sin

import numpy as np

from fem_impact.arrays import Array
from fem_impact.fem.flight import FreeVibration, RigidMotion
from fem_impact.fem.hexmodes import LANES
from fem_impact.solid.frame import turned, turned_at
from fem_impact.solid.model import Model
from fem_impact.solid.rodview import RodState
from fem_impact.solid.run import SolidResult
from fem_impact.solid.stepguard import zone_step

NOW = np.zeros(1)


def later_view(model: Model, last: SolidResult, angle: float) -> RodState:
    """Return what reads the rod of a later strike, whose reference has turned from n towards t, rad."""
    modes, places = last.view.modes, last.view.places
    later = replace(
        modes,
        shape=turned_at(modes.shape, places, angle),
        released=lambda force: modes.released(turned_at(force, places, -angle)),
    )
    return RodState.of(model, later)


def rest_shape(last: SolidResult) -> Array:
    """Return the positions (size,), m, at the end of a run, the rod's without its vibration."""
    shake = last.flight.displacement(np.arange(last.view.size), NOW)[:, 0]
    angle = last.view.angle(last.state, last.model)  # from t towards n
    return last.state.x - last.model.with_ties(turned_at(shake, last.view.places, -angle))


def carry(
    model: Model,
    view: RodState,
    last: SolidResult,
    angle: float,
    motion: RigidMotion,
    vibration: FreeVibration,
) -> Model:
    """Return the model of a strike with the rod that its last run left: shape, stresses, hardening, motion.

    Parameters
    ----------
    model : of the strike, with an undeformed rod; its zones take over stresses and hardening
    view : of that model
    last : the run before, on the same mesh of the rod
    angle : by which the rod has turned from n towards t since the end of that run, rad
    motion : rigid motion now, with the place of the mass centre in the model's frame
    vibration : about the rest shape, in the modes of ``view``
    """
    rod = model.layout.rod
    x, v = model.start[0].copy(), np.zeros_like(model.start[1])
    here, there = (np.array([one.centre[0], 0.0, one.centre[2]]) for one in (motion, last.motion))
    x[rod] = here + turned(rest_shape(last)[last.model.layout.rod] - there, angle)
    x[rod] += model.with_ties(vibration.displacement(np.arange(view.size), NOW)[:, 0])[rod]
    arm = x[rod] - here
    v[rod] = model.with_ties(vibration.modes.shape @ (vibration.modes.omega * vibration.b))[rod]
    v[rod[:, 0]] += motion.V_t + motion.Omega * arm[:, 2]
    v[rod[:, 2]] += motion.V_n - motion.Omega * arm[:, 0]
    whole = _zone_steps(model, "rod", model.start[0])
    _take_over(model, last.model, "rod", angle)
    return _begun_at(model, "rod", (x, v), whole)


def dented(model: Model, last: SolidResult) -> Model:
    """Return a model whose barrier is that of an earlier run on the same mesh, at rest with its dents."""
    moved, block = np.zeros_like(model.start[0]), model.layout.barrier_slice
    moved[block] = last.state.x[last.model.layout.barrier_slice] - model.start[0][block]
    model.hanging.expand(moved)  # the places of tied nodes are not kept by a run
    x = model.start[0] + moved
    whole = _zone_steps(model, "barrier", model.start[0])
    _take_over(model, last.model, "barrier", 0.0)
    return _begun_at(model, "barrier", (x, model.start[1]), whole)


def _zone_steps(model: Model, body: str, x: Array) -> list[float]:
    return [zone_step(zone, model, x) for zone in model.zones if zone.body == body]


def _begun_at(model: Model, body: str, start: tuple[Array, Array], whole: Sequence[float]) -> Model:
    """Return a model that starts from another shape of a body, at the step that its deformed zones allow.

    ``whole`` are the stable steps of these zones, s, in the shape that the step of the body was found for.
    """
    deformed = _zone_steps(model, body, start[0])
    shares = [now / before for now, before in zip(deformed, whole, strict=True)]
    steps = {**model.steps, body: min([1.0, *shares]) * model.steps[body]}
    return replace(model, start=start, steps=steps)


def _take_over(model: Model, earlier: Model, body: str, angle: float) -> None:
    """Give a body's zones the stresses and the hardening of an earlier run, turned from n towards t, rad."""
    of_new, of_old = ([zone for zone in one.zones if zone.body == body] for one in (model, earlier))
    for new, old in zip(of_new, of_old, strict=True):
        new.blocks.stress[:] = turned_stress(old.blocks.stress, angle)
        new.blocks.strain[:] = old.blocks.strain
        new.blocks.flow[:] = old.blocks.flow


def turned_stress(stress: Array, angle: float) -> Array:
    """Return deviators (blocks, 8, 6 LANES), tt, bb, nn, tb, bn, nt, turned from n towards t, rad."""
    tt, bb, nn, tb, bn, nt = np.moveaxis(stress.reshape(*stress.shape[:2], 6, LANES), 2, 0)
    c, s = cos(angle), sin(angle)
    parts = (
        c * c * tt + 2 * c * s * nt + s * s * nn,
        bb,
        s * s * tt - 2 * c * s * nt + c * c * nn,
        c * tb + s * bn,
        c * bn - s * tb,
        (c * c - s * s) * nt + c * s * (nn - tt),
    )
    return np.stack(parts, axis=2).reshape(stress.shape)


def lowered(model: Model, gap: float) -> Model:
    """Return a model whose rod is moved along n until it lies a ``gap``, m, over the barrier."""
    assert model.contact is not None, "a strike has a contact"
    x, v = model.start
    x = x.copy()
    x[model.layout.rod[:, 2]] -= model.contact.clearance(x) - gap
    return replace(model, start=(x, v))
