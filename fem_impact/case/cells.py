"""How many cells the radius of a contact has at its peak, and how far e and mu are off with so many.

Largest difference from the finest mesh: of four elastic rods (aluminium, steel, tungsten) and of three that
yield, with 0.8 to 9 cells on meshes halved up to three times, and of the 13 measured sets on three or four.
All had one fine zone of equal cells and true masses.

=========  ==========  ====  ====  ====  =================================
bodies     cells       runs  e     mu    plastic and friction work, of E_0
=========  ==========  ====  ====  ====  =================================
elastic    1.1 to 1.6  3     .3 %  5 %   .007
elastic    1.6 to 2.3  3     .3 %  3 %   .001
elastic    2.3 to 3.6  3     .2 %  .3 %  .001
elastic    3.6 to 6    3     0     1 %   0
yielding   1.1 to 1.6  1     3 %   35 %  .22
yielding   1.6 to 2.3  5     8 %   25 %  .10
yielding   2.3 to 3.6  18    6 %   21 %  .12
yielding   3.6 to 6    19    5 %   7 %   .05
=========  ==========  ====  ====  ====  =================================

The errors go down as one over the number n of cells. Extrapolated to vanishing cells, e and mu of the
measured sets are off by 10 to 25 % over n (a yielding tip that sticks shears a skin as thick as a cell), mu
of the elastic rods by 8 % over n. With fewer cells than `LEAST` a single node may slide down the slope of one
facet: e was 1.4 instead of .8, and mu three times f.
"""

from functools import lru_cache
from math import ceil, log2, sqrt

import numpy as np

import meshes
from fem_impact.case.bodies import Bodies
from fem_impact.case.mesh import no_mesh
from fem_impact.errors import SceneError
from fem_impact.scene.fields import TIP_SIZE
from fem_impact.scene.projectile import ProjectileSpec
from rigid import Turned

LEAST = {"elastic": 1.6, "yielding": 2.0}  # below it e, mu and all shares are not given
ADVISED = {"elastic": 4.0, "yielding": 5.0}  # e and mu within 2 and 5 %
ERROR = {"elastic": 0.08, "yielding": 0.25}  # of e and of mu, times the number of cells
RIM = 0.4  # cells by which the nodes that are pressed reach beyond the estimated radius, of 38 runs
COARSEST = 0.7  # of the body's cells: larger ones leave the tip without a fine zone
THIN = 10.0  # median thickness of a user's cells over that of one that makes the step small
FINEST = TIP_SIZE.low  # m


def kind(bodies: Bodies) -> str:
    """Return which numbers of this module a contact has."""
    return "yielding" if bodies.contact.yielding else "elastic"


def contact_radius(bodies: Bodies) -> float:
    """Return the estimated radius of the contact, m: the geometric mean of its semi-axes."""
    return bodies.estimate.radius


def body_cell(bodies: Bodies) -> float:
    """Return the edge, m, of the body's cells where it touches, before they are split.

    As many lie over the diameter of a rod as ``accuracy.across`` says; over that of the nose or section that
    touches if the projectile has a shape of its own. A meshed barrier has cells of the same size; under a
    projectile with a mesh of its own, as many over its largest width.

    Raises
    ------
    SceneError
        If the nose or section that touches is so small that its cells are finer than any that a scene may
        state.
    """
    rod = bodies.rod
    plain = rod.is_rod or rod.own_mesh is not None
    width = rod.diameter if plain else 2 * _contact_radius(rod, bodies.first_inclination, bodies.scene.across)
    edge = width / bodies.scene.across
    if edge < FINEST:
        raise SceneError(
            f"touches with a nose so sharp that its cells are {edge * 1e6:.2g} um wide.",
            key="projectile",
            remedy=f"Give it a radius of at least {ceil(0.5e6 * FINEST * bodies.scene.across)} um there, or "
            "use fidelity rigid.",
        )
    return edge


def rod_cell(bodies: Bodies) -> float:
    """Return the edge, m, of the projectile's cells where it touches, before they are split.

    Of a mesh of its own it is the mean edge of the cells at the point that touches first.
    """
    mesh = bodies.rod.own_mesh
    if mesh is None:
        return body_cell(bodies)
    return float(meshes.edge_lengths(mesh.half(), bodies.touching_cells).mean())


@lru_cache(maxsize=256)
def _contact_radius(rod: ProjectileSpec, angle: float, across: int) -> float:
    """Return the radius, m, of the nose or section of a turned projectile that touches."""
    body = rod.body()
    assert isinstance(body, Turned), "a mesh of its own has its own cells"
    place = np.array([float(part) for part in body.contact_point(abs(angle))])
    try:
        return meshes.contact_radius(body.outline, place, across, body.bore)
    except meshes.MeshError as error:
        raise no_mesh(error, rod, across) from None


