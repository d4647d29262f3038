"""Refuse what a fidelity does not hold of barriers that turn, and of bodies that strike more than once."""

from fem_impact.case.effects.slots import ModelSpec
from fem_impact.errors import SceneError
from fem_impact.scene.barrier import Barrier
from fem_impact.scene.impact import FIRST, Following
from fem_impact.scene.types import Scene


def require_still(barrier: Barrier, fidelity: str) -> None:
    """Refuse a barrier that turns where a fidelity has none (SceneError)."""
    if barrier.inertia is not None and fidelity == "rigid":
        raise SceneError(
            "lets the barrier turn, which the rigid fidelity does not hold.",
            key="barrier.inertia",
            value=f"{barrier.inertia:.3g} kg m2",
            remedy="Use the fidelity modal or solid, or leave out inertia and centre_depth.",
        )


def require_followed(scene: Scene) -> None:
    """Refuse to follow more than the first impact where later strikes do not know what acts (SceneError).

    That is a barrier which nothing holds, and friction that changes with the sliding speed or the place.
    """
    if scene.impact.until == FIRST:
        if scene.strikes != Following():
            problem = "says how a body is followed, but the scene asks for the first impact alone."
            raise SceneError(problem, key="strikes", remedy='Add until = "rest" to impact, or leave it out.')
        return
    if scene.surface.sliding_law is not None:
        raise SceneError(
            "changes friction with the sliding speed, which strikes after the first do not know.",
            key="surface.sliding_law",
            remedy='Leave it out, or use until = "first".',
        )
    if faces := scene.projectile.faces:
        raise SceneError(
            "gives a part of the projectile its own friction, but strikes after the first know one alone.",
            key=f"projectile.mesh_surfaces.{faces[0].name}",
            value=faces[0].surface.state,
            remedy='Leave mesh_surfaces out, or use until = "first".',
        )
    if scene.barrier.mass is not None:
        raise SceneError(
            "follows a body that comes back to a barrier which the first impact has set moving, and nothing "
            "is known of what holds or stops that.",
            key="impact.until",
            value=scene.impact.until,
            remedy='Leave out barrier.mass, so that the barrier stands, or use until = "first".',
        )


def require_carried(scene: Scene, slots: ModelSpec) -> None:
    """Refuse finite elements over several strikes where what one leaves is not handed on (SceneError)."""
    (_, count), *_ = scene.strikes.stages("solid")
    if scene.impact.until == FIRST or count == 1:
        return
    obstacles = {
        "a rod without vibration, whose nose alone is meshed": not slots.vibrating,
        "a viscous rod, whose cells remember their strains": slots.contact_loss is not None,
        "a plate that bends and still swings": scene.barrier.bends,
    }
    what = next((what for what, holds in obstacles.items() if holds), "")
    if what:
        raise SceneError(
            f"asks finite elements for more than the first strike of {what}.",
            key="strikes.fidelity",
            value=scene.strikes.fidelity,
            remedy='Write "solid for the first 1, then modal" or "solid for the first 1, then rigid".',
        )
