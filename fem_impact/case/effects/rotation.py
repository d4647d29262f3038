"""Large rotation: the linear part of the rod is linear in a frame that turns with it."""

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.slots import ModelSpec
from rigid import sliding_path


def number(bodies: Bodies) -> float:
    """Return the estimated angle turned during the impact, rad: tau at the mean spin, T1 at the last one.

    A second contact comes about a bending period after the first. The last spin is that of a rigid rod whose
    contact gives back all that it takes up along the normal.
    """
    pair, before = bodies.contact, bodies.scene.impact.omega
    (d_c, d_d), (_, k2) = pair.arms, pair.reduced
    path = sliding_path(pair.v_n, pair.v_t, omega=pair.omega, e=1.0, f=pair.f, d_c=d_c, d_d=d_d, k2=k2)
    after = float(path.motion.Omega)
    turned = 0.5 * abs(before + after) * bodies.estimate.duration
    return turned + abs(after) * bodies.bending_period


def fill(bodies: Bodies, spec: ModelSpec) -> None:
    """Let the frame of the linear part turn with the rod."""
    spec.turning_frame = True
