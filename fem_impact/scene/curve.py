"""Points of a flow curve as stated: in the scene or a CSV file, with plastic, true or engineering strain."""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from math import log
from pathlib import Path
from typing import Any

from fem_impact.errors import ResultError, SceneError
from fem_impact.scene.fields import PLASTIC_STRAIN, check_choice
from fem_impact.scene.units import parse_number, parse_quantity
from fem_impact.scene.user_table import finite, in_si, read_user_table

Points = tuple[tuple[float, float], ...]
STRAINS = ("plastic", "true", "engineering")
ELASTIC = 5e-4  # plastic strain up to which a point of a measured curve counts as one of the elastic line
EXAMPLE = '[[0, "350 MPa"], [0.02, "360 MPa"], [0.15, "480 MPa"]], plastic strain and true stress'
HEADER = "strain,stress_MPa"
PER_CENT = ("strain_%", "strain[%]", "strain(%)")
"""Headers of strains in per cent, without blanks."""


def beside(data: Any, folder: Path) -> Any:
    """Return tables in which the files of curves are named from the ``folder`` of their own file."""
    if isinstance(data, list):
        return [beside(one, folder) for one in data]
    if not isinstance(data, Mapping):
        return data
    points = data.get("points")
    named = {"points": str((folder / points).resolve())} if isinstance(points, str) else {}
    return {key: beside(value, folder) for key, value in data.items()} | named


def curve(stated: Any, strain: Any, E: float) -> Points:
    """Return points (plastic strain, true stress in Pa) of a curve.

    Parameters
    ----------
    stated : list of pairs, or path of a CSV file
    strain : "plastic", beside true stress; "true", the whole strain, beside true stress; or "engineering",
        beside engineering stress: change of length over the first length, force over the first section
    E : float, Pa
        Young's modulus; the whole strain less stress over E is the plastic one.

    Raises
    ------
    SceneError
        If it cannot be read, or is no curve of that kind.
    """
    kind = check_choice(strain, STRAINS, "strain")
    points = _of_file(stated) if isinstance(stated, str) else _of_rows(stated)
    if (largest := max((e for e, _ in points), default=0.0)) > PLASTIC_STRAIN.high:
        problem = f"has a strain of {largest:g}, above {PLASTIC_STRAIN.high:g}."
        raise SceneError(problem, key="points", remedy=PLASTIC_STRAIN.remedy)
    if kind == "plastic":
        return points
    if kind == "engineering":
        for (_, before), (e, s) in pairwise(points):
            if s < before:  # behind the largest force the strain of the bar is not that of its neck
                raise SceneError(
                    f"falls from {before / 1e6:.4g} to {s / 1e6:.4g} MPa at a strain of {e:.4g}: the bar "
                    "necks, and its strain is no longer that of the metal.",
                    key="points",
                    remedy="Leave out what follows the largest stress, or give true strains and stresses.",
                )
        points = tuple((log(1 + e), s * (1 + e)) for e, s in points if e > -1)
    plastic = [(e - s / E, s) for e, s in points]
    elastic = [k for k, (p, _) in enumerate(plastic) if p <= ELASTIC]
    first = max(elastic, default=0)
    if not elastic or plastic[first][0] < -ELASTIC:
        e, s = points[first]
        raise SceneError(
            f"begins beside the elastic line of E = {E / 1e9:.4g} GPa: at a true strain of {e:.4g} it has "
            f"{s / 1e6:.4g} MPa, of which stress over E is a strain of {s / E:.4g}.",
            key="points",
            remedy="Give the point at which the body yields, with strain = stress / E.",
        )
    if plastic[first][1] == 0 and len(points) > 1:
        e, s = points[first + 1]
        raise SceneError(
            f"leaves the elastic line of E = {E / 1e9:.4g} GPa at its point without stress: the next, at a "
            f"true strain of {e:.4g}, has {s / 1e6:.4g} MPa, of which stress over E is a strain of "
            f"{s / E:.4g}.",
            key="points",
            remedy="Are the strains in per cent? Give 0.01 for 1 %, and the point at which the body yields.",
        )
    return ((0.0, plastic[first][1]), *plastic[first + 1 :])


def _of_rows(rows: Any) -> Points:
    if not isinstance(rows, Sequence) or not all(
        isinstance(row, (list, tuple)) and len(row) == 2 for row in rows
    ):
        raise SceneError("must be a list of pairs.", key="points", remedy=f"Write points = {EXAMPLE}.")
    return tuple(
        (parse_number(strain, f"points[{at}]"), parse_quantity(stress, "stress", f"points[{at}]"))
        for at, (strain, stress) in enumerate(rows, 1)
    )


def _of_file(path: str) -> Points:
    try:
        table = read_user_table(path, HEADER)
        column = table.quantity("stress", "stress")
        shares = {one: 0.01 for one in table.names if one.replace(" ", "") in PER_CENT}
        shares |= {one: 1.0 for one in table.names if one == "strain"}
        if column is None or len(shares) != 1:
            told = f"Its header is such as {HEADER}, or strain_% in place of strain."
            raise ResultError(f"{path}: has no two columns strain and stress. {told}")
        (name, unit), ((strain, share),) = column, shares.items()
        strains = [share * finite(place, text) for place, text in table.column(strain)]
        return tuple(
            zip(strains, (in_si(place, text, unit) for place, text in table.column(name)), strict=True)
        )
    except ResultError as error:
        raise SceneError(str(error), key="points") from None
