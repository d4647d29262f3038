"""The three barriers, of which a model has one: a rigid plane, an elastic block, or a block that yields.

The blocks stand on springs for the rest of a half-space (see `radiation` for the waves that leave).
"""

from itertools import pairwise

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.plasticity import buried_yield_ratio, first_yield_ratio, hardening_of
from fem_impact.case.effects.slots import ModelSpec


def compliance_share(bodies: Bodies) -> float:
    """Return the barrier's share of the elastic contact compliance."""
    rod, plate = bodies.contact.rod, bodies.contact.barrier
    soft_rod, soft_plate = (1 - rod.nu**2) / rod.E, (1 - plate.nu**2) / plate.E
    return soft_plate / (soft_rod + soft_plate)


def yield_ratio(bodies: Bodies) -> float:
    """Return the peak pressure over that of first yield in the plate, the largest of its layers."""
    strata, pair = bodies.barrier.strata, bodies.contact
    under = [buried_yield_ratio(pair, metal, depth) for (depth, _), (_, metal) in pairwise(strata)]
    return max([first_yield_ratio(pair, pair.barrier, pair.rod if pair.rod_yields else None), *under])


def fill_rigid(bodies: Bodies, spec: ModelSpec) -> None:
    """Change no slot: the rigid plane is the default."""


def fill_elastic(bodies: Bodies, spec: ModelSpec) -> None:
    """Mesh the block."""
    spec.meshed_barrier = True


def fill_elastoplastic(bodies: Bodies, spec: ModelSpec) -> None:
    """Mesh the block and let it yield."""
    spec.meshed_barrier = True
    first, *under = (material for _, material in bodies.barrier.strata)
    some = any(metal.yields for metal in under)  # then the first may be one that never yields
    spec.barrier_law = None if some and not first.yields else hardening_of(first)
    if spec.barrier_law and bodies.struck:
        spec.barrier_law = spec.barrier_law.times(bodies.struck.yield_stress / first.yield_stress)
    spec.under_laws = tuple(hardening_of(metal) if metal.yields else None for metal in under)
