"""The three barriers, of which a model has one: a rigid plane, an elastic block, or a block that yields.

The blocks stand on springs for the rest of a half-space (see `radiation` for the waves that leave).
"""

from itertools import pairwise

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.plasticity import SOURCE, buried_yield_ratio, first_yield_ratio, hardening_of
from fem_impact.case.effects.slots import Effect, ModelSpec

LEAST_SHARE = 0.02
COMPLIANCE = (
    "e of a yielding contact falls like E*^-1/2 (Thornton 1997, doi:10.1115/1.2787319), so a share s of the "
    "compliance changes it by s/2, half of the 2 % that e may be off; E_vib falls like tau^-4 and tau grows "
    "like E*^-0.4 (Hertz): 1.6 s"
)


def compliance_share(bodies: Bodies) -> float:
    """Return the barrier's share of the elastic contact compliance."""
    rod, plate = bodies.contact.rod, bodies.contact.barrier
    soft_rod, soft_plate = (1 - rod.nu**2) / rod.E, (1 - plate.nu**2) / plate.E
    return soft_plate / (soft_rod + soft_plate)


def yield_ratio(bodies: Bodies) -> float:
    """Return the peak pressure over that of first yield in the plate, the largest of its layers."""
    strata, pair = bodies.barrier.strata, bodies.contact
    under = [buried_yield_ratio(pair, metal, depth) for (depth, _), (_, metal) in pairwise(strata)]
    return max([first_yield_ratio(pair, pair.barrier, pair.rod), *under])


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
    spec.under_laws = tuple(hardening_of(metal) if metal.yields else None for metal in under)


RIGID = Effect(
    "barrier-rigid",
    "The barrier is a rigid plane.",
    "The barrier is not rigid.",
    "barrier's share of the contact compliance (rigid below the threshold)",
    LEAST_SHARE,
    COMPLIANCE,
    compliance_share,
    fill_rigid,
)
ELASTIC = Effect(
    "barrier-elastic",
    "The barrier is an elastic block on springs.",
    "The barrier is no purely elastic block.",
    "barrier's share of the contact compliance (elastic above, where nothing yields)",
    LEAST_SHARE,
    COMPLIANCE,
    compliance_share,
    fill_elastic,
)
ELASTOPLASTIC = Effect(
    "barrier-elastoplastic",
    "The barrier is a block on springs that yields under the contact.",
    "The barrier does not yield.",
    "peak pressure over first yield of the barrier, (v/v_yield)^0.4",
    1.0,
    SOURCE,
    yield_ratio,
    fill_elastoplastic,
)
