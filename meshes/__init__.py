"""Structured hexahedral meshes of rods and barrier blocks."""

from meshes.block import (
    block,
    drawn_depths,
    drawn_to_ends,
    thin_skin_rise,
    with_columns_at,
    with_free_bottom,
    with_rows_at,
    with_thin_skin,
    with_wide_edges,
)
from meshes.common import ClosedEndError, MeshError, MissingReaderError
from meshes.cut import without_slices
from meshes.faces import face_at
from meshes.files import MeshFile, read, write
from meshes.hexmesh import OUTER, SKIN, SYMMETRY, HexMesh, owners
from meshes.moments import CellMoments, cell_moments
from meshes.own import TIPS, OwnBody, Stated, own_body, read_own
from meshes.quality import Quality, edge_lengths, quality, thicknesses, volume
from meshes.reading.read import extent
from meshes.reading.stored import sets_named
from meshes.reading.text import included
from meshes.refine import refine
from meshes.rod import RodMesh, rod
from meshes.rows import with_thin_rows
from meshes.sphere import pole_edge, sphere
from meshes.symmetry import PARTS
from meshes.turned import cells_across, contact_radius, turned
from meshes.zone import Cloud, Zone

__all__ = [
    "OUTER",
    "PARTS",
    "SKIN",
    "SYMMETRY",
    "TIPS",
    "CellMoments",
    "ClosedEndError",
    "Cloud",
    "HexMesh",
    "MeshError",
    "MeshFile",
    "MissingReaderError",
    "OwnBody",
    "Quality",
    "RodMesh",
    "Stated",
    "Zone",
    "block",
    "cell_moments",
    "cells_across",
    "contact_radius",
    "drawn_depths",
    "drawn_to_ends",
    "edge_lengths",
    "extent",
    "face_at",
    "included",
    "own_body",
    "owners",
    "pole_edge",
    "quality",
    "read",
    "read_own",
    "refine",
    "rod",
    "sets_named",
    "sphere",
    "thicknesses",
    "thin_skin_rise",
    "turned",
    "volume",
    "with_columns_at",
    "with_free_bottom",
    "with_rows_at",
    "with_thin_rows",
    "with_thin_skin",
    "with_wide_edges",
    "without_slices",
    "write",
]
