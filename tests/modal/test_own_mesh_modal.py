"""The reduced model of meshes: their outline, how large their contact is, and what touches flat."""

import numpy as np
import pytest
import skfem
from own_bodies import box, write
from scipy.sparse.linalg import eigsh
from skfem.helpers import dot
from skfem.models.elasticity import lame_parameters, linear_elasticity

from fem_impact import load, replace
from fem_impact.case.case import Case
from fem_impact.case.shaft import pronged
from fem_impact.errors import SceneError
from fem_impact.evidence.studies.coverage.bodies import BODIES
from fem_impact.physics.beam import prongs
from fem_impact.run.modal import closed
from fem_impact.run.simulate import simulate
from fem_impact.scene.read import read_dict
from fem_impact.scene.types import to_dict

SIZES = {"width": 12e-3, "length": 60e-3, "bend": 6e-3}


def scene(folder, body, angle, mirrored=False):
    points, cells = BODIES[body](SIZES)
    if mirrored:
        points, cells = points * [-1.0, 1.0, 1.0], cells[:, [1, 0, 3, 2, 5, 4, 7, 6]]
    path = write(folder / f"{body}{mirrored}.vtu", points, cells)
    mesh = {"mesh": str(path), "mesh_unit": "m", "mesh_symmetry": "half", "material": "rod-steel"}
    return read_dict(
        {
            "id": "own",
            "projectile": mesh,
            "barrier": {"material": "plate-steel"},
            "surface": {"state": "machined"},
            "impact": {"angle": f"{angle} deg", "v_n": "-2 m/s", "v_t": "0 m/s"},
        }
    )


def test_a_body_that_leans_the_other_way_is_the_mirror_image(tmp_path):
    here, there = (simulate(scene(tmp_path, "bent bar", *way), "modal") for way in ((40, False), (-40, True)))
    assert there.restitution.edge.e == pytest.approx(here.restitution.edge.e, rel=1e-4)
    assert there.motion.Omega == pytest.approx(-here.motion.Omega, rel=1e-4)
    assert there.energy.vibration == pytest.approx(here.energy.vibration, rel=1e-3)
    other = simulate(scene(tmp_path, "bent bar", -40), "modal")
    assert abs(other.restitution.edge.e - here.restitution.edge.e) > 0.01


def test_a_contact_is_as_large_as_the_body_where_it_is_pressed_in(tmp_path):
    case = Case.of(scene(tmp_path, "square bar", 30), "modal")
    size, a = case.estimate, np.radians(30.0)
    area = 12e-3 * size.depth * (np.tan(a) + 1 / np.tan(a))
    assert case.bodies.body.section(float(a), size.depth) == pytest.approx(area, rel=1e-9)
    assert np.pi * size.a_t * size.a_b == pytest.approx(area, rel=0.02)


def test_a_bar_of_few_cells_has_places_for_its_modes(tmp_path):
    """Of cells of half the bar's width hardly a node lies near a place."""
    points, cells = box(2, 1, 5, (-6e-3, 0.0, 0.0), (6e-3, 6e-3, 60e-3))
    bar = scene(tmp_path, "square bar", 10)
    table = to_dict(bar)
    del table["projectile"]["mesh_content"]
    table["projectile"]["mesh"] = str(write(tmp_path / "coarse.vtu", points, cells))
    coarse, fine = simulate(read_dict(table), "modal"), simulate(bar, "modal")
    assert coarse.restitution.edge.e == pytest.approx(fine.restitution.edge.e, abs=0.05)
    assert coarse.energy.vibration == pytest.approx(fine.energy.vibration, rel=0.3)


def test_a_side_lands_flat_with_its_width_and_a_ridge_is_refused(tmp_path):
    side = Case.of(scene(tmp_path, "square bar", 90), "modal").bodies.body
    ends = np.array([6e-3, 0.0]), np.array([6e-3, 60e-3])
    assert side.half_widths(*ends, np.linspace(0.0, 1.0, 5)) == pytest.approx(np.full(5, 6e-3))
    upright = simulate(scene(tmp_path, "square bar", 0), "modal")
    assert upright.energy.radiated > 0.0
    assert abs(upright.energy.residual) < 1e-4
    with pytest.raises(SceneError, match=r"lands along a ridge, .* Use fidelity solid"):
        Case.of(scene(tmp_path, "hexagonal bar", 90), "modal")


