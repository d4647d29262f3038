"""The ladder of settings: fidelities, meshes, pairs of meshes, elements and steps, and effects left out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

from fem_impact.scale import Job
from fem_impact.scene import replace_all
from fem_impact.scene.effect_names import BARRIERS, grounded

if TYPE_CHECKING:
    from fem_impact.scene import Scene
    from fem_impact.scene.fields import Element

__all__ = ["FAMILY", "Mesh", "Setting", "ladder", "on_mesh"]

Kind = Literal["rigid", "modal", "mesh", "pair", "numerics", "effect"]


@dataclass(frozen=True, slots=True, order=True)
class Mesh:
    """Cells over the diameter of the body, and how often they are split at the tip.

    ``element`` and ``step`` are those of `Accuracy` where they are not the scene's own.
    """

    across: int
    levels: int
    element: Element | None = None
    step: float | None = None

    def tip_size(self, diameter: float) -> float:
        """Return the element size at the tip, m."""
        return float(diameter / self.across / 2**self.levels)


# meshes whose cells are split as often; cells at the tip are alike only where a mesh is split once more
FAMILY = (Mesh(6, 3), Mesh(8, 3), Mesh(10, 3))
COARSE = (Mesh(6, 2), Mesh(8, 2))  # the family's own bodies with tips of twice the size
PLAIN = Mesh(8, 2)  # the mesh on which elements, steps and effects are changed
NUMERICS = {
    "fully integrated": replace(PLAIN, element="full"),
    "mean dilatation": replace(PLAIN, element="bbar"),
    "with half the default step": replace(PLAIN, step=0.45),
}


@dataclass(frozen=True, slots=True)
class Setting:
    """One way to compute a scene.

    Attributes
    ----------
    name, kind : str
    scene : the scene as it is run; None for a pair, which runs nothing itself
    fidelity : str
    mesh : of a solid run; of a pair its finer mesh
    coarser : the second mesh of a pair
    """

    name: str
    kind: Kind
    fidelity: str
    scene: Scene | None = None
    mesh: Mesh | None = None
    coarser: Mesh | None = None

    @property
    def job(self) -> Job | None:
        """Return the run that this setting needs of its own."""
        if self.scene is None:
            return None
        return Job(f"{self.scene.id}: {self.name}", self.scene, self.fidelity)


def ladder(scene: Scene, family: Sequence[Mesh] = FAMILY) -> list[Setting]:
    """Return the settings from cheap to dear; ``family`` from coarse to fine."""
    scene = replace_all(scene, {"save.frames": 0})
    found = [Setting(kind, kind, kind, scene) for kind in ("rigid", "modal")]
    found += [_solid(scene, mesh) for mesh in (*COARSE, *family)]
    found += [_pair(scene, fine, coarse) for fine, coarse in _pairs(family)]
    found += [_solid(scene, mesh, words) for words, mesh in NUMERICS.items()]
    return found + _without(on_mesh(scene, PLAIN))


def on_mesh(scene: Scene, mesh: Mesh) -> Scene:
    """Return the scene on a mesh."""
    size = mesh.tip_size(scene.projectile.diameter)
    changes: dict[str, Any] = {"across": mesh.across, "tip_size": f"{size * 1e3:.9g} mm"}
    changes |= {"element": mesh.element} if mesh.element else {}
    changes |= {"step": mesh.step} if mesh.step else {}
    return replace_all(scene, {f"accuracy.{key}": value for key, value in changes.items()})


def _pairs(family: Sequence[Mesh]) -> list[tuple[Mesh, Mesh]]:
    """Return fine and coarse: of the family each with each, and each with its own half as fine tip."""
    both = [(family[j], family[i]) for i in range(len(family)) for j in range(i + 1, len(family))]
    halved = [(mesh, replace(mesh, levels=mesh.levels - 1)) for mesh in family]
    return [pair for pair in halved if pair[1] in COARSE] + both


def _solid(scene: Scene, mesh: Mesh, words: str = "") -> Setting:
    size = mesh.tip_size(scene.projectile.diameter)
    name = f"solid {size * 1e3:.3g} mm {words}".strip()
    return Setting(name, "numerics" if words else "mesh", "solid", on_mesh(scene, mesh), mesh)


def _pair(scene: Scene, fine: Mesh, coarse: Mesh) -> Setting:
    sizes = " and ".join(f"{m.tip_size(scene.projectile.diameter) * 1e3:.3g}" for m in (coarse, fine))
    return Setting(f"solid {sizes} mm extrapolated", "pair", "solid", None, fine, coarse)


def _without(scene: Scene) -> list[Setting]:
    """Return the scene with each effect left out that can be, and with a simpler barrier."""
    size = f"{scene.accuracy.tip_size * 1e3:.3g} mm"
    optional = [name for name in scene.active if name not in BARRIERS]
    fewer = {f"without {name}": grounded([e for e in scene.active if e != name]) for name in optional}
    if "barrier-elastoplastic" in scene.active:
        softer = ["barrier-elastic" if e == "barrier-elastoplastic" else e for e in scene.active]
        fewer["with an elastic barrier"] = grounded(softer)
    return [
        Setting(f"solid {size} {words}", "effect", "solid", replace_all(scene, {"effects": names}), PLAIN)
        for words, names in fewer.items()
    ]
