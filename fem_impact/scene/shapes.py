"""Shapes of a projectile as stated: named ones with their sizes, and profiles of points."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.errors import ResultError, SceneError
from fem_impact.scene import fields
from fem_impact.scene.fields import Parameter
from fem_impact.scene.units import DIMENSIONS, parse_quantity
from fem_impact.scene.user_table import in_si, read_user_table

if TYPE_CHECKING:
    from fem_impact.arrays import Array
    from rigid import Turned

Point = tuple[float, float]
TIPS = ("flat", "rounded-edge", "hemisphere")  # shapes that are rods with a tip of the published kinds
MOST_POINTS = 2000
HEIGHT, RADIUS = fields.POINT
SIZES = fields.SHAPE
BY_LENGTH = "nose_length"
TIP = ("tip", "tip_radius", "tip_radius_m")
"""Keys of a rod's tip."""
REPLACED = ("calibre_radius", "cone_angle")  # sizes that the length of the nose may stand for
# sizes that a shape needs, in the order in which they are written
NEEDS = {
    "flat": ("length", "diameter"),
    "rounded-edge": ("length", "diameter", "edge_radius"),
    "hemisphere": ("length", "diameter"),
    "cone": ("length", "diameter", "cone_angle", "face_diameter"),
    "sphere-cone": ("length", "diameter", "cone_angle", "nose_radius"),
    "ogive": ("length", "diameter", "calibre_radius", "nose_radius"),
    "ball": ("diameter",),
}


_TURNED, _MESHED = (
    "Give the outline from the tip as profile = [[place, radius], ...].",
    "It is no body of revolution: mesh it, and name the file as mesh.",
)
_FLAT = 'Write shape = "flat" with length and diameter'
WORDS = {
    **dict.fromkeys(("sphere", "globe"), 'Write shape = "ball" with diameter.'),
    **dict.fromkeys(("cylinder", "rod", "bar", "disc", "disk", "coin", "pin", "blunt"), f"{_FLAT}."),
    **dict.fromkeys(("tube", "pipe", "ring", "washer"), f"{_FLAT}, and inner_diameter."),
    **dict.fromkeys(("capsule", "chamfered", "chamfer", "stepped", "bottle", "dumbbell"), _TURNED),
    **dict.fromkeys(("cube", "box", "block", "plate", "prism", "hexagon"), _MESHED),
}
"""What to write for shapes by other words."""


def _check_shape(shape: object) -> None:
    if isinstance(shape, str) and shape.lower() in WORDS:
        remedy = WORDS[shape.lower()]
        raise SceneError("is not a choice.", key="shape", value=shape, remedy=remedy)
    fields.check_choice(shape, tuple(NEEDS), "shape")


def sizes_of(shape: str, by_length: bool = False) -> tuple[Parameter, ...]:
    """Return the sizes that a named shape needs, with the length of the nose for its form or without."""
    _check_shape(shape)
    keys = (BY_LENGTH if by_length and key in REPLACED else key for key in NEEDS[shape])
    return tuple(next(size for size in SIZES if size.key == key) for key in keys)


def stated_by_length(shape: str, stated: Collection[str]) -> bool:
    """Return whether the form of a nose is stated by its length; refuse both ways, or none (SceneError)."""
    _check_shape(shape)
    form = next((key for key in NEEDS[shape] if key in REPLACED), "")
    if not form:
        return False
    given = {size.key for size in SIZES if {size.key, size.si_key} & {*stated}}
    both = form in given
    if both == (BY_LENGTH in given):
        raise SceneError(
            f"is given beside {form}, which says the same." if both else "is missing, and so is nose_length.",
            key=BY_LENGTH if both else form,
            remedy=f"Give {form} or {BY_LENGTH}, one of them.",
        )
    return BY_LENGTH in given


def refuse_tip(stated: Mapping[str, Any]) -> None:
    """Refuse the tip of a rod beside a named shape, which has its own (SceneError)."""
    key = next((key for key in TIP if key in stated), None)
    if key:
        remedy = f"Leave out {key}, or shape."
        raise SceneError(
            "stands beside a shape, which has its own.", key=key, value=stated[key], remedy=remedy
        )


def is_rounded(tip: object) -> bool:
    """Return whether a word is that of a tip which has a radius."""
    if tip in ("A", "B", "plain"):  # the published tips need no import of the rigid package
        return tip != "plain"
    from fem_impact.scene.tips import tips

    return isinstance(tip, str) and tip in tips()


