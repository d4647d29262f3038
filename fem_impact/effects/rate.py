"""Rate hardening: the flow stress of steel grows with the strain rate.

The flow stress is multiplied by 1 + C ln(rate / 1 per s) for plastic strain rates above 1 per s (Johnson &
Cook 1985, doi:10.1016/0013-7944(85)90052-9, eq 1, no thermal softening). C = 0.022 is their value for the
mild steel 1006 (A constitutive model and data for metals subjected to large strains, high strain rates and
high temperatures, 7th Int. Symp. Ballistics, The Hague 1983), whose yield stress of 350 MPa is the plate's
within a tenth. Their table has .060 for Armco iron, .055 for Carpenter electrical iron, .014 for 4340 and
.012 for S-7 steel; it was read in a public transcription, not in the proceedings themselves.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from fem_impact.effects.slots import Effect, ModelSpec, bodies_of
from fem_impact.physics.hardening import SLOWEST, C, RateFactor, rate_gain

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


def number(scene: Scene) -> float:
    """Return the relative gain of the flow stress at the strain rate of the indentation."""
    return rate_gain(bodies_of(scene))


def fill(scene: Scene, spec: ModelSpec) -> None:
    """Give every material that yields its rate factor."""
    factor = RateFactor(C, SLOWEST)
    spec.rod_law = replace(spec.rod_law, rate=factor) if spec.rod_law else None
    spec.barrier_law = replace(spec.barrier_law, rate=factor) if spec.barrier_law else None


EFFECT = Effect(
    "rate-hardening",
    "Flow stresses grow with the strain rate (Johnson and Cook, mild steel).",
    "Flow stresses do not depend on the strain rate.",
    "C ln(0.4 a/(R tau) per 1/s), gain of the flow stress",
    0.03,
    "e grows like sigma_y^(5/8) (Thornton 1997, doi:10.1115/1.2787319): 2 % of e are 3 % of sigma_y",
    number,
    fill,
    needs=("rod-plasticity", "barrier-elastoplastic"),
)
