"""The projectile as stated: a rod with a tip, or a shape of its own, with its bore and segments."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from math import inf, isclose
from typing import TYPE_CHECKING

from fem_impact.errors import SceneError
from fem_impact.scene import fields, shapes
from fem_impact.scene.material import Material, Surface
from fem_impact.scene.own_mesh import OwnMesh, cell_regions, face_regions, faceted_body

if TYPE_CHECKING:
    from fem_impact.arrays import Array, Ints
    from rigid import Body, Faceted, Turned

ROD = re.compile(r"(?<![-\w])(?<!measured )rod(?![-\w])")  # no part of a name, nor one of the paper's
SECTIONS = 400  # over the length, at which a wall is looked at
# Cells over the diameter; of a body whose mean wall is a THIN-th of its mean diameter or less, so many that
# the period of its ovalling is right to 0.4 to 1.3 %: with 8 it is 5 to 7 % too short, of rings of any wall
ACROSS, THIN_ACROSS, THIN = 8, 16, 8.0


@dataclass(frozen=True, slots=True)
class Segment:
    """A part of a projectile along its axis: its end, m from the tip, and its material.

    An end of inf is the tail of the projectile, which takes its place there.
    """

    to: float
    material: Material


@dataclass(frozen=True, slots=True)
class Region:
    """Cells of a mesh of a material of their own: the set of the file that holds them."""

    name: str
    material: Material


@dataclass(frozen=True, slots=True)
class Face:
    """Outer faces of a mesh with a state of their own: a set of the file, of cells, faces or nodes."""

    name: str
    surface: Surface


@dataclass(frozen=True, slots=True)
class ProjectileSpec:
    """The projectile: length, diameter and tip_radius in m; tip A (round nose), B (rounded edge) or plain.

    A ``shape`` of its own takes the place of the tip, see `turned` and `meshed`; ``bore`` holds points
    (z, radius), m, of the inner surface. ``segments`` follow each other from the tip; ``material`` is that of
    the first. Cells of a mesh that are in one of ``regions`` are of its material, the others of ``material``;
    the outer faces of those in one of ``faces`` have its surface.
    """

    length: float
    diameter: float
    tip: str
    tip_radius: float
    material: Material
    shape: shapes.NamedShape | shapes.Profile | OwnMesh | None = None
    bore: tuple[shapes.Point, ...] = ()
    segments: tuple[Segment, ...] = ()
    regions: tuple[Region, ...] = ()
    faces: tuple[Face, ...] = ()

    @classmethod
    def turned(
        cls,
        shape: shapes.NamedShape | shapes.Profile,
        material: Material,
        bore: tuple[shapes.Point, ...] = (),
        segments: tuple[Segment, ...] = (),
    ) -> ProjectileSpec:
        """Return a projectile of a shape of its own; length and largest diameter follow from it."""
        line = shapes.outline_of(shape)
        length, diameter = float(line[-1, 1]), 2.0 * float(line[:, 0].max())
        return cls(length, diameter, "shape", 0.0, material, shape, bore, segments)

    @classmethod
    def meshed(
        cls,
        mesh: OwnMesh,
        material: Material,
        segments: tuple[Segment, ...] = (),
        regions: tuple[Region, ...] = (),
        faces: tuple[Face, ...] = (),
    ) -> ProjectileSpec:
        """Return a projectile whose shape is a mesh; length and largest width follow from it."""
        points = mesh.half().points
        wide = max(float(points[:, 0].max() - points[:, 0].min()), 2.0 * float(points[:, 1].max()))
        try:
            length = float(points[:, 2].max())
            return cls(length, wide, "shape", 0.0, material, mesh, (), segments, regions, faces)
        except SceneError as error:
            if error.key not in ("length", "diameter"):
                raise
            raise mesh.of_wrong_unit(error) from None

    @property
    def is_rod(self) -> bool:
        """Return whether this is a solid rod of one material with one of the tips, no shorter than wide."""
        plain = self.shape is None and not self.bore and not self.segments
        return plain and self.length >= self.diameter

    @property
    def is_ball(self) -> bool:
        """Return whether this is a solid ball of one material, which has no axis."""
        named = self.shape if isinstance(self.shape, shapes.NamedShape) else None
        return named is not None and named.name == "ball" and not self.bore and not self.segments

    @property
    def called(self) -> str:
        """What it is, in a word: ball, disc, tube, rod, or body where its shape is its own."""
        if self.is_ball or self.is_short:
            return "ball" if self.is_ball else "disc"
        return "body" if self.shape is not None else "tube" if self.bore else "rod"

    def named(self, sentence: str) -> str:
        """Return a sentence about a rod with what this is, `called`, in its place."""
        return ROD.sub(self.called, sentence)

    @property
    def is_short(self) -> bool:
        """Return whether this is a body of revolution that is shorter than wide: it bends as a plate."""
        return self.own_mesh is None and self.length < self.diameter * (1 - 1e-9)

    @property
    def open_at_tail(self) -> bool:
        """Return whether it has a bore that ends at the tail."""
        return bool(self.bore) and isclose(self.bore[-1][0], self.length, rel_tol=1e-9)

    @property
    def bored(self) -> str:
        """The bore in words, its largest diameter; nothing where it is solid."""
        return f", bored to {2e3 * max(radius for _, radius in self.bore):.4g} mm" if self.bore else ""

    @property
    def own_mesh(self) -> OwnMesh | None:
        """Return the user's mesh that is its shape, None where it is a body of revolution."""
        return self.shape if isinstance(self.shape, OwnMesh) else None

    @property
    def across(self) -> int:
        """Cells over the diameter with which a wall bends as it should, unless a scene states them."""
        if not self.bore:
            return ACROSS
        _, outer, inner = self.wall()
        return THIN_ACROSS if THIN * (outer - inner).mean() <= 2.0 * outer.mean() else ACROSS

    def wall(self) -> tuple[Array, Array, Array]:
        """Return places along the axis of a bore, outer radii and inner radii there, m, (k,) each."""
        import numpy as np

        from rigid import Turned

        body = self.body()
        assert isinstance(body, Turned), "a bore is stated for a turned body"
        z = (np.arange(SECTIONS) + 0.5) * self.length / SECTIONS
        inner = body.inner_radius(z)
        bored = inner > 0
        return z[bored], body.radius(z[bored]), inner[bored]

    @property
    def materials(self) -> list[Material]:
        """Return all materials, that which touches first."""
        parts = [part.material for part in self.segments] or [self.material]
        return parts + [region.material for region in self.regions]

    def cell_materials(self) -> Ints:
        """Return which of `materials` each cell (m,) of the half of a mesh is of."""
        import numpy as np

        assert isinstance(self.shape, OwnMesh), "only a mesh has cells of its own"
        half = self.shape.half()
        ends = np.array([part.to for part in self.segments[:-1]])
        of = np.searchsorted(ends, half.points[half.cells, 2].mean(axis=1))
        regions = cell_regions(self.shape, tuple(region.name for region in self.regions))
        return np.asarray(np.where(regions > 0, max(len(self.segments), 1) - 1 + regions, of))

    def face_friction(self, other: float) -> Array:
        """Return the Coulomb coefficient (k,) of each outer face of the half of a mesh.

        That of faces in none of `faces` is the ``other``.
        """
        import numpy as np

        assert isinstance(self.shape, OwnMesh), "only a mesh has cells of its own"
        of = face_regions(self.shape, tuple(face.name for face in self.faces))
        return np.array([other, *(face.surface.friction for face in self.faces)])[of]

    def body(self) -> Turned | Faceted:
        """Return the rigid body."""
        parts = self.segments or (Segment(self.length, self.material),)
        density = tuple((part.to, part.material.rho) for part in parts)
        if isinstance(self.shape, OwnMesh):
            of = tuple((region.name, region.material.rho) for region in self.regions)
            return faceted_body(self.shape, density, of)
        shape = self.shape or shapes.RodTip(self.length, self.diameter, self.tip, self.tip_radius)
        return shapes.turned_body(shape, self.bore, density)

    @property
    def rigid_body(self) -> Body:
        """The rigid body that strikes: of a plain rod the one with the published tips, else `body`."""
        return _rigid_body(self)

    def __post_init__(self) -> None:
        fields.check_numbers(self, fields.PROJECTILE)
        if self.shape is None:
            # the published tips need no import of the rigid package, which would slow every command
            if self.tip not in ("A", "B", "plain"):
                from fem_impact.scene.tips import tips

                fields.check_choice(self.tip, tuple(tips()), "tip")
            if self.tip_radius > self.diameter / 2:
                raise SceneError(
                    f"is larger than the rod's radius ({self.diameter * 500:.3g} mm).",
                    key="tip_radius",
                    value=f"{self.tip_radius * 1e3:.3g} mm",
                    remedy="Give a tip radius of at most half the diameter.",
                )
            if (self.tip == "plain") != (self.tip_radius == 0.0):
                raise SceneError(
                    f'does not fit tip "{self.tip}": a plain tip has radius 0, the others one above 0.',
                    key="tip_radius",
                    value=f"{self.tip_radius * 1e3:.3g} mm",
                    remedy="Leave tip_radius out, or choose another tip."
                    if self.tip == "plain"
                    else 'Change tip_radius, or choose tip = "plain" for a sharp-edged flat face.',
                )
        if self.bore != ():
            object.__setattr__(self, "bore", shapes.checked_points(self.bore, "bore"))
        if self.segments:
            last = self.segments[-1]
            if last.to == inf:
                ended = (*self.segments[:-1], replace(last, to=self.length))
                object.__setattr__(self, "segments", ended)
            _check_segments(self)
        if not self.is_rod:
            self.body()  # refuses what bounds no body


