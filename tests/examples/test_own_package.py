"""A package of the user's own adds a material, a tip and an effect by entry points."""

import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

OWN = Path(__file__).parent / "own_package"
SCENE = """
import json
import fem_impact
from fem_impact.scene.library import source_of
changes = {"projectile.material": "al-6082-t6", "projectile.tip": "ball", "projectile.tip_radius": "9.5 mm"}
scene = fem_impact.replace_all(fem_impact.load("t5b"), {**changes, "effects": ["auto", "lunar-gravity"]})
outcome = fem_impact.simulate(scene, "rigid")
print(json.dumps({
    "rho": scene.projectile.material.rho,
    "source": source_of("al-6082-t6", "E"),
    "effects": fem_impact.Case.of(scene).active,
    "gravity": fem_impact.Case.of(scene).slots.gravity,
    "mass": outcome.motion.mass,
    "versions": dict(outcome.provenance.versions),
}))
"""


def installed(place, entries=None):
    """Write what an installer leaves of the package, with other entry points where they are given."""
    stated = tomllib.loads((OWN / "pyproject.toml").read_text())["project"]
    groups = entries or stated["entry-points"]
    (place / "my_impact_parts.py").write_text((OWN / "my_impact_parts.py").read_text())
    info = place / "my_impact_parts-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {stated['name']}\nVersion: 1.0\n")
    lines = [
        f"[{group}]\n" + "\n".join(f"{k} = {v}" for k, v in names.items()) for group, names in groups.items()
    ]
    (info / "entry_points.txt").write_text("\n".join(lines) + "\n")
    return {**os.environ, "PYTHONPATH": str(place)}


def run(code, env, words=("-c",)):
    return subprocess.run(
        [sys.executable, *words, code], capture_output=True, text=True, env=env, check=False
    )


def test_a_scene_uses_what_the_package_adds(tmp_path):
    done = run(SCENE, installed(tmp_path))
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["rho"] == 2700.0
    assert found["source"] == "certificate of the bar"
    assert "lunar-gravity" in found["effects"] and found["gravity"] == 1.62
    assert 0.05 < found["mass"] < 0.06  # of aluminium, with a hemisphere
    assert found["versions"]["my-impact-parts"] == "1.0"


def test_without_the_package_its_names_are_refused():
    done = run(SCENE, dict(os.environ))
    assert "is a shape, not one of the published tips" in done.stderr


@pytest.mark.parametrize(
    ("group", "entry", "words"),
    [
        ("fem_impact.materials", {"rod-steel": "my_impact_parts:ALUMINIUM"}, "already taken"),
        ("fem_impact.materials", {"tin": "my_impact_parts:MOON"}, "is no table of a material"),
        ("fem_impact.materials", {"tin": "my_impact_parts:TIN"}, "cannot be imported"),
        ("fem_impact.effects", {"moon": "my_impact_parts:LUNAR_GRAVITY"}, "is no Effect of that name"),
    ],
)
def test_what_cannot_be_added_is_refused_with_the_package_named(tmp_path, group, entry, words):
    code = "import sys\nfrom fem_impact.cli.main import main\nsys.exit(main(['check', 't5b']))"
    done = run(code, installed(tmp_path, {group: entry}))
    assert done.returncode == 2, done.stderr
    assert words in done.stderr
    assert "my-impact-parts" in done.stderr
