"""The motion at first contact, by a height, a speed or two velocities; how a body is followed after it."""

import re
from collections.abc import Collection
from dataclasses import dataclass
from itertools import pairwise
from math import atan2, cos, hypot, isclose, radians, sin, sqrt
from typing import Any

from fem_impact.errors import SceneError
from fem_impact.options import FIDELITIES
from fem_impact.scene import fields

BESIDE = radians(2.0)  # rad between velocity and axis of a dropped rod at most; of the measured ones .017
FIRST, REST = "first", "rest"
STRIKES = re.compile(r"([1-9][0-9]{0,2}) strikes?")
WAYS = (("height",), ("speed",), ("v_n", "v_t"))
"""The keys of each way to state how fast the body comes."""
NUMBERS = (*fields.IMPACT, fields.SLOPE, fields.HEIGHT, fields.SPEED)
"""All numbers that a table of an impact may hold."""
_KEEP = "Give a height, or a speed along the body's axis, or v_n and v_t, and keep one of them."


@dataclass(frozen=True, slots=True)
class Impact:
    """Motion at first contact: angle in rad, v_n and v_t of the mass centre in m/s, omega in rad/s.

    ``slope``, rad, is that of the barrier; None: the rod's axis is vertical. ``until`` says how far the body
    is followed: "first", to the end of the first impact, "3 strikes", or "rest".
    Where the velocities follow from a ``height``, m, or a ``speed``, m/s, that is kept beside them: make such
    an impact by `Impact.dropped` or `Impact.thrown`.
    """

    angle: float
    v_n: float
    v_t: float
    omega: float = 0.0
    height: float | None = None
    speed: float | None = None
    slope: float | None = None
    until: str = FIRST

    def __post_init__(self) -> None:
        fields.check_numbers(self, (*fields.MOTION, fields.HEIGHT, fields.SPEED, fields.SLOPE))
        # refuse another word than those that say how far a body is followed (SceneError)
        if not isinstance(self.until, str) or not (
            self.until in (FIRST, REST) or STRIKES.fullmatch(self.until)
        ):
            remedy = 'Use "first", "rest", or a number of strikes up to 999, such as "3 strikes".'
            raise SceneError(
                "does not say how far the body is followed.", key="until", value=self.until, remedy=remedy
            )
        if self.height is None and self.speed is None:
            return
        speed = self.speed if self.height is None else _fallen(self.height)
        way = self.angle if self.height is None else self.vertical
        wanted = _along(way, speed) if speed and None in (self.height, self.speed) else (0.0, 0.0)
        if not all(isclose(a, b, rel_tol=1e-9) for a, b in zip(wanted, (self.v_n, self.v_t), strict=True)):
            raise SceneError("does not belong to its v_n and v_t.", key=self.stated[0], remedy=_KEEP)

    @classmethod
    def dropped(
        cls, angle: float, height: float, omega: float = 0.0, slope: float | None = None, until: str = FIRST
    ) -> "Impact":
        """Return the impact of a rod that fell from rest by ``height``, m, down the vertical: v^2 = 2 g h."""
        fallen = _along(angle if slope is None else slope, _fallen(fields.HEIGHT.checked(height)))
        return cls(angle, *fallen, omega, height=height, slope=slope, until=until)

    @classmethod
    def thrown(
        cls, angle: float, speed: float, omega: float = 0.0, slope: float | None = None, until: str = FIRST
    ) -> "Impact":
        """Return the impact of a rod that moves along its axis at ``speed``, m/s."""
        along = _along(angle, fields.SPEED.checked(speed))
        return cls(angle, *along, omega, speed=speed, slope=slope, until=until)

    @property
    def vertical(self) -> float:
        """Angle, rad, between the vertical and the barrier's normal: the slope, or that of the rod's axis."""
        return self.angle if self.slope is None else self.slope

    @property
    def most_strikes(self) -> int | None:
        """How many strikes are followed, None where they are to the rest."""
        counted = STRIKES.fullmatch(self.until)
        return int(counted[1]) if counted else 1 if self.until == FIRST else None

    @property
    def stated(self) -> tuple[str, ...]:
        """The keys by which its velocities are stated, one of `WAYS`."""
        return next((way for way in WAYS[:2] if getattr(self, way[0]) is not None), WAYS[2])

    @property
    def beside(self) -> float:
        """Angle, rad, from the rod's axis to its velocity; about 0 for a rod that was dropped."""
        return atan2(-self.v_t, -self.v_n) - self.angle


