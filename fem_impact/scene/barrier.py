"""What the rod strikes: a massive body, a plate that bends, or a body that is free to move."""

from __future__ import annotations

from dataclasses import dataclass
from typing import get_args

from fem_impact.errors import SceneError
from fem_impact.scene import fields
from fem_impact.scene.checks import check_choice, check_numbers
from fem_impact.scene.material import Material


@dataclass(frozen=True, slots=True)
class Barrier:
    """What the rod strikes: massive and at rest unless stated otherwise.

    ``boundary`` is what holds the outer faces of a meshed block: springs and dashpots of the half-space
    around it, or a rigid frame (``fixed``), as in plain models of other codes.
    A plate of ``thickness``, m, has the ``support`` of a base that it is bonded to (``backed``), or is free
    underneath and so wide that bending waves run away (``infinite``); ``span``, m, says how wide, at least.
    A barrier of ``mass``, kg, is free to move and does not turn. ``v_n`` and ``v_t``, m/s, are its velocity
    before the impact.
    """

    material: Material
    boundary: fields.Boundary = "half-space"
    thickness: float | None = None
    support: fields.Support = "backed"
    span: float | None = None
    mass: float | None = None
    v_n: float = 0.0
    v_t: float = 0.0

    def __post_init__(self) -> None:
        check_choice(self.boundary, get_args(fields.Boundary), "boundary")
        check_choice(self.support, get_args(fields.Support), "support")
        check_numbers(self, fields.BARRIER)
        _check_support(self)

    @property
    def bends(self) -> bool:
        """Whether it is a plate whose bending waves run away."""
        return self.support == "infinite"


def _check_support(barrier: Barrier) -> None:
    """Refuse a barrier that is stated in two ways."""
    if barrier.bends and barrier.thickness is None:
        raise SceneError("is missing: how much a plate bends depends on it.", key="thickness")
    if barrier.bends and barrier.mass is not None:
        remedy = 'Leave out the mass, or support = "infinite".'
        raise SceneError("is that of a free body, but an infinite plate has none.", key="mass", remedy=remedy)
    if barrier.span is not None and not barrier.bends:
        remedy = 'Leave it out, or add support = "infinite" and a thickness.'
        raise SceneError("means nothing for a barrier that does not bend.", key="span", remedy=remedy)
    if barrier.boundary == "fixed" and (barrier.bends or barrier.mass is not None):
        remedy = 'Leave out boundary = "fixed", or the mass and the support.'
        raise SceneError("holds the barrier, which is stated to give way.", key="boundary", remedy=remedy)
