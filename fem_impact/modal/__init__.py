"""The reduced model: free modes of the rod, a local contact law with friction, repeated contacts."""

from fem_impact.contact_law import ContactLaw, contact_law, restitution
from fem_impact.modal.impact import ModalResult, solve
from fem_impact.modal.record import reduce
from fem_impact.modal.rod import ModalRod, modal_rod

__all__ = [
    "ContactLaw",
    "ModalResult",
    "ModalRod",
    "contact_law",
    "modal_rod",
    "reduce",
    "restitution",
    "solve",
]
