"""Plates that are free underneath: which are meshed through their thickness, and what is refused."""

import math

import numpy as np

from fem_impact.arrays import Array
from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.barrier import compliance_share
from fem_impact.errors import SceneError
from fem_impact.physics.contact import pressure_speed
from fem_impact.physics.plate import contact_time, least_span, plate_waves, zener_number
from fem_impact.scene.barrier import Barrier
from fem_impact.tables.text import plain

# of e, by a half-space under the contact: above it that is told, and finite elements mesh the plate through
THIN = 0.02
DEEP = 0.1  # dent over the thickness of a plate or layer, from which it is told
ROWS = 2  # of cells through a plate at least: their lumped masses turn with 1.5 times the plate's inertia
FLATTEST = 0.5  # least height of the rows of a plate over their width
MOST_ZENER = 2.0  # up to it `contact_time` is no shorter than Zener's contact, see there
# of a plate before refinement: above the first its cells are twice as large and split once more at the
# contact, as long as `ROWS` of them are no flatter than `FLATTEST`; the second takes about 1 GB
MANY_CELLS, MOST_CELLS = 5e4, 3e5
# cells times the passages of a pressure wave through one of them while the plate is touched, above which they
# widen towards its edges; how many times wider they become at most, and least cells in a bending wave there
MANY_PASSAGES, WIDEST, PER_WAVE = 2.5e7, 4.0, 12.0


def half_space_error(bodies: Bodies) -> float:
    """Return how far e may be off, of itself, where a plate that bends is a half-space under the contact.

    Under a force P a half-space has u = (1 + nu)(3 - 2 nu) P / (2 pi E h) of its give deeper than h on the
    axis (Boussinesq), and Hertz' contact of the radius a gives 3 (1 - nu^2) P / (4 E a) in all (Johnson 1985,
    Contact Mechanics, sections 3.2 and 4.2, doi:10.1017/CBO9781139171731). e changes by half of the share of
    the compliance that is wrong (Thornton 1997, doi:10.1115/1.2787319). It is 0 for other barriers.
    """
    return 0.5 * _deeper(bodies) * compliance_share(bodies) if bodies.contact.compliant else 0.0


def _deeper(bodies: Bodies) -> float:
    barrier = bodies.barrier
    if not barrier.bends or barrier.thickness is None:
        return 0.0
    nu = barrier.material.nu
    return 2 * (3 - 2 * nu) / (3 * math.pi * (1 - nu)) * 0.5 * contact_width(bodies) / barrier.thickness


def contact_width(bodies: Bodies) -> float:
    """Return the estimated width of the contact, m: twice the geometric mean of its semi-axes."""
    return 2 * bodies.estimate.radius


def _width_told(bodies: Bodies) -> str:
    """Return the width of the contact as text; of one much longer than wide also what it is the mean of."""
    size, width = bodies.estimate, f"{plain(contact_width(bodies) * 1e3, 2)} mm"
    short, long = sorted((2e3 * size.a_t, 2e3 * size.a_b))
    if long < 4 * short:
        return width
    return f"{width} (the geometric mean of {plain(long, 2)} mm and {plain(short, 2)} mm)"


def is_thin(bodies: Bodies) -> bool:
    """Return whether finite elements mesh a plate through its thickness, as it is thin beside the contact."""
    return "plate-bending" in bodies.effects and half_space_error(bodies) > THIN


def is_wider(bodies: Bodies) -> bool:
    """Return whether the contact is wider than a plate that bends is thick, so that it is no local one."""
    return bodies.barrier.bends and contact_width(bodies) > (bodies.barrier.thickness or math.inf)


def thin_plate(bodies: Bodies, meshed_through: bool) -> str:
    """Tell where a plate that bends is thin beside the contact, and what that means for e."""
    error, h = half_space_error(bodies), bodies.barrier.thickness
    if h is None or error <= THIN:
        return ""
    width = contact_width(bodies)
    thin = f"the contact is {_width_told(bodies)} wide, {plain(width / h, 2)} of the plate's thickness"
    if meshed_through:
        return (
            f"idealised: {thin}, so the plate is meshed through it and bends by itself: its impedance is not "
            f"added, which would count the bending twice{_hardly_left(bodies, h)}"
        )
    return (
        f"idealised: {thin}, and taken as that of a half-space, which gives {100 * _deeper(bodies):.2g} % of "
        f"its way deeper than the plate is thick: e may be off by some {100 * error:.2g} %"
    )


def pressed_part(barrier: Barrier) -> tuple[str, float | None]:
    """Return what of a barrier a dent is in, and its thickness, m, None of a massive one."""
    return ("first layer", barrier.layers[0].thickness) if barrier.layers else ("plate", barrier.thickness)


def too_thin(bodies: Bodies, meshed: bool) -> tuple[str, ...]:
    """Tell where a dent is deep beside the plate, or the wall of a tube thin, and what that leaves out.

    Without a mesh the wall behind a contact that is wider than it counts as massive.
    """
    size, rod, (part, first) = bodies.estimate, bodies.rod, pressed_part(bodies.barrier)
    dent, told = f"the estimated dent is {size.depth * 1e3:.2g} mm deep", []
    if first is not None and size.depth > DEEP * first:
        told.append(
            f"left out: {dent}, {size.depth / first:.2g} of the {part}'s {first * 1e3:.2g} mm: that it "
            "thins, tears or is pierced"
        )
    if rod.bore:
        (rho, z), (along, _, inner) = bodies.contact.touch_point, rod.wall()
        wall, width = float(np.hypot(along - z, inner - rho).min()), contact_width(bodies)
        behind = f"the bore {wall * 1e3:.2g} mm behind it: that the wall buckles, folds or is pierced"
        if size.depth > wall:
            told.append(f"left out: {dent}, {behind}")
        elif width > wall and not meshed:
            told.append(f"left out: the contact is {_width_told(bodies)} wide, {behind}")
    return tuple(told)


