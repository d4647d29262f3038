"""Structured hexahedral meshes of rods and barrier blocks."""
