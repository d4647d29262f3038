"""What the rod strikes: a massive body, a plate that bends, or a body that is free to move."""

from dataclasses import dataclass
from itertools import accumulate
from math import inf
from typing import get_args

from fem_impact.errors import SceneError
from fem_impact.scene import fields
from fem_impact.scene.material import Material


@dataclass(frozen=True, slots=True)
class Layer:
    """A layer of a barrier: its thickness, m, and its material."""

    thickness: float
    material: Material

    def __post_init__(self) -> None:
        fields.check_numbers(self, fields.LAYER)


@dataclass(frozen=True, slots=True)
class Barrier:
    """What the rod strikes: massive and at rest unless stated otherwise.

    ``boundary`` is what holds the outer faces of a meshed block: springs and dashpots of the half-space
    around it, or a rigid frame (``fixed``), as in plain models of other codes.
    A plate of ``thickness``, m, has the ``support`` of a base that it is bonded to (``backed``), or is free
    underneath and so wide that bending waves run away (``infinite``); ``span``, m, says how wide, at least.
    A barrier of ``mass``, kg, is free to move. It turns if its ``inertia``, kg m2, is stated, too: about its
    mass centre, which lies ``centre_depth``, m, below the struck surface and ``centre_offset``, m, up the
    slope of the struck point. ``v_n`` and ``v_t``, m/s, are its velocity before the impact. ``layers`` lie
    on its ``material``, bonded, the first on top.
    """

    material: Material
    boundary: fields.Boundary = "half-space"
    thickness: float | None = None
    support: fields.Support = "backed"
    span: float | None = None
    mass: float | None = None
    inertia: float | None = None
    centre_depth: float | None = None
    centre_offset: float = 0.0
    v_n: float = 0.0
    v_t: float = 0.0
    layers: tuple[Layer, ...] = ()

    def __post_init__(self) -> None:
        fields.check_choice(self.boundary, get_args(fields.Boundary), "boundary")
        fields.check_choice(self.support, get_args(fields.Support), "support")
        fields.check_numbers(self, fields.BARRIER)
        if self.bends and self.thickness is None:
            raise SceneError("is missing: how much a plate bends depends on it.", key="thickness")
        if self.bends and self.mass is not None:
            remedy = 'Leave out the mass, or support = "infinite".'
            problem = "is that of a free body, but an infinite plate has none."
            raise SceneError(problem, key="mass", remedy=remedy)
        if self.span is not None and not self.bends:
            remedy = 'Leave it out, or add support = "infinite" and a thickness.'
            raise SceneError("means nothing for a barrier that does not bend.", key="span", remedy=remedy)
        if self.boundary == "fixed" and (self.bends or self.mass is not None):
            remedy = 'Leave out boundary = "fixed", or the mass and the support.'
            raise SceneError("holds the barrier, which is stated to give way.", key="boundary", remedy=remedy)
        if self.inertia is None and (self.centre_depth is not None or self.centre_offset != 0.0):
            key = "centre_offset" if self.centre_depth is None else "centre_depth"
            remedy = "Add its mass and inertia, or leave this out."
            raise SceneError("means nothing for a barrier that does not turn.", key=key, remedy=remedy)
        if self.inertia is not None and self.mass is None:
            raise SceneError("is that of a free barrier: state its mass, too.", key="inertia")
        if self.inertia is not None and self.centre_depth is None:
            problem = "is missing: friction turns the barrier by it. State how deep its mass centre lies."
            raise SceneError(problem, key="centre_depth")
        if self.layers and self.bends:
            remedy = 'Leave out the layers, or support = "infinite".'
            problem = "lie on a plate that bends, whose impedance is known for one material alone."
            raise SceneError(problem, key="layers", remedy=remedy)
        if self.layers and self.mass is not None:
            problem = "lie on a barrier that is free to move: only a massive one may have them."
            raise SceneError(problem, key="layers", remedy="Leave out the layers, or the mass.")

    @property
    def strata(self) -> tuple[tuple[float, Material], ...]:
        """The materials from the top down, each with the depth, m, at which it ends; inf for the last."""
        ends = accumulate(layer.thickness for layer in self.layers)
        tops = tuple(zip(ends, (layer.material for layer in self.layers), strict=True))
        return (*tops, (inf, self.material))

    @property
    def struck(self) -> Material:
        """The material at the surface: that of the first layer, if there are any."""
        return self.strata[0][1]

    @property
    def bends(self) -> bool:
        """Whether it is a plate whose bending waves run away."""
        return self.support == "infinite"
