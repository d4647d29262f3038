"""Options that state a scene: an id or a file with changed values, or a solid steel rod in a few words."""

from __future__ import annotations

import math
import re
import shlex
import sys
import tomllib
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

from fem_impact.cli.parser import Options
from fem_impact.errors import SceneError, UsageError, did_you_mean

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene
    from rigid import Projectile

USUAL_TIP = "B"
SLOWED = 0.5
"""Share of the old speed of approach below which a fall along the axis is no other way to state it."""
ALONG = 1e-6
"""Angle, rad, between velocity and axis at most of a body that moves along its axis."""
SHAPE = ("tip", "tip_radius")
"""Options of a steel rod that have a default."""


def asked_scene(options: Options) -> Scene:
    """Return the scene that the options name, changed as they say; it is read once, in ``options.read_s``."""
    if options.asked is None:
        begun = perf_counter()
        if options.until:
            options.changes = [*options.changes, f"impact.until={options.until}"]
        options.asked = changed_scene(options.scene, options.changes)
        options.read_s = perf_counter() - begun
    return options.asked


def changed_scene(id_or_path: str, changes: Sequence[str]) -> Scene:
    """Load a scene and apply the changes of the command line; the changed scene is checked once.

    Its title tells the values of projectile, barrier, surface and impact that were changed.
    """
    from fem_impact.scene.shipped import load_to_change, replace, replace_all, titled

    given = read_changes(changes)
    scene = load_to_change(id_or_path, given)
    if not given:
        return scene
    changed = replace_all(scene, given, "--set")
    return replace(changed, "title", titled(scene.title, given)) if changed.title == scene.title else changed


def placed(error: SceneError, options: Options) -> SceneError:
    """Return a complaint about a key of the scene with the place that states it: the file or ``--set``."""
    key, of, _ = error.key.partition(" of ")  # hardness of rod-steel: of whichever body is made of it
    if error.source or not re.fullmatch(r"[a-z_]+(\.[a-z_0-9]+)*", key):
        return error
    changes = read_changes(options.changes)
    changed = error.key in changes or any(of and one.endswith(f"material.{key}") for one in changes)
    file = options.scene if Path(options.scene).is_file() else ""
    return error.under("", "--set" if changed else file)


def read_changes(changes: Sequence[str]) -> dict[str, Any]:
    """Return key and value of each ``key=value``: the table of ``@FILE``, TOML where it can be, else text."""
    read = [_change(text) for text in changes]
    keys = [key for key, _ in read]
    if twice := [key for key in keys if keys.count(key) > 1]:
        raise UsageError("is given twice.", key=f"--set {twice[0]}", remedy="Keep one of the two.")
    return dict(read)


def _change(change: str) -> tuple[str, Any]:
    key, equals, text = (part.strip() for part in change.partition("="))
    if not equals or not key:
        remedy = "Write --set accuracy.tip_size='0.5 mm'."
        raise UsageError("is not of the form key=value.", key="--set", value=change, remedy=remedy)
    if key == "effects" and not text.startswith("[") and "," in text:
        return key, [name.strip() for name in text.split(",")]
    if text.startswith("@"):
        from fem_impact.scene.read import read_tables

        return key, read_tables(Path(text[1:]))
    if names_material(key) and re.fullmatch(r"[\d.]+", text):
        return key, text
    if re.fullmatch(r"[+-]?\.\d+", text):  # .36, which TOML refuses
        return key, float(text)
    try:
        return key, tomllib.loads(f"value = {text}")["value"] if "\n" not in text else text
    except (ValueError, RecursionError):
        return key, text


def names_material(key: str) -> bool:
    """Return whether a key takes the name of a material, which may be a number: 4340, 1.4404."""
    *path, last = key.split(".")
    return last == "material" or path[-1:] == ["mesh_materials"]


def command_line(options: Options, command: str, *names: str, scene: str = "") -> str:
    """Return the line of a command: its scene with the changes, and the named options that are given.

    ``scene`` stands in place of the one that the options name.
    """
    words = ["fem-impact", command, *([scene or options.scene] if scene or options.scene else [])]
    words += [word for change in options.changes for word in ("--set", change)]
    for name in names:
        given = getattr(options, name)
        values = given if isinstance(given, list | tuple) else [given]
        words += [word for value in values if value for word in (f"--{name.replace('_', '-')}", str(value))]
    return shlex.join(words)


def say_kept(scene: Scene, options: Options) -> None:
    """Say what ``--set`` left as it was: velocities at another angle, a bore in a longer projectile."""
    changed = set(read_changes(options.changes))
    _say_fall(scene, changed, options)
    rod = scene.projectile
    longer = bool({"projectile.length", "projectile.length_m"} & changed)
    if rod.segments and longer and "projectile.segments" not in changed:
        kept = ", ".join(f"{1e3 * part.to:.4g} mm" for part in rod.segments[:-1])
        sys.stderr.write(
            f"fem-impact: the segments still end at {kept or 'the tail'}; the last one ends at the new tail\n"
        )
    if rod.open_at_tail and longer and "projectile.bore" not in changed:
        sys.stderr.write("fem-impact: the bore ends at the new tail\n")
    elif rod.bore and longer and "projectile.bore" not in changed:
        ends = f"{1e3 * rod.bore[0][0]:.4g} to {1e3 * rod.bore[-1][0]:.4g} mm"
        sys.stderr.write(
            f"fem-impact: warning: the bore is that of the old length, {ends} from the tip. Another one: "
            '--set projectile.bore=\'[["0 mm", "6 mm"], ["400 mm", "6 mm"]]\'\n'
        )


