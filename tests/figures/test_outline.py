"""The drawing of a projectile: what stands where, to scale, and what is refused."""

import re

import numpy as np
import pytest
from own_bodies import box, write

from fem_impact.case.case import Case
from fem_impact.figures.outline import draw
from fem_impact.figures.outline import drawn as in_words
from fem_impact.figures.still import new_figure
from fem_impact.scene.shipped import load, replace, replace_all
from rigid import Turned


def drawn(monkeypatch, tmp_path, name):
    """Return the axes of a scene's drawing."""
    kept = []
    monkeypatch.setattr(
        "fem_impact.figures.still.new_figure", lambda *size: kept.append(new_figure(*size)) or kept[0]
    )
    scene = load(name)
    body, rod = scene.projectile.rigid_body, scene.projectile
    parts = [(part.to, part.material.name) for part in rod.segments] or [(body.length, rod.material.name)]
    draw(body, Case(scene).contact.touch_point, parts, tmp_path / "a.svg")
    return kept[0].axes[0], body, scene


def filled(axes):
    """Area, mm2, of each filled part."""
    found = []
    for part in axes.collections:
        x, y = part.get_paths()[0].vertices.T
        found.append(0.5 * abs(np.dot(x, np.roll(y, 1)) - np.dot(y, np.roll(x, 1))))
    return found


def test_a_tube_is_drawn_with_its_bore_contact_and_mass_centre(monkeypatch, tmp_path):
    axes, body, scene = drawn(monkeypatch, tmp_path, "tube")
    assert isinstance(body, Turned)
    z = np.linspace(0.0, body.length, 4000)[1:-1]
    wall = np.trapezoid(body.radius(z) - body.inner_radius(z), z) * 1e6
    assert filled(axes) == pytest.approx([wall, wall], rel=2e-3)
    marks = {line.get_label(): line.get_xydata()[0] for line in axes.lines}
    rho, place = Case(scene).contact.touch_point
    assert marks["touches first"] == pytest.approx([1e3 * place, -1e3 * rho])
    assert marks["mass centre"] == pytest.approx([1e3 * body.z_c, 0.0])
    assert axes.get_aspect() == 1.0


def test_a_bent_mesh_is_drawn_as_it_is_bent(tmp_path):
    """Towards x > 0, which is drawn below: the tip lies in the highest row, the tail in the lowest."""
    points, cells = box(2, 1, 10, (-3e-3, 0.0, 0.0), (3e-3, 3e-3, 0.1))
    points[:, 0] += 0.03 * points[:, 2] / 0.1
    write(tmp_path / "bent.vtu", points, cells)
    rod = {"mesh": tmp_path / "bent.vtu", "mesh_unit": "m", "material": "rod-steel"}
    body = replace(load("t5b"), "projectile", rod).projectile.rigid_body
    lines = in_words(body, body.touch(0.5)[:2])
    assert lines[0].startswith("  #") and lines[0].count("#") < 20
    assert lines[-1].startswith(" " * 40) and "o" in "".join(lines)


def test_a_long_rod_is_drawn_with_a_break_that_hides_nothing(monkeypatch, tmp_path):
    axes, body, _ = drawn(monkeypatch, tmp_path, "tungsten-rod")
    tip, tail = axes.figure.axes
    assert tip.get_xlim()[1] == pytest.approx(5e3 * body.diameter)
    assert tail.get_xlim()[0] == pytest.approx(1e3 * body.length - 5e3 * body.diameter)
    assert f"mass centre, {1e3 * body.z_c:.4g} mm from the tip" in (tmp_path / "a.svg").read_text(
        encoding="utf-8"
    )
    whole, _, _ = drawn(monkeypatch, tmp_path, "heavy-tail")  # 6 diameters
    assert len(whole.figure.axes) == 1


def test_each_material_has_its_colour(monkeypatch, tmp_path):
    axes, _, scene = drawn(monkeypatch, tmp_path, "heavy-tail")
    colours = [tuple(part.get_facecolor()[0]) for part in axes.collections]
    assert colours[0] == colours[1] != colours[2] == colours[3]
    svg = (tmp_path / "a.svg").read_text(encoding="utf-8")
    for name in (part.material.name for part in scene.projectile.segments):
        assert name in re.sub(r"<!--\s*|\s*-->", "|", svg)


@pytest.mark.parametrize("name", ["t5b.svg", "t5b.png"])
def test_check_writes_the_drawing(cli, tmp_path, name):
    code, out, _ = cli("check", "t5b", "--drawing", name)
    assert code == 0 and out.endswith(f"drawing: {name}\n")
    assert (tmp_path / name).stat().st_size > 1000


def test_another_format_is_refused_before_any_work(cli, tmp_path):
    code, out, err = cli("check", "t5b", "--drawing", "t5b.pdf")
    assert (code, out) == (2, "") and "projectile.svg" in err
    assert not list(tmp_path.iterdir())


def test_a_mesh_is_drawn_with_its_cells_and_its_materials(cli, tmp_path):
    from own_bodies import taper

    write(tmp_path / "bar.vtu", *taper(end=0.9))
    (tmp_path / "own.toml").write_text(
        'id = "own"\n'
        'projectile = { mesh = "bar.vtu", material = "rod-steel" }\n'
        'barrier = { material = "plate-steel" }\n'
        'surface = { state = "custom", friction = 0.2, source = "assumed" }\n'
        'impact = { angle = "30 deg", speed = "2 m/s" }\n'
    )
    picture = tmp_path / "bar.svg"
    code, out, _ = cli("check", str(tmp_path / "own.toml"), "--picture", str(picture))
    assert code == 0
    assert f"drawing: {picture}" in out
    assert "the mesh is taken as a half of a body that is symmetric about y = 0" in out
    # 40 cells in the plane of symmetry, and 8 facets of the tip with their mirror images
    assert picture.read_text().count("<path") > 56


def test_walls_of_a_tube_are_drawn_however_thin():
    sharp = {"projectile.tip": "plain", "projectile.tip_radius": "0 mm"}
    scene = replace_all(load("tube"), sharp | {"projectile.inner_diameter": "17.5 mm"})
    upper, axis, lower = in_words(scene.projectile.rigid_body, Case(scene).contact.touch_point)
    assert upper.count("#") > 60 and not axis.strip() and lower.count("#") > 60
