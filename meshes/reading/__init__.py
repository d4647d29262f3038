"""What a mesh file holds, of each format by the reader that reads it right."""

from meshes.reading.read import stored_mesh
from meshes.reading.stored import NODES, StoredMesh

__all__ = ["NODES", "StoredMesh", "stored_mesh"]
