"""The block's outer boundary: sums of springs and dashpots, and waves that leave."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.sparse as sp
import solid_shapes as shapes

import meshes
from fem_impact import simulate as run_levels
from fem_impact.evidence.references.waves import radiation_resistance
from fem_impact.fem.boundary import RADIATION, line_share, radiating_share, spread_boundary
from fem_impact.fem.elements import lame_constants, lumped_mass
from fem_impact.fem.sparse import Hanging, NodeProduct, assemble, assemble_mass, tie_operator
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all
from fem_impact.solid.elastic import Dashpots, ElasticBlock, Weight
from fem_impact.solid.march import advance, evaluate
from meshes import OUTER

E, NU, RHO = shapes.E, shapes.NU, shapes.RHO
LAME, G = lame_constants(E, NU)
FAST, SLOW = np.sqrt((LAME + 2 * G) / RHO), np.sqrt(G / RHO)


def test_dashpots_add_up_to_wave_resistance_times_area():
    w, d, h = 8e-3, 5e-3, 6e-3  # half block: symmetry plane at b = 0, free top
    mesh = meshes.block([-w / 2, 0, -h], [w / 2, d, 0], 1e-3)
    damping = spread_boundary(mesh, E, NU, RHO)[1].sum(axis=0)
    ends, side, bottom = 2 * d * h, w * h, w * d
    exact = RHO * np.array(
        [
            FAST * ends + SLOW * (side + bottom),
            FAST * side + SLOW * (ends + bottom),
            FAST * bottom + SLOW * (ends + side),
        ]
    )
    assert damping == pytest.approx(exact, rel=1e-12)


def test_springs_add_up_to_the_integral_over_the_faces():
    a = 6e-3
    mesh = meshes.block([-a, 0, -a], [a, a, 0], 0.5e-3)
    spring = spread_boundary(mesh, E, NU, RHO)[0].sum(axis=0)
    s = (np.arange(200) + 0.5) / 200 * a
    x, y = np.meshgrid(s, s)
    # integral of 1/r over a face of one quarter of the whole box, whose faces all lie a away
    unit = (1 / np.sqrt(x**2 + y**2 + a**2)).mean() * a**2
    normal, across = 4 / 3 * G * unit, 2 / 3 * G * unit
    exact = [2 * normal + 4 * across, 2 * normal + 4 * across, 2 * normal + 4 * across]
    exact = np.array(exact) - [0, 0, 0]
    # t: two ends (one quarter each), side and bottom (two quarters each), and so on
    assert spring == pytest.approx(exact, rel=2e-3)


def test_springs_of_a_line_are_those_of_the_nearest_point_of_it():
    """They were those of its middle: ten times too soft beside the ends of a rod that lands on its side."""
    mesh = meshes.block([-20e-3, 0, -4e-3], [20e-3, 4e-3, 0], 1e-3)
    point, line = spread_boundary(mesh, E, NU, RHO)[0], spread_boundary(mesh, E, NU, RHO, half=16e-3)[0]
    x, y, z = np.round(1e3 * mesh.points.T).astype(int)
    row = (y == 4) & (z == -2) & (abs(x) <= 15)
    assert np.ptp(line[row, 1]) < 1e-9 * line[row, 1].max()
    middle = row & (x == 0)
    assert line[middle, 1] == pytest.approx(point[middle, 1], rel=0.03)
    assert (line >= point * (1 - 1e-12)).all()


def test_a_line_radiates_less_than_a_point_as_lambs_problem_has_it():
    """Half sines over 160 mm of steel; Lamb's integral over wave numbers has .26 at 24 us."""
    steel = 210e9, 0.3, 7800.0
    assert line_share(0.08, 24e-6, steel) == pytest.approx(0.264, rel=0.1)
    assert line_share(0.08, 1.0, steel) == pytest.approx(1.0, abs=1e-6)
    assert line_share(0.008, 24e-6, steel) > 0.95


@pytest.mark.long
def test_a_rod_on_its_side_radiates_as_from_a_wide_block():
    """With 40 and 70 mm around its contact and plain dashpots e is .801 and .801; it was .687 with 6 mm."""
    size = {"shape": "flat", "length": "160 mm", "diameter": "16 mm"}
    steel = {
        "name": "s",
        "E": "210 GPa",
        "nu": 0.3,
        "rho": "7800 kg/m3",
        "source": "stated",
        "family": "steel",
    }
    rod = {
        "projectile": {**size, "material": steel},
        "barrier.material": steel,
        "impact.angle": "90 deg",
        "impact.v_n": "-1 m/s",
        "impact.v_t": "0 m/s",
    }
    mesh = {
        "accuracy.levels": 2,
        "accuracy.tip_size": "1 mm",
        "accuracy.unresolved": "report",
        "save.frames": 0,
    }
    outcome = run_levels(replace_all(load("t5b"), rod | mesh))
    assert outcome.motion.V_n == pytest.approx(0.801, abs=0.03)


