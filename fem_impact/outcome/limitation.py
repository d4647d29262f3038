"""What limits trust in a record: sentences, each with the kind of its cause."""

from collections.abc import Iterable
from typing import Literal

from fem_impact.outcome.keys import group

LimitationKind = Literal["input", "model", "range", "resolution", "result", "run"]


@group
class Limitation:
    """A sentence that limits how far a record may be trusted, with the kind of its cause.

    ========== ==================================================================================
    input      What scene and materials do not state, or leave out although its number matters
    model      What the model leaves out, idealises or takes from elsewhere
    range      Where the scene leaves what was measured
    resolution What elements, fine zones and modes do not resolve, or hardly
    result     A number that an impact on a resting barrier does not give by itself, and its cause
    run        What the computation did not do: write a frame, time an effect, reach a wanted error
    ========== ==================================================================================
    """

    kind: LimitationKind
    text: str


def limitations(kind: LimitationKind, *texts: str) -> tuple[Limitation, ...]:
    """Return the limitations of one kind that sentences state; an empty one states none."""
    return tuple(Limitation(kind=kind, text=text) for text in texts if text)


HEAVIEST_FIRST: tuple[LimitationKind, ...] = ("run", "resolution", "result", "input", "range", "model")
"""Kinds in the order in which they are told: what makes a number wrong before what the model leaves out."""
WRONG_NUMBERS = HEAVIEST_FIRST[:3]
"""Kinds that may make the numbers of this run wrong, told beside them."""


def by_weight(of: Iterable[Limitation]) -> tuple[Limitation, ...]:
    """Return limitations with the heaviest first, those of a kind in the order given."""
    return tuple(sorted(of, key=lambda one: HEAVIEST_FIRST.index(one.kind)))


def texts(of: Iterable[Limitation], *kinds: LimitationKind) -> tuple[str, ...]:
    """Return the sentences of limitations, of some ``kinds`` or, where none is named, of all."""
    return tuple(one.text for one in of if not kinds or one.kind in kinds)
