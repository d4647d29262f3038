"""``free-spin`` and ``momentum``: motions of a rod whose outcome is a conservation law.

A rod that turns is stretched by its own spin, and a rod set going unstretched rings about that. In a slender
one the strain is rho w^2 (L^2 / 4 - x^2) / (2 E), so with s = w L / c0 its energy is at most 2 s^2 / 5 of
the kinetic one, and length and moment of inertia grow by at most s^2 / 6 and 2 s^2 / 5.
"""

from math import pi

import numpy as np

from fem_impact import Case
from fem_impact.evidence.problems import setups
from fem_impact.evidence.problems.problem import Check, Solved, Values, within
from fem_impact.evidence.references.rod_end import bar_speed
from fem_impact.solid.march import march
from fem_impact.solid.run import solve as run_solid

SMALL = 1e-6
FASTEST = 0.05  # spin times length over c0
CLOSING = 2e-3  # speed of the tip over c0
STILL = 1e-9  # rad/s
EVERY = 200


def spin(p: Values) -> Solved:
    """Let a free rod turn: no strain energy but that of its own spin, the same length and the same spin.

    Raises
    ------
    SceneError
        If the spin stretches the rod too much for the reference.
    """
    c0 = bar_speed(p["E"], p["rho"])
    fastest = FASTEST * c0 / p["length"]
    within(p, "omega", -fastest, fastest, "rad/s", "a faster spin stretches the rod.")
    stretch = (p["omega"] * p["length"] / c0) ** 2
    allowed = (SMALL + 0.4 * stretch) * abs(p["omega"]) + STILL
    frozen = dict(p) | {"v_n": 1e-3, "v_t": 0.0, "angle": pi / 4, "max_time": 1e-2}
    effects = ("vibration", "barrier-rigid", "large-rotation")
    # a case refuses a spin that may take the tip away from the barrier: it is given to the model
    model = setups.scene_model(setups.rod_scene(frozen | {"omega": 0.0}, effects)).coasting()
    state, ledger, rod = model.initial_state(), model.ledger(), model.layout.rod
    arm = state.x[rod] - setups.rigid_of(model, state).centre
    state.v[rod[:, 0]] += p["omega"] * arm[:, 2]
    state.v[rod[:, 2]] -= p["omega"] * arm[:, 0]
    watch = setups.Until(ledger, p["time"], every=EVERY, names=("strain_rod",))
    march(model, state, [watch])
    omega, start = setups.rigid_of(model, state).Omega, model.start[0]
    # the distance between lowest and highest node, now and before
    places = rod[~model.geometry.rod.mesh.is_hanging]
    ends = places[[np.argmin(start[places[:, 2]]), np.argmax(start[places[:, 2]])]]
    now, before = (float(np.linalg.norm(np.diff(x[ends], axis=0))) for x in (state.x, start))
    checks = (
        Check("strain energy / E_0", "1", watch.most, 0.4 * stretch, SMALL, "at most"),
        Check("change of length", "1", now / before - 1, 0.0, SMALL + stretch / 6, "absolute"),
        Check("spin", "rad/s", omega, p["omega"], allowed, "absolute"),
        Check("energy ledger / E_0", "1", ledger.worst / ledger.start, 0.0, SMALL, "at most"),
    )
    return Solved(checks, state.step, len(model.geometry.rod.mesh.cells))


def momentum(p: Values) -> Solved:
    """Let a spinning rod strike without friction: impulse, its moment and energy must balance.

    Raises
    ------
    SceneError
        If the tip moves away, or so fast that its cells are squeezed.
    """
    scene = setups.rod_scene(p, ("vibration", "barrier-rigid", "large-rotation"))
    away = p["omega"] * float(scene.projectile.rigid_body.arms(p["angle"])[0])
    fastest = CLOSING * bar_speed(p["E"], p["rho"])
    within(p, "v_n", max(away, 0.0) + 1e-4, away + fastest, "m/s", "the tip must close in, and slowly.")
    result = run_solid(Case.of(scene))
    rod, motion, book = scene.projectile.rigid_body, result.motion, result.model.book
    impulse, moment = 2 * book.impulse[1], -2 * book.impulse[2]
    start = result.model.start[0][result.view.places]
    centre = result.view.mass @ start / result.view.mass.sum()
    impact = scene.impact
    before = motion.inertia * impact.omega + motion.mass * (centre[2] * impact.v_t - centre[0] * impact.v_n)
    turned = 1e-4 * max(abs(moment), motion.inertia * abs(motion.Omega - impact.omega))
    # of a run that is not over only the modes are known
    ringing = sum(result.vibration_check or (result.flight.energy,))
    accounted = (motion.kinetic + ringing + result.accounts["contact_dissipation"]) / result.E_0
    checks = (
        Check("mass", "kg", motion.mass, rod.mass, 1e-6),
        Check("normal momentum gained", "N s", motion.mass * (motion.V_n - impact.v_n), impulse, SMALL),
        Check("tangential velocity", "m/s", motion.V_t, impact.v_t, SMALL * p["v_n"], "absolute"),
        Check("angular momentum gained", "N m s", motion.spin - before, moment, turned, "absolute"),
        Check("energy kept / E_0", "1", accounted, 1.0, 2e-5 if result.vibration_check else 5e-4, "absolute"),
        Check("energy ledger / E_0", "1", result.worst / result.E_0, 0.0, 1e-5, "at most"),
    )
    return Solved(checks, result.steps, len(result.model.geometry.rod.mesh.cells))