def refuse_as_tip(tip: object) -> None:
    """Refuse the name of a shape as that of a tip (SceneError), and say how a shape is written."""
    if isinstance(tip, str) and tip in NEEDS and not is_rounded(tip):
        raise SceneError(
            "is a shape, not one of the published tips.",
            key="tip",
            value=tip,
            remedy=f'Write shape = "{tip}" with {" and ".join(NEEDS[tip])} in place of tip and tip_radius.',
        )


@dataclass(frozen=True, slots=True)
class NamedShape:
    """A shape by name with its sizes, SI, in the order of `sizes_of`."""

    name: str
    sizes: tuple[float, ...]
    by_length: bool = False

    def __post_init__(self) -> None:
        wanted = sizes_of(self.name, self.by_length)
        checked = (size.checked(v) for size, v in zip(wanted, self.sizes, strict=True))
        object.__setattr__(self, "sizes", tuple(checked))

    def outline(self) -> Array:
        """Return vertices (k, 2), (rho, z), m, of the outer surface from the axis at the tip to the tail."""
        from rigid import shapes

        wanted = sizes_of(self.name, self.by_length)
        given = dict(zip((size.key for size in wanted), self.sizes, strict=True))
        if self.name == "ball":
            return shapes.ball(given["diameter"])
        length, diameter = given["length"], given["diameter"]
        tip, nose = (given.get("nose_radius", 0.0), given.get("face_diameter", 0.0)), given.get(BY_LENGTH)
        if self.name == "ogive":
            calibre = shapes.calibre_of(nose, diameter, tip[0]) if nose else given["calibre_radius"]
            return shapes.ogive(length, diameter, calibre, tip[0])
        angle = shapes.cone_angle_of(nose, diameter, *tip) if nose else given["cone_angle"]
        return shapes.cone(length, diameter, angle, *tip)


@dataclass(frozen=True, slots=True)
class Profile:
    """Points (z, r), m, of a surface of revolution; straight between them, or a smooth curve through them."""

    points: tuple[Point, ...]
    smooth: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", checked_points(self.points))
        if not isinstance(self.smooth, bool):
            raise SceneError("must be true or false.", key="profile_smooth", value=self.smooth)
        if self.points[0][0] != 0.0:
            raise SceneError(
                "must start at z = 0, the tip.", key="profile", value=f"z = {self.points[0][0] * 1e3:.4g} mm"
            )
        if self.points[-1][0] <= 0.0:
            raise SceneError("has no length: its last z is 0.", key="profile")
        for number, (before, after) in enumerate(pairwise(self.points), 2):
            if before[1] == after[1] == 0.0:
                raise SceneError(
                    "leaves no body between it and the point before: both lie on the axis.",
                    key=f"profile[{number}]",
                    value=f"z = {after[0] * 1e3:.4g} mm, radius 0",
                    remedy="A row is [z, radius]: first the distance from the tip.",
                )

    def outline(self) -> Array:
        """Return vertices (k, 2), (rho, z), m, of the outer surface from the axis at the tip to the tail."""
        from rigid import shapes

        line = _swapped(self.points)
        line = shapes.smooth(line) if self.smooth else line
        return line if line[0, 0] == 0.0 else _swapped(((0.0, 0.0), *((z, r) for r, z in line.tolist())))


@dataclass(frozen=True, slots=True)
class RodTip:
    """A rod with a turned tip, m, as a shape that may have a bore and segments."""

    length: float
    diameter: float
    tip: str
    tip_radius: float

    def outline(self) -> Array:
        """Return vertices (k, 2), (rho, z), m, of the outer surface from the axis at the tip to the tail."""
        import rigid

        return rigid.shapes.of_nose(rigid.SHAPES[self.tip](self.diameter / 2, self.tip_radius), self.length)


Shape = NamedShape | Profile | RodTip


@lru_cache(maxsize=64)
def outline_of(shape: Shape) -> Array:
    """Return the outline of a shape, (k, 2), (rho, z), m.

    Raises
    ------
    SceneError
        If its sizes do not fit each other.
    """
    import rigid

    try:
        return shape.outline()
    except rigid.TooLongError as error:
        # the remedy for a nose that is longer than the body
        sizes = NEEDS.get(shape.name, ()) if isinstance(shape, NamedShape) else ("tip_radius",)
        keys = " or ".join(key for key in sizes if key in (*REPLACED, "tip_radius"))
        length = f" (projectile.{BY_LENGTH}, {keys})" if keys in REPLACED else f" (projectile.{keys})"
        shorter_nose = f"Give a projectile.length beyond the nose, or with it a shorter nose{length}."
        raise SceneError(f"is not a shape: {error}.", key="shape", remedy=shorter_nose) from None
    except rigid.ShapeError as error:
        raise SceneError(f"is not a shape: {error}.", key="shape") from None


