"""The scenes on the page about own projectiles are complete and can be planned in each fidelity."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

from fem_impact.case.case import Case
from fem_impact.scene.read import read_dict
from fem_impact.scene.shapes import NEEDS

PAGE = (Path(__file__).parents[2] / "docs/how-to/own-projectile.md").read_text()
SCENES = [tomllib.loads(block) for block in re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)]


@pytest.mark.parametrize("data", SCENES, ids=lambda data: data["id"])
def test_a_scene_of_the_page_is_valid(data):
    for fidelity in ("rigid", "modal", "solid"):
        assert Case.of(read_dict(data), fidelity).scene.id == data["id"]


def test_the_page_names_every_shape_and_its_sizes():
    assert len(SCENES) == 5
    for shape, sizes in NEEDS.items():
        row = next(line for line in PAGE.splitlines() if line.startswith(f"| `{shape}`"))
        assert all(size in row for size in sizes if size not in ("length", "diameter"))
