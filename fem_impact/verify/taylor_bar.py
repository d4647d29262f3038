"""``taylor``: a yielding copper bar on a frictionless rigid wall.

Printed: final length 21.42 to 21.43 mm and foot radius 7.22 to 7.23 mm for 32.4 mm, 3.2 mm, 227 m/s, E 117
GPa, nu .35, rho 8930, yield 400 MPa, hardening 100 MPa, 80 us (Foulk et al. 2021, Simo 1992). A law without
rate has no length of its own, so a bar of other length and the same shape and speed ends in the same shape.
"""

from __future__ import annotations

import numpy as np

import meshes
from fem_impact.solid.hardening import linear_hardening
from fem_impact.solid.march import march
from fem_impact.solid.stepguard import StepGuard
from fem_impact.verify import steel
from fem_impact.verify.bodies import Body, body_model, placed, unsliced
from fem_impact.verify.problem import Check, Parameter, Problem, Solved, Values
from fem_impact.verify.watch import Until

__all__ = ["PROBLEM"]

LENGTH, RADIUS, SPEED, TIME = 32.4e-3, 3.2e-3, 227.0, 80e-6
E, NU, RHO = 117e9, 0.35, 8930.0
YIELD, HARDENING = 400e6, 100e6
FINAL, FOOT = 21.42e-3, 7.22e-3


def solve(p: Values) -> Solved:
    """Strike with the printed copper and compare the final shape."""
    scale = p["length"] / LENGTH
    flat = np.array([[0.0, 0.0], [scale * RADIUS, 0.0]])
    slab = p["length"] / p["slices"]
    bar = meshes.rod(flat, p["length"], int(p["across"]), slice_length=slab, nose=False)
    speed = np.zeros_like(bar.mesh.points)
    speed[:, 2] = -SPEED
    points = placed(bar.mesh.points, 0.0, 0.0)
    model = body_model(
        Body(
            unsliced(bar.mesh),
            points,
            speed,
            E,
            NU,
            RHO,
            kind="bbar",
            law=linear_hardening(YIELD, HARDENING),
            yields=np.ones(len(bar.mesh.cells), dtype=bool),
            friction=0.0,
        )
    )
    state, guard = model.initial_state(), StepGuard(model, every=10)
    energy = Until(model.ledger(), scale * TIME, every=50)
    march(model, state, [guard, energy])
    x = state.x[model.layout.rod]
    foot = x[points[:, 2] < 1e-9]
    # the section is a polygon of the round one's area: compare equal areas
    swell = float(np.hypot(points[:, 0], points[:, 1]).max()) / (scale * RADIUS)
    radius = float(np.hypot(foot[:, 0], foot[:, 1]).max()) / swell
    length = float(np.ptp(x[:, 2]))
    checks = (
        Check("final length", "m", length, scale * FINAL, scale * 0.06e-3, "absolute"),
        Check("foot radius", "m", radius, scale * FOOT, scale * 0.08e-3, "absolute"),
        Check("energy ledger / E_0", "1", energy.ledger.worst / energy.ledger.start, 0.0, 1e-3, "at most"),
    )
    return Solved(checks, state.step, len(bar.mesh.cells))


PROBLEM = Problem(
    "taylor",
    "a copper bar flattens on a frictionless wall: final length and foot radius",
    (
        Parameter(
            "length", "length of the bar; its radius keeps the proportion", LENGTH, 1e-3, 1.0, "length"
        ),
        Parameter("slices", "cells along the bar", 96, 10, 200, multiple=1),
        steel.across(8),
    ),
    solve,
)