@pytest.mark.slow
def test_a_rod_written_to_a_mesh_is_that_rod(tmp_path):
    """Facets of 0.8 mm stand for an edge of 3 mm."""
    from fem_impact.fem.body import MeshedBodies

    rod = load("t5b")
    fine = {"effects": ["vibration", "barrier-rigid"], "accuracy.tip_size": "0.79 mm", "accuracy.across": 24}
    bare = rod
    for key, value in fine.items():
        bare = replace(bare, key, value)
    mesh = MeshedBodies(Case.of(bare)).geometry.rod.mesh
    assert not mesh.is_hanging.any()
    path = write(tmp_path / "rod.vtu", mesh.points, mesh.cells)
    stated = to_dict(rod)
    stated["projectile"] = {
        "mesh": str(path),
        "mesh_unit": "m",
        "mesh_symmetry": "half",
        "material": stated["projectile"]["material"],
    }
    del stated["measured"]
    ours, theirs = (simulate(one, "modal") for one in (rod, read_dict(stated)))
    assert theirs.restitution.edge.e == pytest.approx(ours.restitution.edge.e, abs=0.025)
    assert theirs.restitution.mu == pytest.approx(ours.restitution.mu, abs=0.04)
    assert theirs.energy.vibration == pytest.approx(ours.energy.vibration, abs=0.002)


def channel(folder, angle):
    """Half of a channel 24 x 24 x 3 x 200 mm of aluminium, as 2 m/s bring it down on S235."""
    points, cells = box(8, 4, 40, (0.0, 0.0, 0.0), (24e-3, 12e-3, 0.2))
    middle = points[cells].mean(axis=1)
    cells = cells[(middle[:, 0] < 3e-3) | (middle[:, 1] > 9e-3)]
    used, cells = np.unique(cells, return_inverse=True)
    table = to_dict(scene(folder, "square bar", angle))
    del table["projectile"]["mesh_content"]
    path = write(folder / f"channel{angle}.vtu", points[used], cells.reshape(-1, 8))
    table["projectile"] |= {"mesh": str(path), "material": "aluminium-6082-t6"}
    table["barrier"] = {"material": "s235"}
    table["surface"] = {"state": "custom", "friction": 0.36, "source": "assumed"}
    return read_dict(table)


def test_the_ends_of_two_flanges_bear_what_they_are_wide(tmp_path):
    """Finite elements have 1410 +- 230 N and e 0.31; with all that lies between the ends it was 3440 N."""
    found = simulate(channel(tmp_path, 25), "modal")
    assert 1300 < found.contact.peak_force < 2100
    assert found.restitution.edge.e == pytest.approx(0.31, abs=0.05)


def test_a_channel_that_lands_on_its_end_lands_flat(tmp_path):
    """Its end is no whole face: the plane of motion cuts the web alone."""
    case = Case.of(channel(tmp_path, 0), "modal")
    result = closed(case, recorded=True)
    assert result.finished and result.laid
    one_wave = case.contact.rod.rho * np.sqrt(case.contact.rod.E / case.contact.rod.rho) * 198e-6 * 2.0
    assert one_wave < result.force < 2 * one_wave


