"""Simulate a scene as a user asks for it: on levels of meshes, on one mesh, or without a mesh."""

from dataclasses import replace

from fem_impact.answers.refine.chain import BUDGET, LevelChain
from fem_impact.answers.refine.forecast import OverBudgetError
from fem_impact.answers.refine.level_meshes import LevelMeshes
from fem_impact.case.case import Case
from fem_impact.case.size import SETUP
from fem_impact.errors import FemImpactError, SceneError
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import Unknown, or_none
from fem_impact.outcome.record import Outcome
from fem_impact.progress import watched
from fem_impact.run import simulate as run
from fem_impact.scene.types import Scene, require_scene
from fem_impact.tables.text import plain, with_band

SPARE = 0.1  # of a budget that is used up, that the modes of the reduced model may still take
TOLD = {"e": "e_edge", "mu": "mu", "E_vib/E_0": "E_vib_over_E_0"}
"""Numbers, by the key of an outcome, that are told without a mesh where a budget holds none."""


def compiled(scene: Scene, fidelity: str) -> Case:
    """Return the case of a scene, after all that can be refused before any work.

    Raises
    ------
    UsageError, SceneError
        As `Case.of`, of levels that of the first one; or a wanted error is asked of a model without a mesh.
    """
    if not on_levels(scene, fidelity):
        _require_mesh(scene, fidelity)
        return Case.of(scene, fidelity)
    case = Case(scene)
    _ = LevelMeshes.of(case).pilot
    if scene.accuracy.tip_size is not None:
        case.require_memory()  # of the last level, whose cells are stated
    return case


def refused_by(scene: Scene, fidelity: str) -> str:
    """Return why a fidelity refuses a scene, nothing where it answers it."""
    try:
        compiled(scene, fidelity)
    except SceneError as error:
        return str(error)
    return ""


def on_levels(scene: Scene, fidelity: str) -> bool:
    """Say whether a scene runs on several meshes."""
    return fidelity == "solid" and (scene.accuracy.levels > 1 or scene.accuracy.target is not None)


def _require_mesh(scene: Scene, fidelity: str) -> None:
    if scene.accuracy.target is not None:
        raise SceneError(
            f"is asked of the {fidelity} model, which has no mesh to refine.",
            key="accuracy",
            value=f"{100 * scene.accuracy.target:.3g} %",
            remedy="Leave out the fidelity for finite elements, or the wanted error.",
        )


def simulate(
    scene: Scene,
    fidelity: str | None = None,
    options: RunOptions = RunOptions(),
    workers: int = 1,
    budget_s: float | None = None,
    case: Case | None = None,
    read_s: float = 0.0,
) -> Outcome:
    """Compute an impact.

    Finite elements run on levels from coarse to fine (`LevelChain`), as many as the scene asks for or, where
    it states an error instead, until the bands of e and of the vibration energy are as narrow; not longer
    than about ``budget_s``, s of wall time (ten minutes unless stated). The outcome is that of the finest
    level with the limits and bands of all; files of the others stand below ``options.out``. With two
    ``workers`` a second process runs each level at the second place of the barrier's grid. ``case`` is what
    `compiled` returned for this scene, where the caller has it; ``read_s``, s, is what reading it took of the
    budget.

    Raises
    ------
    UsageError, SceneError, OutputPathError, ResultError, RunError
        As `fem_impact.run.simulate.simulate`; or a wanted error is asked of a model without a mesh; or the
        budget does not hold the first level, with what the models without a mesh say.

    Examples
    --------
    >>> from fem_impact.scene.shipped import load
    >>> outcome = simulate(load("t5b"), "rigid")
    >>> outcome.told("e_edge"), outcome.told("Omega_rad_per_s")
    ('0.306', '7.75')
    """
    require_scene(scene)
    fidelity = fidelity or scene.strikes.first
    with watched(options.progress) as progress:
        options = replace(options, progress=progress)
        if on_levels(scene, fidelity):
            budget = BUDGET if budget_s is None else budget_s
            try:
                return LevelChain(case or Case(scene), options, budget, workers, read_s=read_s).run()
            except OverBudgetError as late:
                said = _without_mesh(scene, SPARE * budget)
                raise OverBudgetError(f"{late} {said}", late.enough_s) from None
        _require_mesh(scene, fidelity)
        return run.simulate(scene, fidelity, options, case)


def _without_mesh(scene: Scene, spare_s: float) -> str:
    """Return what the reduced model says, or rigid theory where that takes more than ``spare_s``, s."""
    scene = scene.untargeted.first_impact
    for fidelity, model in (("modal", "the reduced model"), ("rigid", "rigid theory")):
        try:
            if fidelity == "modal" and SETUP * Case(scene).size.rod > spare_s:
                continue
            outcome = run.simulate(scene, fidelity)
        except FemImpactError:
            continue
        numbers = []
        for name, key in TOLD.items():
            value, half = outcome.estimate(key)
            if not isinstance(value, Unknown):
                numbers.append(f"{name} = {plain(value) if half is None else with_band(value, half)}")
        error = "" if or_none(outcome.half_widths) else ", of unknown error"
        return f"Without a mesh, {model} says{error}: {', '.join(numbers)} (fidelity {fidelity})."
    return "No model without a mesh holds the scene."