def _hardly_left(bodies: Bodies, thickness: float) -> str:
    """Tell where a plate takes nearly all the energy, so that the contact lasts until the time is up."""
    number = zener_number(bodies.contact)
    if number <= MOST_ZENER:
        return ""
    enough = 1e3 * thickness * math.sqrt(number / MOST_ZENER)  # the impedance grows as its square
    return (
        f". Zener's lambda is {number:.2g}: beyond {MOST_ZENER:g} the rod hardly leaves the plate (by his "
        "equation e is below 0.021), and the run may end without e, at max_time. A thickness of "
        f"{enough:.2g} mm brings lambda down to {MOST_ZENER:g}"
    )


def rows_through(bodies: Bodies, base: float) -> int:
    """Return how many rows of cells of width ``base``, m, lie through a plate."""
    assert bodies.barrier.thickness is not None, "a plate that bends has a thickness"
    return max(ROWS, round(bodies.barrier.thickness / base))


def doublings(bodies: Bodies, edge: float) -> int:
    """Return how often cells of an ``edge``, m, are made twice as large away from the contact with a plate.

    It is 0 but for a plate that is meshed through and reaches so far that it would have too many cells.
    """
    thickness, count = bodies.barrier.thickness, 0
    if thickness is None or not is_thin(bodies):
        return 0
    reach = plate_waves(bodies.contact)[1]
    while True:
        base = edge * 2**count
        cells = 2 * (reach / base) ** 2 * rows_through(bodies, base)
        if cells <= MANY_CELLS or thickness < FLATTEST * ROWS * 2 * base:
            return count
        count += 1


def widening(bodies: Bodies, base: float) -> float:
    """Return how many times wider than ``base``, m, at the contact cells are at the edges of a plate.

    It is 1 but for a plate that is meshed through and would take long with equal cells.
    """
    speed, reach = plate_waves(bodies.contact)
    time = contact_time(bodies.contact)
    cells = 2 * (reach / base) ** 2 * rows_through(bodies, base)
    if cells * pressure_speed(bodies.barrier.material) * time / base <= MANY_PASSAGES:
        return 1.0
    shortest = 2 / math.sqrt(3) * speed * time  # of three times the frequency 1 / (2 time) of that speed
    return min(max(shortest / (PER_WAVE * base), 1.0), WIDEST)


def require_plate(bodies: Bodies, meshed_through: bool) -> None:
    """Refuse a plate too thin for a local contact, or too narrow for its bending waves (SceneError)."""
    barrier, estimate = bodies.barrier, bodies.estimate
    if not barrier.bends or barrier.thickness is None:
        return
    if is_wider(bodies) and not meshed_through:
        by_mesh = ", or use fidelity solid, which meshes the plate through its thickness"
        raise SceneError(
            f"is less than the width of the contact, {_width_told(bodies)}: it is no local one, and the "
            "plate would bulge under it.",
            key="barrier.thickness",
            value=f"{barrier.thickness * 1e3:.3g} mm",
            remedy=f"Give a thicker plate or a lower speed{by_mesh * is_thin(bodies)}.",
        )
    if barrier.span is not None and barrier.span < (least := least_span(bodies.contact)):
        raise SceneError(
            "is so short that bending waves are back before the contact ends. It lasts "
            f"{contact_time(bodies.contact) * 1e6:.3g} us as the plate gives way "
            f"({estimate.duration * 1e6:.3g} us on a massive barrier).",
            key="barrier.span",
            value=f"{barrier.span * 1e3:.3g} mm",
            remedy=f"Give at least {math.ceil(least * 1e3)} mm.",
        )


def require_plate_mesh(bodies: Bodies, base: float, block: tuple[Array, Array]) -> None:
    """Refuse a plate whose rows would be too flat, or whose mesh has too many cells (SceneError).

    ``base``, m, is the width of its cells, ``block`` its lowest and highest corner before rows are moved.
    """
    h, across = bodies.barrier.thickness, bodies.scene.across
    assert h is not None, "a plate that bends has a thickness"
    flat, value = h / (ROWS * base), f"{h * 1e3:.3g} mm"
    if flat < FLATTEST:
        raise SceneError(
            f"leaves {ROWS} rows of cells, {base * 1e3:.3g} mm wide, only {flat:.2g} as high as wide.",
            key="barrier.thickness",
            value=value,
            remedy=f"Give accuracy.across = {2 * math.ceil(0.5 * across * FLATTEST / flat)} or more, or a "
            "thicker plate.",
        )
    low, high = block
    cells = math.prod((high - low) / base)
    if cells > MOST_CELLS:
        reach = plate_waves(bodies.contact)[1]
        raise SceneError(
            f"needs a mesh of {cells:.2g} cells: to {reach * 1e3:.3g} mm beside the contact, from where "
            f"bending waves are back after it, with cells {base * 1e3:.3g} mm wide at the contact.",
            key="barrier.thickness",
            value=value,
            remedy="Give a thicker plate, or a projectile that touches it for a shorter time.",
        )