def _say_fall(scene: Scene, changed: set[str], options: Options) -> None:
    """Say that the velocities are those of the angle before, or that the fall is as fast as it was."""
    impact = scene.impact
    given = any(key.startswith(("impact.v_", "impact.speed", "impact.height")) for key in changed)
    turned = {"impact.angle", "impact.angle_rad"} & changed
    if given or not turned or (impact.height and impact.slope is not None):
        return
    from fem_impact.scene.shipped import load_to_change

    old = load_to_change(options.scene, read_changes(options.changes)).impact
    if old.angle == impact.angle:
        return
    speed = math.hypot(impact.v_n, impact.v_t)
    if impact.speed or impact.height:
        falls = "still moves" if scene.projectile.is_ball else "still moves along its axis"
        sentence = (
            f"the {scene.projectile.called} {falls} at {speed:.4g} m/s, which turns its velocity: "
            f"v_n = {impact.v_n:.4g} m/s, v_t = {impact.v_t:.4g} m/s. To keep the old one: "
            f"--set impact.v_n='{old.v_n:.4g} m/s' --set impact.v_t='{old.v_t:.4g} m/s'"
        )
    elif abs(impact.beside) < ALONG:  # it moves along its axis all the same
        return
    else:
        sentence = "warning: v_n and v_t are those of the old angle."
        still = not (scene.barrier.v_n or scene.barrier.v_t)
        # a fall along the axis still strikes
        if still and speed * math.cos(impact.angle) > SLOWED * abs(impact.v_n):
            sentence += f" A fall as fast at the new one: --set impact.speed='{speed:.4g} m/s'"
    sys.stderr.write(f"fem-impact: {sentence}\n")


def named_scene(options: Options, needed: Sequence[str]) -> Scene | None:
    """Return the scene that is named, None where the options state a solid steel rod instead.

    ``needed`` are the options that state it in full.
    """
    given = [f"--{name.replace('_', '-')}" for name in (*needed, *SHAPE) if getattr(options, name)]
    if options.scene:
        if given:
            remedy = "A scene states its rod and impact itself: change it with --set key=value."
            raise UsageError("describes a rod, but a scene is named too.", key=given[0], remedy=remedy)
        return asked_scene(options)
    missing = [f"--{name}" for name in needed if not getattr(options, name)]
    if options.changes and not missing:
        remedy = "Name a scene to change, or leave --set out."
        raise UsageError("changes a scene, and none is named.", key="--set", remedy=remedy)
    if missing:
        what = f"{', '.join(missing)} {'are' if missing[1:] else 'is'} missing"
        what = "no scene is given" if len(missing) == len(needed) else what
        remedy = "Name a scene (`fem-impact scenes` lists them), or state a solid steel rod in full."
        raise UsageError(f"{what}.", key="SCENE", remedy=remedy)
    return None


def rod_of(options: Options) -> Projectile:
    """Return the solid steel rod that the options describe.

    Raises
    ------
    UsageError
        A quantity has no unit, the tip is unknown, or it is an added one and has no radius.
    SceneError
        No such rod can be turned.
    """
    from fem_impact.answers.verdict.dropped import DENSITY, TIP_RADII
    from fem_impact.scene.tips import tips
    from fem_impact.scene.units import option_quantity
    from rigid import Projectile, RigidError

    tip, known = options.tip or USUAL_TIP, tips()
    if tip not in known:
        remedy = did_you_mean(tip, known, f"Known are: {', '.join(known)}.")
        raise UsageError("is no tip.", key="--tip", value=tip, remedy=remedy)
    if not options.tip_radius and tip not in TIP_RADII:
        remedy = 'Give its radius, such as --tip-radius "3 mm".'
        raise UsageError("has no default radius.", key="--tip", value=tip, remedy=remedy)
    given = options.tip_radius
    radius = option_quantity(given, "length", "--tip-radius") if given else TIP_RADII[tip]
    length, diameter = (
        option_quantity(getattr(options, name), "length", f"--{name}") for name in ("length", "diameter")
    )
    try:
        return Projectile(length, diameter, tip, radius, DENSITY)
    except RigidError as error:
        remedy = "Change --length, --diameter, --tip or --tip-radius."
        raise SceneError(f"{error}.", key="rod", remedy=remedy) from None


def angle_of(options: Options) -> float:
    """Return the angle, rad; one beyond a right angle to either side is refused."""
    from fem_impact.scene.units import option_quantity

    alpha = option_quantity(options.angle, "angle", "--angle")
    if not abs(alpha) <= math.pi / 2:
        raise SceneError("must lie from -90 to 90 degrees.", key="--angle", value=options.angle)
    return alpha
