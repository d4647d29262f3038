"""Rate hardening: the flow stress of a metal grows with the strain rate, by the law of its own data.

The law is Johnson and Cook's or Cowper and Symonds' (`fem_impact.scene.material`). A metal without data has
none, and the case says so; no law of another metal takes its place.
"""

from dataclasses import replace

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.slots import ModelSpec
from fem_impact.physics.hardening import HardeningLaw, rate_gain, rate_law, strain_rate
from fem_impact.scene.material import Material


def number(bodies: Bodies) -> float:
    """Return the largest relative gain of flow stress, of the bodies that yield, or of both if none does."""
    metals = bodies.contact.yielding or [bodies.contact.rod, bodies.contact.barrier]
    rate = strain_rate(bodies.estimate)
    return max(rate_gain(metal, rate) for metal in metals)


def fill(bodies: Bodies, spec: ModelSpec) -> None:
    """Give every material that yields its own rate law."""
    spec.rod_law = _faster(spec.rod_law, bodies.contact.rod)
    spec.barrier_law = _faster(spec.barrier_law, bodies.contact.barrier)
    under = zip(spec.under_laws, bodies.barrier.strata[1:], strict=True) if spec.under_laws else ()
    spec.under_laws = tuple(_faster(law, metal) for law, (_, metal) in under)


def _faster(law: HardeningLaw | None, metal: Material) -> HardeningLaw | None:
    return replace(law, rate=rate_law(metal)) if law else None