def levels_of(bodies: Bodies) -> tuple[int, int]:
    """Return how often the cells are split at the contact, for the rod and for a meshed barrier.

    Splitting comes as near to a stated size as halving can; the rod's is `ADVISED` where none is stated, the
    barrier's that of the rod.
    """
    tip = bodies.scene.accuracy.tip_size or max(size_for(bodies, ADVISED[kind(bodies)]), FINEST)
    edges = (rod_cell(bodies), tip), (body_cell(bodies), bodies.scene.accuracy.barrier_size or tip)
    rod, barrier = (max(0, round(log2(base / size))) for base, size in edges)
    return rod, barrier


def contact_edge(bodies: Bodies) -> float:
    """Return the edge, m, of the cells that resolve the contact, as they are split.

    A barrier that takes the rod's form resolves it with its own cells, else the larger ones count.
    """
    rod, barrier = levels_of(bodies)
    of_rod, of_barrier = rod_cell(bodies) / 2**rod, body_cell(bodies) / 2**barrier
    if bodies.contact.barrier_conforms:
        return float(of_barrier)
    return float(max(of_rod, of_barrier) if bodies.contact.compliant else of_rod)


def expected_cells(bodies: Bodies) -> float:
    """Return the cells over the radius that are expected on the mesh of the bodies.scene."""
    return float(contact_radius(bodies) / contact_edge(bodies) + RIM)


def size_for(bodies: Bodies, cells: float, radius: float | None = None) -> float:
    """Return the tip size, m, with so many cells over a radius, m, by default the estimated one.

    Halving comes as near to it as it can: the cells may be a factor of sqrt(2) larger or smaller.
    """
    widest = COARSEST * body_cell(bodies)
    return min((contact_radius(bodies) if radius is None else radius) / (cells - RIM), widest)


def level_size(bodies: Bodies, radius: float) -> float:
    """Return the edge, m, of cells of which as many as advised lie over the radius, m, of a contact."""
    return max(radius / (ADVISED[kind(bodies)] - RIM), FINEST)


def advice(bodies: Bodies, radius: float | None = None) -> str:
    """Return what to give so that a contact, of a radius, m, if that is known, is resolved.

    It is the size of cells that halving makes: a larger one may be rounded up to cells that are too large.
    """
    h = size_for(bodies, ADVISED[kind(bodies)], radius)
    if h < FINEST:
        return "No tip size resolves it: use the modal fidelity"
    edge = min(base / 2 ** ceil(log2(base / h)) for base in (rod_cell(bodies), body_cell(bodies)))
    return f"Give accuracy.tip_size = {max(edge, FINEST) * 1e3:.2g} mm or less"


def widest_tip_size(bodies: Bodies) -> float:
    """Return the largest ``accuracy.tip_size``, m, two digits, that just resolves the estimated contact.

    Splitting halves the edges, so they come out up to sqrt(2) longer than asked for.
    """
    return float(f"{size_for(bodies, LEAST[kind(bodies)]) / sqrt(2):.1e}")


def thin_cells(rod: ProjectileSpec) -> str:
    """Say when a cell of the user's mesh is so thin that it makes the time step small."""
    mesh = rod.own_mesh
    if mesh is None:
        return ""
    thick = meshes.thicknesses(mesh.half())
    thinnest, median = float(thick.min()), float(np.median(thick))
    if thinnest * THIN > median:
        return ""
    count, place = int((thick * THIN < median).sum()), mesh.half().points[mesh.half().cells[thick.argmin()]]
    x, y, z = 1e3 * place.mean(axis=0)
    return (
        f"The thinnest cell of the mesh, {thinnest * 1e6:.3g} um about ({x:.4g}, {y:.4g}, {z:.4g}) mm, allows"
        f" {thinnest / median:.1g} of the time step of the median cell, {median * 1e6:.3g} um; {count} "
        f"{'cell is' if count == 1 else 'cells are'} thinner than a tenth of that."
    )


def coarse_tip(bodies: Bodies) -> str:
    """Say when the mesh may not resolve the contact."""
    if expected_cells(bodies) >= LEAST[kind(bodies)] or bodies.scene.accuracy.target is not None:
        return ""  # a target chooses its own mesh
    return (
        f"The contact, about {contact_radius(bodies) * 1e3:.2g} mm in radius, may be too narrow for elements "
        f"of {contact_edge(bodies) * 1e3:.2g} mm at the tip: e, mu and all shares then depend on the mesh. "
        f"{advice(bodies)}."
    )