@pytest.mark.parametrize("nu", [0.0, 0.1, 0.2, 0.29, 0.4, 0.49])
def test_radiation_of_a_half_space_is_that_of_lambs_integral(nu):
    G = E / (2 * (1 + nu))
    exact = radiation_resistance(E, nu, RHO) * 2 * np.pi * G * np.sqrt(G / RHO)
    assert np.polyval(RADIATION, nu) == pytest.approx(exact, rel=0.003)


def test_dashpots_take_what_a_slow_force_radiates():
    """Under a force that grows at 1 N/s in the middle, the whole block's dashpots take D (Lamb), in W."""
    mesh = meshes.block([-4e-3, 0, -4e-3], [4e-3, 4e-3, 0], 1e-3)
    n, places = len(mesh.points), np.arange(3 * len(mesh.points)).reshape(-1, 3)
    spring, damping = (part.ravel() for part in spread_boundary(mesh, E, NU, RHO))
    T = tie_operator(mesh.tie, places, 3 * n)
    K = (
        assemble(mesh.points, mesh.cells, lame_constants(E, NU), "incompatible", T) + sp.diags(spring)
    ).tocsr()
    held = np.zeros(3 * n, dtype=bool)
    held[places[mesh.points[:, 1] == 0, 1]] = True
    loaded = places[np.linalg.norm(mesh.points, axis=1).argmin(), 2]
    share = radiating_share(K, damping, held, loaded, (E, NU, RHO))
    push = 0.5 * (np.arange(3 * n) == loaded)
    speed = np.linalg.solve(K.toarray()[~held][:, ~held], push[~held])
    taken = 2 * share * float(damping[~held] @ speed**2)
    assert taken == pytest.approx(radiation_resistance(E, NU, RHO), rel=0.005)
    assert 0.2 < share < 0.9


def test_free_surfaces_carry_nothing():
    mesh = meshes.block([-3e-3, 0, -3e-3], [3e-3, 3e-3, 0], 1e-3)
    spring, damping = spread_boundary(mesh, E, NU, RHO)
    x = mesh.points
    inside = (abs(x[:, 0]) < 2.9e-3) & (x[:, 1] < 2.9e-3) & (x[:, 2] > -2.9e-3)
    assert inside.sum() > 20
    assert not spring[inside].any() and not damping[inside].any()
    assert (damping[~inside] > 0).all()


class Column:
    """A column that moves along n only, with the boundary at its foot."""

    def __init__(self, damped, cells=80, h=0.5e-3):
        mesh = meshes.block([-h / 2, 0, -cells * h], [h / 2, h, 0], h)
        corners = mesh.points[mesh.faces]
        foot = np.isclose(corners[..., 2], -cells * h).all(axis=1) & (mesh.face_tag == OUTER)
        foot_only = replace(mesh, faces=mesh.faces[foot], face_tag=mesh.face_tag[foot])
        places = np.arange(mesh.points.size).reshape(-1, 3)
        T = tie_operator(mesh.tie, places, places.size)
        K = assemble(mesh.points, mesh.cells, lame_constants(E, NU), "incompatible", T)
        mass = assemble_mass(lumped_mass(mesh.points, mesh.cells, RHO), mesh.cells, T)
        inverse = 1 / mass
        inverse[places[:, :2]] = 0.0
        damping = spread_boundary(foot_only, E, NU, RHO)[1].ravel()
        held = np.flatnonzero(damping * (inverse > 0))
        size = places.size
        self.block = ElasticBlock(NodeProduct.of(K, places, mesh.points.ravel()), slice(0, size))
        self.pots = Dashpots(held, damping[held], inverse[held])
        self.model = SimpleNamespace(
            forces=[self.block],
            impulses=[self.pots] if damped else [],
            inverse_mass=inverse,
            hanging=Hanging.of([(mesh.tie, places)]),
        )
        self.mass, self.up, self.length = mass, places[:, 2], cells * h
        self.state = shapes.at_rest(mesh.points.ravel())
        self.state.dt_next = 0.5 * h / FAST
        self._send(mesh.points[:, 2])
        self.fly(1e-12)  # one step: from here on velocities stand half a step behind, as the energy needs

    def _send(self, z):
        """A smooth pulse that runs down."""
        width = self.length / 4
        s = np.clip((z + 0.4 * self.length) / width, -1, 1)
        self.state.x[self.up] += 1e-6 * (1 + np.cos(np.pi * s)) / 2
        self.state.v[self.up] = -1e-6 * FAST * np.pi / (2 * width) * np.sin(np.pi * s)

    def energy(self):
        evaluate(self.model, self.state)
        s = self.state
        kinetic = 0.5 * s.v @ (self.mass * s.v) + 0.5 * s.dt * (s.v[self.up] @ s.force[self.up])
        return kinetic + self.block.energies(s)[0]

    def fly(self, time):
        while self.state.time < time:
            evaluate(self.model, self.state)
            advance(self.model, self.state)


