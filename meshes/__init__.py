"""Structured hexahedral meshes of rods and barrier blocks."""

from meshes.block import block, thin_skin_rise, with_thin_skin
from meshes.cut import without_slices
from meshes.errors import MeshError
from meshes.files import MeshFile, read, write
from meshes.hexmesh import OUTER, SKIN, SYMMETRY, HexMesh
from meshes.quality import Quality, quality, volume
from meshes.refine import refine
from meshes.rod import RodMesh, rod
from meshes.sphere import sphere
from meshes.turned import contact_radius, turned
from meshes.zone import Zone

__all__ = [
    "OUTER",
    "SKIN",
    "SYMMETRY",
    "HexMesh",
    "MeshError",
    "MeshFile",
    "Quality",
    "RodMesh",
    "Zone",
    "block",
    "contact_radius",
    "quality",
    "read",
    "refine",
    "rod",
    "sphere",
    "thin_skin_rise",
    "turned",
    "volume",
    "with_thin_skin",
    "without_slices",
    "write",
]