@lru_cache(maxsize=64)
def turned_body(shape: Shape, bore: tuple[Point, ...], density: tuple[Point, ...]) -> Turned:
    """Return the rigid body of a shape with a bore and densities, kg/m3, up to their ends, m.

    Raises
    ------
    SceneError
        If they bound no body.
    """
    import rigid

    try:
        return rigid.Turned(outline_of(shape), density, _swapped(bore) if bore else None)
    except rigid.TooLongError as error:
        remedy = (
            "Give with the length a projectile.bore that ends at the tail or before it, or a longer "
            "projectile. A bore whose last point lies at the tail follows a changed length."
        )
        raise SceneError(f"bounds no body: {error}.", key="bore", remedy=remedy) from None
    except rigid.ShapeError as error:
        raise SceneError(
            f"bounds no body: {error}.", key="bore" if "bore" in str(error) else "profile"
        ) from None


def _swapped(points: Iterable[Point]) -> Array:
    import numpy as np

    return np.array([(r, z) for z, r in points], dtype=np.float64)


EXAMPLES = {
    "profile": '["0 mm", "0 mm"], ["20 mm", "6 mm"], ["100 mm", "6 mm"]',
    "bore": '["0 mm", "4 mm"], ["100 mm", "4 mm"]',
}
"""Points in a remedy: a cone with a cylinder behind it, and its straight bore of 8 mm open at both ends."""


def checked_points(points: Any, key: str = "profile") -> tuple[Point, ...]:
    """Return points (z, r), m, of a profile or bore, z never turning back.

    Raises
    ------
    SceneError
        Naming the row.
    """
    if not isinstance(points, (list, tuple)) or not 2 <= len(points) <= MOST_POINTS:
        raise SceneError(
            f"must be a list of 2 to {MOST_POINTS} points [z, radius].",
            key=key,
            value=points if isinstance(points, str) else None,
            remedy=f"Write {key} = [{EXAMPLES[key]}], rows of distance from the tip and radius there.",
        )
    rows = tuple(_pair(row, f"{key}[{number}]") for number, row in enumerate(points, 1))
    for number, (before, after) in enumerate(pairwise(rows), 2):
        if after[0] < before[0] or after == before:
            raise SceneError(
                "must lie behind the point before it: z grows from tip to tail.",
                key=f"{key}[{number}]",
                value=f"z = {after[0] * 1e3:.4g} mm after {before[0] * 1e3:.4g} mm",
            )
    return rows


def _pair(row: Any, key: str) -> Point:
    if not isinstance(row, (list, tuple)) or len(row) != 2:
        raise SceneError("must be a pair [z, radius].", key=key, value=row)
    try:
        return float(HEIGHT.checked(row[0])), float(RADIUS.checked(row[1]))
    except SceneError as error:
        raise error.under(key) from None


def stated_points(points: Any, key: str) -> Any:
    """Return stated points in SI: each quantity with its unit; what is no list of pairs is left as it is."""
    if not isinstance(points, (list, tuple)):
        return points
    return tuple(
        tuple(parse_quantity(value, "length", f"{key}[{number}]") for value in row)
        if isinstance(row, (list, tuple))
        else row
        for number, row in enumerate(points, 1)
    )


def read_points(path: Path) -> tuple[Point, ...]:
    """Read points (z, r), m, from a CSV file with columns z and r.

    The header names the columns and their unit: ``z_mm,r_mm`` or ``z [mm], r [mm]``; without a unit they are
    metres.

    Raises
    ------
    ResultError
        Naming file, line and column.
    """
    table, metre = read_user_table(path, "z_mm,r_mm"), DIMENSIONS["length"].units[0]
    columns = [table.quantity(key, "length", bare=metre) for key in ("z", "r")]
    lengths = list[list[float]]()
    for column in columns:
        if column is None:
            told = "The first line names them, such as z_mm,r_mm."
            raise ResultError(f"{path}: has no columns z and r. {told}")
        name, unit = column
        lengths.append([in_si(place, text, unit) for place, text in table.column(name)])
    z, r = lengths
    return tuple(zip(z, r, strict=True))


def written_points(points: Iterable[Point]) -> list[list[Any]]:
    """Return points (z, r), m, of a profile or bore as a scene file writes them."""
    return [[HEIGHT.write(z), RADIUS.write(r)] for z, r in points]
