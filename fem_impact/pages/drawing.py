"""The projectile of a case as a picture: its section, or its mesh."""

from pathlib import Path

from fem_impact.case.case import Case
from fem_impact.figures.outline import draw, draw_mesh
from fem_impact.figures.still import WIDTH
from rigid import Faceted


def draw_projectile(case: Case, path: Path, width: float = WIDTH) -> None:
    """Draw a projectile with its materials, first contact and mass centre into a .png or .svg file.

    ``width`` is that of the picture, inches.

    A mesh is drawn with its cells, and its tip as the barrier sees it.

    Raises
    ------
    OutputPathError
        The place cannot be written.
    """
    rod, body, touch = case.scene.projectile, case.bodies.body, case.contact.touch_point
    if rod.own_mesh is not None:
        names = [material.name for material in rod.materials]
        assert isinstance(body, Faceted), "a mesh has facets"
        draw_mesh(rod.own_mesh.half(), (body.x_c, body.z_c), touch, rod.cell_materials(), names, path, width)
        return
    parts = [(part.to, part.material.name) for part in rod.segments]
    draw(body, touch, parts or [(body.length, rod.material.name)], path, width)
