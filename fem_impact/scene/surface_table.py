"""From the table of a surface to the surface: a known state, one of the user's own, or that of the pair."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from itertools import product

from fem_impact.errors import SceneError
from fem_impact.scene import fields, library
from fem_impact.scene.material import Material, Surface, widening
from fem_impact.scene.sliding import EXAMPLE, SlidingLaw, law_of
from fem_impact.scene.tables import Table, check_keys, needed, numbers_of

LAW = "sliding_law"


def read_surface(table: Table) -> Surface | None:
    """Read a surface; that of the pair, which is None, follows from both materials."""
    check_keys(table, ("state", "source", *(f.key for f in fields.SURFACE), LAW))
    states = '"custom" beside friction and source, or "machined", "contaminated", "cleaned", "pair"'
    state = needed(table, "state", states)
    if state != "custom":
        return None if state == "pair" else of_known(partial(library.surface, state), table)
    f = needed(table, "friction", "0.3, Coulomb's coefficient")
    interval = {"friction_low": f, "friction_high": f}
    numbers = numbers_of(table, fields.SURFACE, ("state", "source", LAW), interval)
    source = needed(table, "source", '"our own tests", where the friction is known from')
    return Surface(state="custom", source=source, sliding_law=_sliding_law(table), **numbers)


def of_known(surface: Callable[[], Surface], table: Table) -> Surface:
    """Return a surface of known friction; its table may repeat what is known."""
    known = surface()
    for key, value in table.items():
        if key != LAW and value != getattr(known, key):
            raise SceneError(
                f"is not the value of a {known.state} surface ({getattr(known, key)}).",
                key=key,
                value=value,
                remedy='Leave it out, or write state = "custom" with your own friction and its source.',
            )
    return replace(known, sliding_law=_sliding_law(table))


def _sliding_law(table: Table) -> SlidingLaw | None:
    """Return the law of friction over speed, by its name or from its table; None where none is stated."""
    stated = table.get(LAW)
    if stated is None:
        return None
    try:
        if isinstance(stated, str):
            return library.sliding_law(stated)
        if not isinstance(stated, Mapping):
            raise SceneError("must be a name or a table.", remedy=f"Write {LAW} = {EXAMPLE}.")
        return law_of(stated)
    except SceneError as error:
        raise error.under(LAW) from None


OWN = 'surface = { state = "custom", friction = 0.3, source = "our own tests" }'


def pair_surface(rod: Material, barrier: Material) -> Surface:
    """Return the surface of a pair: the interval of its friction, the middle of it, and where it was read.

    Raises
    ------
    SceneError
        If no table has the pair.
    """
    found = known_pair(rod, barrier)
    if found is None:
        raise SceneError(
            f"is missing: no friction of {rod.name} on {barrier.name} is known.",
            key="friction",
            remedy=f"State it, such as {OWN}; `fem-impact scenes --friction` lists the known pairs.",
        )
    return found


def known_pair(rod: Material, barrier: Material) -> Surface | None:
    """Return the surface of a pair as `pair_surface` does, None where no table has it."""
    table = {frozenset(pair["families"]): pair for pair in library.friction_pairs()}
    first, second = (widening(library.family_of(metal)) for metal in (rod, barrier))
    both = sorted(product(enumerate(first), enumerate(second)), key=lambda ones: ones[0][0] + ones[1][0])
    pair = next(
        (table[key] for (_, one), (_, other) in both if (key := frozenset((one, other))) in table), None
    )
    if pair is None:
        return None
    low, high = float(pair["low"]), float(pair["high"])
    names = " on ".join(pair["families"])
    source = f"{names}, dry: {pair['source']}"
    return Surface("pair", round(0.5 * (low + high), 4), low, high, source)
