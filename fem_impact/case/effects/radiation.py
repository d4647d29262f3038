"""Waves that leave through the outer boundary of a meshed barrier, by dashpots beside its springs."""

from math import sqrt

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.slots import ModelSpec
from fem_impact.errors import SceneError
from fem_impact.physics.contact import impedance


def number(bodies: Bodies) -> float:
    """Return the share of the normal energy that an elastic impact radiates into a half-space (Hunter).

    Of a part that lands flat it is at most that of a bar on a dashpot with the impedance of the half-space.
    Nothing leaves a block with fixed faces, and what leaves a plate that bends are bending waves.
    """
    if bodies.barrier.boundary == "fixed" or bodies.barrier.bends:
        return 0.0
    plate, pair = bodies.barrier.material, bodies.contact
    if pair.lands_flat:
        bar, ground = sqrt(pair.rod.E * pair.rod.rho), impedance(plate)
        return 4 * bar * ground / (bar + ground) ** 2
    return float(1.127 * (pair.approach / (plate.E / plate.rho) ** 0.5) ** 0.6)


def fill(bodies: Bodies, spec: ModelSpec) -> None:
    """Put dashpots on the outer boundary of the block.

    Raises
    ------
    SceneError
        If the block's faces are fixed, or the barrier is a plate that bends.
    """
    if bodies.barrier.bends:
        raise SceneError(
            "lets bending waves out, which are the effect plate-bending, not radiation into a half-space.",
            key="barrier.support",
            value="infinite",
            remedy='Leave "radiation" out of the effects.',
        )
    if bodies.barrier.boundary == "fixed":
        raise SceneError(
            "lets no waves out, which radiation asks for.",
            key="barrier.boundary",
            value="fixed",
            remedy='Leave "radiation" out of the effects, or "fixed" out of the scene.',
        )
    spec.radiating = True
