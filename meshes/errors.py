"""Errors of the mesh package."""

__all__ = ["MeshError"]


class MeshError(ValueError):
    """A mesh cannot be built or is not usable; the message names the place and the remedy."""
