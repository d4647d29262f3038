"""Projectiles of which no mesh can be made are refused by the case, with remedies that work."""

from __future__ import annotations

import re
from dataclasses import replace
from time import process_time

import pytest

from fem_impact.answers.simulate import refused_by
from fem_impact.case.case import Case
from fem_impact.case.cells import body_cell
from fem_impact.case.mesh import _require_mesh
from fem_impact.errors import SceneError
from fem_impact.fem.geometry import build_geometry
from fem_impact.run.simulate import simulate
from fem_impact.scene.read import read_dict

ROD = {"length": "150 mm", "diameter": "16 mm", "material": "brass"}
TUBE = {**ROD, "tip": "plain", "bore": [["4 mm", "6 mm"], ["150 mm", "6 mm"]]}
CAPPED = {**ROD, "shape": "hemisphere", "bore": [["2 mm", "3 mm"], ["150 mm", "3 mm"]]}
ROUND = [["0 mm", "8 mm"], ["142 mm", "8 mm"], ["149 mm", "4 mm"], ["150 mm", "0 mm"]]
SHELL = {"material": "brass", "profile": ROUND, "bore": [["40 mm", "2 mm"], ["148 mm", "2 mm"]]}


def scene(projectile, angle=30, **accuracy):
    return read_dict(
        {
            "id": "tube",
            "projectile": projectile,
            "barrier": {"material": "plate-steel"},
            "surface": {"state": "machined"},
            "impact": {"angle": f"{angle} deg", "height": "0.5 m"},
            "accuracy": {"across": 8, **accuracy},
        }
    )


def mesh(stated):
    planned = Case.of(stated)
    return build_geometry(planned.bodies, planned.zones, 0.0, meshed_barrier=False).rod.mesh


@pytest.mark.parametrize(("angle", "across"), [(0, 8), (30, 6), (30, 8), (30, 10), (60, 8), (60, 10)])
def test_a_tube_closed_by_four_millimetres_is_meshed(angle, across):
    made = mesh(scene(TUBE, angle, across=across))
    inside = made.points[(abs(made.points[:, 2] - 4e-3) < 1e-9) & (abs(made.points[:, 0]) < 5e-3)]
    assert len(inside) > 8


@pytest.mark.parametrize("fault", ["tip", "tail"])
def test_a_bore_that_begins_in_a_rounding_is_refused_with_what_works(fault):
    body = CAPPED if fault == "tip" else SHELL
    number, z = (1, "2") if fault == "tip" else (2, "148")
    _require_mesh.cache_clear()
    begun = process_time()
    with pytest.raises(SceneError, match=rf'bore\[{number}\] = "z = {z} mm": cannot be meshed') as refused:
        Case.of(scene(body))
    assert process_time() - begun < 3.0  # .02 to .2 s on a free core
    found = re.search(r"Give z = (\S+ mm) there", refused.value.remedy)
    points = [list(row) for row in body["bore"]]
    points[number - 1][0] = found[1]
    assert len(mesh(scene({**body, "bore": points})).cells) > 100


def test_a_wall_that_is_thin_beside_its_cells_is_refused_with_cells_that_work():
    thin = {**TUBE, "bore": [["30 mm", "7.4 mm"], ["150 mm", "7.4 mm"]]}
    with pytest.raises(SceneError, match=r"projectile: cannot be meshed: a wall of 0\.075") as refused:
        Case.of(scene(thin, across=6))
    across = int(re.search(r"It can be with accuracy.across = (\d+)\.", refused.value.remedy)[1])
    assert len(mesh(scene(thin, across=across)).cells) > 100


def test_the_reduced_model_needs_a_mesh_for_its_modes_alone():
    """`check` names the fidelities that take a scene: it named modal, whose run refused the shape."""
    with pytest.raises(SceneError, match="cannot be meshed"):
        Case.of(scene(CAPPED), "modal")
    still = replace(scene(CAPPED), effects=("auto", "-vibration"))
    assert Case.of(still, "modal").fidelity == "modal"
    assert refused_by(scene(CAPPED), "modal") and not refused_by(scene(CAPPED), "rigid")


POINTED = {"material": "brass", "profile": [["0 mm", "0 mm"], ["20 mm", "6 mm"], ["100 mm", "6 mm"]]}
GROOVE = [["20 mm", "6 mm"], ["20 mm", "2 mm"], ["21 mm", "2 mm"], ["21 mm", "6 mm"]]
GROOVED = {"material": "brass", "profile": [["0 mm", "6 mm"], *GROOVE, ["100 mm", "6 mm"]]}
SLIM = {**ROD, "tip": "plain", "bore": [["0 mm", "0.5 mm"], ["150 mm", "0.5 mm"]]}


@pytest.mark.parametrize(
    ("body", "remedy"),
    [(POINTED, "round it with a radius"), (GROOVED, "spread it over"), (SLIM, "give 0.2 to 0.95 of it")],
)
def test_a_shape_without_a_mesh_is_told_what_to_change_of_it_and_is_computed_as_a_rigid_body(body, remedy):
    for fidelity in ("solid", "modal"):
        with pytest.raises(SceneError, match=f"cannot be meshed: .*{remedy}.*rigid needs no mesh") as refused:
            simulate(scene(body), fidelity)
        assert "longer rod" not in str(refused.value) and "accuracy.tip_size" not in str(refused.value)
    assert simulate(scene(body), "rigid").motion.mass > 0


COIN = {"material": "brass", "profile": [["0 mm", "12 mm"], ["2 mm", "12 mm"]]}
ROUNDED = {
    "material": "brass",
    "shape": "rounded-edge",
    "length": "6 mm",
    "diameter": "24 mm",
    "edge_radius": "2 mm",
}
SHORT = {
    "coin": COIN,
    "flat": {"material": "brass", "shape": "flat", "length": "2 mm", "diameter": "24 mm"},
    "ring": {**COIN, "bore": [["0 mm", "8 mm"], ["2 mm", "8 mm"]]},
    "lid": {
        "material": "brass",
        "profile": [["0 mm", "12 mm"], ["6 mm", "12 mm"]],
        "bore": [["2 mm", "10 mm"], ["6 mm", "10 mm"]],
    },
    "pin": {"material": "brass", "profile": [["0 mm", "5 mm"], ["5 mm", "5 mm"]]},
    "chamfered": {
        "material": "brass",
        "profile": [["0 mm", "11.5 mm"], ["0.5 mm", "12 mm"], ["2 mm", "12 mm"]],
    },
}


@pytest.mark.parametrize("name", SHORT)
def test_a_short_body_is_meshed_with_cells_no_wider_than_half_its_plate_and_vibrates(name):
    stated = scene(SHORT[name], 30)
    case = Case.of(stated, "solid")
    assert case.slots.vibrating
    assert body_cell(case.bodies) < 0.51 * {"pin": 5e-3}.get(name, 2e-3)
    assert len(mesh(stated).cells) > 100


@pytest.mark.parametrize("fidelity", ["modal", "solid"])
def test_a_short_body_with_a_rounded_edge_is_meshed(fidelity):
    assert Case.of(scene(ROUNDED), fidelity).slots.vibrating
    assert len(mesh(scene(ROUNDED)).cells) > 100
