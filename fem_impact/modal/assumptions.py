"""What the reduced model leaves out, in sentences that its outcome carries."""

from __future__ import annotations

__all__ = ["ASSUMPTIONS"]

ASSUMPTIONS = (
    "Contact by Hertz or, with a yielding body, by Thornton's law with 2.8 times the softer yield stress; "
    "the elliptic contact is replaced by a round one of the same sqrt(R1 R2).",
    "The indented surface keeps the barrier's direction: no ploughing, so a sliding contact has mu = f.",
    "Tangential force by Coulomb's limit and Mindlin's stiffness: no plastic shear flow under the tip.",
    "No hardening, no residual stress, no waves in the barrier.",
    "A later contact finds the rod and the barrier indented where they touch, as a first one left them.",
)
