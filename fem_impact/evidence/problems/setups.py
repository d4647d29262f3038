"""What many problems share: parameters (the study's rod steel by default), scenes, runs, their observers."""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import meshio
import numpy as np

from fem_impact import Case, Scene
from fem_impact.errors import RunError
from fem_impact.evidence.problems.problem import Values, within
from fem_impact.fem.flight import RigidMotion, rigid_motion
from fem_impact.scene.barrier import Barrier
from fem_impact.scene.fields import Element
from fem_impact.scene.impact import Impact
from fem_impact.scene.material import Material, Surface
from fem_impact.scene.own_mesh import OwnMesh
from fem_impact.scene.projectile import ProjectileSpec
from fem_impact.scene.shapes import NamedShape
from fem_impact.scene.types import Accuracy, Save
from fem_impact.solid.build import build
from fem_impact.solid.ledger import Ledger
from fem_impact.solid.march import march
from fem_impact.solid.model import Model
from fem_impact.solid.state import State
from fem_impact.solid.stepguard import SMALLEST, StepGuard
from meshes import HexMesh

WIDER = 1.2  # a nose draws the cells where it touches apart, by so much with 8 of them across
COARSE = 0.249  # of a bar's width: so large a tip size leaves its cells whole
NEAREST = 2**0.4  # cells are halved to the size nearest to the stated one, which is to be nearly the largest


def slender(p: Values, across: str, low: float, high: float) -> None:
    """Refuse a length that is not ``low`` to ``high`` times a size across the body.

    Raises
    ------
    SceneError
        If the body is too stubby or too slender.
    """
    within(p, "length", low * p[across], high * p[across], "m", f"{low:g} to {high:g} times the {across}.")


def steel(p: Values) -> Material:
    """Return the elastic material of a problem's E, nu and rho."""
    return Material("problem", p["E"], p["nu"], p["rho"])


def problem_scene(
    projectile: ProjectileSpec,
    barrier: Barrier,
    effects: tuple[str, ...],
    impact: Impact,
    accuracy: Accuracy,
    f: float = 0.0,
) -> Scene:
    """Return the scene of a problem."""
    surface = Surface("custom", f, f, f, "a problem of the verification")
    title = "a problem of the verification"
    save = Save(frames=0)
    return Scene("verify", title, projectile, barrier, surface, impact, effects, accuracy, save)


def fine_tip(touch: float, cells: float) -> float:
    """Return the ``tip_size``, m, with which so many cells lie over a contact radius ``touch``, m."""
    return touch / (cells * WIDER * NEAREST)


def ball(p: Values, metal: Material) -> ProjectileSpec:
    """Return the ball of a problem's radius."""
    return ProjectileSpec.turned(NamedShape("ball", (2 * p["radius"],)), metal)


def scene_model(scene: Scene) -> Model:
    """Return the model that a user's run of a scene marches."""
    return build(Case.of(scene))


def falling(
    body: ProjectileSpec, barrier: Barrier, effects: tuple[str, ...], speed: float, **accuracy: Any
) -> Model:
    """Return the model of a scene's body that vibrates and falls along the normal at a speed, m/s.

    ``accuracy`` are keys of `Accuracy`; no small element is made heavier.
    """
    mesh = Accuracy(mass_scaling=1.0, **accuracy)
    drop = Impact(0.0, -speed, 0.0)
    return scene_model(problem_scene(body, barrier, ("vibration", *effects), drop, mesh))


def meshed_bar_model(
    p: Values,
    half: HexMesh,
    impact: Impact,
    effects: tuple[str, ...],
    f: float = 0.0,
    element: Element = "incompatible",
) -> Model:
    """Return the model of a scene with a bar's mesh of its own, half of it, which touches at time 0."""
    accuracy = Accuracy(tip_size=COARSE * float(np.ptp(half.points[:, 0])), mass_scaling=1.0, element=element)
    with TemporaryDirectory() as folder:
        path = Path(folder) / "bar.vtu"
        meshio.write(path, meshio.Mesh(half.points, [("hexahedron", half.cells)]))
        bar = ProjectileSpec.meshed(OwnMesh.of(str(path)), steel(p))
        scene = problem_scene(bar, Barrier(steel(p)), ("vibration", *effects), impact, accuracy, f)
        return build(Case.of(scene), gap=0.0)


def rod_scene(p: Values, effects: tuple[str, ...]) -> Scene:
    """Return the scene of a rod with a rounded edge; absent values are those of a frictionless drop.

    Used are length, diameter, tip_radius, E, nu, rho, barrier_E, angle, v_n, v_t (approach speeds above 0),
    omega, f, tip_size, across, max_time.
    """
    rod = steel(p)
    return problem_scene(
        ProjectileSpec(p["length"], p["diameter"], "B", p["tip_radius"], rod),
        Barrier(steel({**p, "E": p.get("barrier_E", p["E"])})),
        effects,
        Impact(p["angle"], -p["v_n"], -p["v_t"], p.get("omega", 0.0)),
        Accuracy(tip_size=p["tip_size"], across=int(p["across"]), max_time=p["max_time"]),
        p.get("f", 0.0),
    )


