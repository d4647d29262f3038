"""Layers of a barrier: which rows of its mesh end at their interfaces, and what is refused."""

from dataclasses import replace
from itertools import pairwise
from math import ceil, inf, sqrt

import numpy as np

from fem_impact.arrays import Array
from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.plasticity import buried_yield_ratio, hardening_of, struck
from fem_impact.case.plates import rows_through, widening
from fem_impact.case.recorded import AnyZones
from fem_impact.case.zones import Corners, zones_of
from fem_impact.errors import SceneError
from fem_impact.physics import layered
from fem_impact.physics.contact_law import REPRESENTATIVE
from fem_impact.scene.material import Material
from meshes import drawn_depths

FLATTEST = 0.2
"""Least height of the cells of a layer over their height without it.

Layers of the barrier's own material change e of a steel rod on aluminium by at most .004 at 0.22 to 1, and by
.005 at 0.11; of a round tip by .011 and .015, as much as other places of the grid do.
"""
# half-space springs of a layer are too stiff at its sides: 8 mm of steel on aluminium gave 9 % less under a
# static load than a layered half-space (Burmister 1945) with 6 mm around, 4 % with 12 mm and 2 % with 24 mm
AROUND = 1.5
# margin under a line over half of its length: a rod of 160 x 16 mm on its side, on coarse levels and with
# plain dashpots, has e .823, .802, .801 and .801 with margins of .08, .2, .5 and .9
BESIDE = 0.25
# share of a free barrier's mass that its block has at most, and how many times smaller its margin is tried:
# an aluminium cone of 6 mm on steel at -17 m/s has mu and E_vib / E_0 of .2185 and .01622 with margins of
# 4 and 2 mm, .2181 and .01622 with 1 mm
MOST_OF_BARRIER, SMALLER = 0.5, 0.8
MOST_CELLS = 3e5  # largest number of cells of a block before refinement: about 1 GB
UNDER = 2.0  # rows of the base's cells under the last layer, at least


def interfaces(bodies: Bodies) -> Array:
    """Return the depths (k,), m, at which the layers end."""
    return np.array([depth for depth, _ in bodies.barrier.strata if depth < inf])


def block_of(bodies: Bodies, zones: AnyZones) -> Corners:
    """Return the corners of the barrier's block, before its rows are moved.

    It is wider than its fine zone by the margin of the scene, of a thin body by its diameter at most, and of
    layers by `AROUND` times their depth, which it holds, and of a contact that is a line by `BESIDE` times
    half of its length where the barrier is not free; its rows are as high as wide. Of a light free
    barrier it is no more than a half, and of cells it has no more than `MOST_CELLS` where no layers are, as
    far as it can be. A plate that is meshed through its thickness goes on to its edges instead, before its
    cells widen.
    """
    if zones.edges:
        low, high = zones.block(2 * zones.edges / (1 + widening(bodies, zones.base)))
        return np.array([*low[:2], -rows_through(bodies, zones.base) * zones.base]), high
    ends, whole = interfaces(bodies), bodies.barrier.mass
    margin = min(bodies.scene.accuracy.block_margin, bodies.scene.projectile.diameter)
    line = zones.line if whole is None else 0.0
    margin = max(margin, AROUND * ends.max(initial=0.0), BESIDE * line)
    low, high = zones.block(margin)
    most = inf if len(ends) else MOST_CELLS * zones.base**3
    if whole is not None:
        most = min(most, MOST_OF_BARRIER * whole / (2 * bodies.barrier.material.rho))
    while np.prod(high - low) > most and margin > zones.base:
        margin *= SMALLER
        low, high = zones.block(margin)
    if len(ends):
        deep = max(-float(low[2]), float(ends[-1]) + UNDER * zones.base + zones.rise)
        low = np.array([low[0], low[1], -ceil(deep / zones.base) * zones.base])
    return low, high


def require_heavier(bodies: Bodies, zones: AnyZones) -> None:
    """Refuse a free barrier that is lighter than its block even where that is smallest (SceneError)."""
    whole = bodies.barrier.mass
    if whole is None:
        return
    low, high = block_of(bodies, zones)
    block = 2 * min(material.rho for _, material in bodies.barrier.strata) * float(np.prod(high - low))
    if whole <= block:
        raise lighter_than_block(whole, block)


def lighter_than_block(whole: float, block: float) -> SceneError:
    """Return the refusal of a free barrier of a mass, kg, whose meshed block has more, kg."""
    return SceneError(
        f"is less than the {block:.3g} kg of the block that finite elements mesh around the contact, whose "
        "size follows their cells.",
        key="barrier.mass",
        value=f"{whole:.3g} kg",
        remedy=f"Give more than {block:.3g} kg; or smaller cells, such as twice the accuracy.across; or the "
        "effect barrier-rigid: it stays a rigid body.",
    )


def moved_rows(bodies: Bodies, zones: AnyZones) -> tuple[Array, Array]:
    """Return depths (k,), m, of rows of whole cells before and after they are moved to the interfaces.

    The first is the surface, the last the bottom, which moves to the underside of a plate that is meshed
    through its thickness; between two of them depths are stretched evenly.
    """
    low, _ = block_of(bodies, zones)
    count = max(1, round(-float(low[2]) / zones.base))
    rows = drawn_depths(np.linspace(0.0, -float(low[2]), count + 1), zones.barrier_size, zones.skin_rows)
    chosen, done = [0], 0.0
    for depth in interfaces(bodies):
        stretch = (depth - done) / (rows[chosen[-1] + 1 : -1] - rows[chosen[-1]])
        if not len(stretch):
            raise _too_thin(bodies, zones, 0.0)
        chosen.append(chosen[-1] + 1 + int(np.argmin(np.abs(np.log(stretch)))))
        done = float(depth)
    bottom = bodies.barrier.thickness if zones.edges else rows[-1]
    return rows[[*chosen, -1]], np.array([0.0, *interfaces(bodies), bottom])


