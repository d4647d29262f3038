"""A projectile whose shape is a mesh of the user's own, from a file."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.errors import MissingLibraryError, SceneError
from fem_impact.scene.fields import PROJECTILE, check_choice, check_text
from fem_impact.scene.units import DIMENSIONS, parse_quantity

if TYPE_CHECKING:
    from fem_impact.arrays import Array, Bools, Ints
    from meshes import HexMesh, OwnBody
    from rigid import Faceted

UNITS = tuple(unit.symbol for unit in DIMENSIONS["length"].units)
PARTS = ("whole", "half", "quarter", "eighth")
PLANE = re.compile(r"\s*([xyz])\s*=(.*)")
POUNDS = ("inch", "in", "ft")  # units of length beside which decks count pounds of force
KEYS = (
    *("mesh", "mesh_unit", "mesh_content", "mesh_symmetry", "mesh_tip", "mesh_sets"),
    *("mesh_materials", "mesh_surfaces"),
)
TIPS = ("-z", "+z", "-x", "+x", "-y", "+y", "-axis", "+axis")
POUND = 4.4482216  # N, of force, in which decks in inches count
LENGTH = next(one for one in PROJECTILE if one.key == "length")
LACKING = 0.01  # of its mass: a body that lacks more is another body
Tip = str | tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class OwnMesh:
    """A mesh file: its path, the unit of its coordinates, the SHA-256 of its content, and how it is taken.

    The content is part of the scene: another one under the same name makes another scene.

    Attributes
    ----------
    symmetry : which part of the body the mesh is, one of `PARTS`, or the planes in which it was cut, such as
        "x = 10 mm, y = 20 mm"; None: recognised
    tip : where the tip points in the file, one of `TIPS` or a direction; None: to its lowest z
    sets : sets of cells of the file that are the body; empty: all cells
    """

    path: str
    unit: str
    content: str
    symmetry: str | None = None
    tip: Tip | None = None
    sets: tuple[str, ...] = ()

    @classmethod
    def of(
        cls,
        path: str,
        unit: str = "m",
        content: str | None = None,
        symmetry: str | None = None,
        tip: Tip | None = None,
        sets: tuple[str, ...] = (),
    ) -> OwnMesh:
        """Return the mesh of a file; a stated ``content`` must be the file's.

        Raises
        ------
        SceneError
            If the file is missing or has changed, or a word is none of its choices.
        """
        check_choice(unit, UNITS, "mesh_unit")
        if symmetry is not None and not _planes(symmetry):
            other = 'the planes in which it was cut, such as "x = 10 mm, y = 20 mm"'
            check_choice(symmetry, PARTS, "mesh_symmetry", other)
        if tip is not None and not isinstance(tip, tuple):
            check_choice(tip, TIPS, "mesh_tip", "a direction such as [1, 0, -1]")
        found = _content(path)
        if content not in (None, found):
            problem = f"has changed: its SHA-256 is {found[:12]}..., the scene was stated with that of"
            remedy = "Put the old file back, or leave mesh_content out to state another scene."
            raise SceneError(f"{problem} mesh_content.", key="mesh", value=path, remedy=remedy)
        return cls(path, unit, found, symmetry, tip, sets)

    def body(self) -> OwnBody:
        """Return the body with its half y >= 0 in its own frame, tip at z = 0, m; see `meshes.own_body`.

        Raises
        ------
        SceneError
            If it is no body that the model can hold.
        MissingLibraryError
            If a library that reads its format is not installed.
        """
        return _body(self)

    def masses(self, own: bool) -> tuple[float, str]:
        """Return the masses without volume that the file holds, kg, nan if unknown, and what is told of them.

        Those that may be the body's ``own``, or all others. A file's unit of mass is the one that goes with
        its unit of length, newtons and seconds, or with inches, pounds of force and seconds.
        """
        these, force = [one for one in self.body().masses if one.own == own], self.unit in POUNDS
        kg = (POUND if force else 1.0) / _metres(self)
        told = []
        for one in these:
            known = f"{1e3 * kg * one.mass:.4g} g ({one.mass:.4g} in the file)"
            where = (
                f", the first at ({', '.join(f'{1e3 * x:.4g}' for x in one.place)}) mm" if one.place else ""
            )
            told.append(
                f"{one.count} {one.what} of {known if one.mass == one.mass else 'unknown mass'}{where}"
            )
        system = f", counted in {self.unit}, {'lbf' if force else 'N'} and s" if told else ""
        return kg * sum(one.mass for one in these), f"{', and '.join(told)}{system}"

    def of_wrong_unit(self, error: SceneError) -> SceneError:
        """Return the refusal of a mesh whose length or diameter no body has, in words about its unit."""
        problem = f"has a {error.key} of {error.value}. Is its unit {self.unit}?"
        remedy = f'State the unit of its coordinates, such as mesh_unit = "mm". {error.problem}'
        return SceneError(problem, key="mesh", value=self.path, remedy=remedy)

    def half(self) -> HexMesh:
        """Return the half y >= 0 of the body."""
        return self.body().half


def stated(table: Mapping[str, Any]) -> OwnMesh:
    """Return the mesh that the table of a projectile states.

    Raises
    ------
    SceneError
        As `OwnMesh.of`.
    """
    sets = table.get("mesh_sets", [])
    named = [sets] if isinstance(sets, str) else sets
    if not isinstance(named, list):
        remedy = 'Name sets of the file, such as mesh_sets = ["ROD"].'
        raise SceneError("is no list of names.", key="mesh_sets", value=sets, remedy=remedy)
    content, symmetry, tip = (table.get(key) for key in ("mesh_content", "mesh_symmetry", "mesh_tip"))
    path, unit = check_text(table["mesh"], "mesh", 1000), table.get("mesh_unit", "m")
    names = tuple(check_text(name, "mesh_sets", 200) for name in named)
    if isinstance(tip, list):
        numbers = [float(part) for part in tip if type(part) in (int, float) and isfinite(part)]
        if len(numbers) != 3 or len(tip) != 3 or not any(numbers):
            remedy = "Give three numbers of which one is not zero, such as [1, 0, -1]."
            raise SceneError("is no direction.", key="mesh_tip", value=tip, remedy=remedy)
        tip = numbers[0], numbers[1], numbers[2]
    return OwnMesh.of(path, unit, content, symmetry, tip, names)


def _planes(symmetry: object) -> tuple[tuple[int, float], ...]:
    """Return axis and place, m, of each plane that is stated; none where a word is."""
    found = [PLANE.fullmatch(part) for part in symmetry.split(",")] if isinstance(symmetry, str) else [None]
    if not all(found) or len({one[1] for one in found if one}) < len(found):
        return ()
    return tuple(
        ("xyz".index(one[1]), parse_quantity(one[2], "length", "mesh_symmetry")) for one in found if one
    )


def _content(path: str) -> str:
    """Return the SHA-256 of a file and of those that it takes parts from."""
    from meshes import included

    try:
        content = Path(path).read_bytes()
        parts = [one.read_bytes() for one in included(Path(path))]
        return hashlib.sha256(b"".join([content, *parts])).hexdigest()
    except OSError as error:
        reason = "there is no such file" if isinstance(error, FileNotFoundError) else str(error.strerror)
        remedy = "Name a mesh file, from the place of the scene's file."
        raise SceneError(f"cannot be read: {reason}.", key="mesh", value=path, remedy=remedy) from None


def _metres(mesh: OwnMesh) -> float:
    """Return the metres in one unit of the file."""
    unit = DIMENSIONS["length"].unit(mesh.unit)
    assert unit is not None, "the unit was checked"
    return unit.to_si("1")


@lru_cache(maxsize=8)
def _body(mesh: OwnMesh) -> OwnBody:
    import meshes

    planes = _planes(mesh.symmetry)
    stated = meshes.Stated(None if planes else mesh.symmetry, mesh.tip, mesh.sets, planes)
    try:
        return meshes.read_own(mesh.path, _metres(mesh), stated)
    except meshes.MissingReaderError as error:
        raise MissingLibraryError(f"{mesh.path}: {error}") from None
    except meshes.MeshError as error:
        _require_unit(mesh)
        raise SceneError(str(error), key="mesh", value=mesh.path) from None


def _require_unit(mesh: OwnMesh) -> None:
    """Refuse a file whose cells make no body if no body is as long: its unit is to be mended first."""
    import meshes

    size = _metres(mesh) * meshes.extent(mesh.path)
    if isfinite(size) and not LENGTH.allows(2.0 * size):  # a part of a body may be half as long
        try:
            LENGTH.checked(size)
        except SceneError as error:
            raise mesh.of_wrong_unit(error) from None


@lru_cache(maxsize=8)
def cell_regions(mesh: OwnMesh, names: tuple[str, ...]) -> Ints:
    """Return for each cell (m,) of the half the number, from 1, of the set that holds it; 0 where none does.

    Raises
    ------
    SceneError
        If the file has no such set of cells of the body, it does not lie on both sides of the plane of
        symmetry, or two of them hold one cell.
    """
    return _numbered(mesh, names, mesh.body().sets, len(mesh.half().cells), ("mesh_materials", "cells"))


@lru_cache(maxsize=8)
def face_regions(mesh: OwnMesh, names: tuple[str, ...]) -> Ints:
    """Return for each outer face (k,) of the half the number, from 1, of the set that holds it; else 0.

    A set of cells stands for their outer faces, one of nodes for the faces that have all corners in it.

    Raises
    ------
    SceneError
        As `cell_regions`.
    """
    from meshes import owners

    body, owner = mesh.body(), owners(mesh.half())
    sets = {name: here[owner] for name, here in body.sets.items()}
    for name, here in body.faces.items():
        sets[name] = sets[name] | here if name in sets else here
    return _numbered(mesh, names, sets, len(owner), ("mesh_surfaces", "cells, faces or nodes"))


def _numbered(
    mesh: OwnMesh, names: tuple[str, ...], sets: Mapping[str, Bools], count: int, where: tuple[str, str]
) -> Ints:
    """Return for each of so many cells or faces the number of the set that holds it; see `cell_regions`.

    ``where`` is the key of the scene that names the sets, and what they are sets of.
    """
    import numpy as np

    import meshes

    key, what = where
    region = np.zeros(count, dtype=np.int64)
    for number, name in enumerate(names, 1):
        meant = meshes.sets_named(name, sets)
        if len(meant) != 1:
            one_of = f"Name one of {' and '.join(meant)}." if meant else ""
            remedy = one_of or f"It has {', '.join(sorted(sets)[:12]) or 'none'}."
            raise SceneError(f"is no set of {what} of the mesh.", key=f"{key}.{name}", remedy=remedy)
        stored = meant[0]
        if stored in mesh.body().lopsided:
            problem = "lies on one side of the plane of symmetry y = 0 more than on the other."
            remedy = "The model holds half of a symmetric body: name a set that is symmetric."
            raise SceneError(problem, key=f"{key}.{name}", remedy=remedy)
        here = sets[stored]
        if region[here].any():
            remedy = f"Leave one of {name} and {names[int(region[here].max()) - 1]} out."
            held = "cells" if key == "mesh_materials" else "faces"
            problem = f"holds {int((region[here] > 0).sum())} {held} that another set holds too."
            raise SceneError(problem, key=f"{key}.{name}", remedy=remedy)
        region[here] = number
    return region


@lru_cache(maxsize=8)
def faceted_body(
    mesh: OwnMesh, density: tuple[tuple[float, float], ...], regions: tuple[tuple[str, float], ...] = ()
) -> Faceted:
    """Return the rigid body of a mesh with densities, kg/m3, up to their ends, m from the tip.

    Sets of the file may have ``regions``, pairs of a name and a density, of their own.

    Raises
    ------
    SceneError
        If a cell lies on both sides of the end of a segment, the body would lack more than a hundredth of
        its mass that the file holds without volume, or as `cell_regions`.
    """
    import numpy as np

    import meshes
    import rigid

    half = mesh.half()
    part = meshes.cell_moments(half)
    ends = [end for end, _ in density]
    _require_joints(part.low, part.high, ends[:-1])
    middle = 0.5 * (part.low + part.high)
    rho = np.array([value for _, value in density])[np.searchsorted(ends[:-1], middle)]
    of = cell_regions(mesh, tuple(name for name, _ in regions))
    rho = np.where(of > 0, np.array([0.0, *(value for _, value in regions)])[of], rho)
    moments = [rho * moment for moment in (part.volume, part.x, part.z, part.xx, part.zz)]
    quads = half.faces_with(meshes.SKIN)
    nodes, facets = np.unique(quads, return_inverse=True)
    parts = np.column_stack([part.low, part.high, *moments])
    body = rigid.Faceted(half.points[nodes], facets.reshape(quads.shape), parts)
    lacking, told = mesh.masses(own=True)
    if not abs(lacking) <= LACKING * body.mass:
        problem = (
            f"holds masses without volume, which the body of {1e3 * body.mass:.4g} g would lack: {told}."
        )
        remedy = (
            "Mesh them as cells of a material of their own (mesh_materials), or leave them out of the file."
        )
        if not mesh.sets and mesh.body().sets:
            remedy += " If they belong to another body, name the cells of this one: mesh_sets."
        raise SceneError(problem, key="mesh", value=mesh.path, remedy=remedy)
    return body


def _require_joints(low: Array, high: Array, joints: Sequence[float]) -> None:
    """Refuse a joint of two segments that cuts cells between their ends ``low`` and ``high`` (m,), m."""
    import numpy as np

    slack = 1e-3 * (high - low)
    for number, joint in enumerate(joints, 1):
        cut = (low + slack < joint) & (joint < high - slack)
        if cut.any():
            starts, ends = np.sort(low + slack), np.sort(high - slack)
            rows = np.unique(low.round(9))[1:]  # those between cells of which none lies on both sides
            rows = rows[np.searchsorted(starts, rows) == np.searchsorted(ends, rows, "right")]
            remedy = "No row of cells ends level. Leave out segments, and name the other cells by a set: "
            remedy += "mesh_materials."
            if len(rows):
                near = float(rows[np.argmin(np.abs(rows - joint))])
                remedy = f"The nearest nodes between two rows are at {near * 1e3:.6g} mm from the tip."
            raise SceneError(
                f"lies within {int(cut.sum())} cells of the mesh, which have one material each.",
                key=f"segments[{number}].to",
                value=f"{joint * 1e3:g} mm",
                remedy=remedy,
            )