def _fallen(height: float) -> float:
    from rigid import GRAVITY

    return sqrt(2 * GRAVITY * height)


def _along(angle: float, speed: float) -> tuple[float, float]:
    return -speed * cos(angle), -speed * sin(angle)


def the_way(keys: Collection[str]) -> tuple[str, ...]:
    """Return the way by which a table with these keys states the velocities.

    Raises
    ------
    SceneError
        If there is none, or more than one.
    """
    given = [way for way in WAYS if set(way) & set(keys)]
    if len(given) == 1:
        return given[0]
    names = " and by ".join(" and ".join(key for key in way if key in keys) for way in given)
    problem = f"states the velocity twice, by {names}." if given else "does not say how fast the body comes."
    raise SceneError(problem, remedy=_KEEP)


def restated(old: Impact, table: dict[str, Any], changed: Collection[str]) -> dict[str, Any]:
    """Return the table of a changed impact, in which the changed keys state the velocities.

    A new height or speed takes the place of velocities, and they of it. A new angle alone leaves a fall a
    fall: a rod that came along its axis still does, as fast as before.

    Raises
    ------
    SceneError
        One velocity alone is changed of an impact that a height or speed states.
    """
    new = set(changed)
    velocities = new & set(WAYS[2])
    if len(velocities) == 1 and old.stated != WAYS[2] and not new & {"height", "speed"}:
        # the other velocity would silently be that of the old fall
        (key,), (other,), (way,) = velocities, set(WAYS[2]) - velocities, old.stated
        raise SceneError(
            f"is one of two velocities, but the scene states its impact by {way} along the body's axis.",
            key=f"impact.{key}",
            remedy=f"Change impact.{way}, or state both velocities: add impact.{other}.",
        )
    if not new & {key for way in WAYS for key in way}:
        along = old.slope is None and abs(old.beside) <= BESIDE
        if "angle" not in new or old.stated != WAYS[2] or not along:
            return table
        table, new = {**table, "speed": fields.SPEED.write(hypot(old.v_n, old.v_t))}, {"speed"}
    both = (fields.V_N, fields.V_T) if velocities else ()
    return one_way({**{p.key: p.write(getattr(old, p.key)) for p in both if p.key not in new}, **table}, new)


def one_way(table: dict[str, Any], new: Collection[str]) -> dict[str, Any]:
    """Return the table of an impact without the ways to state the velocities that new keys replace."""
    kept = {key for way in WAYS if set(way) & set(new) for key in way}
    others = {key for way in WAYS for key in way} - kept if kept else set()
    return {key: value for key, value in table.items() if key not in others}


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
    angle_error : how far the angle may be off either way, rad
    speed_error : share by which the velocities, as seen from the barrier, may be off
    """

    fidelity: str = ""
    angle_error: float | None = None
    speed_error: float | None = None

    def __post_init__(self) -> None:
        fields.check_numbers(self, fields.STRIKES)
        # all stages but the last have a number, and each is coarser than the one before
        stages = self.stated if isinstance(self.fidelity, str) else ()
        counted = all(count for _, count in stages[:-1])
        ordered = all(_finer(one, other) for (one, _), (other, _) in pairwise(stages))
        if self.fidelity != "" and not (stages and counted and ordered and stages[-1][1] is None):
            problem = "does not say which models compute the strikes."
            raise SceneError(problem, key="fidelity", value=self.fidelity, remedy=REMEDY)

    @property
    def stated(self) -> tuple[Stage, ...]:
        """The stages as stated, from the first strike on; none where a part of them is not understood."""
        parts = [STAGE.fullmatch(part) for part in self.fidelity.split(", then ")]
        stages = tuple((part[1], int(part[2]) if part[2] else None) for part in parts if part)
        return stages if all(parts) else ()

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
