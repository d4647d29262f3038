"""Friction of a pair of materials whose surface no scene states: intervals of tables, by family."""

from itertools import product

from fem_impact.errors import SceneError
from fem_impact.scene.family import widening
from fem_impact.scene.library import family_of, friction_pairs
from fem_impact.scene.material import Material
from fem_impact.scene.surface import Surface

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
    table = {frozenset(pair["families"]): pair for pair in friction_pairs()}
    first, second = (widening(family_of(metal)) for metal in (rod, barrier))
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
