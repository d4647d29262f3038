"""Films of the waves in the rod, drawn off screen from field files."""

from fem_impact.render.film import RenderResult, render
from fem_impact.render.probe import require_gl
from fem_impact.render.side_by_side import render_side_by_side

__all__ = ["RenderResult", "render", "render_side_by_side", "require_gl"]
