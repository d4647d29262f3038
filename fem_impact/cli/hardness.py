"""The command ``hardness``: what the hardness of a scene's materials says of a hardened layer."""

from collections.abc import Iterator
from dataclasses import asdict
from math import inf

from fem_impact.answers.hardness import Hardness, SkinPoint, hardnesses
from fem_impact.cli.parser import Options
from fem_impact.cli.scene_options import asked_scene
from fem_impact.cli.terminal import print_answer
from fem_impact.errors import UsageError
from fem_impact.scene.fields import SKIN
from fem_impact.tables.table import Table
from fem_impact.tables.text import wrapped

NONE = "No material states a hardness beside strengths or a curve that give its flow stress without it."


def hardness(options: Options) -> int:
    """Print the layers that meet the hardness of each material."""
    loads = [_load(text) for text in options.loads.split(",")] if options.loads else []
    scatter = _number("--scatter", options.scatter) if options.scatter else 0.0
    found = list(hardnesses(asked_scene(options), loads, scatter))
    lines = [line for one in found for line in _lines(one)] or wrapped(NONE)
    print_answer(options, [_document(one) for one in found], "\n".join(lines) + "\n")
    return 0


def _number(option: str, text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = -1.0
    if not 0 < number < inf:
        raise UsageError("is no number above 0.", key=option, value=text)
    return number


def _load(text: str) -> float:
    """Return a load of a hardness test, kgf, within the bounds of that of a skin."""
    load = _number("--loads", text)
    allowed = next(number for number in SKIN if number.key == "load")
    if not allowed.allows(load):
        raise UsageError(f"must be {allowed.low:g} to {allowed.high:g} kgf.", key="--loads", value=text)
    return load


def _document(one: Hardness) -> dict[str, object]:
    """Return a hardness for ``--json``, where no finite depth is null."""
    plain = asdict(one)
    points = [{k: None if v == inf else v for k, v in point.items()} for point in plain["points"]]
    return plain | {"points": points}


def _lines(one: Hardness) -> Iterator[str]:
    if one.reason:
        where = f"{one.place} ({one.material}): HV {one.HV:g} is stated, but no layer that meets it is known"
        yield from [*wrapped(f"{where}. {one.reason}"), ""]
        return
    low, usual, high = one.bulk
    yield from wrapped(
        f"{one.place} ({one.material}): HV {one.HV:g} is stated; its flow curve alone has HV "
        f"{usual:.0f} with friction 0.1 under the pyramid, {low:.0f} without and {high:.0f} with 0.2."
    )
    if one.skin is not None:
        yield from wrapped(f"The layer of the scene is {1e3 * one.skin:.3g} mm deep.")
    loads = list(dict.fromkeys(point.load for point in one.points))
    rows = [
        [f"{factor:g}", *(_depth(point) for point in one.points if point.factor == factor)]
        for factor in dict.fromkeys(point.factor for point in one.points)
    ]
    heads = "factor", *(f"depth at HV {load:g}, mm" for load in loads)
    yield from ["", *Table.of(heads, rows).terminal(indent="  ").splitlines(), ""]


def _depth(point: SkinPoint) -> str:
    """Return depth and range, mm; a bar where no depth suffices."""
    low, at, high = (
        "–" if depth == inf else f"{1e3 * depth:.2g}" for depth in (point.low, point.depth, point.high)
    )
    return f"{at} ({low} to {high})"
