"""A film of the waves in the rod, drawn off screen from a field file."""

from fem_impact.render.film import RenderResult, render
from fem_impact.render.probe import require_gl

__all__ = ["RenderResult", "render", "require_gl"]
