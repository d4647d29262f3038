"""A dropped rod as a scene, and a scene as a dropped rod where the measured tests apply to it."""

from math import hypot
from typing import Any

from fem_impact.answers.verdict.drop import DENSITY, RodDropInput
from fem_impact.errors import SceneError
from fem_impact.scene.barrier import Barrier
from fem_impact.scene.impact import BESIDE, Impact
from fem_impact.scene.library import materials, surface, surfaces
from fem_impact.scene.projectile import ProjectileSpec
from fem_impact.scene.types import Scene
from rigid import GRAVITY, Projectile

ROD, PLATE = "rod-steel", "plate-steel"


def scene_of(case: RodDropInput) -> Scene:
    """Return the scene of a dropped rod of the measured steels."""
    steels, rod = materials(), case.rod
    v_n, v_t = case.velocity
    return Scene(
        id="dropped-rod",
        title=f"a steel rod dropped {case.height:g} m on a {case.surface} plate",
        projectile=ProjectileSpec(rod.length, rod.diameter, rod.tip, rod.tip_radius, steels[ROD]),
        barrier=Barrier(steels[PLATE]),
        surface=surface(case.surface),
        impact=Impact(case.alpha, v_n, v_t),
    )


def dropped(scene: Scene) -> RodDropInput:
    """Return the dropped rod that a scene states.

    Raises
    ------
    SceneError
        The measured tests do not apply: another shape, barrier, material or surface than theirs, spin, or a
        velocity that no fall along the axis has.
    """
    reason = _not_measured(scene)
    if reason:
        remedy = "Give a scene that is, such as t5b with another length, height or angle."
        raise SceneError(f"is not what the measured tests are about: {reason}.", key=scene.id, remedy=remedy)
    rod, impact = scene.projectile, scene.impact
    body = Projectile(rod.length, rod.diameter, rod.tip, rod.tip_radius, DENSITY)
    height = hypot(impact.v_n, impact.v_t) ** 2 / (2 * GRAVITY)
    return RodDropInput(body, height, abs(impact.angle), scene.surface.state)


def _not_measured(scene: Scene) -> str:
    steels, impact, known = materials(), scene.impact, surfaces().values()
    pairs: tuple[tuple[str, Any, Any], ...] = (
        ("rod", scene.projectile.material, steels[ROD]),
        ("barrier", scene.barrier.material, steels[PLATE]),
    )
    if not scene.projectile.is_rod:
        return "they are about solid rods with a tip"
    plate = scene.barrier
    if plate.bends or plate.mass is not None or plate.v_n or plate.v_t:
        return "they are about a massive plate at rest"
    for body, mine, measured in pairs:
        if mine != measured:
            return f"they are about a {body} of {measured.name}, not of {mine.name}"
    if scene.surface not in known:
        return f"they are about {', '.join(s.state for s in known)} surfaces, not {scene.surface.state} ones"
    if impact.omega or abs(impact.beside) > BESIDE:
        return "their rods fell along their axis without spin"
    return ""
