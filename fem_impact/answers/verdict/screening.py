"""Closed-form screening of a scene: T1/tau and gamma, at once and without a solver."""

from dataclasses import dataclass

from fem_impact.case.bodies import Bodies
from fem_impact.tables.text import plain
from rigid import LIMIT, Projectile, behaves_rigidly

ROUND = (
    "The contact is estimated as that of a round tip, but a flat face lands all at once: in two runs on "
    "finite elements it lasted 0.3 and 0.6 of that"
)


@dataclass(frozen=True, slots=True)
class Screening:
    """Estimates of whether a rod vibrates.

    Attributes
    ----------
    period, duration : first bending period T1 and contact time tau of the first contact, s
    ovalling : period of the ovalling of a hollow body's wall, s; 0 of a solid one
    gamma : slenderness l / d^1.3815, m^-0.3815 (Eq 29)
    straight, flat : whether the rod strikes along its axis, and whether it lands on a flat face
    widest : largest diameter or width, m, of a body that is no solid round rod of one; 0 of such a rod
    """

    period: float
    duration: float
    ovalling: float
    gamma: float
    straight: bool
    flat: bool
    widest: float

    @property
    def ratio(self) -> float:
        """T1/tau: small where the contact is slow beside the rod's bending."""
        return self.period / self.duration

    @property
    def published(self) -> str:
        """What the published limit, gamma <= 26.45 m^-0.3815, says."""
        if self.widest:
            return (
                f"the published limit {LIMIT:g} is of solid round rods of one diameter: it says nothing here"
            )
        if self.straight:  # it is about e that does not change with the inclination
            return f"the published limit {LIMIT:g} is for inclined rods: it says nothing of a straight impact"
        rigid = bool(behaves_rigidly(self.gamma))
        said = "the rod rebounds as a rigid body" if rigid else "the rod does not rebound as a rigid body"
        return f"the published limit {LIMIT:g} says: {said}"

    @property
    def sentence(self) -> str:
        """Both numbers in one sentence."""
        widest = f" from the largest width, {plain(1e3 * self.widest)} mm" if self.widest else ""
        text = (
            f"T1/tau = {self.ratio:.2f} (first bending period {plain(self.period * 1e6)} us, estimated "
            f"contact {plain(self.duration * 1e6)} us), gamma = {self.gamma:.1f} m^-0.3815{widest}: "
            f"{self.published}"
        )
        if self.flat:
            return f"{text}. {ROUND}"
        if self.ovalling <= self.period or self.straight:
            return text
        return (
            f"{text}. Neither number knows of the wall, which ovals more slowly than the body bends: within "
            f"{plain(self.ovalling * 1e6)} us, {self.ovalling / self.duration:.2f} of the contact"
        )


def screening(bodies: Bodies) -> Screening:
    """Return the closed-form estimates of bodies with the effects in force."""
    return Screening(
        bodies.bending_period,
        float(bodies.estimate.duration),
        bodies.ovalling_period,
        float(bodies.body.gamma),
        bodies.scene.impact.angle == 0,
        bodies.contact.lands_flat,
        0.0 if isinstance(bodies.body, Projectile) else bodies.body.diameter,
    )
