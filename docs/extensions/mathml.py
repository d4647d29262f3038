"""Formulas as MathML, which browsers draw by themselves: pages need neither a network nor a server."""

import re

from docutils.nodes import SkipNode
from docutils.utils.math.latex2mathml import tex2mathml

_ACCENTED = re.compile(
    r"<munderover>\s*(<mi>[^<]*</mi>)\s*(<m[ion]>[^<]*</m[ion]>)\s*(<mo[^>]*>[˙¨]</mo>)\s*</munderover>"
)


def mathml(formula, block=False):
    """Return a formula as MathML; an index of a letter with dots stands beside it, not below."""
    drawn = tex2mathml(formula, as_block=block)
    return _ACCENTED.sub(r"<msub><mover accent='true'>\1\3</mover>\2</msub>", drawn)


def _inline(writer, node):
    writer.body.append(mathml(node.astext()))
    raise SkipNode


def _block(writer, node):
    writer.body.append(f'<div class="math">{mathml(node.astext(), block=True)}</div>')
    raise SkipNode


def setup(app):
    """Register the writer of formulas."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