@lru_cache(maxsize=64)
def _rigid_body(rod: ProjectileSpec) -> Body:
    from rigid import Projectile

    if rod.is_rod:
        return Projectile(rod.length, rod.diameter, rod.tip, rod.tip_radius, rod.material.rho)
    return rod.body()


def _check_segments(rod: ProjectileSpec) -> None:
    ends = [0.0, *(segment.to for segment in rod.segments)]
    for number, (before, end) in enumerate(pairwise(ends), 1):
        if end == inf:
            remedy = "Give its end; only the last segment may leave it out and ends at the tail."
            raise SceneError("is missing.", key=f"segments[{number}].to", remedy=remedy)
        if number < len(rod.segments) and end >= rod.length:
            raise SceneError(
                f"leaves no room for the next segment: the projectile is {rod.length * 1e3:.6g} mm long.",
                key=f"segments[{number}].to",
                value=f"{end * 1e3:g} mm",
                remedy=f"Give an end before {rod.length * 1e3:.6g} mm, or a longer projectile.",
            )
        if not end > before:
            raise SceneError(
                "must end behind the one before it.",
                key=f"segments[{number}].to",
                value=f"{end * 1e3:g} mm",
                remedy=f"Give an end beyond {before * 1e3:g} mm.",
            )
    if abs(ends[-1] - rod.length) > 1e-9 * rod.length:
        raise SceneError(
            f"must end at the tail: the projectile is {rod.length * 1e3:.6g} mm long.",
            key=f"segments[{len(rod.segments)}].to",
            value=f"{ends[-1] * 1e3:.6g} mm",
            remedy='Leave "to" out, so that the last segment ends at the tail, or change the length.',
        )
    if rod.material != rod.segments[0].material:
        raise SceneError("is not that of the first segment.", key="material", value=rod.material.name)
