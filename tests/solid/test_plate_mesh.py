"""A plate that is meshed through its thickness: its mesh, its edges, and impacts on it."""

import re

import numpy as np
import pytest

import meshes
from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.fem.boundary import plate_edges
from fem_impact.outcome.groups import texts
from fem_impact.outcome.keys import or_none
from fem_impact.physics.plate import zener_number
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all
from fem_impact.solid.build import build
from fem_impact.solid.elastic import Dashpots
from fem_impact.solid.fine_zone import SkinWatch
from fem_impact.solid.foundation import BendingPlate
from meshes import OUTER, SKIN

E, NU, RHO, SPEED = 206e9, 0.29, 7850.0, 600.0
COARSE = {
    "accuracy.tip_size": "1 mm",
    "accuracy.across": 6,
    "accuracy.unresolved": "report",
    "projectile.length": "40 mm",
    "barrier.thickness": "5 mm",
    "save.frames": 0,
}


def scene(**changes):
    return replace_all(load("plate-10mm"), COARSE | changes)


@pytest.fixture(scope="module")
def model():
    return build(Case.of(scene()))


@pytest.fixture(scope="module")
def yielding():
    return simulate(scene(), "solid")


def test_the_mesh_is_as_thick_as_the_plate_and_free_underneath(model):
    mesh = model.geometry.barrier
    assert mesh.points[:, 2].min() == -5e-3 and mesh.points[:, 2].max() == 0.0
    bottom = (mesh.points[mesh.faces, 2] == -5e-3).all(axis=1)
    assert bottom.any() and (mesh.face_tag[bottom] == SKIN).all()
    cut = mesh.points[mesh.faces_with(OUTER)]
    spread = np.ptp(cut, axis=1)
    assert (spread[:, 2] > 0).all() and (spread[:, :2].min(axis=1) == 0).all()


def test_it_stands_on_no_springs_and_has_no_impedance_beside_its_mesh(model):
    """A body that is held nowhere has no strain when it moves as a whole."""
    block = next(item for item in model.forces if item.body == "barrier")
    moved = model.start[0][model.layout.barrier_slice].reshape(-1, 3) + np.array([1e-6, 0.0, 1e-6])
    block.stiffness.multiply(moved.ravel())
    assert block.stiffness.energy < 1e-9 * 0.5e-12 * E * 5e-3
    kinds = [type(item) for item in model.impulses]
    assert kinds.count(Dashpots) == 1 and BendingPlate not in kinds
    pots = next(item for item in model.impulses if isinstance(item, Dashpots))
    assert (pots.effect, pots.accounts) == ("plate-bending", ("plate",))


@pytest.mark.parametrize("rows", [1, 2, 5])
def test_edges_push_and_turn_like_the_rest_of_the_plate(rows):
    """A bending wave of the phase speed c meets rho h c against w' and D / c against theta'."""
    h = 4e-3
    plate = meshes.with_free_bottom(meshes.block([-8e-3, 0.0, -h], [8e-3, 8e-3, 0.0], h / rows))
    springs, damping = plate_edges(plate, E, NU, RHO, SPEED)
    right = plate.points[:, 0] == 8e-3
    inner = right & (plate.points[:, 1] < 8e-3)  # the corner belongs to two edges
    width = 8e-3 - 0.5 * h / rows
    assert not springs.any()
    assert damping[inner, 2].sum() == pytest.approx(RHO * h * SPEED * width, rel=1e-12)
    D = E * h**3 / (12 * (1 - NU**2))
    turned = (damping[inner, 0] * (plate.points[inner, 2] + 0.5 * h) ** 2).sum()
    assert turned == pytest.approx(D / SPEED * width, rel=1e-12)
    assert damping[inner, 1].sum() == pytest.approx(
        RHO * h * width * np.sqrt(E / (2 * (1 + NU) * RHO)), rel=1e-12
    )


@pytest.mark.long
def test_energy_goes_into_bending_waves_and_the_ledger_closes(yielding):
    energy = yielding.energy
    assert yielding.validity.finished and abs(energy.residual) < 1e-6
    assert 0.2 < energy.plate < 0.6 and energy.plastic_barrier > 0.1
    assert or_none(energy.locked_barrier) is None and "W_plate holds both" in energy.locked_barrier.reason
    told = next(choice for choice in yielding.provenance.effect_choices if choice.name == "plate-bending")
    assert told.on and "by itself" in told.sentence


@pytest.mark.long
def test_cells_are_split_down_to_the_underside_within_the_fine_zone():
    thin = build(Case.of(scene(**{"barrier.thickness": "3.5 mm", "accuracy.across": 8})))
    mesh = thin.geometry.barrier
    deepest = mesh.points[mesh.cells[mesh.level == mesh.level.max()], 2].min()
    assert deepest == pytest.approx(-3.5e-3, abs=2e-3)
    with pytest.raises(SceneError, match="rows of cells"):
        Case.of(scene(**{"barrier.thickness": "1 mm"}))


@pytest.mark.parametrize(
    ("bends", "plate", "rod", "stops"),
    [(True, -4e-3, -4e-3, False), (False, -4e-3, -4e-3, True), (True, 0.0, -4e-3, True)],
)
def test_skin_outside_the_contact_is_held_against_the_plate_where_it_has_gone(
    model, bends, plate, rod, stops
):
    """A thin plate gives way under the rod by more than the run may let skin enter it."""
    state, watch = model.initial_state(), SkinWatch(model, bends)
    state.x[model.layout.rod[:, 2]] += rod
    state.x[model.layout.barrier[:, 2]] += plate
    assert watch.observe(state) == stops
    assert bool(watch.below()) == stops
    assert watch.reason.startswith("The rod came down on the barrier outside") == stops


@pytest.mark.parametrize(("thickness", "told"), [("3.5 mm", True), ("6.5 mm", False)])
def test_a_plate_that_takes_nearly_all_is_told_with_a_thickness_that_does_not(thickness, told):
    """The impedance of a plate goes as the square of its thickness."""
    soft = {"accuracy.across": 8, "barrier.material": "aluminium-6061-t6", "projectile.length": "60 mm"}
    planned = Case.of(scene(**soft, **{"barrier.thickness": thickness}))
    sentence = " ".join(texts(planned.limitations, "range", "model"))
    assert ("the rod hardly leaves the plate" in sentence) == told
    if told:
        enough = re.search(r"A thickness of (\S+ mm)", sentence)[1]
        thicker = replace_all(planned.scene, {"barrier.thickness": enough})
        assert zener_number(Case.of(thicker).contact) == pytest.approx(2.0, rel=0.06)
