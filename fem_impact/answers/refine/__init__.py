"""Meshes from coarse to fine until an error is reached or time is used up."""