def rigid_of(model: Model, state: State) -> RigidMotion:
    """Return the rigid part of the body's motion."""
    places = model.layout.rod[~model.geometry.rod.mesh.is_hanging]
    return rigid_motion(state.x[places], state.v[places], model.mass[places[:, 0]])


SMOOTHING = 0.05  # window of the peak force over the contact time
MECHANICAL = ("kinetic_rod", "strain_rod", "kinetic_barrier", "strain_barrier")


class Recorder:
    """Records a number of the state until a time, s; none where ``sample`` gives None.

    It was so ``back`` steps before the state's time: velocities, forces half a step before positions.
    """

    def __init__(
        self, sample: Callable[[State], float | None], back: float = 0.5, end: float = inf, every: int = 1
    ) -> None:
        self.sample, self.back, self.end, self.every = sample, back, end, every
        self.times: list[float] = []
        self.values: list[float] = []

    def observe(self, state: State) -> bool:
        """Sample; stop at the end."""
        value = self.sample(state)
        if value is not None:
            self.times.append(state.time - self.back * state.dt)
            self.values.append(value)
        return state.time >= self.end

    @property
    def touches(self) -> int:
        """Return how often a force sets in after having been absent."""
        on = np.array(self.values) > 0
        return int((np.diff(np.concatenate([[0], on.astype(int)])) == 1).sum())

    @property
    def span(self) -> tuple[float, float]:
        """Return the times of the first and the last force, s."""
        on = np.flatnonzero(np.array(self.values) > 0)
        return self.times[int(on[0])], self.times[int(on[-1])]

    def mean(self, start: float, end: float, origin: float = 0.0) -> float:
        """Return the mean between two times after ``origin``, s."""
        t = np.array(self.times) - origin
        return float(np.array(self.values)[(t >= start) & (t <= end)].mean())

    def peak(self, window: float) -> float:
        """Return the largest value averaged over a window, s: single nodes close in small jerks."""
        t, y = np.array(self.times), np.array(self.values)
        width = max(1, round(window / float(np.diff(t).mean())))
        return float(np.convolve(y, np.ones(width) / width, "valid").max())

    def frequency(self) -> float:
        """Return the frequency from the first to the last zero crossing."""
        t, y = np.array(self.times), np.array(self.values)
        k = np.flatnonzero(np.sign(y[1:]) != np.sign(y[:-1]))
        crossing = t[k] - y[k] * (t[k + 1] - t[k]) / (y[k + 1] - y[k])
        return float((len(k) - 1) / (2 * (crossing[-1] - crossing[0])))


def force_recorder(model: Model) -> Recorder:
    """Return a recorder of the normal force, N, of the whole body over the step that led to each state."""
    book = model.book
    return Recorder(lambda state: 2 * book.step.impulse_n / state.kick if state.step else None)


class Until:
    """Watches mechanical energy, or what ``names`` say, over that of the start, until a time or condition."""

    def __init__(
        self,
        ledger: Ledger,
        end: float,
        done: Callable[[], bool] = lambda: False,
        every: int = 10,
        names: tuple[str, ...] = MECHANICAL,
    ) -> None:
        self.ledger, self.end, self.done, self.every, self.names = ledger, end, done, every, names
        self.most = 0.0

    def observe(self, state: State) -> bool:
        """Sample; stop at the end."""
        accounts = self.ledger.sample(state)
        self.most = max(self.most, sum(accounts[name] for name in self.names) / self.ledger.start)
        return state.time >= self.end or self.done()


def follow(model: Model, state: State, until: Until, every: int, crushed: float = SMALLEST) -> None:
    """March a body that yields to its end, the step following its cells ``every`` so many steps.

    The run ends where the step falls below ``crushed`` of the first.

    Raises
    ------
    RunError
        If a cell folds or is crushed.
    """
    guard = StepGuard(model, every, crushed)
    march(model, state, [guard, until])
    if guard.reason:
        raise RunError(guard.reason)


@dataclass(frozen=True, slots=True)
class TipImpact:
    """End of a strike.

    Attributes
    ----------
    force, duration : largest force, N; contact time, s
    motion : rigid motion after it
    radiated, closing : energy that left through the block's boundary, and that closing nodes lost, J
    most : largest energy on the way over E_0
    """

    force: float
    duration: float
    motion: RigidMotion
    radiated: float
    closing: float
    most: float
    state: State

    def kept(self, speed: float) -> float:
        """Return the energy of the rebound and what was radiated over that of the approach at ``speed``."""
        return (self.motion.kinetic + self.radiated) / (0.5 * self.motion.mass * speed**2)


def run_strike(model: Model, end: float, expected: float) -> TipImpact:
    """March until ``end`` s and read the contact."""
    state, force = model.initial_state(), force_recorder(model)
    energy = Until(model.ledger(), end, every=20)
    march(model, state, [force, energy])
    start, stop = force.span
    peak = force.peak(SMOOTHING * expected)
    spent = energy.ledger.sample(state)
    motion = rigid_of(model, state)
    return TipImpact(
        peak, stop - start, motion, spent["radiated"], spent["contact_dissipation"], energy.most, state
    )