def test_a_plane_wave_leaves():
    column = Column(damped=True)
    start = column.energy()
    column.fly(0.2 * column.length / FAST)
    assert column.energy() == pytest.approx(start, rel=1e-3)  # still on its way
    column.fly(1.2 * column.length / FAST)
    left = column.energy()
    assert left < 2e-3 * start
    assert start - left == pytest.approx(column.pots.energies(column.state)[0], rel=1e-9)


def test_without_dashpots_it_comes_back():
    column = Column(damped=False)
    start = column.energy()
    column.fly(1.2 * column.length / FAST)
    assert column.energy() == pytest.approx(start, rel=1e-9)


def test_dashpots_never_add_energy_however_long_the_step():
    rng = np.random.default_rng(1)
    for damping in (1e-3, 1.0, 1e6):
        state = shapes.at_rest(np.zeros(30))
        state.v[:] = rng.normal(size=30)
        state.kick = state.dt_next = 1.0
        before = (state.v**2).sum()
        pots = Dashpots(np.arange(30), np.full(30, damping), np.ones(30))
        pots.resolve(state)
        assert 0.5 * (before - (state.v**2).sum()) == pytest.approx(pots.radiated, rel=1e-6)
        assert (state.v**2).sum() <= before


@pytest.mark.parametrize("mass", [1e-4, 1.0, 1e4])
def test_dashpots_on_a_foundation_of_any_mass_add_no_energy_and_keep_the_momentum(mass):
    """They were implicit for the block alone: a foundation lighter than what drags it was shaken apart."""
    state = shapes.at_rest(np.zeros(31))
    state.v[:] = np.random.default_rng(2).normal(size=31)
    state.kick = state.dt_next = 1.0
    m = np.append(np.ones(30), mass)
    start, momentum = 0.5 * m @ state.v**2, m @ state.v
    ends = np.full(30, 30)
    pots = Dashpots(np.arange(30), np.ones(30), np.ones(30), ends, np.full(30, 1 / mass))
    for _ in range(200):
        before = 0.5 * m @ state.v**2
        pots.resolve(state)
        assert 0.5 * m @ state.v**2 <= before * (1 + 1e-12)
    assert start - 0.5 * m @ state.v**2 == pytest.approx(pots.radiated, rel=1e-9)
    assert m @ state.v == pytest.approx(momentum, rel=1e-9)
    assert np.ptp(state.v[:30]) < 1e-9


def test_weight_and_its_potential():
    weight = Weight(np.array([-3.0, 0.0, -4.0]), np.zeros(3))
    state = shapes.at_rest(np.array([0.1, 0.2, 0.3, 9.0]))
    weight.add(state)
    assert state.force == pytest.approx([-3.0, 0.0, -4.0, 0.0])
    assert weight.energies(state)[0] == pytest.approx(3.0 * 0.1 + 4.0 * 0.3)


@pytest.mark.parametrize("name", ["t5b", pytest.param("tube", marks=pytest.mark.long)])
def test_a_face_that_lands_flat_gets_no_motion_to_the_side(name):
    """Springs about the edge that was taken for the contact gave mu = -.0016 and a spin of .06 rad/s."""
    flat = {"impact.angle": "0 deg", "impact.v_t": "0 m/s", "accuracy.tip_size": "1.2 mm"}
    found = simulate(replace_all(load(name), flat))
    assert found.motion.Omega == pytest.approx(0, abs=1e-8)
    assert found.restitution.mu == pytest.approx(0, abs=1e-9)
