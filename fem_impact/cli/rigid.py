"""The commands that need no finite elements: ``audit``, ``coefficients`` and ``figure``."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.cli.common import changed_scene, checked_file, print_json
from fem_impact.cli.options import Options
from fem_impact.errors import SceneError, UsageError
from fem_impact.files.atomic import write_text
from fem_impact.tables.text import wrapped

if TYPE_CHECKING:
    from fem_impact.evidence.paper.drawn import Drawn
    from fem_impact.scene.camera import Camera
    from fem_impact.scene.types import Scene
    from rigid import Arms, Body, Projectile


USUAL_TIP = "B"
SHAPE = ("tip", "tip_radius")
"""Options of a steel rod that have a default."""
TESTED = ("length", "diameter", "angle")
"""Options of a tested steel rod that must be given where no scene is."""


def audit(options: Options) -> int:
    """Recompute the printed columns and print where they disagree."""
    out = checked_file(options.out) if options.out else None
    from fem_impact.evidence.paper.audit import audit_document, audit_text, records_table

    document = audit_document(options.set_id)
    if out:
        write_text(out, records_table(document).csv())
    _print(document, audit_text, options)
    return 0


def coefficients(options: Options) -> int:
    """Work out the coefficients of the user's own tests."""
    from fem_impact.answers.verdict.text import own_text
    from fem_impact.evidence.paper.own_data import own_coefficients
    from fem_impact.physics import contact
    from fem_impact.scene.camera import read_camera
    from rigid import RigidError

    if scene := named_scene(options, TESTED):
        rod, alpha, own = contact.projectile(scene), scene.impact.angle, scene.projectile
        tip = own.tip, own.tip_radius
    else:
        rod, alpha = rod_of(options), angle_of(options)
        tip = rod.tip, rod.tip_radius
    stated = _stated_arms(options)
    camera = read_camera(options.file)
    arms, source = _arms(stated, rod, alpha, camera)
    try:
        document = own_coefficients(camera, rod, tip, alpha, arms, source)
    except RigidError as error:
        raise SceneError(f"{error}.", source=str(options.file), remedy="Check signs and arms.") from None
    _print({"file": str(options.file), **document}, own_text, options)
    return 0


def figure(options: Options) -> int:
    """Draw one figure of the paper."""
    from fem_impact.evidence.paper.figures import draw_figure

    drawn = draw_figure(options.number, options.out or Path("results") / "paper")
    if options.json:
        print_json(_figure_entry(drawn))
    else:
        sys.stdout.write(_figure_text(drawn))
    return 0


def named_scene(options: Options, needed: Sequence[str]) -> Scene | None:
    """Return the scene that is named, None where the options state a solid steel rod instead.

    ``needed`` are the options that state it in full.
    """
    given = [f"--{name.replace('_', '-')}" for name in (*needed, *SHAPE) if getattr(options, name, None)]
    if options.scene:
        if given:
            remedy = "A scene states its rod and impact itself: change it with --set key=value."
            raise UsageError("describes a rod, but a scene is named too.", key=given[0], remedy=remedy)
        return changed_scene(options.scene, options.changes)
    missing = [f"--{name}" for name in needed if not getattr(options, name, None)]
    if options.changes or missing:
        what = (
            "no scene is given"
            if len(missing) == len(needed)
            else f"{', '.join(missing)} {'are' if missing[1:] else 'is'} missing"
        )
        remedy = "Name a scene (`fem-impact scenes` lists them), or state a solid steel rod in full."
        raise UsageError(f"{what}.", key="SCENE", remedy=remedy)
    return None


def rod_of(options: Options) -> Projectile:
    """Return the solid steel rod that the options describe."""
    from fem_impact.answers.verdict.drop import rod_from_options

    return rod_from_options(
        options.length or "", options.diameter or "", options.tip or USUAL_TIP, options.tip_radius
    )


def angle_of(options: Options) -> float:
    """Return the angle, rad; one that is not in [0, pi/2) is refused."""
    from fem_impact.scene.units import option_quantity

    alpha = option_quantity(options.angle or "", "angle", "--angle")
    if not 0 <= alpha < math.pi / 2:
        raise SceneError("must lie from 0 up to 90 degrees.", key="--angle", value=options.angle)
    return alpha


def _stated_arms(options: Options) -> Arms | None:
    """Return the arms, m, of ``--d-c`` and ``--d-d``, which are given both or neither."""
    import numpy as np

    from fem_impact.scene.units import option_quantity
    from rigid import Arms

    given = (options.d_c, options.d_d)
    if given == (None, None):
        return None
    if options.d_c is None or options.d_d is None:
        raise UsageError("one arm alone was given.", key="--d-c, --d-d", remedy="Give both or neither.")
    d_c, d_d = (option_quantity(text, "length", "--d-c, --d-d") for text in (options.d_c, options.d_d))
    return Arms(np.asarray(d_c), np.asarray(d_d))


def _arms(stated: Arms | None, rod: Body, alpha: float, camera: Camera) -> tuple[Arms, str]:
    """Return the arms, m, and their source: options, the file, or the shape of the tip."""
    import numpy as np

    from rigid import Arms

    if stated is not None:
        return stated, "as stated"
    if camera.arms:
        return Arms(*map(np.asarray, camera.arms)), "as the file states"
    return rod.arms(alpha), "lowest point of the tip's shape"


def _print(document: dict[str, Any], text: Callable[[dict[str, Any]], str], options: Options) -> None:
    if options.json:
        print_json(document)
    else:
        sys.stdout.write(text(document))


def _figure_entry(drawn: Drawn) -> dict[str, Any]:
    statements = [{"claim": s.claim, "found": s.found, "holds": s.holds} for s in drawn.statements]
    places = {"picture": str(drawn.picture), "data": str(drawn.data)}
    return {"figure": drawn.number, **places, "sentence": drawn.sentence, "statements": statements}


def _figure_text(drawn: Drawn) -> str:
    lines = [*wrapped(drawn.sentence, hang=""), "", "The paper's statements:"]
    for s in drawn.statements:
        lines += wrapped(f"{'holds' if s.holds else 'FAILS'}: {s.claim}: {s.found}", "  ")
    return "\n".join([*lines, "", f"picture: {drawn.picture}", f"data: {drawn.data}"]) + "\n"
