"""The command ``coefficients``: restitution, impulse ratio and moment coefficient of a user's own tests."""

import numpy as np

from fem_impact.answers.verdict.text import own_text
from fem_impact.cli.parser import Options
from fem_impact.cli.scene_options import angle_of, named_scene, rod_of
from fem_impact.cli.terminal import print_answer
from fem_impact.errors import SceneError, UsageError
from fem_impact.evidence.paper.own_data import own_coefficients
from fem_impact.run.seen_tests import TURNING, SeenTests
from fem_impact.run.tests import other_impacts, seen_tests
from fem_impact.scene.own_tests import read_camera
from fem_impact.scene.units import option_quantity
from rigid import Arms, RigidError, touch_arms

TESTED = ("length", "diameter", "angle")
"""Options of a tested steel rod that must be given where no scene is."""


def coefficients(options: Options) -> int:
    """Work out the coefficients of the user's own tests."""
    if scene := named_scene(options, TESTED):
        rod, alpha = scene.projectile.rigid_body, scene.impact.angle
        tip = scene.projectile.tip, scene.projectile.tip_radius
    else:
        rod, alpha = rod_of(options), angle_of(options)
        tip = rod.tip, rod.tip_radius
    stated = _stated_arms(options)
    camera = read_camera(options.file)
    seen = seen_tests(scene, camera) if scene else SeenTests.of(camera.motion, rod.mass, rod.k2, 0.0, None)
    if seen.turns:
        raise SceneError(TURNING, key="barrier.inertia", remedy="Give tests on a barrier that does not turn.")
    if stated is not None:
        arms, source = stated, "as stated"
    elif camera.arms:
        arms, source = Arms(*map(np.asarray, camera.arms)), "as the file states"
    else:
        touch = rod.touch(alpha)
        source = "middle of what lands flat" if touch.length else "lowest point of the tip's shape"
        arms = touch_arms(touch, rod.x_c, rod.z_c, alpha)
    try:
        with np.errstate(divide="ignore", invalid="ignore"):  # no moment coefficient without an arm
            document = own_coefficients(camera, seen, rod, tip, alpha, arms, source)
    except RigidError as error:
        raise SceneError(f"{error}.", source=str(options.file), remedy="Check signs and arms.") from None
    document = {"file": str(options.file), **document}
    if scene:
        document["notes"] = [*other_impacts(scene, camera), *document["notes"]]
    print_answer(options, document, own_text(document))
    return 0


def _stated_arms(options: Options) -> Arms | None:
    """Return the arms, m, of ``--d-c`` and ``--d-d``, which are given both or neither."""
    given = options.d_c, options.d_d
    if not any(given):
        return None
    if not all(given):
        raise UsageError("one arm alone was given.", key="--d-c, --d-d", remedy="Give both or neither.")
    return Arms(*(np.asarray(option_quantity(text, "length", "--d-c, --d-d")) for text in given))
