"""The state of surfaces that touch: Coulomb friction, its interval and source."""

from dataclasses import dataclass
from typing import Literal

from fem_impact.errors import SceneError
from fem_impact.scene import fields
from fem_impact.scene.checks import check_choice, check_numbers, check_text
from fem_impact.scene.sliding import SlidingLaw


@dataclass(frozen=True, slots=True)
class Surface:
    """State of the two surfaces: Coulomb f that goes in, its interval and where they come from.

    ``pair`` is that of a table of dry pairs of materials, for a scene that states no surface.
    ``sliding_law`` is how friction changes with speed; None: it does not.
    """

    state: Literal["machined", "contaminated", "cleaned", "pair", "custom"]
    friction: float
    friction_low: float
    friction_high: float
    source: str
    sliding_law: SlidingLaw | None = None

    def __post_init__(self) -> None:
        check_choice(self.state, ("machined", "contaminated", "cleaned", "pair", "custom"), "state")
        check_numbers(self, fields.SURFACE)
        check_text(self.source, "source", 1000)
        if not self.friction_low <= self.friction <= self.friction_high:
            raise SceneError(
                f"lies outside its own interval, {self.friction_low:g} to {self.friction_high:g}.",
                key="friction",
                value=self.friction,
                remedy="Give friction_low <= friction <= friction_high.",
            )
