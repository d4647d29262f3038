"""Layers of a barrier: waves at an interface, the give of a layered half-space, runs."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

import meshes
from fem_impact.case.case import Case
from fem_impact.fem.body import MeshedBodies, assemble_masses, make_body, of_materials, stiffness_of
from fem_impact.fem.layout import number
from fem_impact.physics.contact import pressure_speed
from fem_impact.run.simulate import simulate
from fem_impact.scene.library import materials
from fem_impact.scene.read import read_dict
from fem_impact.solid.block import elastic_block
from fem_impact.solid.build import build
from meshes import SKIN, RodMesh

STEEL, ALUMINIUM = (materials()[name] for name in ("steel-4340", "aluminium-6061-t6"))


def scene(layers=(), base="aluminium-6061-t6", effects="auto", **accuracy):
    stated = [{"thickness": thickness, "material": name} for thickness, name in layers]
    return read_dict(
        {
            "id": "layered",
            "effects": effects,
            "projectile": {
                "tip": "A",
                "length": "60 mm",
                "diameter": "19 mm",
                "tip_radius": "7 mm",
                "material": "rod-steel",
            },
            "barrier": {"material": base, **({"layers": stated} if stated else {})},
            "surface": {"state": "custom", "friction": 0.2, "source": "assumed"},
            "impact": {"angle": "30 deg", "speed": "2 m/s"},
            "accuracy": {"tip_size": "0.6 mm", "unresolved": "report", **accuracy},
            "save": {"frames": 0},
        }
    )


# -- waves ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("pair", [(STEEL, ALUMINIUM), (ALUMINIUM, STEEL), (STEEL, STEEL)])
def test_a_wave_is_sent_back_and_on_at_an_interface_by_the_impedances(pair):
    """Velocities (Z1 - Z2) / (Z1 + Z2) and 2 Z1 / (Z1 + Z2) of the incoming one; plane waves of pressure."""
    h, cells, depth = 0.5e-3, 240, 60.2e-3
    block = meshes.block([-h / 2, 0, -cells * h], [h / 2, h, 0], h)
    rows = np.array([0.0, 60e-3, cells * h])
    mesh = meshes.with_rows_at(block, rows, np.array([0.0, depth, cells * h]))
    layout = number(RodMesh.plain(mesh), None)
    body = make_body("rod", mesh, mesh.points, layout.rod, pair[0], np.zeros(len(mesh.cells), bool))
    place = -mesh.points[mesh.cells, 2].mean(axis=1)
    body = of_materials(body, (place > depth).astype(int), pair)
    n = layout.rod_size
    K = stiffness_of(body, np.ones(len(mesh.cells), bool), n)
    mass = assemble_masses([body], layout)[:n]
    speeds, up = [pressure_speed(m) for m in pair], layout.rod[:, 2]
    z = -mesh.points[:, 2]
    width = 8e-3
    u, v = np.zeros(n), np.zeros(n)
    u[up] = np.exp(-(((z - 30e-3) / width) ** 2))  # runs down: u(z - c t)
    v[up] = u[up] * 2 * (z - 30e-3) / width**2 * speeds[0]
    dt = 0.5 * h / max(speeds)
    moving = np.zeros(n, dtype=bool)
    moving[up] = True
    time = 30e-3 / speeds[0] + 22e-3 / min(speeds)
    for _ in range(round(time / dt)):
        v[moving] -= dt * (K @ u)[moving] / mass[moving]
        u += dt * v
    Z = [m.rho * c for m, c in zip(pair, speeds, strict=True)]
    back, on = (Z[0] - Z[1]) / sum(Z), 2 * Z[0] / sum(Z)
    above, below = u[up][z < depth], u[up][z > depth]
    assert below.max() == pytest.approx(on, rel=0.01)
    assert above[np.abs(above).argmax()] == pytest.approx(back, abs=0.01)


# -- static give ---------------------------------------------------------------------------------------------


def surface_give(k, layer, base, thickness):
    """Return surface displacement over pressure, m/Pa, of a bonded layer under a pressure cos(k x).

    Exact, by Airy's function (A + B k z) exp(-k z) + (C + D k z) exp(k z) in the layer and the first two
    terms in the half-space: Burmister's problem (1945, J. Appl. Phys. 16, 89).
    """

    def rows(z, m, sign):
        """Columns for the two terms with exp(sign k z): U, W, normal and shear stress."""
        deep = z - thickness if sign > 0 else z  # what grows is measured from the interface: no overflow
        C, out = (1 + m.nu) / m.E, []
        for c0, c1 in ((1.0, 0.0), (0.0, 1.0)):
            g = np.exp(sign * k * deep)
            f = (c0 + c1 * k * deep) * g
            d1 = k * (sign * c0 + c1 * (1 + sign * k * deep)) * g
            d2 = k**2 * (c0 + c1 * (2 * sign + k * deep)) * g
            d3 = k**3 * (sign * c0 + c1 * (3 + sign * k * deep)) * g
            U = C / k * ((1 - m.nu) * d2 + m.nu * k**2 * f)
            W = C / k**2 * ((1 - m.nu) * d3 - (2 - m.nu) * k**2 * d1)
            out.append([U, W, -(k**2) * f, k * d1])
        return np.array(out).T

    top = np.hstack([rows(0.0, layer, -1), rows(0.0, layer, 1), np.zeros((4, 2))])
    under = np.hstack([rows(thickness, layer, -1), rows(thickness, layer, 1), -rows(0.0, base, -1)])
    system = np.vstack([top[2:], under])
    scale = np.abs(system).max(axis=1)
    solved = np.linalg.solve(system / scale[:, None], np.array([-1.0, 0, 0, 0, 0, 0]) / scale)
    return float(top[1] @ solved)


def mean_give(layer, base, thickness, a, b):
    """Return the mean displacement over a rectangle 2 a by 2 b of unit pressure, m/Pa."""
    k = np.geomspace(1e-3, 200.0, 500) / max(a, b)
    give = np.array([surface_give(x, layer, base, thickness) * x for x in k])
    angle = (np.arange(90) + 0.5) / 90 * np.pi / 2
    spread = np.array(
        [
            np.mean((np.sinc(x * a * np.cos(angle) / np.pi) * np.sinc(x * b * np.sin(angle) / np.pi)) ** 2)
            for x in k
        ]
    )
    below = give[0] * k[0]
    return 4 * a * b / (4 * np.pi**2) * 2 * np.pi * (np.trapezoid(give * spread, k) + below)


def found_give(one):
    """Return the mean displacement of the block of a scene under unit pressure, m/Pa, and the rectangle."""
    made = MeshedBodies(Case.of(one))
    body, layout, place = made.true_barrier, made.layout, made.layout.barrier_slice
    block = elastic_block(body, layout, made.x)
    quads = body.mesh.faces_with(SKIN)
    corners = body.mesh.points[quads]
    middle = corners.mean(axis=1)
    loaded = (np.abs(middle[:, 0]) < 1.3e-3) & (middle[:, 1] < 1.3e-3)
    area = np.ptp(corners[loaded][..., 0], axis=1) * np.ptp(corners[loaded][..., 1], axis=1)
    force = np.zeros(place.stop - place.start)
    np.add.at(force, body.places[quads[loaded], 2] - place.start, area[:, None] / 4)
    K = sp.csc_matrix(block.stiffness + block.springs)
    free = made.inverse_mass[place] > 0
    u = np.zeros(len(force))
    u[free] = sp.linalg.spsolve(K[free][:, free], force[free])
    low, high = corners[loaded].min(axis=(0, 1)), corners[loaded].max(axis=(0, 1))
    assert area.sum() == pytest.approx((high - low)[:2].prod(), rel=1e-9)
    return float(force @ u / force.sum()), (0.5 * (high[0] - low[0]), high[1])


def test_the_reference_of_one_material_is_that_of_a_loaded_square():
    """Mean give of a uniformly loaded square of side B on a half-space: .95 p B (1 - nu^2) / E."""
    exact = 0.9496 * 2e-3 * (1 - STEEL.nu**2) / STEEL.E
    assert mean_give(STEEL, STEEL, 1e-3, 1e-3, 1e-3) == pytest.approx(exact, rel=3e-3)


@pytest.mark.long
def test_a_layered_block_gives_as_a_layered_half_space():
    """Layers from 1.2 to 8 mm of steel on aluminium, over the give of the same block of steel alone."""
    gives = []
    for thickness in (1.2, 2.0, 4.0, 8.0):
        layers = [(f"{thickness} mm", "steel-4340")]
        found, patch = found_give(scene(layers))
        plain, _ = found_give(scene([(f"{thickness} mm", "steel-4340")], base="steel-4340"))
        ratio = found / plain
        exact = mean_give(STEEL, ALUMINIUM, thickness * 1e-3, *patch)
        exact /= mean_give(STEEL, STEEL, thickness * 1e-3, *patch)
        assert ratio == pytest.approx(exact, rel=0.03)
        gives.append(ratio)
    assert (np.diff(gives) < 0).all()
    assert gives[0] > 1.5
    assert gives[-1] < 1.2


# -- meshes and runs -----------------------------------------------------------------------------------------


def test_rows_of_cells_end_at_the_interfaces():
    one = scene([("1.5 mm", "steel-4340"), ("3 mm", "copper")])
    made = MeshedBodies(Case.of(one))
    body = made.true_barrier
    low, high = (
        -body.mesh.points[body.mesh.cells, 2].max(axis=1),
        -body.mesh.points[body.mesh.cells, 2].min(axis=1),
    )
    for depth in (1.5e-3, 4.5e-3):
        assert not ((low < depth - 1e-9) & (high > depth + 1e-9)).any()
    inside = [material.name for material, _ in body.parts]
    assert inside == ["steel-4340", "copper", "aluminium-6061-t6"]
    assert sum(here.sum() for _, here in body.parts) == len(body.mesh.cells)
    volume = np.prod(np.ptp(body.mesh.points, axis=0)[:2])
    copper = materials()["copper"].rho * 3e-3 * volume
    assert body.mass[body.parts[1][1]].sum() == pytest.approx(copper, rel=1e-9)
    hanging = body.mesh.is_hanging
    assert (body.mesh.tie @ body.mesh.points)[hanging] == pytest.approx(body.mesh.points[hanging])


@pytest.mark.long
def test_each_material_that_yields_has_its_own_zone_and_law():
    model = build(Case.of(scene([("1.2 mm", "steel-4340")], base="lead")))
    zones = [zone for zone in model.zones if zone.body == "barrier"]
    assert [zone.law.yield_stress for zone in zones] == [STEEL.yield_stress, materials()["lead"].yield_stress]
    assert not set(zones[0].cells) & set(zones[1].cells)
    points = model.geometry.barrier.points[model.geometry.barrier.cells]
    assert -points[zones[0].cells][..., 2].min() == pytest.approx(1.2e-3)
    elastic = build(
        Case.of(scene([("1.2 mm", "alumina")], base="lead", effects=["auto", "barrier-elastoplastic"]))
    )
    assert [zone.G for zone in elastic.zones if zone.body == "barrier"] == [zones[1].G]


@pytest.mark.long
@pytest.mark.parametrize(("thickness", "near"), [("2.375 mm", 4e-3), ("0.6 mm", 0.015)])
def test_a_layer_of_the_base_s_own_material_changes_nothing(thickness, near):
    """The thin one is a quarter as high as its cells are wide."""
    plain, layered = (simulate(scene(layers)) for layers in ((), [(thickness, "aluminium-6061-t6")]))
    assert layered.restitution.impulse.e == pytest.approx(plain.restitution.impulse.e, abs=near)
    assert layered.energy.plastic_barrier == pytest.approx(plain.energy.plastic_barrier, rel=2.5 * near)


@pytest.mark.slow
def test_a_hard_plate_on_a_soft_base_lies_between_both_and_is_balanced():
    effects = ["auto", "radiation"]
    hard, both, soft = (
        simulate(scene(layers, base, effects))
        for layers, base in (
            ((), "steel-4340"),
            ([("2 mm", "steel-4340")], "aluminium-6061-t6"),
            ((), "aluminium-6061-t6"),
        )
    )
    assert abs(both.energy.residual) < 1e-4
    assert both.energy.radiated > 0.0
    assert both.energy.plastic_rod > 0.1
    assert soft.energy.plastic_rod < 1e-6
    durations = [
        float(one.contact.intervals[0].end - one.contact.intervals[0].start) for one in (hard, both, soft)
    ]
    assert durations[0] < durations[1] < durations[2]


@pytest.mark.slow
def test_a_soft_base_flows_under_a_thin_layer():
    outcome = simulate(scene([("1.2 mm", "steel-4340")], base="lead"))
    assert abs(outcome.energy.residual) < 1e-4
    assert outcome.energy.plastic_barrier > 0.05


@pytest.mark.long
def test_the_shipped_scene_runs_on_a_coarse_mesh():
    from fem_impact.scene.shipped import load

    shipped = load("layered")
    coarse = replace(shipped, accuracy=replace(shipped.accuracy, tip_size=0.6e-3))
    outcome = simulate(replace(coarse, save=replace(coarse.save, frames=0)))
    assert abs(outcome.energy.residual) < 1e-4