def test_two_feet_with_a_gap_between_bear_what_they_are_wide(tmp_path):
    """Feet of 4 mm at both sides of a bar of 12 x 12 mm, 3 mm high: finite cells of the gap bear nothing."""
    points, cells = box(6, 3, 20, (-6e-3, 0.0, 0.0), (6e-3, 6e-3, 60e-3))
    middle = points[cells].mean(axis=1)
    cells = cells[(np.abs(middle[:, 0]) > 2e-3) | (middle[:, 2] > 3e-3)]
    used, cells = np.unique(cells, return_inverse=True)
    whole = scene(tmp_path, "square bar", 0)
    table = to_dict(whole)
    del table["projectile"]["mesh_content"]
    table["projectile"]["mesh"] = str(write(tmp_path / "feet.vtu", points[used], cells.reshape(-1, 8)))
    elastic = ["auto", "-rod-plasticity", "barrier-elastic"]
    found = []
    for one in (read_dict(table), whole):
        case = Case.of(replace(one, "effects", elastic), "modal")
        result = closed(case, recorded=True)
        assert result.finished and result.laid
        (site,) = result.sites
        found.append((result.force, site.high_t - site.low_t))
    (feet, reach), (full, wide) = found
    assert reach == pytest.approx(wide, rel=1e-3)  # from the one foot's outer edge to the other's
    assert np.sqrt(2 / 3) * 0.8 < feet / full < 1.0


def parted(folder, name, keep):
    """Half of a bar of 20 x 8 x 100 mm with those cells alone that ``keep`` names, at 10 degrees."""
    points, cells = box(10, 2, 50, (-10e-3, 0.0, 0.0), (10e-3, 4e-3, 0.1))
    x, _, z = points[cells].mean(axis=1).T
    used, cells = np.unique(cells[keep(x, z)], return_inverse=True)
    points, cells = points[used], cells.reshape(-1, 8)
    table = to_dict(scene(folder, "square bar", 10))
    del table["projectile"]["mesh_content"]
    table["projectile"]["mesh"] = str(write(folder / f"{name}.vtu", points, cells))
    return read_dict(table), points, cells


def first_mode(points, cells, steel):
    """Circular frequency, rad/s, of the first mode in the plane of motion, by quadratic elements."""
    mesh = skfem.MeshHex(points.T, cells[:, [0, 1, 3, 4, 2, 5, 7, 6]].T)
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementHex2()))
    stiffness = linear_elasticity(*lame_parameters(steel.E, steel.nu))
    mass = skfem.BilinearForm(lambda u, v, w: steel.rho * dot(u, v))
    held = basis.get_dofs(lambda x: x[1] == 0.0).all(["u^2"])
    K, M, *_ = skfem.condense(stiffness.assemble(basis), mass.assemble(basis), D=held)
    squares = eigsh(K, 4, M, sigma=-1e6, return_eigenvectors=False)
    return float(np.sqrt(np.sort(squares)[3]))


def test_prongs_of_a_fork_swing_on_their_own(tmp_path):
    """Friction of it was 8.6 +- 3.9 % by the reduced model, and at most 2.6 % on four levels of meshes."""
    fork, points, cells = parted(tmp_path, "fork", lambda x, z: (np.abs(x) > 6e-3) | (z > 40e-3))
    case = Case.of(fork, "modal")
    period = 2 * np.pi / first_mode(points, cells, case.contact.rod)
    assert case.bodies.bending_period == pytest.approx(period, rel=0.15)
    outcome = simulate(fork, "modal")
    assert "prongs 40 mm long and 4 mm wide" in outcome.validity.model_band.reason


def test_feet_and_holes_leave_a_body_one_beam(tmp_path):
    whole, *_ = parted(tmp_path, "bar", lambda x, z: z > 0.0)
    feet, *_ = parted(tmp_path, "feet", lambda x, z: (np.abs(x) > 6e-3) | (z > 6e-3))
    hole, *_ = parted(tmp_path, "hole", lambda x, z: (np.abs(x) > 4e-3) | (np.abs(z - 50e-3) > 4e-3))
    bar, foot, bore = (Case.of(one, "modal").bodies for one in (whole, feet, hole))
    assert [pronged(one) for one in (bar, foot, bore)] == [""] * 3
    assert prongs(foot.rod).length == pytest.approx(6e-3)
    assert prongs(bore.rod).length == pytest.approx(8e-3)
    assert bar.bending_period == pytest.approx(foot.bending_period, rel=0.1)
