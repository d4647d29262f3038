"""A package of the user's own adds a material, a tip, a law of friction and effects by entry points."""

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
case = fem_impact.Case.of(scene)
print(json.dumps({
    "rho": scene.projectile.material.rho,
    "source": source_of("al-6082-t6", "E"),
    "effects": case.active,
    "gravity": case.slots.gravity,
    "mass": case.bodies.body.mass,
}))
"""

COARSE = """
import json
import fem_impact
from fem_impact.errors import FemImpactError
COARSE = {
    "accuracy.tip_size": "1.6 mm", "accuracy.across": 6, "accuracy.levels": 1,
    "accuracy.unresolved": "report", "projectile.length": "60 mm",
}
def run(fidelity, *effects, **changes):
    scene = fem_impact.replace_all(fem_impact.load("quick"), {**COARSE, "effects": [*effects], **changes})
    try:
        outcome = fem_impact.simulate(scene, fidelity)
    except FemImpactError as error:
        return type(error).__name__ + " " + str(error)
    origin = outcome.provenance
    return {"V_n": outcome.motion.V_n, "mu": outcome.restitution.mu, "residual": outcome.energy.residual,
            "effects": origin.effects, "versions": dict(origin.versions)}
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


FIDELITY_RUNS = (
    COARSE
    + """
base = ["vibration", "barrier-rigid"]
found = {
    (fidelity, name): run(fidelity, *base, name) for fidelity in ("rigid", "modal", "solid")
    for name in ("lunar-gravity", "magnet")
}
found |= {(fidelity, ""): run(fidelity, *base) for fidelity in ("modal", "solid")}
found |= {
    (fidelity, "waxed"): run(fidelity, *base, "friction", **{"surface.sliding_law": "waxed"})
    for fidelity in ("rigid", "modal", "solid")
}
print(json.dumps([[*key, value] for key, value in found.items()]))
"""
)


@pytest.mark.long
def test_each_fidelity_computes_what_is_added_or_refuses_it(tmp_path):
    done = run(FIDELITY_RUNS, installed(tmp_path))
    assert done.returncode == 0, done.stderr
    found = {(fidelity, name): value for fidelity, name, value in json.loads(done.stdout)}
    refused = {("rigid", "lunar-gravity"), ("rigid", "magnet"), ("modal", "magnet")}
    assert {key for key, value in found.items() if isinstance(value, str)} == refused
    for fidelity, name in refused:
        told = found[fidelity, name]
        assert told.startswith("SceneError") and f'effects = "{name}"' in told
        assert f"not computed by the fidelity {fidelity}" in told and "Use fidelity" in told
    for key in set(found) - refused:
        assert abs(found[key]["residual"]) < 1e-4
        assert key[1] == "waxed" or found[key]["effects"][2:] == ([key[1]] if key[1] else [])
        assert found[key]["versions"]["my-impact-parts"] == "1.0"
    pulled = found["solid", ""]["V_n"] - found["solid", "magnet"]["V_n"]
    assert 0.005 < pulled < 0.2  # 50 N on 0.13 kg over some 0.1 ms of contact: about 0.04 m/s
    for fidelity in ("rigid", "modal", "solid"):
        assert 0.57 / 2 < found[fidelity, "waxed"]["mu"] < 0.45  # half of .57 at high speeds, .57 at rest
    for fidelity in ("modal", "solid"):
        assert found[fidelity, "lunar-gravity"]["V_n"] != found[fidelity, ""]["V_n"]


@pytest.mark.long
def test_what_a_scene_does_not_name_changes_nothing_in_it(tmp_path):
    code = """
import fem_impact
scene = fem_impact.replace_all(fem_impact.load("quick"), {"impact.v_n": "-5 mm/s", "impact.v_t": "-5 mm/s"})
case = fem_impact.Case.of(scene)
print(case.active, case.choices, case.limitations, case.slots)
"""
    bare, added = (run(code, env) for env in (dict(os.environ), installed(tmp_path)))
    assert bare.returncode == 0, bare.stderr
    assert bare.stdout == added.stdout  # though the Moon's number is above its threshold


def test_the_command_lists_what_packages_add_and_what_computes_it(tmp_path):
    code = "import sys\nfrom fem_impact.cli.main import main\nsys.exit(main(['scenes', '--added', '--json']))"
    done = run(code, installed(tmp_path))
    listed = {row["name"]: (row["kind"], row["fidelities"]) for row in json.loads(done.stdout)["added"]}
    every = ["rigid", "modal", "solid"]
    assert listed == {
        "al-6082-t6": ("materials", every),
        "ball": ("shapes", every),
        "waxed": ("friction_laws", every),
        "lunar-gravity": ("effects", ["modal", "solid"]),
        "magnet": ("effects", ["solid"]),
    }


@pytest.mark.long
@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("fidelities=('rigid',)", "fills gravity, which the fidelity rigid"),
        ("fill=lambda bodies, spec: None", "fills no slot and adds no item"),
        ("forces=lambda builder: []", "adds items of the finite elements"),
    ],
)
def test_an_effect_that_would_change_nothing_is_refused(tmp_path, change, words):
    env = installed(tmp_path)
    module = tmp_path / "my_impact_parts.py"
    module.write_text(
        module.read_text()
        + f"\nfrom dataclasses import replace\nLUNAR_GRAVITY = replace(LUNAR_GRAVITY, {change})\n"
    )
    fidelity = "rigid" if "fidelities" in change else "modal"
    done = run(COARSE + f"print(run({fidelity!r}, 'auto', 'lunar-gravity'))", env)
    assert done.stdout.startswith("UsageError") and words in done.stdout, done.stdout + done.stderr
    assert "my-impact-parts" in done.stdout


def test_without_the_package_its_names_are_refused():
    done = run(SCENE, dict(os.environ))
    assert "is a shape, not one of the published tips" in done.stderr


@pytest.mark.long
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
