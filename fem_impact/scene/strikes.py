"""How a body is followed: the models of its strikes, and what is not known of how it comes."""

import re
from dataclasses import dataclass
from itertools import pairwise

from fem_impact.errors import SceneError
from fem_impact.options import FIDELITIES
from fem_impact.scene import fields

Stage = tuple[str, int | None]
"""A model, and how many strikes it computes: None is all that follow."""
STAGE = re.compile(r"(rigid|modal|solid)(?: for the (?:first|next) ([1-9][0-9]{0,2}))?")
REMEDY = (
    'Name models from the finest on, such as "solid for the first 3, then modal" or "solid for the first 1, '
    'then modal for the next 4, then rigid".'
)


@dataclass(frozen=True, slots=True)
class Following:
    """How a body is followed beyond its first impact.

    Attributes
    ----------
    fidelity : the models of its strikes, such as "solid for the first 3, then modal"; empty: that of the run,
        of finite elements the first strike
    angle_error : how far the angle may be off either way, rad; speed_error : share of the velocities
    """

    fidelity: str = ""
    angle_error: float | None = None
    speed_error: float | None = None

    def __post_init__(self) -> None:
        fields.check_numbers(self, fields.STRIKES)
        if not isinstance(self.fidelity, str) or (self.fidelity and not _holds(self.fidelity)):
            problem = "does not say which models compute the strikes."
            raise SceneError(problem, key="fidelity", value=self.fidelity, remedy=REMEDY)

    @property
    def stated(self) -> tuple[Stage, ...]:
        """The stages as stated, from the first strike on."""
        return _stages(self.fidelity) if self.fidelity else ()

    @property
    def first(self) -> str:
        """Return the model of the first strike where none is asked for otherwise."""
        return self.stated[0][0] if self.fidelity else "solid"

    def stages(self, fidelity: str) -> tuple[Stage, ...]:
        """Return the stages of a run of a ``fidelity``, which computes the first strike.

        Finer models are left out of a run of a coarser one; without a statement finite elements compute the
        first strike, and other models all.
        """
        rest = [stage for stage in self.stated if not _finer(stage[0], fidelity)]
        if rest and rest[0][0] == fidelity:
            return tuple(rest)
        if fidelity == "rigid" or (fidelity == "modal" and not rest):
            return ((fidelity, None),)
        return ((fidelity, 1), *(rest or [("rigid", None)]))


def _finer(model: str, other: str) -> bool:
    return FIDELITIES.index(model) > FIDELITIES.index(other)


def _stages(text: str) -> tuple[Stage, ...]:
    """Return the stages of a statement; those of none where a part of it is not understood."""
    parts = [STAGE.fullmatch(part) for part in text.split(", then ")]
    return tuple((part[1], int(part[2]) if part[2] else None) for part in parts if part) if all(parts) else ()


def _holds(text: str) -> bool:
    """Return whether all stages but the last have a number, and each is coarser than the one before."""
    stages = _stages(text)
    counted = all(count is not None for _, count in stages[:-1])
    ordered = all(_finer(one, other) for (one, _), (other, _) in pairwise(stages))
    return bool(stages) and counted and ordered and stages[-1][1] is None
