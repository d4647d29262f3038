"""Contact as velocity impulses at lumped nodes: on a rigid plane, or between two meshed surfaces."""

from fem_impact.solid.contact.book import ContactBook
from fem_impact.solid.contact.patch import STEEP, Patch, make_patch
from fem_impact.solid.contact.plane import PlaneContact
from fem_impact.solid.contact.surface import SurfaceContact

__all__ = ["STEEP", "ContactBook", "Patch", "PlaneContact", "SurfaceContact", "make_patch"]