def as_one(bodies: Bodies) -> Material:
    """Return the material that stands for the layers of a barrier in a contact law, see `layered`.

    It is that of the first layer, with the stiffness and strength that all of them have under a contact as
    wide as that on the first one alone.
    """
    strata, size = bodies.barrier.strata, bodies.estimate
    E, nu = layered.elastic(strata, size.radius)
    first, strain = strata[0][1], REPRESENTATIVE * size.radius / sqrt(size.R1 * size.R2)
    flows = [float(hardening_of(one).flow_stress(strain)) if one.yields else inf for _, one in strata]
    stress = flows[-1]
    for at in range(len(strata) - 2, -1, -1):
        depth, upper = strata[at]
        stress = layered.hardness(depth, size.radius, (flows[at], upper.E), (stress, strata[at + 1][1].E))
    starts = first.yield_stress * (stress / flows[0] if first.yields else 1.0)
    ultimate = max(first.ultimate_stress, starts)  # of a soft thin layer on a hard base the own one is less
    try:
        return replace(first, E=E, nu=nu, yield_stress=starts, ultimate_stress=ultimate)
    except SceneError:  # no metal is so soft and so strong
        raise SceneError(
            f"are {first.name} that yields on what is so much softer that no one material stands for all of "
            f"them (E {E / 1e9:.2g} GPa, yield stress {starts / 1e6:.3g} MPa), as the reduced model needs.",
            key="barrier.layers",
            remedy="Use fidelity solid, or leave the layers out.",
        ) from None


def flows_below(bodies: Bodies) -> str:
    """Return what yields under a first layer that does not, empty where nothing does."""
    strata, pair = bodies.barrier.strata, bodies.contact
    if pair.barrier.yields or not pair.barrier_yields:
        return ""
    buried = ((depth, metal) for (depth, _), (_, metal) in pairwise(strata) if metal.yields)
    flows = any(buried_yield_ratio(pair, metal, depth) > 1.0 for depth, metal in buried)
    return "a base that yields under layers that do not" * flows


def require_layers(bodies: Bodies, fidelity: str) -> None:
    """Refuse layers that no row of cells fits, and such as the reduced model has no law of (SceneError)."""
    if not bodies.barrier.layers:
        return
    if fidelity == "modal" and (what := flows_below(bodies)):
        raise SceneError(
            f"are {what}: the reduced model has no law of that.",
            key="barrier.layers",
            remedy="Use fidelity solid, or leave the layers out.",
        )
    if fidelity == "solid" and bodies.contact.compliant:
        zones = zones_of(bodies)
        before, after = moved_rows(bodies, zones)
        share = float((np.diff(after) / np.diff(before)).min())
        if share < FLATTEST:
            raise _too_thin(bodies, zones, share)
        low, high = block_of(bodies, zones)
        if (count := float(np.prod((high - low) / zones.base))) > MOST_CELLS:
            raise _too_deep(bodies, zones.base, count)


def _too_thin(bodies: Bodies, zones: AnyZones, share: float) -> SceneError:
    thin = int(np.argmin([layer.thickness for layer in bodies.barrier.layers]))
    thickness = bodies.barrier.layers[thin].thickness
    across = 2 * ceil(0.5 * bodies.scene.across * zones.base * FLATTEST / thickness * 1.5)
    flatness = f"their height would be {share:.2g} of their width" if share else "no row is left for it"
    return SceneError(
        f"fits no row of the barrier's cells, {zones.base * 1e3:.3g} mm wide: {flatness}.",
        key=f"barrier.layers[{thin + 1}].thickness",
        value=f"{thickness * 1e3:.3g} mm",
        remedy=f"Give accuracy.across = {max(across, bodies.scene.across + 2)}, or a thicker layer.",
    )


def _too_deep(bodies: Bodies, base: float, count: float) -> SceneError:
    thick = int(np.argmax([layer.thickness for layer in bodies.barrier.layers]))
    layer, wide = bodies.barrier.layers[thick], 2e3 * bodies.estimate.radius
    depth = 1e3 * float(interfaces(bodies)[-1])
    return SceneError(
        f"makes a block of {count:.1g} cells, {base * 1e3:.3g} mm wide, down to the base under the layers, "
        f"{depth:.3g} mm deep.",
        key=f"barrier.layers[{thick + 1}].thickness",
        value=f"{1e3 * layer.thickness:.3g} mm",
        remedy=f'Give "{layer.material.name}" as barrier.material, without this layer and those under it: a '
        f"contact of about {wide:.2g} mm does not feel what lies so deep. Or give a thinner layer, or a "
        "smaller accuracy.across.",
    )


def thin_layer(bodies: Bodies) -> str:
    """Say where the first layer is thin for the contact, whose estimates know it alone."""
    if len(struck(bodies)) < 2:
        return ""
    thickness, radius = bodies.barrier.layers[0].thickness, bodies.estimate.radius
    return (
        f"The first layer, {thickness * 1e3:.3g} mm, is thin for a contact of about {1e3 * radius:.2g} mm "
        "radius; cells and most effects are chosen as if it were thick."
    )
