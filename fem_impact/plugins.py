"""What other installed packages add: materials, shapes of tips, effects, each an entry point of its name.

A package names them in its ``pyproject.toml``, such as::

    [project.entry-points."fem_impact.materials"]
    "al-6082-t6" = "my_package:AL_6082"

======================== ======================================================================
group                    what the name stands for
======================== ======================================================================
fem_impact.materials     a table of values with their units and a table ``sources``, as in materials.toml
fem_impact.shapes        a function that makes a `rigid.Nose` from the radii of rod and tip, m
fem_impact.friction_laws a `fem_impact.scene.sliding.SlidingLaw`
fem_impact.effects       a `fem_impact.case.effects.slots.Effect` of the same name
======================== ======================================================================
"""

from collections.abc import Collection
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Any

from fem_impact.errors import UsageError

GROUPS = ("materials", "shapes", "friction_laws", "effects")


def added(group: str, ours: Collection[str]) -> dict[str, Any]:
    """Return what other packages add to a group by its name; ``ours`` are the names already taken.

    Raises
    ------
    UsageError
        A name is taken, or what it stands for cannot be imported.
    """
    entries: dict[str, Any] = {}
    for entry in _entries(group):
        if entry.name in ours or entry.name in entries:
            raise wrong(entry.name, group, "is a name that is already taken.")
        try:
            entries[entry.name] = entry.load()
        except Exception as error:  # a foreign module may fail in any way
            problem = f"cannot be imported ({type(error).__name__}: {error})."
            raise wrong(entry.name, group, problem) from error
    return entries


def listed() -> list[tuple[str, str, str]]:
    """Return group, name and package of everything that other packages add."""
    return [
        (group, entry.name, f"{entry.dist.name} {entry.dist.version}" if entry.dist else "")
        for group in GROUPS
        for entry in sorted(_entries(group), key=lambda entry: entry.name)
    ]


@cache
def providers() -> dict[str, str]:
    """Return name and version of each package that adds something, sorted: results depend on them."""
    packages = (entry.dist for group in GROUPS for entry in _entries(group))
    return dict(sorted((package.name, package.version) for package in packages if package))


def wrong(name: str, group: str, problem: str) -> UsageError:
    """Return the complaint on an entry point."""
    owner = next((entry.dist.name for entry in _entries(group) if entry.name == name and entry.dist), "")
    remedy = f"Mend or uninstall the package {owner}." if owner else "Mend the package that adds it."
    return UsageError(problem, key=f"entry point fem_impact.{group}: {name}", remedy=remedy)


@cache
def _entries(group: str) -> tuple[EntryPoint, ...]:
    return tuple(entry_points(group=f"fem_impact.{group}"))
